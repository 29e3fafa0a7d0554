// SPDX-License-Identifier: MIT
#include "glb.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

#include "relume/core/check.h"
#include "relume/core/error.h"

namespace relume::asset {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian and is read as it lies");

constexpr std::uint32_t kMagic = 0x46546c67;  // "glTF"
constexpr std::uint32_t kJson = 0x4e4f534a;   // "JSON"
constexpr std::uint32_t kBin = 0x004e4942;    // "BIN\0"
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

std::uint32_t u32At(std::span<const std::byte> data, std::size_t offset) {
  std::uint32_t value;
  std::memcpy(&value, data.subspan(offset, sizeof value).data(), sizeof value);
  return value;
}

// Fills a buffer of known size from front to back.
struct Filler {
  std::vector<std::byte> out;
  std::size_t at = 0;

  void bytes(const void* data, std::size_t size) {
    RELUME_CHECK_LE(at + size, out.size());
    if (size) std::memcpy(out.data() + at, data, size);
    at += size;
  }
  void u32(std::size_t value) {
    RELUME_CHECK_LT(value, std::size_t{1} << 32);
    const auto word = static_cast<std::uint32_t>(value);
    bytes(&word, sizeof word);
  }
};

}  // namespace

Glb parseGlb(std::span<const std::byte> file, const std::string& name) {
  if (file.size() < 4 || u32At(file, 0) != kMagic)
    throw Error(ErrorCode::kNotGltf, name, "is not a binary glTF", "give the .glb that `relume bake` wrote");
  const auto truncated = [&](std::uint64_t needed) {
    throw Error(ErrorCode::kTruncated, name, fmt::format("has {} bytes but needs {}", file.size(), needed),
                "copy or download it again");
  };
  if (file.size() < kHeader + kChunkHeader) truncated(kHeader + kChunkHeader);
  if (const auto version = u32At(file, 4); version != 2)
    throw Error(ErrorCode::kUnsupported, name, fmt::format("is binary glTF version {}, not 2", version));
  const std::uint64_t length = u32At(file, 8);
  if (length > file.size()) truncated(length);

  Glb glb;
  for (std::uint64_t at = kHeader; at + kChunkHeader <= length;) {
    const std::uint64_t size = u32At(file, at);
    const std::uint32_t type = u32At(file, at + 4);
    const bool first = at == kHeader;
    at += kChunkHeader;
    if (at + size > length) truncated(at + size);
    const auto body = file.subspan(at, size);
    if (first != (type == kJson))
      throw Error(ErrorCode::kNotGltf, name, "its first chunk is not the one of JSON");
    if (first) glb.json = {reinterpret_cast<const char*>(body.data()), body.size()};
    if (type == kBin && glb.bin.empty()) glb.bin = body;
    at += size;
  }
  return glb;
}

std::vector<std::byte> writeGlb(std::string json, std::span<const std::byte> bin) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t bin_size = (bin.size() + 3) / 4 * 4;
  const std::size_t total = kHeader + kChunkHeader + json.size() + (bin_size ? kChunkHeader + bin_size : 0);
  Filler file{std::vector<std::byte>(total)};
  file.u32(kMagic);
  file.u32(2);
  file.u32(total);
  file.u32(json.size());
  file.u32(kJson);
  file.bytes(json.data(), json.size());
  if (bin_size) {
    file.u32(bin_size);
    file.u32(kBin);
    file.bytes(bin.data(), bin.size());
  }
  return std::move(file.out);
}

}  // namespace relume::asset
