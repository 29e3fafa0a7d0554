// SPDX-License-Identifier: MIT
// Bounds-checked views and accessors of a document. Nothing is allocated that the bytes of the file do not
// justify.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "json_value.h"
#include "relume/scene/gltf.h"

namespace relume::scene::gltf {

/// accessor.componentType
enum class Component : std::uint32_t {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
};
std::size_t sizeOf(Component component);

/// How an accessor lays its elements out. Throws Error kInvalidValue, kOutOfBounds.
struct ElementLayout {
  Component component = Component::kFloat;
  std::uint32_t components = 1;  ///< numbers in an element: 1 for SCALAR to 16 for MAT4
  std::uint32_t rows = 1;        ///< numbers in a column: matrix columns begin at multiples of 4 bytes
  std::uint32_t count = 0;
  std::size_t element_size = 0;  ///< bytes, with the padding between matrix columns
  std::size_t stride = 0;        ///< bytes from element to element
};
ElementLayout layoutOf(const Value& accessor, const Value& view);

/// Typed elements, sparse substitution done. The bytes live as long as the Access they came from and this
/// object.
struct Accessor : ElementLayout {
  bool normalized = false;
  const std::byte* data = nullptr;
  std::shared_ptr<const std::vector<std::byte>> owned;
  std::string subject;

  const std::byte* element(std::size_t i) const { return data + i * stride; }
  [[noreturn]] void fail(ErrorCode code, const std::string& problem) const {
    throw Error(code, subject, problem);
  }
};

class Access {
 public:
  explicit Access(const Document& document) : document_(document), root_(document.name_, document.json_) {}
  Access(const Access&) = delete;
  Access& operator=(const Access&) = delete;

  const Value& root() const { return root_; }
  const std::filesystem::path& folder() const { return document_.folder_; }
  /// The most elements that may come out of `bytes` of compressed or implied data. A flat grid, the best case
  /// of Draco, has 7 triangles in a byte; meshoptimizer packs at most 16 vertices into one.
  static std::size_t plausibleCount(std::size_t bytes) { return (std::size_t{1} << 16) + 64 * bytes; }
  std::size_t inputBytes() const { return document_.input_bytes_; }

  /// Bytes of a buffer view, decompressed. Valid while this lives.
  std::span<const std::byte> viewBytes(std::uint32_t view);
  /// The accessor that the JSON value `reference` names by its index.
  Accessor accessor(const Value& reference);

 private:
  std::span<const std::byte> bufferRange(const Value& place, const Value& range);
  std::span<const std::byte> decompressed(std::uint32_t index, const Value& view, const Value& compression);
  std::span<const std::byte> elements(const Value& place, std::uint32_t view, std::uint64_t offset,
                                      std::size_t stride, std::size_t element_size, std::size_t count);
  void applySparse(Accessor& accessor, const Value& sparse);

  const Document& document_;
  Value root_;
  std::map<std::uint32_t, std::vector<std::byte>> decompressed_;
};

/// Every element as N floats, normalized integers as the specification says; `pick` selects elements (empty:
/// all). Instances for N = 2, 3, 4. The accessor must have at least N components.
template <int N>
std::vector<glm::vec<N, float>> readVectors(const Accessor& accessor,
                                            std::span<const std::uint32_t> pick = {});

/// Elements of a SCALAR of unsigned integers.
std::vector<std::uint32_t> readIndices(const Accessor& accessor);

/// The elements `pick`ed, without gaps between them but for the padding to `stride` bytes each.
std::vector<std::byte> gatherBytes(const Accessor& accessor, std::span<const std::uint32_t> pick,
                                   std::size_t stride);

}  // namespace relume::scene::gltf
