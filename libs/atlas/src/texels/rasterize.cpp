// SPDX-License-Identifier: MIT
// Conservative raster of an atlas. A texel belongs to the chart that covers most of its square (the first of
// equals); its point is made from that chart's triangles alone. Two passes over windows of charts, so that
// points are written once, straight to their place, and nothing is sorted:
//   1  coverage of each texel by each chart; the largest claim wins (an atomic maximum, hence the same for
//   any thread count); 2  prefix sums over the page turn claims into places in Texels::points, and winners
//   build their points there.
// What the first pass cut is kept for the second as far as a fixed room goes. Memory beyond the result: 8
// bytes per texel of the pages, 4 per triangle, and that room.
#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>

#include "relume/atlas/texels.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "texels/coverage.h"
#include "texels/texel_footprint.h"

namespace relume::atlas {
namespace {

constexpr std::size_t kWindowTexels = std::size_t{1} << 18;  // larger charts are cut into bands of rows
constexpr double kLeastClaim = 1e-6;
constexpr std::size_t kKeptBytes = std::size_t{32} << 20;

/// Part of a chart, the unit of parallel work.
struct Item {
  std::uint32_t chart;
  Window window;
};

std::vector<Item> workItems(const ChartTriangles& triangles) {
  std::vector<Item> items;
  for (std::uint32_t chart = 0; chart + 1 < triangles.first.size(); ++chart) {
    const Window& w = triangles.window[chart];
    if (w.empty()) continue;
    const int rows = static_cast<int>(std::max<std::size_t>(kWindowTexels / w.width(), 1));
    for (int y = w.y0; y < w.y1; y += rows)
      items.push_back({chart, {w.x0, y, w.x1, std::min(w.y1, y + rows)}});
  }
  return items;
}

/// Coverage in the upper half, so that the larger claim is the larger number; of equals the first chart.
std::uint64_t claimOf(double coverage, std::uint32_t chart) {
  return (std::uint64_t{std::bit_cast<std::uint32_t>(static_cast<float>(std::min(coverage, 1.0)))} << 32) |
         ~chart;
}
std::uint32_t winner(std::uint64_t claim) { return ~static_cast<std::uint32_t>(claim); }

void raise(std::uint64_t& claim, std::uint64_t to) {
  std::atomic_ref<std::uint64_t> shared(claim);
  std::uint64_t now = shared.load(std::memory_order_relaxed);
  while (now < to && !shared.compare_exchange_weak(now, to, std::memory_order_relaxed)) {
  }
}

/// A won texel after the passes met: its chart and its place in the points.
struct Place {
  std::uint32_t chart = scene::kNone, point = 0;
};
static_assert(sizeof(Place) == sizeof(std::uint64_t));

class Raster {
 public:
  Raster(const scene::Scene& scene, const Atlas& atlas, const RasterOptions& options)
      : scene_(scene),
        atlas_(atlas),
        options_(options),
        triangles_(trianglesByChart(scene, atlas)),
        items_(workItems(triangles_)),
        kept_(items_.size()),
        textures_(scene) {}

  std::size_t items() const { return items_.size(); }

  void claim(Progress& progress) {
    claims_.assign(atlas_.texels(), 0);
    parallelFor(
        items_.size(), 1,
        [&](std::size_t begin, std::size_t end) {
          FragmentGrid grid;
          for (std::size_t i = begin; i < end; ++i) {
            fragmentsOf(triangles_, atlas_, items_[i].chart, items_[i].window, grid);
            forEachCell(items_[i], grid, [&](std::size_t texel, std::span<const Fragment> fragments) {
              double coverage = 0;
              for (const Fragment& f : fragments) coverage += static_cast<double>(f.coverage);
              if (coverage > kLeastClaim) raise(claims_[texel], claimOf(coverage, items_[i].chart));
            });
            keep(i, grid);
          }
        },
        &progress);
    std::uint32_t points = 0;
    for (std::uint64_t& claim : claims_) {
      const Place place = claim ? Place{winner(claim), points++} : Place{};
      claim = std::bit_cast<std::uint64_t>(place);
    }
    points_ = points;
  }

  void build(Texels& texels, Progress& progress) {
    texels.points.resize(points_);
    std::vector<std::vector<SubSample>> samples(items_.size());
    parallelFor(
        items_.size(), 1,
        [&](std::size_t begin, std::size_t end) {
          FragmentGrid grid;
          for (std::size_t i = begin; i < end; ++i) {
            FootprintBuilder builder(scene_, uvOf(items_[i]), items_[i].chart,
                                     options_.materials ? &textures_ : nullptr);
            if (kept_[i].first.empty())
              fragmentsOf(triangles_, atlas_, items_[i].chart, items_[i].window, grid);
            else
              grid = std::move(kept_[i]);
            forEachCell(items_[i], grid, [&](std::size_t texel, std::span<const Fragment> fragments) {
              const Place place = placeOf(texel);
              if (place.chart != items_[i].chart) return;
              const WorkItem work("texel", texel);
              const auto [x, y] = coordinates(texel);
              SurfacePoint point = builder.build(x, y, fragments, samples[i]);
              point.texel = static_cast<std::uint32_t>(texel);
              texels.points[place.point] = point;
            });
            samples[i].shrink_to_fit();
          }
        },
        &progress);
    join(samples, texels);
  }

