// SPDX-License-Identifier: MIT
#include "relume/asset/direction_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "relume/core/error.h"
#include "table_numbers.h"

namespace relume::asset {
namespace {

constexpr std::size_t kMostDirections = 64;
constexpr float kUnitTolerance = 1e-3f;

std::string mapName(std::size_t direction) { return fmt::format("map{}", direction); }

}  // namespace

std::vector<Table> tablesOf(const DirectionMaps& maps) {
  std::vector<float> directions, most;
  std::vector<std::uint32_t> charts, rectangles, sizes;
  for (const Direction d : maps.directions) directions.insert(directions.end(), {d.x, d.y, d.z});
  for (const auto& c : maps.charts) charts.insert(charts.end(), {c.page, c.x, c.y, c.width, c.height});
  for (const auto& r : maps.rectangles)
    rectangles.insert(rectangles.end(), {r.x, r.y, r.width, r.height}), most.push_back(r.most);
  for (const auto& t : maps.textures) sizes.insert(sizes.end(), {t.width, t.height});
  std::vector<Table> tables = {{"directions", 3, std::move(directions)},
                               {"charts", 5, std::move(charts)},
                               {"rectangles", 4, std::move(rectangles)},
                               {"most", 1, std::move(most)},
                               {"sizes", 2, std::move(sizes)}};
  for (std::size_t i = 0; i < maps.textures.size(); ++i)
    tables.push_back({mapName(i), 3, maps.textures[i].rgb});
  return tables;
}

DirectionMaps directionMapsOf(const Layer& layer, const AtlasTable& atlas) {
  DirectionMaps maps;
  const auto& directions = numbers<float>(layer, "directions", 3);
  const std::size_t n = directions.size() / 3;
  if (n == 0 || n > kMostDirections) corrupt(layer, fmt::format("has {} directions", n));
  for (std::size_t i = 0; i < n; ++i) {
    maps.directions.emplace_back(directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]);
    if (!(std::abs(glm::length(maps.directions.back()) - 1) < kUnitTolerance))
      corrupt(layer, fmt::format("direction {} is not a unit vector", i));
  }
  const auto& charts = numbers<std::uint32_t>(layer, "charts", 5);
  const std::uint32_t known =
      atlas.chart.empty() ? 0 : *std::max_element(atlas.chart.begin(), atlas.chart.end()) + 1;
  if (charts.size() / 5 < known)
    corrupt(layer, fmt::format("knows {} charts of {}", charts.size() / 5, known));
  const auto width = static_cast<std::uint32_t>(atlas.width),
             height = static_cast<std::uint32_t>(atlas.height);
  const auto inside = [](std::uint32_t x, std::uint32_t w, std::uint32_t all) {
    return x <= all && w <= all - x;
  };
  for (std::size_t c = 0; c < charts.size() / 5; ++c) {
    const DirectionMaps::Chart chart{charts[5 * c], charts[5 * c + 1], charts[5 * c + 2], charts[5 * c + 3],
                                     charts[5 * c + 4]};
    if (chart.page >= atlas.pages || !inside(chart.x, chart.width, width) ||
        !inside(chart.y, chart.height, height))
      corrupt(layer, fmt::format("chart {} leaves its page", c));
    maps.charts.push_back(chart);
  }
  const auto& sizes = numbers<std::uint32_t>(layer, "sizes", 2, n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t texels = std::uint64_t{sizes[2 * i]} * sizes[2 * i + 1];
    const auto& rgb = numbers<std::uint8_t>(layer, mapName(i), 3);
    if (rgb.size() % 3 != 0 || rgb.size() / 3 != texels)
      corrupt(layer, fmt::format("map {} has the wrong size", i));
    maps.textures.push_back({sizes[2 * i], sizes[2 * i + 1], rgb});
  }
  const auto& rectangles = numbers<std::uint32_t>(layer, "rectangles", 4, maps.charts.size() * n);
  const auto& most = numbers<float>(layer, "most", 1, maps.charts.size() * n);
  for (std::size_t k = 0; k < most.size(); ++k) {
    const DirectionMaps::Rectangle r{rectangles[4 * k], rectangles[4 * k + 1], rectangles[4 * k + 2],
                                     rectangles[4 * k + 3], most[k]};
    const DirectionMaps::Texture& texture = maps.textures[k % n];
    const bool empty = r.width == 0;
    if (!empty &&
        (r.height == 0 || !inside(r.x, r.width, texture.width) || !inside(r.y, r.height, texture.height)))
      corrupt(layer, fmt::format("a rectangle leaves map {}", k % n));
    if (!(std::isfinite(r.most) && r.most >= 0)) corrupt(layer, "a maximum is negative or not finite");
    maps.rectangles.push_back(r);
  }
  return maps;
}

}  // namespace relume::asset
