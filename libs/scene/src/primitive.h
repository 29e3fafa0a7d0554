// SPDX-License-Identifier: MIT
// The geometry of one glTF primitive, Draco-compressed or not.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "access.h"
#include "compression.h"

namespace relume::scene::gltf {

enum class Mode : std::uint32_t {
  kPoints,
  kLines,
  kLineLoop,
  kLineStrip,
  kTriangles,
  kTriangleStrip,
  kTriangleFan
};

class PrimitiveReader {
 public:
  /// Decodes a Draco stream at once. `access` must outlive this.
  PrimitiveReader(Access& access, const Value& primitive);

  Mode mode() const { return mode_; }
  /// Number of elements of POSITION; 0 when there is no POSITION.
  std::uint32_t vertexCount() const { return vertices_; }
  /// Nothing when the primitive has no such attribute. Throws Error kInvalidValue when it has fewer elements
  /// than POSITION.
  std::optional<Accessor> attribute(const std::string& semantic);
  /// An attribute of a morph target.
  Accessor targetAttribute(std::size_t target, const std::string& semantic);
  /// Corners of the triangles, in the order of the file; all below vertexCount(). Empty for points and lines.
  std::vector<UVec3> triangles();
  bool isDraco() const { return draco_.has_value(); }

 private:
  std::vector<std::uint32_t> indices();
  Accessor checked(Accessor accessor) const;

  Access& access_;
  Value primitive_;
  Mode mode_;
  std::uint32_t vertices_ = 0;
  std::optional<DracoMesh> draco_;
  std::vector<std::string> draco_semantics_;
};

}  // namespace relume::scene::gltf
