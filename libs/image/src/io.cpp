// SPDX-License-Identifier: MIT
#include "relume/image/io.h"

#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>

#include "codecs.h"
#include "relume/core/check.h"
#include "relume/core/error.h"
#include "relume/core/file.h"

namespace relume::image {
namespace {

using namespace detail;

Texels decodeTexels(Bytes file, const std::string& subject, bool keep_16_bits) {
  switch (fileKind(file)) {
    case FileKind::kPng:
      return decodePng(file, subject, keep_16_bits);
    case FileKind::kJpeg:
      return decodeJpeg(file, subject);
    case FileKind::kWebp:
      return decodeWebp(file, subject);
    default:
      break;
  }
  if (file.size() < 12) throwTruncated(subject);
  throw Error(ErrorCode::kUnsupported, subject, "is not a PNG, JPEG or WebP image",
              "convert it to one of them");
}

// Grey and alpha become red, green, blue and alpha: no reader of an Image meets two channels.
Image toLinear(const Texels& texels) {
  const int values = texels.bytes_per_value == 2 ? 65536 : 256;
  std::vector<float> linear(static_cast<std::size_t>(values));
  for (int i = 0; i < values; ++i)
    linear[static_cast<std::size_t>(i)] =
        srgbToLinear(static_cast<float>(i) / static_cast<float>(values - 1));
  const auto value = [&](std::size_t i) -> std::size_t {
    if (texels.bytes_per_value == 1) return texels.data[i];
    std::uint16_t v;
    std::memcpy(&v, texels.data.data() + 2 * i, sizeof v);
    return v;
  };
  const auto channels = static_cast<std::size_t>(texels.channels);
  const bool has_alpha = channels == 2 || channels == 4;
  Image out(texels.width, texels.height, channels == 2 ? 4 : texels.channels);
  const auto out_channels = static_cast<std::size_t>(out.channels);
  for (std::size_t p = 0; p < out.pixels(); ++p) {
    float* to = out.data.data() + p * out_channels;
    for (std::size_t c = 0; c < out_channels; ++c) {
      const bool is_alpha = has_alpha && c + 1 == out_channels;
      const std::size_t from = is_alpha ? channels - 1 : channels == 2 ? 0 : c;
      const std::size_t v = value(p * channels + from);
      to[c] = is_alpha ? static_cast<float>(v) / static_cast<float>(values - 1) : linear[v];
    }
  }
  return out;
}

unsigned char toByte(float v) {
  return static_cast<unsigned char>(255.0f * (v > 0.0f ? std::min(v, 1.0f) : 0.0f) + 0.5f);  // NaN becomes 0
}

std::vector<std::byte> encodePng(const Image& image, bool srgb) {
  Texels texels{image.width, image.height, image.channels, 1, {}};
  texels.data.resize(image.data.size());
  const auto channels = static_cast<std::size_t>(image.channels);
  const bool has_alpha = channels == 2 || channels == 4;
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const bool is_alpha = has_alpha && i % channels == channels - 1;
    texels.data[i] = toByte(srgb && !is_alpha ? linearToSrgb(image.data[i]) : image.data[i]);
  }
  return detail::encodePng(texels);
}

std::string lowerExtension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

void checkShape(const Image& image) {
  RELUME_CHECK(image.channels >= 1 && image.channels <= 4);
  RELUME_CHECK(image.width > 0 && image.height > 0);
  RELUME_CHECK_EQ(image.data.size(), image.pixels() * static_cast<std::size_t>(image.channels));
}

std::uint32_t bigEndian(Bytes file, std::size_t at, std::size_t count) {
  std::uint32_t v = 0;
  for (std::size_t i = 0; i < count; ++i) v = v << 8 | byteAt(file, at + i);
  return v;
}

// The size stands in the frame header, SOF0 to SOF15 without the tables DHT (C4), JPG (C8) and DAC (CC).
std::optional<IVec2> jpegSize(Bytes file) {
  for (std::size_t at = 2; at + 4 <= file.size();) {
    if (byteAt(file, at) != 0xff) return std::nullopt;
    const std::uint8_t marker = byteAt(file, at + 1);
    if (marker == 0xff) {
      ++at;  // fill byte
      continue;
    }
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame && at + 9 <= file.size()) return IVec2(bigEndian(file, at + 7, 2), bigEndian(file, at + 5, 2));
    const std::uint32_t length = bigEndian(file, at + 2, 2);
    if (length < 2 || marker == 0xda) return std::nullopt;
    at += 2 + length;
  }
  return std::nullopt;
}

}  // namespace

Image readImage(const std::filesystem::path& path) { return decodeImage(readFile(path), path.string()); }

Image decodeImage(std::span<const std::byte> file, const std::string& subject) {
  switch (fileKind(file)) {
    case FileKind::kExr:
      return decodeExr(file, subject);
    case FileKind::kHdr:
      return decodeHdr(file, subject);
    case FileKind::kUnknown:
      break;
    default:
      return toLinear(decodeTexels(file, subject, true));
  }
  if (file.size() < 12) throwTruncated(subject);
  throw Error(ErrorCode::kUnsupported, subject, "is not an EXR, HDR, PNG, JPEG or WebP image",
              "convert it to one of them");
}

void writeImage(const std::filesystem::path& path, const Image& image) {
  checkShape(image);
  const std::string extension = lowerExtension(path);
  if (extension == ".exr") return writeExr(path, image);
  if (extension == ".hdr") return writeFileAtomically(path, encodeHdr(image));
  if (extension == ".png") return writeFileAtomically(path, encodePngSrgb(image));
  throw Error(ErrorCode::kUsage, path.string(), "images are written as .exr, .hdr or .png",
              "end the name with one of them");
}

void writeExr(const std::filesystem::path& path, const Image& image) {
  checkShape(image);
  writeFileAtomically(path, encodeExr(image));
}

std::vector<std::byte> encodePngData(const Image& values) {
  checkShape(values);
  return encodePng(values, false);
}

std::vector<std::byte> encodePngSrgb(const Image& linear) {
  checkShape(linear);
  return encodePng(linear, true);
}

Image8 decodeTexture(std::span<const std::byte> file, const std::string& subject) {
  Texels texels = decodeTexels(file, subject, false);
  return {texels.width, texels.height, texels.channels, std::move(texels.data)};
}

std::optional<IVec2> textureSize(std::span<const std::byte> file) {
  IVec2 size(0);
  switch (fileKind(file)) {
    case FileKind::kPng:
      if (file.size() >= 24) size = IVec2(bigEndian(file, 16, 4), bigEndian(file, 20, 4));
      break;
    case FileKind::kJpeg:
      return jpegSize(file);
    case FileKind::kWebp:
      if (!WebPGetInfo(reinterpret_cast<const std::uint8_t*>(file.data()), file.size(), &size.x, &size.y))
        size = IVec2(0);
      break;
    default:
      break;
  }
  if (size.x <= 0 || size.y <= 0) return std::nullopt;
  return size;
}

}  // namespace relume::image
