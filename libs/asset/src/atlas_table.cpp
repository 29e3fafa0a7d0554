// SPDX-License-Identifier: MIT
// What relighting must know of each covered texel, in about a fifth of its size: positions and normals as in
// surface_codec.h, albedo as its square root in 8 bits: even steps for the eye, as sRGB, but with a formula
// of one line.
#include "atlas_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "relume/codec/quantize.h"
#include "relume/core/check.h"
#include "relume/core/error.h"
#include "surface_codec.h"

namespace relume::asset {
namespace {

constexpr const char* kTexel = "atlas texel";

std::vector<std::uint8_t> encodeAlbedo(const std::vector<Vec3>& albedo) {
  std::vector<std::uint8_t> q;
  q.reserve(albedo.size() * 3);
  for (std::size_t i = 0; i < albedo.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      if (!(albedo[i][c] >= 0))
        throw Error(ErrorCode::kInvalidValue, fmt::format("{} {}", kTexel, i),
                    "has an albedo that is not a number from 0 to 1");
      q.push_back(codec::unorm8FromFloat(std::sqrt(albedo[i][c]), 0, 1));
    }
  return q;
}

bool hasPlane(const JsonNode& atlas, const char* name) {
  for (const JsonNode& plane : atlas.at("planes").items())
    if (ArrayReader::info(plane).name == name) return true;
  return false;
}

template <class T>
std::vector<T> readPlane(const JsonNode& atlas, ArrayReader& reader, const char* name, const char* storage,
                         std::size_t channels, std::size_t count) {
  for (const JsonNode& plane : atlas.at("planes").items()) {
    const ArrayInfo info = ArrayReader::info(plane);
    if (info.name != name) continue;
    if (info.storage != storage || info.channels != channels || info.count != count)
      plane.fail(fmt::format("is not {} x {} of {}", count, channels, storage));
    return reader.read<T>(plane);
  }
  atlas.fail(fmt::format("has no plane {}", name));
}

}  // namespace

std::size_t AtlasTable::pageTexels() const {
  return std::size_t{pages} * static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
}

Json encodeAtlas(const AtlasTable& atlas, ArrayWriter& writer) {
  const std::size_t count = atlas.texel.size();
  RELUME_CHECK_EQ(atlas.position.size(), count);
  RELUME_CHECK_EQ(atlas.normal.size(), count);
  if (!atlas.albedo.empty()) RELUME_CHECK_EQ(atlas.albedo.size(), count);
  RELUME_CHECK_EQ(atlas.valid.size(), count);
  RELUME_CHECK_EQ(atlas.chart.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    RELUME_CHECK_LT(atlas.texel[i], atlas.pageTexels());
    if (i > 0) RELUME_CHECK_LT(atlas.texel[i - 1], atlas.texel[i]);
  }
  const Grid grid = gridOf(atlas.position, kTexel);
  Json json;
  json["width"] = atlas.width;
  json["height"] = atlas.height;
  json["pages"] = atlas.pages;
  json["texels"] = count;
  json["positionOrigin"] = {grid.origin.x, grid.origin.y, grid.origin.z};
  json["positionStep"] = grid.step;
  Json& planes = json["planes"];
  planes.push_back(writer.write("texel", "uint32", atlas.texel, 1));
  planes.push_back(writer.write("position", "uint32", encodePositions(atlas.position, grid), 3));
  planes.push_back(writer.write("normal", "uint16", encodeNormals(atlas.normal, kTexel), 2));
  if (!atlas.albedo.empty())
    planes.push_back(writer.write("sqrtAlbedo", "uint8", encodeAlbedo(atlas.albedo), 3));
  planes.push_back(writer.write("valid", "uint8", atlas.valid, 1));
  planes.push_back(writer.write("chart", "uint32", atlas.chart, 1));
  return json;
}

AtlasTable decodeAtlas(const JsonNode& node, ArrayReader& reader) {
  AtlasTable atlas;
  atlas.width = static_cast<int>(node.at("width").integer(1, kMaxSide));
  atlas.height = static_cast<int>(node.at("height").integer(1, kMaxSide));
  atlas.pages = static_cast<std::uint32_t>(node.at("pages").integer(1, kMaxPages));
  const std::size_t count = node.at("texels").integer(0, atlas.pageTexels());
  reader.reserve(node, count * (sizeof(Point) + sizeof(Normal) + sizeof(Vec3)));

  atlas.texel = readPlane<std::uint32_t>(node, reader, "texel", "uint32", 1, count);
  for (std::size_t i = 0; i < count; ++i)
    if (atlas.texel[i] >= atlas.pageTexels() || (i > 0 && atlas.texel[i] <= atlas.texel[i - 1]))
      node.fail(fmt::format("has texel {} out of order or range", i));

  Grid grid;
  for (int c = 0; c < 3; ++c)
    grid.origin[c] = node.at("positionOrigin").item(static_cast<std::size_t>(c)).real();
  grid.step = node.at("positionStep").real();
  const auto positions = readPlane<std::uint32_t>(node, reader, "position", "uint32", 3, count);
  atlas.position.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    atlas.position[i] = decodePosition(positions.data() + 3 * i, grid);
    if (!isFinite(atlas.position[i])) node.fail(fmt::format("has an infinite position at texel {}", i));
  }

  const auto normals = readPlane<std::uint16_t>(node, reader, "normal", "uint16", 2, count);
  atlas.normal.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (std::max(normals[2 * i], normals[2 * i + 1]) > kOctahedralLast)
      node.fail("has a normal off the octahedron");
    atlas.normal[i] = decodeNormal(normals.data() + 2 * i);
  }

  if (hasPlane(node, "sqrtAlbedo")) {
    const auto albedo = readPlane<std::uint8_t>(node, reader, "sqrtAlbedo", "uint8", 3, count);
    atlas.albedo.resize(count);
    for (std::size_t i = 0; i < 3 * count; ++i) {
      const float root = codec::floatFromUnorm8(albedo[i], 0, 1);
      atlas.albedo[i / 3][static_cast<int>(i % 3)] = root * root;
    }
  }
  atlas.valid = readPlane<std::uint8_t>(node, reader, "valid", "uint8", 1, count);
  atlas.chart = readPlane<std::uint32_t>(node, reader, "chart", "uint32", 1, count);
  return atlas;
}

}  // namespace relume::asset
