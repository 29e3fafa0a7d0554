// SPDX-License-Identifier: MIT
// Whether charts cover one place of the plane twice, decided on their borders.
#pragma once
#include <span>
#include <vector>

#include "charts/chart_mesh.h"

namespace relume::atlas {

struct Segment {
  DVec2 a, b;
};

/// Segments sorted into bands of y, so that those near a point or another segment are found quickly.
class SegmentBands {
 public:
  explicit SegmentBands(std::vector<Segment> segments);

  const std::vector<Segment>& segments() const { return segments_; }
  /// How often the closed curves that the segments form wind around p.
  int winding(DVec2 p) const;
  /// Calls f(index) for segments whose y-range meets [lo, hi]; some may come more than once. Stops when f
  /// returns true, and returns whether it did.
  template <class F>
  bool anyNear(double lo, double hi, F&& f) const {
    if (hi < lo_ || lo > hi_) return false;
    for (std::size_t band = bandOf(lo), last = bandOf(hi); band <= last; ++band) {
      for (std::uint32_t i = first_[band]; i < first_[band + 1]; ++i) {
        if (f(members_[i])) return true;
      }
    }
    return false;
  }

 private:
  std::size_t bandOf(double y) const;

  std::vector<Segment> segments_;
  double lo_ = 0, hi_ = 0, bands_per_unit_ = 0;
  std::vector<std::uint32_t> first_, members_;
};

/// Whether the segments cross in a point inside both.
bool crossing(const Segment& s, const Segment& t);

/// The border of a chart as segments, the chart on their left.
std::vector<Segment> borderSegments(const ChartMesh& chart);

/// A point of the chart close to the middle of a border edge.
DVec2 justInside(const ChartMesh& chart, std::size_t border_edge);

/// Whether the map of a chart covers a place twice. All triangles must be counter-clockwise. Such a map is
/// injective if and only if its border winds around every covered point once: proper crossings and the
/// winding just inside every border edge decide it.
bool overlapsItself(const ChartMesh& chart);

/// Moves border vertices that reach less than `tolerance` beyond another border edge of their chart onto that
/// edge: where a vertex of one side of a slit lies on an edge of the other (T-junctions), rounding lets the
/// sides overlap by a hair.
void closeSlits(ChartMesh& chart, double tolerance);

}  // namespace relume::atlas
