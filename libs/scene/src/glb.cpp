// SPDX-License-Identifier: MIT
#include "glb.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

namespace relume::scene::gltf {

static_assert(std::endian::native == std::endian::little,
              "glTF is little-endian, and its bytes are used as they are");

namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t w;
  std::memcpy(&w, bytes.data() + at, sizeof w);
  return w;
}

void append(std::vector<std::byte>& out, std::uint32_t w) {
  const std::size_t at = out.size();
  out.resize(at + sizeof w);
  std::memcpy(out.data() + at, &w, sizeof w);
}

}  // namespace

bool isGlb(std::span<const std::byte> file) { return file.size() >= 4 && word(file, 0) == kMagic; }

GlbChunks splitGlb(std::span<const std::byte> file, const std::string& name) {
  if (file.size() < kHeader)
    throw Error(ErrorCode::kTruncated, name,
                fmt::format("ends after {} bytes, within the header", file.size()));
  if (const std::uint32_t version = word(file, 4); version != 2)
    throw Error(ErrorCode::kUnsupported, name, fmt::format("is binary glTF of version {}", version),
                "export it as glTF 2.0");
  const std::size_t length = word(file, 8);
  if (length > file.size())
    throw Error(ErrorCode::kTruncated, name,
                fmt::format("has {} bytes, but its header says {}", file.size(), length),
                "copy or export it again");
  file = file.first(std::max(length, kHeader));

  GlbChunks chunks;
  bool first = true;
  for (std::size_t at = kHeader; at < file.size(); first = false) {
    if (file.size() - at < kChunkHeader)
      throw Error(ErrorCode::kTruncated, name, "ends within the header of a chunk",
                  "copy or export it again");
    const std::size_t size = word(file, at);
    const std::uint32_t type = word(file, at + 4);
    at += kChunkHeader;
    if (size > file.size() - at)
      throw Error(
          ErrorCode::kTruncated, name,
          fmt::format("a chunk has {} bytes, but the file ends after {} of them", size, file.size() - at),
          "copy or export it again");
    const auto data = file.subspan(at, size);
    at += size;
    if (first && type != kJson)
      throw Error(ErrorCode::kNotGltf, name, "its first chunk is not JSON", "export it again");
    if (first) chunks.json = {reinterpret_cast<const char*>(data.data()), data.size()};
    if (type == kBinary && !chunks.binary) chunks.binary = data;
  }
  if (first) throw Error(ErrorCode::kTruncated, name, "ends after its header", "copy or export it again");
  return chunks;
}

std::vector<std::byte> joinGlb(std::string json, const std::vector<std::span<const std::byte>>& pieces) {
  json.resize(alignedSize(json.size()), ' ');
  std::size_t binary = 0;
  for (const auto& piece : pieces) binary += alignedSize(piece.size());
  const std::size_t total =
      kHeader + kChunkHeader + json.size() + (pieces.empty() ? 0 : kChunkHeader + binary);
  if (total > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::kUnsupported, "output",
                fmt::format("would have {} bytes; a .glb holds at most 4 GiB", total),
                "bake fewer or smaller layers");
  std::vector<std::byte> out;
  out.reserve(total);
  append(out, kMagic);
  append(out, 2);
  append(out, static_cast<std::uint32_t>(total));
  append(out, static_cast<std::uint32_t>(json.size()));
  append(out, kJson);
  const auto text = std::as_bytes(std::span(json));
  out.insert(out.end(), text.begin(), text.end());
  if (pieces.empty()) return out;
  append(out, static_cast<std::uint32_t>(binary));
  append(out, kBinary);
  for (const auto& piece : pieces) {
    out.insert(out.end(), piece.begin(), piece.end());
    out.resize(alignedSize(out.size()));
  }
  return out;
}

}  // namespace relume::scene::gltf
