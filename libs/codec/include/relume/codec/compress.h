// SPDX-License-Identifier: MIT
// Lossless compression of arrays of numbers: a reversible filter that makes them compressible, then
// Zstandard. docs/format.md gives both steps in pseudo-code.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace relume::codec {

/// What an array looks like to the filter: rows of `channels` little-endian integers of `element_size` bytes
/// each.
struct Layout {
  std::size_t element_size = 1;  ///< 1, 2 or 4 bytes
  std::size_t channels = 1;      ///< integers in a row
};

enum class Filter : std::uint8_t {
  kNone,     ///< the bytes as they are
  kShuffle,  ///< bytes of equal place and channel together: all lowest bytes of channel 0, then its next
             ///< bytes, then channel 1
  kDelta,    ///< each row less the row before (modulo 2^bits), then kShuffle
};

/// Deterministic for one version of Zstandard. `data` holds whole rows.
std::vector<std::byte> compress(std::span<const std::byte> data, Filter filter, Layout layout);

/// The `decoded_size` bytes that were compressed. Throws Error kCorruptAsset when `stored` is not exactly one
/// frame that says and has that size; allocates nothing before the frame has been seen to be large enough for
/// it.
std::vector<std::byte> decompress(std::span<const std::byte> stored, std::size_t decoded_size, Filter filter,
                                  Layout layout);

}  // namespace relume::codec
