// SPDX-License-Identifier: MIT
// Content hashes for caches and checksums for files.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace relume {

/// 128 bits of XXH3; equal content, equal digest. Not cryptographic.
struct Digest {
  std::uint64_t lo = 0, hi = 0;
  auto operator<=>(const Digest&) const = default;
  std::string hex() const;  ///< 32 lower-case digits
};

/// Feeds values in order; strings and vectors include their length, so that ("ab","c") differs from
/// ("a","bc").
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  Hasher& bytes(const void* data, std::size_t size);
  template <class T>
  requires std::is_trivially_copyable_v<T> Hasher& add(const T& value) { return bytes(&value, sizeof value); }
  Hasher& add(std::string_view text);
  template <class T>
  Hasher& addAll(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::uint64_t count = values.size();
    return bytes(&count, sizeof count).bytes(values.data(), values.size_bytes());
  }
  template <class T>
  Hasher& addAll(const std::vector<T>& values) {
    return addAll(std::span<const T>(values));
  }
  Digest digest() const;

 private:
  void* state_;
};

/// CRC-32 as in PNG and zip (ISO 3309), the checksum of the asset file.
std::uint32_t crc32(std::span<const std::byte> data);

}  // namespace relume
