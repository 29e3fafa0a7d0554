// SPDX-License-Identifier: MIT
// What every atlas must be, found again by slow and obvious means.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "relume/atlas/atlas.h"
#include "relume/core/progress.h"

namespace relume::atlas::test {

using scene::kNone;
using D2 = glm::dvec2;

inline double turn(D2 a, D2 b) { return a.x * b.y - a.y * b.x; }

/// Area of the part of a triangle in a texel's square, by clipping against its four sides.
inline double areaInTexel(const std::array<D2, 3>& triangle, int x, int y) {
  std::vector<D2> polygon(triangle.begin(), triangle.end());
  const auto clip = [&](auto&& inside) {
    std::vector<D2> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const D2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      const double da = inside(a), db = inside(b);
      if (da >= 0) kept.push_back(a);
      if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + (da / (da - db)) * (b - a));
    }
    polygon = std::move(kept);
  };
  clip([&](D2 p) { return p.x - x; });
  clip([&](D2 p) { return x + 1 - p.x; });
  clip([&](D2 p) { return p.y - y; });
  clip([&](D2 p) { return y + 1 - p.y; });
  double area = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    area += 0.5 * turn(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return std::abs(area);
}

/// shape: [pages][height][width]: the chart that covers a texel, kNone for none. Fails where two do.
inline std::vector<std::uint32_t> coveredBy(const Atlas& atlas) {
  std::vector<std::uint32_t> owner(atlas.texels(), kNone);
  std::size_t shared = 0;
  for (const InstanceUv& uv : atlas.instances) {
    for (std::size_t t = 0; t < uv.triangles.size(); ++t) {
      const std::uint32_t chart = uv.triangle_chart[t];
      if (chart == kNone) continue;
      std::array<D2, 3> p;
      for (int k = 0; k < 3; ++k) p[static_cast<std::size_t>(k)] = D2(uv.uv[uv.triangles[t][k]]);
      const auto range = [&](auto&& of, int size) {
        const auto [lo, hi] = std::minmax({of(p[0]), of(p[1]), of(p[2])});
        return std::pair(std::max(0, static_cast<int>(std::floor(lo))),
                         std::min(size - 1, static_cast<int>(std::floor(hi))));
      };
      const auto [x0, x1] = range([](D2 q) { return q.x; }, atlas.width);
      const auto [y0, y1] = range([](D2 q) { return q.y; }, atlas.height);
      for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
          if (!(areaInTexel(p, x, y) > 0)) continue;
          std::uint32_t& o = owner[(std::size_t{uv.page} * static_cast<std::size_t>(atlas.height) +
                                    static_cast<std::size_t>(y)) *
                                       static_cast<std::size_t>(atlas.width) +
                                   static_cast<std::size_t>(x)];
          shared += o != kNone && o != chart;
          o = chart;
        }
      }
    }
  }
  EXPECT_EQ(shared, 0u) << "texels covered by two charts";
  return owner;
}

/// The least number of uncovered texels between texels of two charts, or `most` if there are more everywhere.
inline int narrowestGutter(const Atlas& atlas, const std::vector<std::uint32_t>& owner, int most) {
  int narrowest = most;
  const auto width = atlas.width, height = atlas.height;
  for (std::uint32_t page = 0; page < atlas.pages; ++page) {
    const auto at = [&](int x, int y) {
      return owner[(std::size_t{page} * static_cast<std::size_t>(height) + static_cast<std::size_t>(y)) *
                       static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(x)];
    };
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (at(x, y) == kNone) continue;
        for (int dy = 0; dy <= most; ++dy) {
          for (int dx = -most; dx <= most; ++dx) {
            if (x + dx < 0 || x + dx >= width || y + dy >= height) continue;
            const std::uint32_t other = at(x + dx, y + dy);
            if (other != kNone && other != at(x, y))
              narrowest = std::min(narrowest, std::max(std::abs(dx), dy) - 1);
          }
        }
      }
    }
  }
  return narrowest;
}

/// Texel centres strictly inside two triangles.
inline std::size_t centresClaimedTwice(const Atlas& atlas) {
  std::vector<std::uint8_t> claims(atlas.texels(), 0);
  for (const InstanceUv& uv : atlas.instances) {
    for (std::size_t t = 0; t < uv.triangles.size(); ++t) {
      if (uv.triangle_chart[t] == kNone) continue;
      D2 p[3];
      for (int k = 0; k < 3; ++k) p[k] = D2(uv.uv[uv.triangles[t][k]]);
      if (turn(p[1] - p[0], p[2] - p[0]) < 0) std::swap(p[1], p[2]);
      const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
      const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
      for (int y = std::max(0, static_cast<int>(y0)); y <= std::min(atlas.height - 1, static_cast<int>(y1));
           ++y) {
        for (int x = std::max(0, static_cast<int>(x0)); x <= std::min(atlas.width - 1, static_cast<int>(x1));
             ++x) {
          const D2 c(x + 0.5, y + 0.5);
          bool inside = true;
          for (int k = 0; k < 3; ++k) inside = inside && turn(p[(k + 1) % 3] - p[k], c - p[k]) > 0;
          if (inside) {
            ++claims[(std::size_t{uv.page} * static_cast<std::size_t>(atlas.height) +
                      static_cast<std::size_t>(y)) *
                         static_cast<std::size_t>(atlas.width) +
                     static_cast<std::size_t>(x)];
          }
        }
      }
    }
  }
  return static_cast<std::size_t>(
      std::count_if(claims.begin(), claims.end(), [](std::uint8_t n) { return n > 1; }));
}

