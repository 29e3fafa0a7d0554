// SPDX-License-Identifier: MIT
#include "access.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "compression.h"
#include "extensions.h"

namespace relume::scene::gltf {

namespace {

constexpr std::byte kZeros[64] = {};  // the largest element is a MAT4 of floats

struct Shape {
  const char* name;
  std::uint32_t rows, columns;
};
constexpr Shape kShapes[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1},
                             {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};

Component componentOf(const Value& value) {
  const std::uint64_t code = value.integer();
  switch (code) {
    case 5120:
    case 5121:
    case 5122:
    case 5123:
    case 5125:
    case 5126:
      return static_cast<Component>(code);
    default:
      value.fail(ErrorCode::kInvalidValue, fmt::format("is {}, no component type of glTF", code));
  }
}

template <class T>
T load(const std::byte* p) {
  T v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

template <class T>
float toFloat(T v, bool normalized) {
  if constexpr (std::is_same_v<T, float>) {
    return v;
  } else {
    if (!normalized) return static_cast<float>(v);
    const float f = static_cast<float>(v) / static_cast<float>(std::numeric_limits<T>::max());
    return std::max(f, -1.0f);
  }
}

/// Calls body with a value of the component's type.
template <class Body>
auto withType(Component component, Body body) {
  switch (component) {
    case Component::kByte:
      return body(std::int8_t{});
    case Component::kUnsignedByte:
      return body(std::uint8_t{});
    case Component::kShort:
      return body(std::int16_t{});
    case Component::kUnsignedShort:
      return body(std::uint16_t{});
    case Component::kUnsignedInt:
      return body(std::uint32_t{});
    case Component::kFloat:
      break;
  }
  return body(float{});
}

}  // namespace

std::size_t sizeOf(Component component) {
  return withType(component, [](auto v) { return sizeof v; });
}

std::span<const std::byte> Access::bufferRange(const Value& place, const Value& range) {
  const std::uint32_t index = range["buffer"].index(document_.buffers_.size(), "buffer");
  const auto& buffer = document_.buffers_[index];
  if (!buffer)
    place.fail(ErrorCode::kInvalidReference,
               fmt::format("needs buffer {}, of which the file has no data", index),
               "put its file beside the glTF file or export as .glb");
  const std::uint64_t offset = range["byteOffset"].integer(0), length = range["byteLength"].integer();
  if (offset > buffer->size() || length > buffer->size() - offset)
    place.fail(ErrorCode::kOutOfBounds, fmt::format("covers bytes {} to {} of buffer {}, which has {}",
                                                    offset, offset + length, index, buffer->size()));
  return std::span(*buffer).subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

std::span<const std::byte> Access::viewBytes(std::uint32_t index) {
  if (const auto found = decompressed_.find(index); found != decompressed_.end()) return found->second;
  const Value view = root_["bufferViews"].at(index);
  for (const char* name : kMeshoptExtensions)
    if (const Value compression = view.extension(name)) return decompressed(index, view, compression);
  return bufferRange(view, view);
}

std::span<const std::byte> Access::decompressed(std::uint32_t index, const Value& view,
                                                const Value& compression) {
  CompressedView packed;
  packed.bytes = bufferRange(compression, compression);
  packed.mode = compression["mode"].text("");
  packed.filter = compression["filter"].text("NONE");
  packed.subject = compression.subject();
  const std::uint64_t stride = compression["byteStride"].integer(), count = compression["count"].integer();
  if (stride == 0 || stride > 256)
    compression["byteStride"].fail(ErrorCode::kInvalidValue,
                                   fmt::format("is {}; 1 to 256 are possible", stride));
  // The codec cannot pack more than 64 bytes of zeros into one.
  if (count > Access::plausibleCount(packed.bytes.size()))
    compression["count"].fail(
        ErrorCode::kOutOfBounds,
        fmt::format("is {}, more than {} compressed bytes can hold", count, packed.bytes.size()));
  packed.stride = static_cast<std::size_t>(stride);
  packed.count = static_cast<std::size_t>(count);
  const std::uint64_t length = view["byteLength"].integer();
  std::vector<std::byte> bytes = decompressView(packed);
  if (length > bytes.size())
    view["byteLength"].fail(ErrorCode::kOutOfBounds,
                            fmt::format("is {}, but only {} bytes were compressed", length, bytes.size()));
  bytes.resize(static_cast<std::size_t>(length));
  return decompressed_.emplace(index, std::move(bytes)).first->second;
}

std::span<const std::byte> Access::elements(const Value& place, std::uint32_t view, std::uint64_t offset,
                                            std::size_t stride, std::size_t element_size, std::size_t count) {
  const auto bytes = viewBytes(view);
  const std::uint64_t needed =
      count == 0 ? 0 : static_cast<std::uint64_t>(stride) * (count - 1) + element_size;
  if (offset > bytes.size() || needed > bytes.size() - offset)
    place.fail(ErrorCode::kOutOfBounds,
               fmt::format("{} elements from byte {} need {} bytes, but bufferViews[{}] has {}", count,
                           offset, needed, view, bytes.size()));
  return bytes.subspan(static_cast<std::size_t>(offset));
}

ElementLayout layoutOf(const Value& accessor, const Value& view) {
  ElementLayout layout;
  const std::string type = accessor["type"].text("");
  const auto* shape = std::ranges::find(kShapes, type, &Shape::name);
  if (shape == std::end(kShapes))
    accessor["type"].fail(ErrorCode::kInvalidValue,
                          fmt::format("is \"{}\", no type of glTF", type.substr(0, 20)));
  layout.component = componentOf(accessor["componentType"]);
  layout.rows = shape->rows;
  layout.components = shape->rows * shape->columns;
  const std::size_t column = shape->rows * sizeOf(layout.component), padded = (column + 3) / 4 * 4;
  layout.element_size = shape->columns == 1 ? column : padded * (shape->columns - 1) + column;

  const std::uint64_t count = accessor["count"].integer();
  if (count > std::numeric_limits<std::uint32_t>::max() - 1)
    accessor["count"].fail(ErrorCode::kOutOfBounds, fmt::format("is {}, more than can be indexed", count));
  layout.count = static_cast<std::uint32_t>(count);

  const std::uint64_t stride = view["byteStride"].integer(0);
  if (stride > 65536) view["byteStride"].fail(ErrorCode::kInvalidValue, "is more than any element needs");
  layout.stride = stride != 0           ? static_cast<std::size_t>(stride)
                  : shape->columns == 1 ? column
                                        : padded * shape->columns;
  return layout;
}

Accessor Access::accessor(const Value& reference) {
  const Value accessors = root_["accessors"], views = root_["bufferViews"];
  const std::uint32_t index = reference.index(accessors.size(), "accessor");
  const Value json = accessors.at(index), view = json["bufferView"];
  Accessor accessor;
  accessor.subject = fmt::format("{} ({})", reference.subject(), json.path());
  accessor.normalized = json["normalized"].boolean(false);
  if (view) {
    const std::uint32_t v = view.index(views.size(), "buffer view");
    static_cast<ElementLayout&>(accessor) = layoutOf(json, views.at(v));
    accessor.data = elements(json, v, json["byteOffset"].integer(0), accessor.stride, accessor.element_size,
                             accessor.count)
                        .data();
  } else {
    static_cast<ElementLayout&>(accessor) = layoutOf(json, view);
    if (accessor.count > plausibleCount(inputBytes()))
      json["count"].fail(ErrorCode::kOutOfBounds,
                         fmt::format("is {} without a buffer view, too many for a file of {} bytes",
                                     accessor.count, inputBytes()));
    accessor.stride = 0;
    accessor.data = kZeros;
  }
  if (const Value sparse = json["sparse"]) applySparse(accessor, sparse);
  return accessor;
}

void Access::applySparse(Accessor& accessor, const Value& sparse) {
  const Value views = root_["bufferViews"], indices = sparse["indices"], values = sparse["values"];
  const std::uint64_t count = sparse["count"].integer();
  if (count > accessor.count)
    sparse["count"].fail(ErrorCode::kOutOfBounds, fmt::format("is {} of {} elements", count, accessor.count));
  Accessor where;
  where.subject = indices.subject();
  where.component = componentOf(indices["componentType"]);
  where.count = static_cast<std::uint32_t>(count);
  where.element_size = where.stride = sizeOf(where.component);
  where.data = elements(indices, indices["bufferView"].index(views.size(), "buffer view"),
                        indices["byteOffset"].integer(0), where.stride, where.element_size, where.count)
                   .data();
  const std::byte* substitutes =
      elements(values, values["bufferView"].index(views.size(), "buffer view"),
               values["byteOffset"].integer(0), accessor.element_size, accessor.element_size, where.count)
          .data();

  auto bytes = std::make_shared<std::vector<std::byte>>(accessor.count * accessor.element_size);
  if (accessor.data != kZeros)
    for (std::size_t i = 0; i < accessor.count; ++i)
      std::memcpy(bytes->data() + i * accessor.element_size, accessor.element(i), accessor.element_size);
  const std::vector<std::uint32_t> targets = readIndices(where);
  for (std::size_t k = 0; k < targets.size(); ++k) {
    if (targets[k] >= accessor.count)
      indices.fail(ErrorCode::kOutOfBounds,
                   fmt::format("names element {} of {}", targets[k], accessor.count));
    std::memcpy(bytes->data() + targets[k] * accessor.element_size, substitutes + k * accessor.element_size,
                accessor.element_size);
  }
  accessor.stride = accessor.element_size;
  accessor.data = bytes->data();
  accessor.owned = std::move(bytes);
}

template <int N>
std::vector<glm::vec<N, float>> readVectors(const Accessor& accessor, std::span<const std::uint32_t> pick) {
  if (accessor.components < N || accessor.rows != accessor.components)
    accessor.fail(ErrorCode::kInvalidValue,
                  fmt::format("has {} components instead of {}", accessor.components, N));
  std::vector<glm::vec<N, float>> out(pick.empty() ? accessor.count : pick.size());
  withType(accessor.component, [&](auto sample) {
    using T = decltype(sample);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::byte* p = accessor.element(pick.empty() ? i : pick[i]);
      for (int k = 0; k < N; ++k) out[i][k] = toFloat(load<T>(p + k * sizeof(T)), accessor.normalized);
    }
  });
  return out;
}
template std::vector<Vec2> readVectors<2>(const Accessor&, std::span<const std::uint32_t>);
template std::vector<Vec3> readVectors<3>(const Accessor&, std::span<const std::uint32_t>);
template std::vector<Vec4> readVectors<4>(const Accessor&, std::span<const std::uint32_t>);

std::vector<std::uint32_t> readIndices(const Accessor& accessor) {
  if (accessor.components != 1) accessor.fail(ErrorCode::kInvalidValue, "holds indices but is not SCALAR");
  std::vector<std::uint32_t> out(accessor.count);
  withType(accessor.component, [&](auto sample) {
    using T = decltype(sample);
    if constexpr (std::is_unsigned_v<T>) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = load<T>(accessor.element(i));
    } else {
      accessor.fail(ErrorCode::kInvalidValue, "holds indices but is not of unsigned integers");
    }
  });
  return out;
}

std::vector<std::byte> gatherBytes(const Accessor& accessor, std::span<const std::uint32_t> pick,
                                   std::size_t stride) {
  std::vector<std::byte> out(pick.size() * stride);
  for (std::size_t i = 0; i < pick.size(); ++i)
    std::memcpy(out.data() + i * stride, accessor.element(pick[i]), accessor.element_size);
  return out;
}

}  // namespace relume::scene::gltf
