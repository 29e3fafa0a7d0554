// SPDX-License-Identifier: MIT
// RELUME_transfer, version 1: docs/format.md.
#include "relume/asset/asset.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "atlas_table.h"
#include "glb.h"
#include "json_node.h"
#include "layer_codec.h"
#include "relume/core/error.h"
#include "relume/core/file.h"
#include "stored_array.h"

namespace relume::asset {
namespace {

constexpr std::uint64_t kVersion = 1;
constexpr const char* kExtension = "RELUME_transfer";
constexpr std::size_t kViewAlignment = 4;

template <class Items>
std::string namesOf(const Items& items) {
  std::string names;
  for (const auto& item : items) names += (names.empty() ? "" : ", ") + item.name;
  return names.empty() ? "none" : names;
}

template <class Items>
auto findNamed(Items& items, std::string_view name) {
  const auto it =
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
  return it == items.end() ? nullptr : &*it;
}

// Text that is not UTF-8 gets replacement characters, here and so also in the checksum.
Json wellFormed(const Json& json) {
  return Json::parse(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Asset decodeBake(const JsonNode& transfer, ArrayReader& reader) {
  const auto version = transfer.at("version").integer(1, ~std::uint64_t{0});
  if (version > kVersion)
    throw Error(ErrorCode::kUnsupported, transfer.file(),
                fmt::format("its bake has format version {}, this reader knows up to {}", version, kVersion),
                "read it with a newer Relume");
  if (transfer.at("crc32").integer(0, 0xffffffffu) != descriptionCrc(transfer))
    transfer.fail("has a wrong checksum");
  Asset asset;
  asset.generator = transfer.at("generator").text();
  asset.input_hash = transfer.at("inputHash").text();
  asset.atlas = decodeAtlas(transfer.at("atlas"), reader);
  for (const JsonNode& layer : transfer.at("layers").items())
    asset.layers.push_back(decodeLayer(layer, asset.atlas.pageTexels(), reader));
  return asset;
}

}  // namespace

const Plane& Layer::plane(std::string_view plane_name) const {
  if (const Plane* found = findNamed(planes, plane_name)) return *found;
  throw Error(ErrorCode::kMismatch, "layer " + name,
              fmt::format("has no plane {} (it has: {})", plane_name, namesOf(planes)));
}

const Table* Layer::findTable(std::string_view table_name) const { return findNamed(tables, table_name); }

const Layer* Asset::find(std::string_view name) const { return findNamed(layers, name); }

const Layer& Asset::layer(std::string_view name) const {
  if (name.empty() && !layers.empty()) return layers.front();
  if (const Layer* found = find(name)) return *found;
  throw Error(ErrorCode::kNoSuchLayer, fmt::format("layer {}", name), "is not in this bake",
              "it has: " + namesOf(layers));
}

Encoded encode(const Asset& asset) {
  Encoded encoded;
  ArrayWriter writer(encoded.views);
  Json json;
  json["version"] = kVersion;
  json["generator"] = asset.generator;
  json["inputHash"] = asset.input_hash;
  json["atlas"] = encodeAtlas(asset.atlas, writer);
  json["layers"] = Json::array();
  for (const Layer& layer : asset.layers)
    json["layers"].push_back(encodeLayer(layer, asset.atlas.pageTexels(), writer));
  json = wellFormed(json);
  json["crc32"] = descriptionCrc(JsonNode(json, asset.generator, kExtension));
  encoded.json = json.dump();
  return encoded;
}

std::vector<std::byte> encodeGlb(const Asset& asset) {
  const Encoded encoded = encode(asset);
  std::vector<std::byte> bin;
  Json views = Json::array();
  for (const auto& view : encoded.views) {
    bin.resize((bin.size() + kViewAlignment - 1) / kViewAlignment * kViewAlignment);
    views.push_back({{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", view.size()}});
    bin.insert(bin.end(), view.begin(), view.end());
  }
  const Json document = {{"asset", {{"version", "2.0"}, {"generator", asset.generator}}},
                         {"extensionsUsed", {kExtension}},
                         {"extensions", {{kExtension, Json::parse(encoded.json)}}},
                         {"bufferViews", views},
                         {"buffers", {{{"byteLength", bin.size()}}}}};
  return writeGlb(document.dump(-1, ' ', false, Json::error_handler_t::replace), bin);
}

Asset decode(std::span<const std::byte> glb, const std::string& name, const DecodeLimits& limits) {
  try {
    const Glb parts = parseGlb(glb, name);
    const Json json = Json::parse(parts.json, nullptr, false);
    if (json.is_discarded())
      throw Error(ErrorCode::kInvalidJson, name, "its JSON chunk is not valid JSON",
                  "copy or download it again");
    const JsonNode document(json, name, "");
    if (!document.has("extensions") || !document.at("extensions").has(kExtension))
      throw Error(ErrorCode::kNoSuchLayer, name, "carries no bake", "make one with `relume bake`");
    ArrayReader reader(document, parts.bin, limits);
    return decodeBake(JsonNode(json["extensions"][kExtension], name, kExtension), reader);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::kOutOfMemory, name, "is too large for the memory of this machine");
  }
}

Asset readAsset(const std::filesystem::path& path, const DecodeLimits& limits) {
  return decode(readFile(path), path.string(), limits);
}

}  // namespace relume::asset
