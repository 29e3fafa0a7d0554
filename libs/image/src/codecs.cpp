// SPDX-License-Identifier: MIT
#include "codecs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "relume/core/error.h"

namespace relume::image::detail {
namespace {

bool startsWith(Bytes file, std::string_view magic, std::size_t at = 0) {
  if (file.size() < at + magic.size()) return false;
  return std::equal(magic.begin(), magic.end(), file.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char c, std::byte b) { return static_cast<std::byte>(c) == b; });
}

}  // namespace

FileKind fileKind(Bytes file) {
  if (startsWith(file, "\x76\x2f\x31\x01")) return FileKind::kExr;
  if (startsWith(file, "#?RADIANCE") || startsWith(file, "#?RGBE")) return FileKind::kHdr;
  if (startsWith(file, "\x89PNG\r\n\x1a\n")) return FileKind::kPng;
  if (startsWith(file, "\xff\xd8\xff")) return FileKind::kJpeg;
  if (startsWith(file, "RIFF") && startsWith(file, "WEBP", 8)) return FileKind::kWebp;
  return FileKind::kUnknown;
}

void requirePlausibleSize(std::int64_t width, std::int64_t height, std::size_t file_bytes,
                          const std::string& subject) {
  if (width <= 0 || height <= 0)
    throw Error(ErrorCode::kInvalidValue, subject, fmt::format("has {} x {} pixels", width, height));
  if (width > kMaxSide || height > kMaxSide || width * height > kMaxPixels)
    throw Error(ErrorCode::kUnsupported, subject,
                fmt::format("has {} x {} pixels; at most {} per side and {} in all are read", width, height,
                            kMaxSide, kMaxPixels),
                "make the image smaller");
  // Deflate packs at most 1032 : 1, so a PNG of one bit per pixel reaches 8256 pixels per byte; the other
  // formats reach about as much. A uniform lossless WebP has no bound, hence the first 16 million pixels are
  // free.
  const std::int64_t plausible =
      (std::int64_t{1} << 24) +
      8256 * static_cast<std::int64_t>(std::min<std::size_t>(file_bytes, kMaxPixels));
  if (width * height > plausible)
    throw Error(ErrorCode::kFileUnreadable, subject,
                fmt::format("claims {} x {} pixels in {} bytes", width, height, file_bytes),
                "save the image again");
}

void throwTruncated(const std::string& subject) {
  throw Error(ErrorCode::kTruncated, subject, "the image data ends early", "copy or save the file again");
}

void throwUnreadable(const std::string& subject, const std::string& format, const std::string& why) {
  throw Error(ErrorCode::kFileUnreadable, subject, fmt::format("is not a sound {} image: {}", format, why),
              "save the file again");
}

}  // namespace relume::image::detail
