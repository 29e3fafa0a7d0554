// SPDX-License-Identifier: MIT
// What relighting must know of each covered texel, in about a fifth of its size.
//   position   = origin + step q, q < 2^23: on a flat chart successive q differ by constants, which Zstandard
//   likes and the bits of
//                floats hide. The step is a power of two, 2^-23 to 2^-22 of the largest extent: float32's
//                spacing at its far end.
//   normal     octahedral map ([MMESST14] section 3), two integers of 16 bits; the axes are exact.
//   albedo     its square root in 8 bits: even steps for the eye, as sRGB, but with a formula of one line.
// Based on:
//   [MMESST14] Cigolle et al. A Survey of Efficient Representations for Independent Unit Vectors. JCGT 3(2),
//   2014.
#include "atlas_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "relume/codec/quantize.h"
#include "relume/core/check.h"
#include "relume/core/error.h"

namespace relume::asset {
namespace {

constexpr int kPositionBits = 23;
constexpr float kOctahedralMax = 32767.0f;
constexpr std::uint16_t kOctahedralLast = 65534;

[[noreturn]] void badTexel(std::size_t item, const char* problem) {
  throw Error(ErrorCode::kInvalidValue, fmt::format("atlas texel {}", item), problem);
}

struct Grid {
  Point origin{0.0f};
  float step = 1.0f;  ///< metres
};

Grid gridOf(const std::vector<Point>& positions) {
  Box3 box;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!isFinite(positions[i])) badTexel(i, "has a position that is not finite");
    box.add(positions[i]);
  }
  if (box.empty()) return {};
  const Vec3 extent = box.extent();
  const float largest = std::max({extent.x, extent.y, extent.z});
  if (!std::isfinite(largest)) badTexel(0, "lies farther from another than a float can say");
  // ilogb + 1 bits hold the extent; never finer than the smallest normal float.
  const float step =
      largest > 0 ? std::ldexp(1.0f, std::max(std::ilogb(largest) + 1 - kPositionBits, -126)) : 1.0f;
  return {box.lo, step};
}

std::vector<std::uint32_t> encodePositions(const std::vector<Point>& positions, const Grid& grid) {
  std::vector<std::uint32_t> q;
  q.reserve(positions.size() * 3);
  for (const Point& p : positions)
    for (int c = 0; c < 3; ++c)
      q.push_back(
          static_cast<std::uint32_t>(std::lround((static_cast<double>(p[c]) - grid.origin[c]) / grid.step)));
  return q;
}

std::uint16_t octahedralInteger(float x) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * kOctahedralMax) +
                                    static_cast<long>(kOctahedralMax));
}

float awayFromZero(float x) { return x < 0 ? -1.0f : 1.0f; }

// The lower half of the octahedron is folded over the diagonals of the square.
Vec2 fold(Vec2 p) {
  return {(1 - std::abs(p.y)) * awayFromZero(p.x), (1 - std::abs(p.x)) * awayFromZero(p.y)};
}

std::vector<std::uint16_t> encodeNormals(const std::vector<Normal>& normals) {
  std::vector<std::uint16_t> q;
  q.reserve(normals.size() * 2);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Normal n = normals[i];
    const float norm = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (!(norm > 0.5f && norm < 2.0f)) badTexel(i, "has a normal that is not of unit length");
    Vec2 p = Vec2(n.x, n.y) / norm;
    if (n.z < 0) p = fold(p);
    q.push_back(octahedralInteger(p.x));
    q.push_back(octahedralInteger(p.y));
  }
  return q;
}

Normal decodeNormal(std::uint16_t qx, std::uint16_t qy) {
  Vec2 p = Vec2(qx, qy) / kOctahedralMax - Vec2(1.0f);
  const float z = 1 - std::abs(p.x) - std::abs(p.y);
  if (z < 0) p = fold(p);
  return glm::normalize(Vec3(p, z));
}

std::vector<std::uint8_t> encodeAlbedo(const std::vector<Vec3>& albedo) {
  std::vector<std::uint8_t> q;
  q.reserve(albedo.size() * 3);
  for (std::size_t i = 0; i < albedo.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      if (!(albedo[i][c] >= 0)) badTexel(i, "has an albedo that is not a number from 0 to 1");
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
  const Grid grid = gridOf(atlas.position);
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
  planes.push_back(writer.write("normal", "uint16", encodeNormals(atlas.normal), 2));
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
    for (int c = 0; c < 3; ++c)
      atlas.position[i][c] = static_cast<float>(
          grid.origin[c] + static_cast<double>(grid.step) * positions[3 * i + static_cast<std::size_t>(c)]);
    if (!isFinite(atlas.position[i])) node.fail(fmt::format("has an infinite position at texel {}", i));
  }

  const auto normals = readPlane<std::uint16_t>(node, reader, "normal", "uint16", 2, count);
  atlas.normal.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (std::max(normals[2 * i], normals[2 * i + 1]) > kOctahedralLast)
      node.fail("has a normal off the octahedron");
    atlas.normal[i] = decodeNormal(normals[2 * i], normals[2 * i + 1]);
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
