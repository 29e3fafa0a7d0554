// SPDX-License-Identifier: MIT
// Progress on the terminal: one line that is rewritten, or JSON lines for tools, or nothing.
#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "relume/core/progress.h"

namespace relume::app {

/// `mode`: "auto" (a line when stderr is a terminal, else nothing), "json" (objects
/// {"stage","fraction","elapsed_s","left_s"} on stderr, one a line, at most ten a second), "none".
std::unique_ptr<Progress> makeConsoleProgress(const std::string& mode);

}  // namespace relume::app
