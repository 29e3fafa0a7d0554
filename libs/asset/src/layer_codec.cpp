// SPDX-License-Identifier: MIT
#include "layer_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "relume/codec/quantize.h"
#include "relume/core/check.h"
#include "relume/core/error.h"
#include "table_codec.h"

namespace relume::asset {
namespace {

constexpr float kMaxWhole = 16777216.0f;  // 2^24, up to which a float holds every whole number

constexpr std::array<std::pair<const char*, Storage>, 5> kStorages{{{"float32", Storage::kFloat32},
                                                                    {"float16", Storage::kFloat16},
                                                                    {"unorm8", Storage::kUnorm8},
                                                                    {"unorm16", Storage::kUnorm16},
                                                                    {"uint32", Storage::kUint32}}};

const char* storageName(Storage storage) { return kStorages[static_cast<std::size_t>(storage)].first; }

Storage storageOf(const JsonNode& node) {
  for (const auto& [name, storage] : kStorages)
    if (node.text() == name) return storage;
  node.fail(fmt::format("names the unknown storage {}", node.text()));
}

bool isUnorm(Storage storage) { return storage == Storage::kUnorm8 || storage == Storage::kUnorm16; }

bool holds(const Plane& plane, float value) {
  switch (plane.storage) {
    case Storage::kFloat32:
      return std::isfinite(value);
    case Storage::kFloat16:
      return std::abs(value) <= codec::kHalfMax;
    case Storage::kUnorm8:
    case Storage::kUnorm16:
      return value >= plane.lo && value <= plane.hi;
    case Storage::kUint32:
      return value >= 0 && value <= kMaxWhole && value == std::floor(value);
  }
  return false;
}

template <class T, class Convert>
Json writeValues(const Plane& plane, ArrayWriter& writer, Convert convert) {
  std::vector<T> stored(plane.values.size());
  std::transform(plane.values.begin(), plane.values.end(), stored.begin(), convert);
  return writer.write(plane.name.c_str(), storageName(plane.storage), stored,
                      static_cast<std::size_t>(plane.channels));
}

Json encodePlane(const Layer& layer, const Plane& plane, std::size_t page_texels, ArrayWriter& writer) {
  RELUME_CHECK_LT(0, plane.channels);
  RELUME_CHECK_EQ(plane.values.size(), page_texels * static_cast<std::size_t>(plane.channels));
  for (std::size_t i = 0; i < plane.values.size(); ++i)
    if (!holds(plane, plane.values[i]))
      throw Error(ErrorCode::kInvalidValue, fmt::format("layer {}, plane {}", layer.name, plane.name),
                  fmt::format("{} cannot hold the value {} at index {}", storageName(plane.storage),
                              plane.values[i], i),
                  "store the plane as float32");
  const float lo = plane.lo, hi = plane.hi;
  Json json;
  switch (plane.storage) {
    case Storage::kFloat32:
      json = writer.write(plane.name.c_str(), storageName(plane.storage), plane.values,
                          static_cast<std::size_t>(plane.channels));
      break;
    case Storage::kFloat16:
      json = writeValues<std::uint16_t>(plane, writer, codec::halfFromFloat);
      break;
    case Storage::kUnorm8:
      json = writeValues<std::uint8_t>(plane, writer,
                                       [&](float v) { return codec::unorm8FromFloat(v, lo, hi); });
      break;
    case Storage::kUnorm16:
      json = writeValues<std::uint16_t>(plane, writer,
                                        [&](float v) { return codec::unorm16FromFloat(v, lo, hi); });
      break;
    case Storage::kUint32:
      json = writeValues<std::uint32_t>(plane, writer, [](float v) { return static_cast<std::uint32_t>(v); });
      break;
  }
  if (isUnorm(plane.storage)) {
    json["lo"] = lo;
    json["hi"] = hi;
  }
  return json;
}

template <class T, class Convert>
void readValues(const JsonNode& node, ArrayReader& reader, Plane& plane, Convert convert) {
  const std::vector<T> stored = reader.read<T>(node);
  plane.values.resize(stored.size());
  std::transform(stored.begin(), stored.end(), plane.values.begin(), convert);
}

Plane decodePlane(const JsonNode& node, std::size_t page_texels, ArrayReader& reader) {
  const ArrayInfo info = ArrayReader::info(node);
  if (info.count != page_texels)
    node.fail(fmt::format("has {} texels where the atlas has {}", info.count, page_texels));
  Plane plane;
  plane.name = info.name;
  plane.channels = static_cast<int>(info.channels);
  plane.storage = storageOf(node.at("storage"));
  if (isUnorm(plane.storage)) {
    plane.lo = node.at("lo").real();
    plane.hi = node.at("hi").real();
  }
  const float lo = plane.lo, hi = plane.hi;
  reader.reserve(node, std::uint64_t{info.count} * info.channels * sizeof(float));
  switch (plane.storage) {
    case Storage::kFloat32:
      plane.values = reader.read<float>(node);
      break;
    case Storage::kFloat16:
      readValues<std::uint16_t>(node, reader, plane, codec::floatFromHalf);
      break;
    case Storage::kUnorm8:
      readValues<std::uint8_t>(node, reader, plane,
                               [&](std::uint8_t q) { return codec::floatFromUnorm8(q, lo, hi); });
      break;
    case Storage::kUnorm16:
      readValues<std::uint16_t>(node, reader, plane,
                                [&](std::uint16_t q) { return codec::floatFromUnorm16(q, lo, hi); });
      break;
    case Storage::kUint32:
      readValues<std::uint32_t>(node, reader, plane, [](std::uint32_t q) { return static_cast<float>(q); });
      break;
  }
  for (std::size_t i = 0; i < plane.values.size(); ++i)
    if (!holds(plane, plane.values[i])) node.fail(fmt::format("has an impossible value at index {}", i));
  return plane;
}

// JSON has no infinity: null stands for "no limit".
Json encodeParameter(const Layer& layer, const std::string& key, const Parameter& parameter) {
  if (const auto* number = std::get_if<double>(&parameter)) {
    if (std::isnan(*number) || *number == -HUGE_VAL)
      throw Error(ErrorCode::kInvalidValue, fmt::format("layer {}, parameter {}", layer.name, key),
                  "is not a number");
    return std::isfinite(*number) ? Json(*number) : Json();
  }
  if (const auto* text = std::get_if<std::string>(&parameter)) return *text;
  return std::get<bool>(parameter);
}

Parameter decodeParameter(const JsonNode& node) {
  if (node.json().is_null()) return HUGE_VAL;
  if (node.json().is_boolean()) return node.json().get<bool>();
  if (node.json().is_string()) return node.text();
  return node.number();
}

}  // namespace

Json encodeLayer(const Layer& layer, std::size_t page_texels, ArrayWriter& writer) {
  if (!std::isfinite(layer.error_estimate))
    throw Error(ErrorCode::kInvalidValue, "layer " + layer.name, "has an error estimate that is not finite");
  Json json;
  json["name"] = layer.name;
  json["kind"] = layer.kind;
  json["emitters"] = layer.emitters;
  json["transport"] = layer.transport;
  json["receivers"] = layer.receivers;
  json["codec"] = layer.codec;
  json["errorEstimate"] = layer.error_estimate;
  json["samples"] = layer.samples;
  json["parameters"] = Json::object();
  for (const auto& [key, value] : layer.parameters)
    json["parameters"][key] = encodeParameter(layer, key, value);
  json["planes"] = Json::array();
  for (const Plane& plane : layer.planes)
    json["planes"].push_back(encodePlane(layer, plane, page_texels, writer));
  for (const Table& table : layer.tables) json["tables"].push_back(encodeTable(layer, table, writer));
  return json;
}

Layer decodeLayer(const JsonNode& node, std::size_t page_texels, ArrayReader& reader) {
  Layer layer;
  layer.name = node.at("name").text();
  layer.kind = node.at("kind").text();
  layer.emitters = node.at("emitters").text();
  layer.transport = node.at("transport").text();
  layer.receivers = node.at("receivers").text();
  layer.codec = node.at("codec").text();
  layer.error_estimate = node.at("errorEstimate").number();
  layer.samples = node.at("samples").integer(0, ~std::uint64_t{0});
  const JsonNode parameters = node.at("parameters");
  if (!parameters.json().is_object()) parameters.fail("is not an object");
  for (const auto& [key, value] : parameters.json().items())
    layer.parameters[key] = decodeParameter(parameters.at(key.c_str()));
  for (const JsonNode& plane : node.at("planes").items())
    layer.planes.push_back(decodePlane(plane, page_texels, reader));
  if (node.has("tables"))
    for (const JsonNode& table : node.at("tables").items())
      layer.tables.push_back(decodeTable(table, reader));
  return layer;
}

}  // namespace relume::asset
