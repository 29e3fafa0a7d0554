// SPDX-License-Identifier: MIT
// Decoders of compressed geometry: EXT_meshopt_compression by meshoptimizer, KHR_draco_mesh_compression by
// Draco. The libraries are made for untrusted input, but their preconditions and the sizes they allocate are
// checked here.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "access.h"

namespace relume::scene::gltf {

/// The extension's fields; stride in [1, 256], count plausible.
struct CompressedView {
  std::span<const std::byte> bytes;
  std::string mode, filter, subject;
  std::size_t stride = 0, count = 0;
};
/// stride * count bytes. Throws Error kInvalidValue.
std::vector<std::byte> decompressView(const CompressedView& view);

/// What a Draco stream holds, in the component types that the glTF accessors ask for.
struct DracoMesh {
  std::vector<std::uint32_t> indices;  ///< of a triangle list
  std::uint32_t vertices = 0;
  std::vector<std::vector<std::byte>> attributes;  ///< as requested, without gaps
};
struct DracoRequest {
  std::uint32_t id = 0;  ///< Draco's unique id
  Component component = Component::kFloat;
  std::uint32_t components = 1;
  std::string subject;
};
/// Throws Error kInvalidValue, kUnsupported.
DracoMesh decodeDraco(std::span<const std::byte> bytes, const std::vector<DracoRequest>& requests,
                      const std::string& subject);

}  // namespace relume::scene::gltf
