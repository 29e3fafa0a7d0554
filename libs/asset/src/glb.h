// SPDX-License-Identifier: MIT
// The binary glTF container: header, JSON chunk, BIN chunk.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relume::asset {

struct Glb {
  std::string_view json;           ///< points into the file
  std::span<const std::byte> bin;  ///< points into the file; empty where there is none
};

/// Throws Error kNotGltf, kTruncated, kUnsupported. Unknown chunks and bytes after the end are passed over.
Glb parseGlb(std::span<const std::byte> file, const std::string& name);

std::vector<std::byte> writeGlb(std::string json, std::span<const std::byte> bin);

}  // namespace relume::asset
