// SPDX-License-Identifier: MIT
#include "direction_light.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "relume/basis/direction_set.h"

namespace relume::render {
namespace {

constexpr GLuint kChartUnit = 14, kMapUnit = 15;  // shaders/directions.glsl
constexpr GLuint kSetBinding = 11, kPointBinding = 12, kChartBinding = 13, kRectangleBinding = 14;
constexpr std::size_t kPointsOfShare = 24, kRanks = 4;

struct GpuPoint {
  Vec3 way;
  std::uint32_t nearest;
};
struct GpuRectangle {
  Vec2 corner, size;
  float most;
  std::array<float, 3> unused;
};

std::vector<GpuPoint> pointsOf(const std::vector<Direction>& set) {
  std::vector<GpuPoint> points;
  std::vector<std::uint32_t> order(set.size());
  for (const Direction d : basis::sphericalFibonacci(kPointsOfShare * set.size())) {
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return glm::dot(set[a], d) > glm::dot(set[b], d);
    });
    std::uint32_t nearest = 0;
    for (std::size_t k = 0; k < kRanks; ++k) nearest |= order[k] << (8 * k);
    points.push_back({d, nearest});
  }
  return points;
}

Texture chartTexture(const asset::AtlasTable& atlas) {
  std::vector<std::uint32_t> number(atlas.pageTexels(), 0);
  for (std::size_t i = 0; i < atlas.texel.size(); ++i) number[atlas.texel[i]] = atlas.chart[i] + 1;
  Texture t = Texture::makeArray(GL_R32UI, {atlas.width, atlas.height}, static_cast<int>(atlas.pages));
  glTextureSubImage3D(t.name(), 0, 0, 0, 0, atlas.width, atlas.height, static_cast<GLsizei>(atlas.pages),
                      GL_RED_INTEGER, GL_UNSIGNED_INT, number.data());
  t.plain(false);
  return t;
}

/// Bytes are roots: mixed are what they stand for.
Texture mapTexture(const asset::DirectionMaps& maps) {
  IVec2 size(1, 1);
  for (const asset::DirectionMaps::Texture& t : maps.textures)
    size = glm::max(size, IVec2(static_cast<int>(t.width), static_cast<int>(t.height)));
  Texture out = Texture::makeArray(GL_RGB16F, size, static_cast<int>(maps.textures.size()));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t i = 0; i < maps.textures.size(); ++i) {
    const asset::DirectionMaps::Texture& t = maps.textures[i];
    std::vector<float> shares;
    shares.reserve(t.rgb.size());
    for (const std::uint8_t byte : t.rgb) {
      const float root = static_cast<float>(byte) / 255.0f;
      shares.push_back(root * root);
    }
    if (!shares.empty())
      glTextureSubImage3D(out.name(), 0, 0, 0, static_cast<GLint>(i), static_cast<GLsizei>(t.width),
                          static_cast<GLsizei>(t.height), 1, GL_RGB, GL_FLOAT, shares.data());
  }
  out.plain(true);
  return out;
}

}  // namespace

DirectionLight::DirectionLight(const asset::DirectionMaps& maps, const asset::AtlasTable& atlas)
    : count_(static_cast<int>(maps.directions.size())),
      charts_(chartTexture(atlas)),
      maps_(mapTexture(maps)) {
  std::vector<Vec4> set, boxes;
  for (const Direction d : maps.directions) set.emplace_back(d, 0);
  for (const asset::DirectionMaps::Chart& c : maps.charts) boxes.emplace_back(c.x, c.y, c.width, c.height);
  std::vector<GpuRectangle> rectangles;
  for (const asset::DirectionMaps::Rectangle& r : maps.rectangles)
    rectangles.push_back({Vec2(r.x, r.y), Vec2(r.width, r.height), r.most, {}});
  set_ = Buffer(set);
  points_ = Buffer(pointsOf(maps.directions));
  chart_boxes_ = Buffer(boxes);
  rectangles_ = Buffer(rectangles);
}

void DirectionLight::bind() const {
  charts_.bind(kChartUnit);
  maps_.bind(kMapUnit);
  set_.bindStorage(kSetBinding);
  points_.bindStorage(kPointBinding);
  chart_boxes_.bindStorage(kChartBinding);
  rectangles_.bindStorage(kRectangleBinding);
}

}  // namespace relume::render
