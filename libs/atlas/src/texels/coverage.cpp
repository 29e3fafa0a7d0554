// SPDX-License-Identifier: MIT
// Exact area coverage: a triangle is cut into rows of texels and each row into squares, so the pieces add up
// to the triangle. Runs of squares that lie wholly inside come from the edge functions and are not cut.
#include "texels/coverage.h"

#include <algorithm>
#include <cmath>

#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::atlas {
namespace {

// Below this a piece is rounding of the UVs, not a surface.
constexpr double kLeastCoverage = 1e-7;

/// The squares [first, last) of row y that lie in all three half planes.
struct Run {
  int first, last;
};
Run squaresInside(const std::array<DVec2, 3>& ccw, int y, int x0, int x1) {
  double lo = x0, hi = x1 - 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const DVec2 p = ccw[i], edge = ccw[(i + 1) % 3] - p;
    // Edge function a x + b y + c at the square's worst corner.
    const double a = -edge.y, b = edge.x, c = -(a * p.x + b * p.y);
    const double rest = std::min(a, 0.0) + b * y + std::min(b, 0.0) + c;
    if (a > 0) {
      lo = std::max(lo, std::ceil(-rest / a));
    } else if (a < 0) {
      hi = std::min(hi, std::floor(rest / -a));
    } else if (rest < 0) {
      return {x0, x0};
    }
  }
  if (!(lo <= hi)) return {x0, x0};
  return {static_cast<int>(lo), static_cast<int>(hi) + 1};
}

int clampedTexel(double x, int lo, int hi) {
  return static_cast<int>(std::clamp(x, static_cast<double>(lo), static_cast<double>(hi)));
}

bool finite(DVec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); }

Window windowOf(const std::array<DVec2, 3>& corners, const Atlas& atlas) {
  const DVec2 lo = glm::min(corners[0], glm::min(corners[1], corners[2]));
  const DVec2 hi = glm::max(corners[0], glm::max(corners[1], corners[2]));
  return {clampedTexel(std::floor(lo.x), 0, atlas.width), clampedTexel(std::floor(lo.y), 0, atlas.height),
          clampedTexel(std::ceil(hi.x), 0, atlas.width), clampedTexel(std::ceil(hi.y), 0, atlas.height)};
}

void grow(Window& window, const Window& by) {
  if (by.empty()) return;
  if (window.empty()) {
    window = by;
    return;
  }
  window = {std::min(window.x0, by.x0), std::min(window.y0, by.y0), std::max(window.x1, by.x1),
            std::max(window.y1, by.y1)};
}

bool hasArea(const scene::Mesh& mesh, UVec3 t) {
  const Point p = mesh.positions[t.x];
  return glm::cross(mesh.positions[t.y] - p, mesh.positions[t.z] - p) != Vec3(0.0f);
}

}  // namespace

std::array<DVec2, 3> pageTriangle(const InstanceUv& uv, std::uint32_t triangle) {
  const UVec3 t = uv.triangles[triangle];
  return {DVec2(uv.uv[t.x]), DVec2(uv.uv[t.y]), DVec2(uv.uv[t.z])};
}

ChartTriangles trianglesByChart(const scene::Scene& scene, const Atlas& atlas) {
  const std::size_t charts = atlas.charts.size();
  ChartTriangles out;
  out.first.assign(charts + 1, 0);
  out.instance_uv.assign(charts, scene::kNone);
  out.window.assign(charts, {});
  const auto visit = [&](const auto& body) {
    for (std::uint32_t i = 0; i < atlas.instances.size(); ++i) {
      const InstanceUv& uv = atlas.instances[i];
      const scene::Mesh& mesh = scene.meshes[scene.instances[uv.instance].mesh];
      RELUME_CHECK_EQ(uv.triangles.size(), mesh.triangles.size());
      RELUME_CHECK_EQ(uv.triangle_chart.size(), mesh.triangles.size());
      for (std::uint32_t t = 0; t < uv.triangles.size(); ++t) {
        const std::uint32_t chart = uv.triangle_chart[t];
        if (chart == scene::kNone || !hasArea(mesh, mesh.triangles[t])) continue;
        const auto corners = pageTriangle(uv, t);
        if (!finite(corners[0]) || !finite(corners[1]) || !finite(corners[2])) continue;
        if (cross(corners[1] - corners[0], corners[2] - corners[0]) == 0) continue;
        RELUME_CHECK_LT(chart, charts);
        body(i, chart, t, corners);
      }
    }
  };
  visit([&](std::uint32_t i, std::uint32_t chart, std::uint32_t, const std::array<DVec2, 3>& corners) {
    RELUME_CHECK(out.instance_uv[chart] == scene::kNone || out.instance_uv[chart] == i);
    out.instance_uv[chart] = i;
    grow(out.window[chart], windowOf(corners, atlas));
    ++out.first[chart + 1];
  });
  for (std::size_t c = 0; c < charts; ++c) out.first[c + 1] += out.first[c];
  out.triangle.resize(out.first[charts]);
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  visit([&](std::uint32_t, std::uint32_t chart, std::uint32_t t, const std::array<DVec2, 3>&) {
    out.triangle[next[chart]++] = t;
  });
  return out;
}

