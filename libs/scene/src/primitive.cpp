// SPDX-License-Identifier: MIT
#include "primitive.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "extensions.h"

namespace relume::scene::gltf {

PrimitiveReader::PrimitiveReader(Access& access, const Value& primitive)
    : access_(access), primitive_(primitive) {
  const std::uint64_t mode = primitive["mode"].integer(4);
  if (mode > 6) primitive["mode"].fail(ErrorCode::kInvalidValue, fmt::format("is {}, no mode of glTF", mode));
  mode_ = static_cast<Mode>(mode);

  const Value attributes = primitive["attributes"];
  if (!attributes) primitive.fail(ErrorCode::kInvalidValue, "has no attributes");
  if (const Value draco = primitive.extension(kDracoExtension)) {
    std::vector<DracoRequest> requests;
    const Value ids = draco["attributes"];
    if (!ids || !ids.json().is_object()) draco.fail(ErrorCode::kInvalidValue, "has no attributes");
    for (const auto& [semantic, id] : ids.json().items()) {
      const Value reference = attributes[semantic];
      if (!reference) ids[semantic].fail(ErrorCode::kInvalidReference, "is no attribute of the primitive");
      const Accessor shape = access.accessor(reference);
      if (shape.rows != shape.components)
        shape.fail(ErrorCode::kInvalidValue, "is a matrix, which Draco cannot hold");
      const std::uint64_t unique = ids[semantic].integer();
      if (unique > 0xffffffffu) ids[semantic].fail(ErrorCode::kInvalidReference, "is no Draco attribute");
      requests.push_back(
          {static_cast<std::uint32_t>(unique), shape.component, shape.components, shape.subject});
      draco_semantics_.push_back(semantic);
    }
    const std::uint32_t view = draco["bufferView"].index(access.root()["bufferViews"].size(), "buffer view");
    draco_ = decodeDraco(access.viewBytes(view), requests, draco.subject());
    vertices_ = draco_->vertices;
  } else if (const Value positions = attributes["POSITION"]) {
    vertices_ = access.accessor(positions).count;
  }
}

Accessor PrimitiveReader::checked(Accessor accessor) const {
  if (accessor.count < vertices_)
    accessor.fail(ErrorCode::kInvalidValue, fmt::format("has {} elements, but the primitive has {} vertices",
                                                        accessor.count, vertices_));
  return accessor;
}

std::optional<Accessor> PrimitiveReader::attribute(const std::string& semantic) {
  const Value reference = primitive_["attributes"][semantic];
  if (!reference) return std::nullopt;
  Accessor accessor = access_.accessor(reference);
  const auto found = std::ranges::find(draco_semantics_, semantic);
  if (!draco_ || found == draco_semantics_.end()) return checked(std::move(accessor));
  // The stream's own count holds; the accessor tells the type alone.
  const auto& bytes = draco_->attributes[static_cast<std::size_t>(found - draco_semantics_.begin())];
  accessor.count = draco_->vertices;
  accessor.stride = accessor.element_size;
  accessor.data = bytes.data();
  return accessor;
}

Accessor PrimitiveReader::targetAttribute(std::size_t target, const std::string& semantic) {
  return checked(access_.accessor(primitive_["targets"].at(target)[semantic]));
}

std::vector<std::uint32_t> PrimitiveReader::indices() {
  std::vector<std::uint32_t> out;
  if (draco_) {
    out = std::move(draco_->indices);
    draco_->indices.clear();
  } else if (const Value reference = primitive_["indices"]) {
    const Accessor accessor = access_.accessor(reference);
    out = readIndices(accessor);
    for (const std::uint32_t i : out)
      if (i >= vertices_)
        accessor.fail(ErrorCode::kOutOfBounds,
                      fmt::format("names vertex {}, but POSITION has {}", i, vertices_));
  } else {
    out.resize(vertices_);
    std::iota(out.begin(), out.end(), 0u);
  }
  return out;
}

std::vector<UVec3> PrimitiveReader::triangles() {
  std::vector<UVec3> out;
  if (mode_ < Mode::kTriangles) return out;
  const std::vector<std::uint32_t> corner = indices();
  for (const std::uint32_t i : corner)
    if (i >= vertices_)
      primitive_.fail(ErrorCode::kOutOfBounds, fmt::format("names vertex {} of {}", i, vertices_));
  const std::size_t n = corner.size();
  // A Draco stream is always a list. Corners left over at the end of a list are no triangle.
  if (mode_ == Mode::kTriangles || draco_) {
    out.reserve(n / 3);
    for (std::size_t i = 0; i + 2 < n; i += 3) out.emplace_back(corner[i], corner[i + 1], corner[i + 2]);
  } else if (n >= 3) {
    out.reserve(n - 2);
    for (std::size_t i = 0; i + 2 < n; ++i)
      if (mode_ == Mode::kTriangleStrip)
        out.emplace_back(corner[i], corner[i + 1 + i % 2], corner[i + 2 - i % 2]);
      else
        out.emplace_back(corner[i + 1], corner[i + 2], corner[0]);
  }
  return out;
}

}  // namespace relume::scene::gltf
