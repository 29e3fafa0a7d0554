// SPDX-License-Identifier: MIT
// Command lines that a person can paste into a shell.
#pragma once
#include <span>
#include <string>

namespace relume::app {

/// The words as one line that a POSIX shell splits into the same words again.
std::string shellLine(std::span<const std::string> words);

}  // namespace relume::app
