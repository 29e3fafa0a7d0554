// SPDX-License-Identifier: MIT
// Why borders suffice: a map without flipped triangles and without branch points covers a point as often as
// its border winds around it; that number changes only across the border. Limits: branch points (an interior
// vertex whose triangles turn around it twice) are looked for by the winding beside the border alone;
// overlaps thinner than 1e-3 of the height of the border triangles in them are not seen.
#include "charts/overlap.h"

#include <algorithm>
#include <cmath>

namespace relume::atlas {
namespace {

constexpr double kInset = 1e-3;  // share of the way from a border edge to the opposite corner of its triangle

double cross(DVec2 a, DVec2 b) { return a.x * b.y - a.y * b.x; }

}  // namespace

SegmentBands::SegmentBands(std::vector<Segment> segments) : segments_(std::move(segments)) {
  if (segments_.empty()) {
    hi_ = -1;
    first_.assign(2, 0);
    return;
  }
  lo_ = hi_ = segments_[0].a.y;
  for (const Segment& s : segments_) {
    lo_ = std::min({lo_, s.a.y, s.b.y});
    hi_ = std::max({hi_, s.a.y, s.b.y});
  }
  const std::size_t bands = segments_.size() / 4 + 1;
  bands_per_unit_ = hi_ > lo_ ? static_cast<double>(bands) / (hi_ - lo_) : 0.0;
  first_.assign(bands + 1, 0);
  const auto range = [&](const Segment& s) {
    return std::pair(bandOf(std::min(s.a.y, s.b.y)), bandOf(std::max(s.a.y, s.b.y)));
  };
  for (const Segment& s : segments_) {
    const auto [begin, last] = range(s);
    for (std::size_t band = begin; band <= last; ++band) ++first_[band + 1];
  }
  for (std::size_t band = 0; band < bands; ++band) first_[band + 1] += first_[band];
  members_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < segments_.size(); ++i) {
    const auto [begin, last] = range(segments_[i]);
    for (std::size_t band = begin; band <= last; ++band) members_[next[band]++] = i;
  }
}

std::size_t SegmentBands::bandOf(double y) const {
  const double last = static_cast<double>(first_.size()) - 2;
  return static_cast<std::size_t>(std::clamp(std::floor((y - lo_) * bands_per_unit_), 0.0, last));
}

int SegmentBands::winding(DVec2 p) const {
  if (p.y < lo_ || p.y > hi_) return 0;
  const std::size_t band = bandOf(p.y);
  int sum = 0;
  for (std::uint32_t i = first_[band]; i < first_[band + 1]; ++i) {
    const Segment& s = segments_[members_[i]];
    if ((s.a.y <= p.y) == (s.b.y <= p.y)) continue;
    const bool left = cross(s.b - s.a, p - s.a) > 0;
    if (s.a.y <= p.y) {
      sum += left ? 1 : 0;
    } else {
      sum -= left ? 0 : 1;
    }
  }
  return sum;
}

bool crossing(const Segment& s, const Segment& t) {
  const double a = cross(s.b - s.a, t.a - s.a), b = cross(s.b - s.a, t.b - s.a);
  if ((a > 0) == (b > 0) || a == 0 || b == 0) return false;
  const double c = cross(t.b - t.a, s.a - t.a), d = cross(t.b - t.a, s.b - t.a);
  return (c > 0) != (d > 0) && c != 0 && d != 0;
}

std::vector<Segment> borderSegments(const ChartMesh& chart) {
  std::vector<Segment> segments;
  segments.reserve(chart.border.size());
  for (const std::uint32_t h : chart.border)
    segments.push_back({chart.uv[chart.start(h)], chart.uv[chart.end(h)]});
  return segments;
}

DVec2 justInside(const ChartMesh& chart, std::size_t border_edge) {
  const std::uint32_t h = chart.border[border_edge];
  const DVec2 middle = 0.5 * (chart.uv[chart.start(h)] + chart.uv[chart.end(h)]);
  return middle + kInset * (chart.uv[chart.opposite(h)] - middle);
}

bool overlapsItself(const ChartMesh& chart) {
  const SegmentBands bands(borderSegments(chart));
  const auto& segments = bands.segments();
  for (std::uint32_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    const std::uint32_t a = chart.start(chart.border[i]), b = chart.end(chart.border[i]);
    const bool crossed = bands.anyNear(std::min(s.a.y, s.b.y), std::max(s.a.y, s.b.y), [&](std::uint32_t j) {
      const std::uint32_t c = chart.start(chart.border[j]), d = chart.end(chart.border[j]);
      return j > i && a != c && a != d && b != c && b != d && crossing(s, segments[j]);
    });
    if (crossed) return true;
    if (bands.winding(justInside(chart, i)) != 1) return true;
  }
  return false;
}

void closeSlits(ChartMesh& chart, double tolerance) {
  const SegmentBands bands(borderSegments(chart));
  const std::vector<DVec2> before = chart.uv;
  bool moved = false;
  for (const std::uint32_t h : chart.border) {
    const std::uint32_t v = chart.start(h);
    const DVec2 p = chart.uv[v];
    double deepest = 0;
    DVec2 target = p;
    bands.anyNear(p.y - tolerance, p.y + tolerance, [&](std::uint32_t j) {
      const std::uint32_t a = chart.start(chart.border[j]), b = chart.end(chart.border[j]);
      if (a == v || b == v) return false;
      const DVec2 from = chart.uv[a], along = chart.uv[b] - from;
      const double length2 = glm::dot(along, along);
      const double t = length2 > 0 ? glm::dot(p - from, along) / length2 : -1;
      const double depth = t > 0 && t < 1 ? cross(along, p - from) / std::sqrt(length2) : 0;
      if (depth > deepest && depth < tolerance) {
        deepest = depth;
        target = from + t * along;
      }
      return false;
    });
    if (deepest == 0) continue;
    chart.uv[v] = target;
    moved = true;
  }
  if (!moved) return;
  const bool valid = std::all_of(chart.corners.begin(), chart.corners.end(), [&](const auto& c) {
    return cross(chart.uv[c[1]] - chart.uv[c[0]], chart.uv[c[2]] - chart.uv[c[0]]) > 0;
  });
  // Slivers may turn over, and slits may meet at a vertex: better a hair of overlap than a worse one.
  if (!valid || overlapsItself(chart)) chart.uv = before;
}

}  // namespace relume::atlas
