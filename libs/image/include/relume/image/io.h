// SPDX-License-Identifier: MIT
// Image files. Readers treat every byte as untrusted and throw Error (kFileNotFound, kFileUnreadable,
// kTruncated, kUnsupported, kInvalidValue); writers replace the file whole or not at all and throw
// kCannotWrite.
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relume/image/image.h"

namespace relume::image {

/// Reads .exr (any channel type), .hdr, .png, .jpg, .webp by content, not by name. 8- and 16-bit files are
/// taken as sRGB and linearised; an alpha channel stays linear and is the last one (EXR: channels R,G,B[,A]
/// or Y). 1, 3 or 4 channels: grey with alpha becomes red, green, blue and alpha.
Image readImage(const std::filesystem::path& path);
/// The same from memory; `subject` names the image in errors.
Image decodeImage(std::span<const std::byte> file, const std::string& subject);

/// .exr (32-bit float, ZIP, scan lines), .hdr (RGBE) or .png (8 bit; linear values are clamped to [0, 1] and
/// sRGB-encoded) by the name's ending. 1, 3 or 4 channels. Throws kUsage for another ending.
void writeImage(const std::filesystem::path& path, const Image& image);

void writeExr(const std::filesystem::path& path, const Image& image);

/// PNG bytes of `linear` values in [0, 1] stored as they are (no sRGB): data textures such as occlusion.
std::vector<std::byte> encodePngData(const Image& values);
/// PNG bytes, sRGB-encoded.
std::vector<std::byte> encodePngSrgb(const Image& linear);

/// Decodes a PNG, JPEG or WebP texture from memory to 8 bits per channel, 1 to 4 channels, values untouched.
/// `subject` names the image in errors.
Image8 decodeTexture(std::span<const std::byte> file, const std::string& subject);
/// Size without decoding; nothing when the header is not understood.
std::optional<IVec2> textureSize(std::span<const std::byte> file);

}  // namespace relume::image
