// SPDX-License-Identifier: MIT
// Which texels the triangles of a chart cover, and how much of each.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "relume/atlas/atlas.h"
#include "texels/polygon.h"

namespace relume::atlas {

/// Texels x0 <= x < x1, y0 <= y < y1 of a page.
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  bool empty() const { return x0 >= x1 || y0 >= y1; }
  std::uint32_t width() const { return static_cast<std::uint32_t>(x1 - x0); }
  std::uint32_t height() const { return static_cast<std::uint32_t>(y1 - y0); }
};

/// The part of one texel's square that one triangle covers.
struct Fragment {
  std::uint32_t cell = 0;  ///< (y - y0) * width + x - x0 of the window
  std::uint32_t triangle = 0;
  float coverage = 0;  ///< share of the square; exactly 1 where the triangle contains it
};

/// The triangles of each chart, without those that have no area in space or on the page.
struct ChartTriangles {
  std::vector<std::uint32_t> first;        ///< shape: [charts + 1], into `triangle`
  std::vector<std::uint32_t> triangle;     ///< of the chart's instance, increasing
  std::vector<std::uint32_t> instance_uv;  ///< per chart, index into Atlas::instances; kNone: no triangle
  std::vector<Window> window;              ///< per chart, within the page
};
ChartTriangles trianglesByChart(const scene::Scene& scene, const Atlas& atlas);

std::array<DVec2, 3> pageTriangle(const InstanceUv& uv, std::uint32_t triangle);

/// Appends what `corners` (any winding) covers of the window, texel by texel.
void appendFragments(const std::array<DVec2, 3>& corners, std::uint32_t triangle, const Window& window,
                     std::vector<Fragment>& fragments);

/// Fragments of a window, grouped by cell; within a cell by increasing triangle.
struct FragmentGrid {
  std::vector<std::uint32_t> first;  ///< shape: [cells + 1]
  std::vector<Fragment> fragments;
  std::vector<Fragment> unsorted;  ///< working space
};
void fragmentsOf(const ChartTriangles& triangles, const Atlas& atlas, std::uint32_t chart,
                 const Window& window, FragmentGrid& grid);

}  // namespace relume::atlas
