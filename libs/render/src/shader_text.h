// SPDX-License-Identifier: MIT
// The texts of shaders/, which the library carries.
#pragma once
#include <string>

namespace relume::render {

/// "#version", `defines` and the text, with each line `#include "name"` replaced by that text. Lines keep
/// their numbers, in the file and in what it includes. Includes do not nest twice into the same file.
std::string shaderText(const std::string& name, const std::string& defines = {});

}  // namespace relume::render
