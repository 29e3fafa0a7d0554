// SPDX-License-Identifier: MIT
// The file formats behind io.h, one source file each. Every decoder gets the whole file in memory and throws
// Error.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "relume/image/image.h"

namespace relume::image::detail {

using Bytes = std::span<const std::byte>;

enum class FileKind { kUnknown, kExr, kHdr, kPng, kJpeg, kWebp };

/// By the first bytes.
FileKind fileKind(Bytes file);

/// Integer pixels of a texture file. shape: [height][width][channels], each value of `bytes_per_value` bytes,
/// native order
struct Texels {
  int width = 0, height = 0, channels = 0, bytes_per_value = 1;
  std::vector<unsigned char> data;
};

/// Largest side and most pixels of any image file.
inline constexpr std::int64_t kMaxSide = 65536;
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 30;

/// Throws kUnsupported over the limits and kFileUnreadable when the size cannot follow from `file_bytes`
/// bytes, so that a small file cannot ask for much memory.
void requirePlausibleSize(std::int64_t width, std::int64_t height, std::size_t file_bytes,
                          const std::string& subject);

[[noreturn]] void throwTruncated(const std::string& subject);
[[noreturn]] void throwUnreadable(const std::string& subject, const std::string& format,
                                  const std::string& why);

Texels decodePng(Bytes file, const std::string& subject, bool keep_16_bits);
Texels decodeJpeg(Bytes file, const std::string& subject);
Texels decodeWebp(Bytes file, const std::string& subject);
Image decodeHdr(Bytes file, const std::string& subject);
Image decodeExr(Bytes file, const std::string& subject);

/// 8 bits per value. Throws kUnsupported when PNG cannot hold the image.
std::vector<std::byte> encodePng(const Texels& texels);
std::vector<std::byte> encodeHdr(const Image& image);
std::vector<std::byte> encodeExr(const Image& image);

inline std::uint8_t byteAt(Bytes file, std::size_t i) { return std::to_integer<std::uint8_t>(file[i]); }

}  // namespace relume::image::detail