/// World area of a triangle of an instance.
inline double worldArea(const scene::Scene& scene, const InstanceUv& uv, std::size_t triangle) {
  const scene::Instance& instance = scene.instances[uv.instance];
  const scene::Mesh& mesh = scene.meshes[instance.mesh];
  glm::dvec3 p[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = glm::dvec3(glm::dmat4(instance.world_from_local) *
                      glm::dvec4(glm::dvec3(mesh.positions[mesh.triangles[triangle][k]]), 1));
  }
  return 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
}

inline double texelArea(const InstanceUv& uv, std::size_t triangle) {
  const UVec3 c = uv.triangles[triangle];
  return 0.5 * turn(D2(uv.uv[c[1]]) - D2(uv.uv[c[0]]), D2(uv.uv[c[2]]) - D2(uv.uv[c[0]]));
}

struct Measured {
  double coverage = 0;
  double texels_per_metre = 0;  ///< of all charts together
};

/// All that holds for every atlas whose charts are made here.
inline Measured checkAtlas(const scene::Scene& scene, const Atlas& atlas, const AtlasOptions& options) {
  Measured measured;
  std::size_t next = 0;
  double surface = 0, plane = 0;
  std::set<std::uint32_t> charts_seen;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    if (scene.instances[i].dynamic) continue;
    if (next >= atlas.instances.size()) {
      ADD_FAILURE() << "too few instances";
      return measured;
    }
    const InstanceUv& uv = atlas.instances[next++];
    const scene::Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    EXPECT_EQ(uv.instance, i);
    EXPECT_EQ(uv.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(uv.triangle_chart.size(), mesh.triangles.size());
    EXPECT_EQ(uv.uv.size(), uv.source_vertex.size());
    EXPECT_LT(uv.page, atlas.pages);
    for (const Vec2 p : uv.uv) {
      EXPECT_TRUE(p.x >= 0 && p.y >= 0 && p.x <= static_cast<float>(atlas.width) &&
                  p.y <= static_cast<float>(atlas.height));
    }
    std::vector<std::uint32_t> chart_of_vertex(uv.uv.size(), kNone);
    for (std::size_t t = 0; t < uv.triangles.size(); ++t) {
      const std::uint32_t chart = uv.triangle_chart[t];
      for (int k = 0; k < 3; ++k) EXPECT_EQ(uv.source_vertex[uv.triangles[t][k]], mesh.triangles[t][k]);
      if (chart == kNone) {
        EXPECT_LT(worldArea(scene, uv, t), 1e-5);
        continue;
      }
      charts_seen.insert(chart);
      EXPECT_EQ(atlas.charts[chart].instance, i);
      EXPECT_EQ(atlas.charts[chart].page, uv.page);
      EXPECT_GT(texelArea(uv, t), -1e-3) << "triangle " << t << " is turned over";
      for (int k = 0; k < 3; ++k) {
        std::uint32_t& of_vertex = chart_of_vertex[uv.triangles[t][k]];
        EXPECT_TRUE(of_vertex == kNone || of_vertex == chart) << "charts share a vertex";
        of_vertex = chart;
        const Vec2 p = uv.uv[uv.triangles[t][k]];
        const Chart& c = atlas.charts[chart];
        EXPECT_TRUE(p.x >= static_cast<float>(c.first_texel_x) &&
                    p.x <= static_cast<float>(c.first_texel_x + c.width));
        EXPECT_TRUE(p.y >= static_cast<float>(c.first_texel_y) &&
                    p.y <= static_cast<float>(c.first_texel_y + c.height));
      }
      surface += worldArea(scene, uv, t);
      plane += texelArea(uv, t);
    }
  }
  EXPECT_EQ(next, atlas.instances.size());
  EXPECT_EQ(charts_seen.size(), atlas.charts.size()) << "a chart without triangles";
  const std::vector<std::uint32_t> owner = coveredBy(atlas);
  EXPECT_EQ(narrowestGutter(atlas, owner, options.gutter), options.gutter);
  EXPECT_EQ(centresClaimedTwice(atlas), 0u);
  EXPECT_EQ(atlas.statistics.overlapping_texels, 0u);
  const auto covered = static_cast<double>(
      owner.size() - static_cast<std::size_t>(std::count(owner.begin(), owner.end(), kNone)));
  measured.coverage = covered / static_cast<double>(owner.size());
  // Footprints are grown by a hair before packing, so the statistic may be slightly the larger.
  EXPECT_GE(atlas.statistics.coverage, measured.coverage - 1e-9);
  EXPECT_LE(atlas.statistics.coverage, measured.coverage * 1.02 + 1e-3);
  measured.texels_per_metre = std::sqrt(plane / surface);
  EXPECT_LE(atlas.statistics.mean_stretch, 1.15);
  return measured;
}

inline Atlas build(const scene::Scene& scene, const AtlasOptions& options, Warnings* warnings = nullptr) {
  Warnings own;
  SilentProgress progress;
  return buildAtlas(scene, options, warnings ? *warnings : own, progress);
}

}  // namespace relume::atlas::test
