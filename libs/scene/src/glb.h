// SPDX-License-Identifier: MIT
// The binary glTF container, version 2: a header, a JSON chunk, at most one binary chunk.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relume/core/error.h"

namespace relume::scene::gltf {

struct GlbChunks {
  std::string_view json;
  std::optional<std::span<const std::byte>> binary;
};

bool isGlb(std::span<const std::byte> file);

/// Chunks of unknown type are skipped. Throws Error kTruncated, kUnsupported (version), kNotGltf.
GlbChunks splitGlb(std::span<const std::byte> file, const std::string& name);

/// Joins a JSON text and pieces of binary data into a .glb; each piece begins at a multiple of 4, see
/// alignedSize.
std::vector<std::byte> joinGlb(std::string json, const std::vector<std::span<const std::byte>>& pieces);

inline std::size_t alignedSize(std::size_t size) { return (size + 3) / 4 * 4; }

}  // namespace relume::scene::gltf
