// SPDX-License-Identifier: MIT
// Arrays of integers or floats in buffer views, each with the JSON object that describes it (docs/format.md,
// "Planes").
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "json_node.h"
#include "relume/asset/asset.h"
#include "relume/codec/compress.h"

namespace relume::asset {

/// Collects views and describes what it put there.
class ArrayWriter {
 public:
  explicit ArrayWriter(std::vector<std::vector<std::byte>>& views) : views_(views) {}

  /// `values`: [count][channels] of the type that `storage` names.
  template <class T>
  Json write(const char* name, const char* storage, std::span<const T> values, std::size_t channels,
             codec::Filter filter = codec::Filter::kDelta) {
    return writeBytes(name, storage, std::as_bytes(values), {sizeof(T), channels}, filter);
  }
  template <class T>
  Json write(const char* name, const char* storage, const std::vector<T>& values, std::size_t channels,
             codec::Filter filter = codec::Filter::kDelta) {
    return write(name, storage, std::span<const T>(values), channels, filter);
  }
  /// With the filter that leaves the fewest bytes.
  template <class T>
  Json writeSmallest(const char* name, const char* storage, const std::vector<T>& values,
                     std::size_t channels) {
    return writeSmallest(name, storage, std::as_bytes(std::span(values)), {sizeof(T), channels});
  }

 private:
  Json writeSmallest(const char* name, const char* storage, std::span<const std::byte> bytes,
                     codec::Layout layout);
  Json describe(const char* name, const char* storage, std::size_t bytes, codec::Layout layout,
                codec::Filter filter, std::vector<std::byte> stored);
  Json writeBytes(const char* name, const char* storage, std::span<const std::byte> bytes,
                  codec::Layout layout, codec::Filter filter);
  std::vector<std::vector<std::byte>>& views_;
};

/// What a description says of its array, checked against itself.
struct ArrayInfo {
  std::string name, storage;
  std::size_t channels = 0, count = 0;
};

class ArrayReader {
 public:
  /// `views`: the document's bufferViews; `bin`: buffer 0.
  ArrayReader(JsonNode document, std::span<const std::byte> bin, const DecodeLimits& limits)
      : document_(std::move(document)), bin_(bin), bytes_left_(limits.max_bytes) {}

  /// Throws Error kCorruptAsset unless the storage's element has the size of T; the caller checks the storage
  /// itself.
  template <class T>
  std::vector<T> read(const JsonNode& plane) {
    const std::vector<std::byte> bytes = readBytes(plane, sizeof(T));
    std::vector<T> values(bytes.size() / sizeof(T));
    copyBytes(bytes, values.data());
    return values;
  }
  static ArrayInfo info(const JsonNode& plane);
  /// Counts memory that decoded data takes. Throws Error kOutOfMemory beyond the limit.
  void reserve(const JsonNode& plane, std::uint64_t bytes);

 private:
  std::vector<std::byte> readBytes(const JsonNode& plane, std::size_t element_size);
  std::span<const std::byte> storedBytes(const JsonNode& plane) const;
  static void copyBytes(std::span<const std::byte> bytes, void* to);

  JsonNode document_;
  std::span<const std::byte> bin_;
  std::uint64_t bytes_left_;
};

}  // namespace relume::asset
