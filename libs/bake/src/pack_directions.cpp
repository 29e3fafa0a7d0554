// SPDX-License-Identifier: MIT
#include "pack_directions.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "relume/basis/direction_set.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::bake {
namespace {

using Maps = asset::DirectionMaps;
using basis::kFacing;

constexpr std::uint32_t kRim = 1;

std::size_t at(std::uint32_t x, std::uint32_t y, std::uint32_t width) { return std::size_t{y} * width + x; }

/// Of what a map is made: the texels of a chart.
struct Members {
  Maps::Chart place;
  std::vector<std::uint32_t> points;
};

std::vector<Members> membersOf(const atlas::Texels& texels) {
  std::vector<Members> charts;
  const auto width = static_cast<std::uint32_t>(texels.width),
             height = static_cast<std::uint32_t>(texels.height);
  for (std::uint32_t i = 0; i < texels.points.size(); ++i) {
    const atlas::SurfacePoint& p = texels.points[i];
    if (p.chart >= charts.size()) charts.resize(p.chart + 1);
    Members& m = charts[p.chart];
    const std::uint32_t in_page = p.texel % (width * height), x = in_page % width, y = in_page / width;
    Maps::Chart& c = m.place;
    if (m.points.empty()) {
      c = {p.texel / (width * height), x, y, 1, 1};
    } else {
      const std::uint32_t right = std::max(c.x + c.width, x + 1), below = std::max(c.y + c.height, y + 1);
      c.x = std::min(c.x, x), c.y = std::min(c.y, y);
      c.width = right - c.x, c.height = below - c.y;
    }
    m.points.push_back(i);
  }
  return charts;
}

/// Width and height of a chart's rectangle in a direction's map; 0: it faces the direction nowhere.
Maps::Rectangle sizeOf(const Members& chart, const atlas::Texels& texels, Direction d, float scale) {
  double projected = 0, area = 0;
  for (const std::uint32_t i : chart.points) {
    const atlas::SurfacePoint& p = texels.points[i];
    const float cosine = glm::dot(p.shading_normal, d);
    area += static_cast<double>(p.area);
    if (cosine > kFacing) projected += static_cast<double>(p.area * cosine);
  }
  Maps::Rectangle r;
  if (!(projected > 0)) return r;
  const float along = scale * static_cast<float>(std::sqrt(projected / area));
  const auto scaled = [&](std::uint32_t n) {
    return std::max(static_cast<std::uint32_t>(std::lround(along * static_cast<float>(n))), 1u);
  };
  r.width = scaled(chart.place.width), r.height = scaled(chart.place.height);
  return r;
}

/// Places the rectangles of one direction in rows, the highest first. Returns the texture, all black.
Maps::Texture arrange(Maps& maps, std::size_t direction) {
  const std::size_t n = maps.directions.size();
  std::vector<std::size_t> order;
  double area = 0;
  Maps::Texture texture;
  for (std::size_t k = direction; k < maps.rectangles.size(); k += n) {
    const Maps::Rectangle& r = maps.rectangles[k];
    if (r.width == 0) continue;
    order.push_back(k);
    area += static_cast<double>(r.width + 2 * kRim) * static_cast<double>(r.height + 2 * kRim);
    texture.width = std::max(texture.width, r.width + 2 * kRim);
  }
  texture.width = std::max(texture.width, static_cast<std::uint32_t>(std::ceil(std::sqrt(area))));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return maps.rectangles[a].height > maps.rectangles[b].height;
  });
  std::uint32_t x = 0, y = 0, row = 0;
  for (const std::size_t k : order) {
    Maps::Rectangle& r = maps.rectangles[k];
    if (x + r.width + 2 * kRim > texture.width) x = 0, y += row, row = 0;
    r.x = x + kRim, r.y = y + kRim;
    x += r.width + 2 * kRim, row = std::max(row, r.height + 2 * kRim);
  }
  texture.height = y + row;
  texture.rgb.assign(3 * std::size_t{texture.width} * texture.height, 0);
  return texture;
}

