// SPDX-License-Identifier: MIT
// A chart is cut across one of the axes of its box where the boxes of the two sides are smallest in sum.
#include "charts/split.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <numeric>

#include "charts/box.h"
#include "charts/flat_map.h"
#include "charts/overlap.h"

namespace relume::atlas {
namespace {

constexpr double kMostWaste = 0.001;  // share of a page that the box of a chart may leave empty
constexpr double kLeastSide =
    0.08;  // share of a chart's surface that a cut takes off: else many cuts peel single triangles
constexpr double kFlatEnough = 1.01;  // mean stretch
constexpr int kRelaxations = 8;
constexpr double kLongest = 0.9;    // share of the width of a page
constexpr double kMiddle = 0.3;     // the same where the chart is too long
constexpr double kShorter = 0.8;    // length of the parts of what is too long
constexpr double kLeastGain = 0.1;  // share of the emptiness that cutting must save

class Splitter {
 public:
  Splitter(const Topology& topology, const SplitOptions& options)
      : topology_(topology), options_(options), local_(topology.triangleCount(), kNone) {}

  /// Appends the chart or its parts; returns the sum of their costs.
  double split(ChartMesh chart, std::vector<ChartMesh>& parts) {
    const OrientedBox box = boxOf(chart);
    const double whole = cost(box.extent());
    const double waste = whole - chart.area / (options_.texel * options_.texel);
    const bool too_long = box.extent().x > kLongest * options_.page_size * options_.texel;
    if (chart.triangles.size() > 1 &&
        (too_long || waste > kMostWaste * options_.page_size * options_.page_size)) {
      // One cut through a frame saves nothing, three do: only the sum over all further cuts tells.
      const std::size_t before = parts.size();
      const Sides sides = bestCut(chart, box, too_long ? kMiddle : kLeastSide);
      if (!sides[0].empty()) {
        double sum = 0;
        for (const auto& side : sides) {
          for (ChartMesh& part : componentsOf(chart, side)) sum += split(std::move(part), parts);
        }
        const auto shorter = [&](const ChartMesh& part) {
          return boxOf(part).extent().x < kShorter * box.extent().x;
        };
        const bool helps =
            too_long ? std::all_of(parts.begin() + static_cast<std::ptrdiff_t>(before), parts.end(), shorter)
                     : sum <= whole - kLeastGain * waste;
        if (helps) return sum;
        parts.resize(before);
      }
    }
    parts.push_back(std::move(chart));
    return whole;
  }

 private:
  using Sides = std::array<std::vector<std::uint32_t>, 2>;  // indices into ChartMesh::triangles

  double cost(DVec2 extent) const {
    const double rim = 1.0 + options_.gutter;
    return (extent.x / options_.texel + rim) * (extent.y / options_.texel + rim);
  }

  /// Empty when no cut takes enough off.
  Sides bestCut(const ChartMesh& chart, const OrientedBox& box, double least_side) const {
    const auto count = static_cast<std::uint32_t>(chart.triangles.size());
    Sides best;
    double best_cost = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 2; ++axis) {
      std::vector<std::pair<double, std::uint32_t>> order(count);
      std::vector<DVec2> lo(count), hi(count);
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto& c = chart.corners[i];
        const DVec2 p[3] = {box.toBox(chart.uv[c[0]]), box.toBox(chart.uv[c[1]]), box.toBox(chart.uv[c[2]])};
        lo[i] = glm::min(p[0], glm::min(p[1], p[2]));
        hi[i] = glm::max(p[0], glm::max(p[1], p[2]));
        order[i] = {p[0][axis] + p[1][axis] + p[2][axis], i};
      }
      std::sort(order.begin(), order.end());
      std::vector<double> after(count);  // cost of the box of order[i ..]
      DVec2 box_lo(std::numeric_limits<double>::infinity()), box_hi = -box_lo;
      const auto add = [&](std::uint32_t i) {
        box_lo = glm::min(box_lo, lo[i]);
        box_hi = glm::max(box_hi, hi[i]);
        return cost(box_hi - box_lo);
      };
      for (std::uint32_t k = count; k-- > 0;) after[k] = add(order[k].second);
      box_lo = DVec2(std::numeric_limits<double>::infinity()), box_hi = -box_lo;
      std::uint32_t cut = 0;
      double area = 0;
      for (std::uint32_t k = 0; k + 1 < count; ++k) {
        const double sum = add(order[k].second) + after[k + 1];
        area += topology_.area[chart.triangles[order[k].second]];
        if (area > (1 - least_side) * chart.area) break;
        if (area >= least_side * chart.area && sum < best_cost) {
          best_cost = sum;
          cut = k + 1;
        }
      }
      if (cut == 0) continue;
      best = {};
      for (std::uint32_t k = 0; k < count; ++k) best[k < cut ? 0 : 1].push_back(order[k].second);
      for (auto& side : best) std::sort(side.begin(), side.end());
    }
    return best;
  }