void appendFragments(const std::array<DVec2, 3>& corners, std::uint32_t triangle, const Window& window,
                     std::vector<Fragment>& fragments) {
  std::array<DVec2, 3> ccw = corners;
  if (cross(ccw[1] - ccw[0], ccw[2] - ccw[0]) < 0) std::swap(ccw[1], ccw[2]);
  const double low = std::min({ccw[0].y, ccw[1].y, ccw[2].y}),
               high = std::max({ccw[0].y, ccw[1].y, ccw[2].y});
  if (!(low < window.y1) || !(high > window.y0)) return;
  const int y_begin = clampedTexel(std::floor(low), window.y0, window.y1);
  const int y_end = clampedTexel(std::ceil(high), window.y0, window.y1);

  const auto pushPart = [&](std::uint32_t cell, double covered) {
    // Only the containment test below may say 1.
    if (covered > kLeastCoverage) {
      fragments.push_back({cell, triangle, std::min(static_cast<float>(covered), 1.0f - 0x1p-24f)});
    }
  };
  if (y_end - y_begin == 1 && low >= y_begin && high <= y_end) {
    const double left = std::min({ccw[0].x, ccw[1].x, ccw[2].x}),
                 right = std::max({ccw[0].x, ccw[1].x, ccw[2].x});
    const double x = std::floor(left);
    if (right <= x + 1) {  // within one square
      if (x >= window.x0 && x < window.x1) {
        pushPart(static_cast<std::uint32_t>(y_begin - window.y0) * window.width() +
                     static_cast<std::uint32_t>(static_cast<int>(x) - window.x0),
                 0.5 * cross(ccw[1] - ccw[0], ccw[2] - ccw[0]));
      }
      return;
    }
  }

  Polygon rest, row, right, piece, next;
  for (const DVec2 p : ccw) rest.add(p);
  if (low < y_begin) splitAtY(rest, y_begin, nullptr, &next), rest = next;
  for (int y = y_begin; y < y_end; ++y) {
    if (high <= y + 1.0) {
      row = rest;
    } else {
      splitAtY(rest, y + 1.0, &row, &next);
      rest = next;
    }
    if (row.count < 3) continue;
    double left_end = row[0].x, right_end = row[0].x;
    for (int i = 1; i < row.count; ++i) {
      left_end = std::min(left_end, row[i].x), right_end = std::max(right_end, row[i].x);
    }
    if (!(left_end < window.x1) || !(right_end > window.x0)) continue;
    const int x_begin = clampedTexel(std::floor(left_end), window.x0, window.x1);
    const int x_end = clampedTexel(std::ceil(right_end), window.x0, window.x1);
    const Run inside = x_end - x_begin > 1 ? squaresInside(ccw, y, x_begin, x_end) : Run{x_begin, x_begin};
    const std::uint32_t row_cell = static_cast<std::uint32_t>(y - window.y0) * window.width();
    const auto cell = [&](int x) { return row_cell + static_cast<std::uint32_t>(x - window.x0); };

    right = row;
    if (left_end < x_begin) splitAtX(right, x_begin, nullptr, &next), right = next;
    for (int x = x_begin; x < x_end && right.count >= 3;) {
      if (x == inside.first && inside.first < inside.last) {
        for (; x < inside.last; ++x) fragments.push_back({cell(x), triangle, 1.0f});
        splitAtX(right, x, nullptr, &next);
        right = next;
      } else if (right_end <= x + 1.0) {
        pushPart(cell(x++), area(right));
      } else {
        splitAtX(right, x + 1.0, &piece, &next);
        right = next;
        pushPart(cell(x++), area(piece));
      }
    }
  }
}

void fragmentsOf(const ChartTriangles& triangles, const Atlas& atlas, std::uint32_t chart,
                 const Window& window, FragmentGrid& grid) {
  const InstanceUv& uv = atlas.instances[triangles.instance_uv[chart]];
  std::vector<Fragment>& unsorted = grid.unsorted;
  unsorted.clear();
  for (std::uint32_t i = triangles.first[chart]; i < triangles.first[chart + 1]; ++i) {
    appendFragments(pageTriangle(uv, triangles.triangle[i]), triangles.triangle[i], window, unsorted);
  }
  // Counting sort by cell; stable, so triangles stay in order. Afterwards first[c + 1] is the end of cell c.
  const std::size_t cells = std::size_t{window.width()} * window.height();
  grid.first.assign(cells + 2, 0);
  for (const Fragment& f : unsorted) ++grid.first[f.cell + 2];
  for (std::size_t c = 2; c < cells + 2; ++c) grid.first[c] += grid.first[c - 1];
  grid.fragments.resize(unsorted.size());
  for (const Fragment& f : unsorted) grid.fragments[grid.first[f.cell + 1]++] = f;
  grid.first.pop_back();
}

}  // namespace relume::atlas
