// SPDX-License-Identifier: MIT
#include "relume/core/hash.h"

#include <fmt/format.h>
#include <xxhash.h>
#include <zlib.h>

#include <algorithm>

namespace relume {

std::string Digest::hex() const { return fmt::format("{:016x}{:016x}", hi, lo); }

Hasher::Hasher() : state_(XXH3_createState()) { XXH3_128bits_reset(static_cast<XXH3_state_t*>(state_)); }
Hasher::~Hasher() { XXH3_freeState(static_cast<XXH3_state_t*>(state_)); }

Hasher& Hasher::bytes(const void* data, std::size_t size) {
  if (size) XXH3_128bits_update(static_cast<XXH3_state_t*>(state_), data, size);
  return *this;
}
Hasher& Hasher::add(std::string_view text) {
  const std::uint64_t size = text.size();
  return bytes(&size, sizeof size).bytes(text.data(), text.size());
}
Digest Hasher::digest() const {
  const XXH128_hash_t h = XXH3_128bits_digest(static_cast<const XXH3_state_t*>(state_));
  return {h.low64, h.high64};
}

std::uint32_t crc32(std::span<const std::byte> data) {
  uLong crc = ::crc32(0L, nullptr, 0);
  const auto* p = reinterpret_cast<const Bytef*>(data.data());
  for (std::size_t done = 0; done < data.size();) {
    const auto step = static_cast<uInt>(std::min<std::size_t>(data.size() - done, 1u << 30));
    crc = ::crc32(crc, p + done, step);
    done += step;
  }
  return static_cast<std::uint32_t>(crc);
}

}  // namespace relume