  /// Connected parts of some triangles of a chart, with its map. Mates are connected where the chart joins
  /// them, not across its seams.
  std::vector<ChartMesh> componentsOf(const ChartMesh& chart, const std::vector<std::uint32_t>& members) {
    for (const std::uint32_t i : members) local_[chart.triangles[i]] = i;
    const auto joined = [&](std::uint32_t h) {  // half-edge of the chart; its mate there, or kNone
      const std::uint32_t mate = topology_.mate[3 * chart.triangles[h / 3] + h % 3];
      if (mate == kNone || local_[mate / 3] == kNone) return kNone;
      const std::uint32_t m = 3 * local_[mate / 3] + mate % 3;
      const auto vertex = [&](std::uint32_t k) { return chart.corners[k / 3][k % 3]; };
      return vertex(h) == vertex(nextHalfEdge(m)) && vertex(nextHalfEdge(h)) == vertex(m) ? m : kNone;
    };
    std::vector<std::uint32_t> part_of(chart.triangles.size(), kNone);
    std::vector<std::vector<std::uint32_t>> groups;
    for (const std::uint32_t seed : members) {
      if (part_of[seed] != kNone) continue;
      const auto part = static_cast<std::uint32_t>(groups.size());
      std::vector<std::uint32_t> found{seed};
      part_of[seed] = part;
      for (std::size_t k = 0; k < found.size(); ++k) {
        for (std::uint32_t e = 0; e < 3; ++e) {
          const std::uint32_t mate = joined(3 * found[k] + e);
          if (mate == kNone || part_of[mate / 3] != kNone) continue;
          part_of[mate / 3] = part;
          found.push_back(mate / 3);
        }
      }
      std::sort(found.begin(), found.end());
      groups.push_back(std::move(found));
    }
    std::vector<ChartMesh> parts;
    std::vector<std::uint32_t> vertex(chart.uv.size(), kNone);
    for (const auto& group : groups) {
      ChartMesh part;
      for (const std::uint32_t i : group) {
        part.triangles.push_back(chart.triangles[i]);
        auto& corners = part.corners.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
          std::uint32_t& v = vertex[chart.corners[i][k]];
          if (v == kNone) {
            v = static_cast<std::uint32_t>(part.uv.size());
            part.uv.push_back(chart.uv[chart.corners[i][k]]);
          }
          corners[k] = v;
        }
        for (std::uint32_t e = 0; e < 3; ++e) {
          if (joined(3 * i + e) == kNone) {
            part.border.push_back(static_cast<std::uint32_t>(3 * part.triangles.size() - 3) + e);
          }
        }
      }
      for (const std::uint32_t i : group) {
        for (const std::uint32_t v : chart.corners[i]) vertex[v] = kNone;
      }
      normalizeAndMeasure(topology_, part);
      parts.push_back(std::move(part));
    }
    for (const std::uint32_t i : members) local_[chart.triangles[i]] = kNone;
    return parts;
  }

  const Topology& topology_;
  SplitOptions options_;
  std::vector<std::uint32_t> local_;  // mesh triangle -> triangle of the chart being cut
};

/// Freed of the rest, a part may lie flatter: from where it is, or from its own projection.
void flattenAnew(const Topology& topology, ChartMesh& part) {
  if (part.mean_stretch <= kFlatEnough) return;
  ChartMesh from_here = part, from_plane = part;
  projectToPlane(topology, from_plane);
  for (ChartMesh* candidate : {&from_here, &from_plane}) {
    if (!measureStretch(topology, *candidate).valid) continue;
    relaxMap(topology, *candidate, kRelaxations);
    if (!normalizeAndMeasure(topology, *candidate) || candidate->mean_stretch >= part.mean_stretch) continue;
    if (!overlapsItself(*candidate)) part = *candidate;
  }
}

}  // namespace

void splitHollowCharts(const Topology& topology, const SplitOptions& options,
                       std::vector<ChartMesh>& charts) {
  Splitter splitter(topology, options);
  std::vector<ChartMesh> parts, more;
  for (ChartMesh& chart : charts) {
    parts.clear();
    splitter.split(std::move(chart), parts);
    if (parts.size() > 1) {
      for (ChartMesh& part : parts) flattenAnew(topology, part);
      std::move(parts.begin() + 1, parts.end(), std::back_inserter(more));
    }
    chart = std::move(parts.front());
  }
  std::move(more.begin(), more.end(), std::back_inserter(charts));
}

}  // namespace relume::atlas
