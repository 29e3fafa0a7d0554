// SPDX-License-Identifier: MIT
#include "stored_array.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <utility>

#include "relume/core/error.h"
#include "relume/core/hash.h"

namespace relume::asset {
namespace {

constexpr std::uint64_t kMaxCount = std::uint64_t{1} << 32, kMaxChannels = 256;

constexpr std::array<std::pair<const char*, codec::Filter>, 3> kFilters{
    {{"none", codec::Filter::kNone}, {"shuffle", codec::Filter::kShuffle}, {"delta", codec::Filter::kDelta}}};

const char* filterName(codec::Filter filter) { return kFilters[static_cast<std::size_t>(filter)].first; }

codec::Filter filterOf(const JsonNode& node) {
  for (const auto& [name, filter] : kFilters)
    if (node.text() == name) return filter;
  node.fail(fmt::format("names the unknown filter {}", node.text()));
}

}  // namespace

Json ArrayWriter::writeBytes(const char* name, const char* storage, std::span<const std::byte> bytes,
                             codec::Layout layout, codec::Filter filter) {
  return describe(name, storage, bytes.size(), layout, filter, codec::compress(bytes, filter, layout));
}

Json ArrayWriter::writeSmallest(const char* name, const char* storage, std::span<const std::byte> bytes,
                                codec::Layout layout) {
  codec::Filter best = codec::Filter::kNone;
  std::vector<std::byte> stored = codec::compress(bytes, best, layout);
  for (const codec::Filter filter : {codec::Filter::kShuffle, codec::Filter::kDelta}) {
    std::vector<std::byte> other = codec::compress(bytes, filter, layout);
    if (other.size() < stored.size()) stored = std::move(other), best = filter;
  }
  return describe(name, storage, bytes.size(), layout, best, std::move(stored));
}

Json ArrayWriter::describe(const char* name, const char* storage, std::size_t bytes, codec::Layout layout,
                           codec::Filter filter, std::vector<std::byte> stored) {
  Json plane;
  plane["name"] = name;
  plane["storage"] = storage;
  plane["channels"] = layout.channels;
  plane["count"] = bytes / (layout.element_size * layout.channels);
  plane["filter"] = filterName(filter);
  plane["byteLength"] = bytes;
  plane["bufferView"] = views_.size();
  plane["crc32"] = crc32(stored);
  views_.push_back(std::move(stored));
  return plane;
}

ArrayInfo ArrayReader::info(const JsonNode& plane) {
  return {plane.at("name").text(), plane.at("storage").text(), plane.at("channels").integer(1, kMaxChannels),
          plane.at("count").integer(0, kMaxCount)};
}

void ArrayReader::reserve(const JsonNode& plane, std::uint64_t bytes) {
  if (bytes > bytes_left_)
    throw Error(ErrorCode::kOutOfMemory, plane.file(),
                "its planes take more memory than the reader's limit allows",
                "raise the limit if you trust the file");
  bytes_left_ -= bytes;
}

std::span<const std::byte> ArrayReader::storedBytes(const JsonNode& plane) const {
  const JsonNode view = document_.at("bufferViews").item(plane.at("bufferView").integer(0, kMaxCount));
  if (view.at("buffer").integer(0, ~std::uint64_t{0}) != 0) view.fail("is not in the binary chunk");
  const std::uint64_t offset = view.has("byteOffset") ? view.at("byteOffset").integer(0, bin_.size()) : 0;
  return bin_.subspan(offset, view.at("byteLength").integer(0, bin_.size() - offset));
}

std::vector<std::byte> ArrayReader::readBytes(const JsonNode& plane, std::size_t element_size) {
  const ArrayInfo a = info(plane);
  const codec::Filter filter = filterOf(plane.at("filter"));
  const std::uint64_t decoded = a.count * a.channels * element_size;  // at most 2^32 * 2^8 * 2^2
  if (plane.at("byteLength").integer(0, ~std::uint64_t{0}) != decoded)
    plane.at("byteLength").fail(fmt::format("is not count * channels * {}", element_size));
  reserve(plane, decoded);
  const auto stored = storedBytes(plane);
  if (plane.at("crc32").integer(0, 0xffffffffu) != crc32(stored)) plane.fail("has a wrong checksum");
  try {
    return codec::decompress(stored, decoded, filter, {element_size, a.channels});
  } catch (const Error& e) {
    plane.fail(e.problem());
  }
}

void ArrayReader::copyBytes(std::span<const std::byte> bytes, void* to) {
  if (!bytes.empty()) std::memcpy(to, bytes.data(), bytes.size());
}

}  // namespace relume::asset