/// Means over the texels that a rectangle's texels cover, what none covers filled from its neighbours.
/// shape of the result: [height][width][3]
std::vector<float> resample(const Members& chart, const atlas::Texels& texels, const Maps::Rectangle& r,
                            Direction d, std::span<const std::uint8_t> valid,
                            const std::function<Vec3(std::uint32_t)>& value) {
  std::vector<double> sum(3 * std::size_t{r.width} * r.height), weight(std::size_t{r.width} * r.height);
  const auto page_width = static_cast<std::uint32_t>(texels.width),
             page = page_width * static_cast<std::uint32_t>(texels.height);
  const double sx = static_cast<double>(r.width) / chart.place.width,
               sy = static_cast<double>(r.height) / chart.place.height;
  for (const std::uint32_t i : chart.points) {
    const atlas::SurfacePoint& p = texels.points[i];
    if (!valid[i] || !(glm::dot(p.shading_normal, d) > kFacing)) continue;
    const std::uint32_t in_page = p.texel % page;
    const double x0 = (in_page % page_width - chart.place.x) * sx,
                 y0 = (in_page / page_width - chart.place.y) * sy;
    const Vec3 v = value(i);
    for (auto y = static_cast<std::uint32_t>(y0); y < r.height && y < y0 + sy; ++y)
      for (auto x = static_cast<std::uint32_t>(x0); x < r.width && x < x0 + sx; ++x) {
        const double overlap_x = std::min(x0 + sx, x + 1.0) - std::max(x0, static_cast<double>(x)),
                     overlap_y = std::min(y0 + sy, y + 1.0) - std::max(y0, static_cast<double>(y));
        const double w =
            std::max(overlap_x, 0.0) * std::max(overlap_y, 0.0) * static_cast<double>(p.coverage);
        const std::size_t k = at(x, y, r.width);
        weight[k] += w;
        for (int c = 0; c < 3; ++c) sum[3 * k + static_cast<std::size_t>(c)] += w * static_cast<double>(v[c]);
      }
  }
  std::vector<float> values(sum.size());
  std::vector<std::uint8_t> covered(weight.size(), 0);
  for (std::size_t k = 0; k < weight.size(); ++k) {
    if (!(weight[k] > 0)) continue;
    covered[k] = 1;
    for (std::size_t c = 0; c < 3; ++c) values[3 * k + c] = static_cast<float>(sum[3 * k + c] / weight[k]);
  }
  atlas::dilate(static_cast<int>(r.width), static_cast<int>(r.height), 1, 3, values, std::move(covered));
  return values;
}

/// Bytes of a rectangle and its rim.
void write(std::span<const float> values, Maps::Rectangle& r, Maps::Texture& texture) {
  r.most = std::max(*std::max_element(values.begin(), values.end()), 0.0f);
  if (!(r.most > 0)) return;
  const auto clamped = [](std::uint32_t i, std::uint32_t n) { return std::min(i > 0 ? i - 1 : 0, n - 1); };
  for (std::uint32_t y = 0; y < r.height + 2 * kRim; ++y)
    for (std::uint32_t x = 0; x < r.width + 2 * kRim; ++x) {
      const std::size_t from = 3 * at(clamped(x, r.width), clamped(y, r.height), r.width);
      const std::size_t to = 3 * at(r.x - kRim + x, r.y - kRim + y, texture.width);
      for (std::size_t c = 0; c < 3; ++c) {
        const float share = std::sqrt(std::max(values[from + c], 0.0f) / r.most);
        texture.rgb[to + c] = static_cast<std::uint8_t>(std::lround(255.0f * basis::texelOf(share, 1.0f)));
      }
    }
}

}  // namespace

asset::DirectionMaps packDirections(const atlas::Texels& texels, std::span<const Direction> directions,
                                    std::span<const float> coefficients, std::span<const std::uint8_t> valid,
                                    float scale) {
  const std::size_t n = directions.size();
  RELUME_CHECK_EQ(coefficients.size(), texels.points.size() * n * 3);
  Maps maps;
  maps.directions.assign(directions.begin(), directions.end());
  const std::vector<Members> charts = membersOf(texels);
  for (const Members& chart : charts) {
    maps.charts.push_back(chart.place);
    for (const Direction d : directions) maps.rectangles.push_back(sizeOf(chart, texels, d, scale));
  }
  for (std::size_t i = 0; i < n; ++i) maps.textures.push_back(arrange(maps, i));
  parallelFor(n, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < charts.size(); ++c) {
        Maps::Rectangle& r = maps.rectangles[c * n + i];
        if (r.width == 0) continue;
        const auto value = [&](std::uint32_t point) {
          const float* v = &coefficients[(std::size_t{point} * n + i) * 3];
          return Vec3(v[0], v[1], v[2]);
        };
        write(resample(charts[c], texels, r, directions[i], valid, value), r, maps.textures[i]);
      }
  });
  return maps;
}

}  // namespace relume::bake