 private:
  /// Which grids find room depends on the threads, what comes out of them does not.
  void keep(std::size_t item, const FragmentGrid& grid) {
    const std::size_t bytes =
        grid.first.size() * sizeof(grid.first[0]) + grid.fragments.size() * sizeof(Fragment);
    if (kept_bytes_.fetch_add(bytes, std::memory_order_relaxed) + bytes > kKeptBytes) return;
    kept_[item].first = grid.first, kept_[item].fragments = grid.fragments;
  }

  /// Moves the items' samples into one array, in item order, and frees them on the way.
  void join(std::vector<std::vector<SubSample>>& samples, Texels& texels) {
    std::size_t total = 0;
    for (const auto& own : samples) total += own.size();
    RELUME_CHECK_LE(total, std::size_t{std::numeric_limits<std::uint32_t>::max()});
    texels.samples.reserve(total);
    for (std::size_t i = 0; i < items_.size(); ++i) {
      if (samples[i].empty()) continue;
      const auto base = static_cast<std::uint32_t>(texels.samples.size());
      texels.samples.insert(texels.samples.end(), samples[i].begin(), samples[i].end());
      std::vector<SubSample>().swap(samples[i]);
      const Window& w = items_[i].window;
      for (int y = w.y0; y < w.y1; ++y) {
        for (int x = w.x0; x < w.x1; ++x) {
          const Place place = placeOf(texelAt(items_[i].chart, x, y));
          if (place.chart != items_[i].chart) continue;
          SurfacePoint& point = texels.points[place.point];
          if (point.sample_count > 0) point.first_sample += base;
        }
      }
    }
  }

  const InstanceUv& uvOf(const Item& item) const {
    return atlas_.instances[triangles_.instance_uv[item.chart]];
  }
  Place placeOf(std::size_t texel) const { return std::bit_cast<Place>(claims_[texel]); }

  std::size_t texelAt(std::uint32_t chart, int x, int y) const {
    const std::size_t width = static_cast<std::size_t>(atlas_.width),
                      height = static_cast<std::size_t>(atlas_.height);
    return (atlas_.charts[chart].page * height + static_cast<std::size_t>(y)) * width +
           static_cast<std::size_t>(x);
  }
  std::pair<int, int> coordinates(std::size_t texel) const {
    const std::size_t width = static_cast<std::size_t>(atlas_.width),
                      height = static_cast<std::size_t>(atlas_.height);
    return {static_cast<int>(texel % width), static_cast<int>(texel / width % height)};
  }

  template <class Body>
  void forEachCell(const Item& item, const FragmentGrid& grid, const Body& body) const {
    const std::span<const Fragment> all(grid.fragments);
    std::size_t cell = 0;
    for (int y = item.window.y0; y < item.window.y1; ++y) {
      for (int x = item.window.x0; x < item.window.x1; ++x, ++cell) {
        const std::size_t begin = grid.first[cell], end = grid.first[cell + 1];
        if (begin < end) body(texelAt(item.chart, x, y), all.subspan(begin, end - begin));
      }
    }
  }

  const scene::Scene& scene_;
  const Atlas& atlas_;
  const RasterOptions& options_;
  ChartTriangles triangles_;
  std::vector<Item> items_;
  std::vector<FragmentGrid> kept_;  // by item; empty: none
  std::atomic<std::size_t> kept_bytes_ = 0;
  MaterialTextures textures_;
  std::vector<std::uint64_t> claims_;  // per texel of all pages: a claim, later a Place
  std::uint32_t points_ = 0;
};

}  // namespace

Texels rasterize(const scene::Scene& scene, const Atlas& atlas, Progress& progress,
                 const RasterOptions& options) {
  RELUME_CHECK_LE(atlas.texels(), std::size_t{scene::kNone});
  Texels texels;
  texels.width = atlas.width;
  texels.height = atlas.height;
  texels.pages = atlas.pages;
  for (const Chart& chart : atlas.charts) RELUME_CHECK_LT(chart.page, atlas.pages);
  Raster raster(scene, atlas, options);
  const Stage stage(progress, "texels", 2 * raster.items());
  raster.claim(progress);
  raster.build(texels, progress);
  return texels;
}

Point footprintPosition(const Texels& texels, const SurfacePoint& point, Vec2 u) {
  if (point.sample_count == 0) {
    // A little less than the square, so that no ray starts on an edge between two surfaces.
    constexpr float kShare = 1.0f - 0x1p-8f;
    return point.position + (u.x - 0.5f) * kShare * point.dp_dx + (u.y - 0.5f) * kShare * point.dp_dy;
  }
  const auto index = static_cast<std::uint32_t>(u.x * static_cast<float>(point.sample_count));
  return texels.samples[point.first_sample + std::min(index, point.sample_count - 1)].position;
}

}  // namespace relume::atlas
