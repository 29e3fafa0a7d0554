// SPDX-License-Identifier: MIT
// Charts are unfolded about the edges they share, as paper models are: a rigid motion lays the smaller beside
// the larger. Where surfaces are curved the motion leaves gaps along the seam; the vertices are then joined
// and the map relaxed. Cost of a chart is the area of its box with a gutter, in texels; a join must lower the
// sum.
#include "charts/join.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>

#include "charts/box.h"
#include "charts/flat_map.h"
#include "charts/motion.h"
#include "charts/overlap.h"

namespace relume::atlas {
namespace {

constexpr float kSharpest = 1.75f;  // radians: no unfolding about edges sharper than 100 degrees
// Share of the surface in the box of a chart below which gutters dwarf it: sides of 10 texels. Interpolation
// mixes the two sides of a fold, so larger faces, where that would be seen, keep their creases.
constexpr double kDwarfed = 0.6;
constexpr double kSeamTolerance = 0.02;  // texels by which the two sides of a rigid seam may miss each other
constexpr int kRelaxations = 5;
constexpr std::size_t kMostWork = 6;      // triangles relaxed, per triangle of the mesh
constexpr double kMostSeamStretch = 2.0;  // of a triangle that the seam pulls
constexpr double kNearInSpace = 2.0;      // gutters

/// An edge in space that two charts share: vertices of the staying chart (a, b) and of the moving one at the
/// same places.
struct Shared {
  std::uint32_t stay_a, stay_b, move_a, move_b;
  std::uint32_t stay_half_edge, move_half_edge;
  double length;
  float angle;  // between the faces
};

struct Plan {
  std::uint32_t stay, move;
  Motion motion;
  std::vector<Shared> glued;
  double saving;
  bool relax = false;  // the sides of the seam meet only after the map has been relaxed
};

class Joiner {
 public:
  Joiner(const Topology& topology, const JoinOptions& options, std::vector<ChartMesh>& charts)
      : topology_(topology),
        options_(options),
        charts_(charts),
        chart_of_(topology.triangleCount(), kNone),
        local_(topology.triangleCount(), 0),
        boxes_(charts.size()),
        costs_(charts.size()),
        version_(charts.size(), 0),
        bands_(charts.size()) {
    for (std::uint32_t c = 0; c < charts.size(); ++c) {
      for (std::uint32_t i = 0; i < charts[c].triangles.size(); ++i) {
        chart_of_[charts[c].triangles[i]] = c;
        local_[charts[c].triangles[i]] = i;
      }
      refresh(c);
    }
  }

  void run() {
    while (!queue_.empty()) {
      const auto [cost, chart, version] = queue_.top();
      queue_.pop();
      if (version != version_[chart] || charts_[chart].triangles.empty()) continue;
      std::vector<Plan> plans = plansFor(chart);
      std::stable_sort(plans.begin(), plans.end(),
                       [](const Plan& a, const Plan& b) { return a.saving > b.saving; });
      for (const Plan& plan : plans) {
        if (plan.relax ? tryRelaxed(plan) : tryJoin(plan)) break;
      }
    }
    std::erase_if(charts_, [](const ChartMesh& c) { return c.triangles.empty(); });
  }

 private:
  double boxCost(DVec2 extent) const {
    if (std::max(extent.x, extent.y) > options_.longest) return std::numeric_limits<double>::infinity();
    const double rim = 1.0 + options_.gutter;
    return (extent.x / options_.texel + rim) * (extent.y / options_.texel + rim);
  }
  bool dwarfed(std::uint32_t c) const {
    return charts_[c].area < kDwarfed * costs_[c] * options_.texel * options_.texel;
  }

  void refresh(std::uint32_t c) {
    boxes_[c] = boxOf(charts_[c]);
    costs_[c] = boxCost(boxes_[c].extent());
    if (!std::isfinite(costs_[c])) return;  // too long already: stays as it is
    bands_[c].reset();
    queue_.push({costs_[c], c, ++version_[c]});
  }

  const SegmentBands& bands(std::uint32_t c) {
    if (!bands_[c]) bands_[c] = std::make_unique<SegmentBands>(borderSegments(charts_[c]));
    return *bands_[c];
  }

  std::uint32_t cornerVertex(std::uint32_t half_edge) const {
    const std::uint32_t t = half_edge / 3;
    return charts_[chart_of_[t]].corners[local_[t]][half_edge % 3];
  }

  std::vector<Plan> plansFor(std::uint32_t chart) {
    struct Contact {
      std::uint32_t other, half_edge, mate;
    };
    std::vector<Contact> contacts;
    for (const std::uint32_t h : charts_[chart].border) {
      const std::uint32_t half_edge = charts_[chart].meshHalfEdge(h), mate = topology_.mate[half_edge];
      if (mate == kNone || chart_of_[mate / 3] == chart) continue;
      contacts.push_back({chart_of_[mate / 3], half_edge, mate});
    }
    std::stable_sort(contacts.begin(), contacts.end(),
                     [](const Contact& a, const Contact& b) { return a.other < b.other; });
    std::vector<Plan> plans;
    for (std::size_t begin = 0, end; begin < contacts.size(); begin = end) {
      for (end = begin; end < contacts.size() && contacts[end].other == contacts[begin].other;) ++end;
      const std::uint32_t other = contacts[begin].other;
      if (!std::isfinite(costs_[other])) continue;
      const bool chart_stays = charts_[chart].border.size() > charts_[other].border.size();
      const std::uint32_t stay = chart_stays ? chart : other, move = chart_stays ? other : chart;
      std::vector<Shared> shared;
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t s = chart_stays ? contacts[i].half_edge : contacts[i].mate;
        const std::uint32_t m = chart_stays ? contacts[i].mate : contacts[i].half_edge;
        const float cosine = glm::dot(topology_.normal[s / 3], topology_.normal[m / 3]);
        const float angle = std::acos(std::clamp(cosine, -1.0f, 1.0f));
        if (angle > kSharpest) continue;
        if (angle > options_.discontinuity_angle && !dwarfed(chart) && !dwarfed(other)) continue;
        const double length = glm::distance(topology_.position[topology_.vertex(s)],
                                            topology_.position[topology_.vertex(nextHalfEdge(s))]);
        shared.push_back({cornerVertex(s), cornerVertex(nextHalfEdge(s)), cornerVertex(nextHalfEdge(m)),
                          cornerVertex(m), s, m, length, angle});
      }
      if (shared.empty()) continue;
      planRigid(stay, move, shared, plans);
      std::erase_if(shared, [&](const Shared& e) { return e.angle > options_.discontinuity_angle; });
      planRelaxed(stay, move, shared, plans);
      const std::size_t all = shared.size();
      keepLongestChain(shared);
      if (shared.size() < all) planRelaxed(stay, move, std::move(shared), plans);
    }
    return plans;
  }

  void planRigid(std::uint32_t stay, std::uint32_t move, const std::vector<Shared>& shared,
                 std::vector<Plan>& plans) {
    const ChartMesh& s = charts_[stay];
    const ChartMesh& m = charts_[move];
    std::vector<std::size_t> seeds(shared.size());
    std::iota(seeds.begin(), seeds.end(), std::size_t{0});
    std::stable_sort(seeds.begin(), seeds.end(),
                     [&](std::size_t a, std::size_t b) { return shared[a].length > shared[b].length; });
    seeds.resize(std::min<std::size_t>(seeds.size(), 6));
    const double tolerance2 = std::pow(kSeamTolerance * options_.texel, 2);
    std::vector<char> covered(shared.size(), 0);
    for (const std::size_t seed : seeds) {
      if (covered[seed]) continue;
      const Shared& e = shared[seed];
      Plan plan{stay, move, align(m.uv[e.move_a], m.uv[e.move_b], s.uv[e.stay_a], s.uv[e.stay_b]), {}, 0};
      for (std::size_t i = 0; i < shared.size(); ++i) {
        const Shared& f = shared[i];
        const DVec2 a = plan.motion(m.uv[f.move_a]) - s.uv[f.stay_a],
                    b = plan.motion(m.uv[f.move_b]) - s.uv[f.stay_b];
        if (glm::dot(a, a) > tolerance2 || glm::dot(b, b) > tolerance2) continue;
        plan.glued.push_back(f);
        covered[i] = 1;
      }
      if (plan.glued.empty()) continue;
      OrientedBox box = boxes_[stay];
      for (const std::uint32_t h : m.border) {
        const DVec2 p = box.toBox(plan.motion(m.uv[m.start(h)]));
        box.lo = glm::min(box.lo, p);
        box.hi = glm::max(box.hi, p);
      }
      plan.saving = costs_[stay] + costs_[move] - boxCost(box.extent());
      if (plan.saving > 0) plans.push_back(std::move(plan));
    }
  }

  /// Leaves the edges of the longest seam: charts may meet along several, such as the halves of a tube.
  void keepLongestChain(std::vector<Shared>& shared) const {
    std::vector<std::pair<std::uint32_t, std::size_t>> ends;  // point in space, edge
    for (std::size_t i = 0; i < shared.size(); ++i) {
      for (const std::uint32_t h : {shared[i].stay_half_edge, nextHalfEdge(shared[i].stay_half_edge)}) {
        ends.push_back({topology_.point[topology_.vertex(h)], i});
      }
    }
    std::sort(ends.begin(), ends.end());
    std::vector<std::size_t> chain(shared.size());
    std::iota(chain.begin(), chain.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
      while (chain[i] != i) i = chain[i] = chain[chain[i]];
      return i;
    };
    for (std::size_t k = 1; k < ends.size(); ++k) {
      if (ends[k].first != ends[k - 1].first) continue;
      const std::size_t a = find(ends[k].second), b = find(ends[k - 1].second);
      chain[std::max(a, b)] = std::min(a, b);
    }
    std::vector<double> length(shared.size(), 0.0);
    for (std::size_t i = 0; i < shared.size(); ++i) length[find(i)] += shared[i].length;
    if (shared.empty()) return;
    const auto longest =
        static_cast<std::size_t>(std::max_element(length.begin(), length.end()) - length.begin());
    std::vector<Shared> kept;
    for (std::size_t i = 0; i < shared.size(); ++i) {
      if (find(i) == longest) kept.push_back(shared[i]);
    }
    shared = std::move(kept);
  }

  void planRelaxed(std::uint32_t stay, std::uint32_t move, std::vector<Shared> shared,
                   std::vector<Plan>& plans) {
    if (shared.empty()) return;
    const ChartMesh& s = charts_[stay];
    const ChartMesh& m = charts_[move];
    // The rigid motion that fits the vertices of the seam best, weighted by the length of its edges.
    DVec2 s_centre(0), m_centre(0), turn(0);
    double weight = 0;
    for (const Shared& e : shared) {
      s_centre += 0.5 * e.length * (s.uv[e.stay_a] + s.uv[e.stay_b]);
      m_centre += 0.5 * e.length * (m.uv[e.move_a] + m.uv[e.move_b]);
      weight += e.length;
    }
    if (!(weight > 0)) return;
    s_centre /= weight, m_centre /= weight;
    const auto turnBy = [&](DVec2 from, DVec2 to, double w) {
      turn += w * DVec2(glm::dot(from, to), from.x * to.y - from.y * to.x);
    };
    for (const Shared& e : shared) {
      turnBy(m.uv[e.move_b] - m.uv[e.move_a], s.uv[e.stay_b] - s.uv[e.stay_a], 1.0);
      turnBy(m.uv[e.move_a] - m_centre, s.uv[e.stay_a] - s_centre, e.length / weight);
      turnBy(m.uv[e.move_b] - m_centre, s.uv[e.stay_b] - s_centre, e.length / weight);
    }
    const double length = glm::length(turn);
    if (!(length > 0)) return;
    Motion motion{turn / length, DVec2(0)};
    motion.offset = s_centre - motion(m_centre);
    OrientedBox box = boxes_[stay];
    for (const std::uint32_t h : m.border) {
      const DVec2 p = box.toBox(motion(m.uv[m.start(h)]));
      box.lo = glm::min(box.lo, p);
      box.hi = glm::max(box.hi, p);
    }
    const double saving = costs_[stay] + costs_[move] - boxCost(box.extent());
    if (saving > 0) plans.push_back({stay, move, motion, std::move(shared), 0.5 * saving, true});
  }

  bool tryJoin(const Plan& plan) {
    ChartMesh moved = charts_[plan.move];
    for (DVec2& p : moved.uv) p = plan.motion(p);
    for (const Shared& e : plan.glued) {
      moved.uv[e.move_a] = charts_[plan.stay].uv[e.stay_a];
      moved.uv[e.move_b] = charts_[plan.stay].uv[e.stay_b];
    }
    const Stretch stretch = measureStretch(topology_, moved);
    if (!stretch.valid || stretch.squares > std::pow(options_.most_mean_stretch, 2) * stretch.surface)
      return false;
    if (stretch.largest > std::max(kMostSeamStretch, charts_[plan.move].max_stretch)) return false;
    if (overlaps(plan.stay, moved) || overlapsItself(moved)) return false;
    commit(plan, glue(std::move(charts_[plan.stay]), moved, plan.glued));
    return true;
  }

  bool tryRelaxed(const Plan& plan) {
    ChartMesh moved = charts_[plan.move], stays = charts_[plan.stay];
    work_ += moved.triangles.size() + stays.triangles.size();
    if (work_ > kMostWork * topology_.triangleCount()) return false;
    for (DVec2& p : moved.uv) p = plan.motion(p);
    std::vector<DVec2> target = stays.uv;
    for (const Shared& e : plan.glued) {
      target[e.stay_a] = 0.5 * (stays.uv[e.stay_a] + moved.uv[e.move_a]);
      target[e.stay_b] = 0.5 * (stays.uv[e.stay_b] + moved.uv[e.move_b]);
    }
    stays.uv = std::move(target);
    const double stays_max = stays.max_stretch;
    ChartMesh joined = glue(std::move(stays), moved, plan.glued);
    if (!measureStretch(topology_, joined).valid) return false;
    relaxMap(topology_, joined, kRelaxations);
    if (!normalizeAndMeasure(topology_, joined) || joined.mean_stretch > options_.most_mean_stretch)
      return false;
    if (joined.max_stretch > std::max({kMostSeamStretch, stays_max, moved.max_stretch})) return false;
    const double before = costs_[plan.stay] + costs_[plan.move];
    if (boxCost(boxOf(joined).extent()) >= before || overlapsItself(joined)) return false;
    commit(plan, std::move(joined));
    return true;
  }

  glm::dvec3 inSpace(const ChartMesh& chart, std::size_t border_edge, double t) const {
    const std::uint32_t h = chart.meshHalfEdge(chart.border[border_edge]);
    const glm::dvec3 a(topology_.position[topology_.vertex(h)]);
    const glm::dvec3 b(topology_.position[topology_.vertex(nextHalfEdge(h))]);
    return a + t * (b - a);
  }

  /// Whether `moved` covers a place of chart `stay`, or comes within a gutter of a place that is elsewhere in
  /// space.
  bool overlaps(std::uint32_t stay, const ChartMesh& moved) {
    const ChartMesh& s = charts_[stay];
    const SegmentBands& stay_bands = bands(stay);
    const SegmentBands moved_bands(borderSegments(moved));
    const double reach = options_.gutter * options_.texel, reach2 = reach * reach;
    const double near2 = std::pow(kNearInSpace * reach, 2);
    DVec2 lo(std::numeric_limits<double>::infinity()), hi = -lo;
    for (std::size_t i = 0; i < moved.border.size(); ++i) {
      const Segment& segment = moved_bands.segments()[i];
      lo = glm::min(lo, segment.a), hi = glm::max(hi, segment.a);
      const DVec2 s_lo = glm::min(segment.a, segment.b) - reach,
                  s_hi = glm::max(segment.a, segment.b) + reach;
      const bool conflict = stay_bands.anyNear(s_lo.y, s_hi.y, [&](std::uint32_t j) {
        const Segment& other = stay_bands.segments()[j];
        if (std::max(other.a.x, other.b.x) < s_lo.x || std::min(other.a.x, other.b.x) > s_hi.x) return false;
        if (crossing(segment, other)) return true;
        const auto [distance2, u, v] = closestPoints(segment, other);
        if (distance2 >= reach2) return false;
        const glm::dvec3 gap = inSpace(moved, i, u) - inSpace(s, j, v);
        return glm::dot(gap, gap) > near2;
      });
      if (conflict || stay_bands.winding(justInside(moved, i)) != 0) return true;
    }
    return stay_bands.anyNear(lo.y, hi.y, [&](std::uint32_t j) {
      const Segment& other = stay_bands.segments()[j];
      if (std::max(other.a.x, other.b.x) < lo.x || std::min(other.a.x, other.b.x) > hi.x) return false;
      return moved_bands.winding(justInside(s, j)) != 0;
    });
  }

  /// The two charts as one, vertices of the seam in common.
  static ChartMesh glue(ChartMesh s, const ChartMesh& moved, const std::vector<Shared>& seam) {
    // Vertices of the moving chart that lie on the seam become those of the staying one; where one closes a
    // gap between two of these, the two become one.
    std::vector<std::uint32_t> vertex(moved.uv.size(), kNone);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> same;
    const auto identify = [&](std::uint32_t m, std::uint32_t v) {
      if (vertex[m] == kNone) {
        vertex[m] = v;
      } else if (vertex[m] != v) {
        same.push_back({vertex[m], v});
      }
    };
    for (const Shared& e : seam) {
      identify(e.move_a, e.stay_a);
      identify(e.move_b, e.stay_b);
    }
    for (std::uint32_t m = 0; m < vertex.size(); ++m) {
      if (vertex[m] != kNone) continue;
      vertex[m] = static_cast<std::uint32_t>(s.uv.size());
      s.uv.push_back(moved.uv[m]);
    }
    std::vector<std::uint32_t> gone;
    for (const Shared& e : seam) gone.insert(gone.end(), {e.stay_half_edge, e.move_half_edge});
    std::sort(gone.begin(), gone.end());
    const auto glued = [&](const ChartMesh& chart, std::uint32_t h) {
      return std::binary_search(gone.begin(), gone.end(), chart.meshHalfEdge(h));
    };
    std::erase_if(s.border, [&](std::uint32_t h) { return glued(s, h); });
    const auto first = static_cast<std::uint32_t>(3 * s.triangles.size());
    for (const std::uint32_t h : moved.border) {
      if (!glued(moved, h)) s.border.push_back(first + h);
    }
    s.triangles.insert(s.triangles.end(), moved.triangles.begin(), moved.triangles.end());
    for (const auto& c : moved.corners) s.corners.push_back({vertex[c[0]], vertex[c[1]], vertex[c[2]]});
    if (!same.empty()) unify(s, same);
    const auto squares = [](const ChartMesh& c) { return c.area * c.mean_stretch * c.mean_stretch; };
    s.mean_stretch = std::sqrt((squares(s) + squares(moved)) / (s.area + moved.area));
    s.max_stretch = std::max(s.max_stretch, moved.max_stretch);
    s.area += moved.area;
    return s;
  }

  void commit(const Plan& plan, ChartMesh joined) {
    for (std::size_t i = charts_[plan.stay].triangles.size(); i < joined.triangles.size(); ++i) {
      chart_of_[joined.triangles[i]] = plan.stay;
      local_[joined.triangles[i]] = static_cast<std::uint32_t>(i);
    }
    charts_[plan.stay] = std::move(joined);
    charts_[plan.move] = {};
    bands_[plan.move].reset();
    ++version_[plan.move];
    refresh(plan.stay);
  }

  static void unify(ChartMesh& chart, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& same) {
    std::vector<std::uint32_t> vertex(chart.uv.size());
    std::iota(vertex.begin(), vertex.end(), 0u);
    const auto find = [&](std::uint32_t v) {
      while (vertex[v] != v) v = vertex[v];
      return v;
    };
    for (auto [a, b] : same) {
      a = find(a), b = find(b);
      vertex[std::max(a, b)] = std::min(a, b);
    }
    std::uint32_t kept = 0;
    for (std::uint32_t v = 0; v < vertex.size(); ++v) {
      if (vertex[v] != v) {
        vertex[v] = vertex[vertex[v]];  // lower and already final
        continue;
      }
      chart.uv[kept] = chart.uv[v];
      vertex[v] = kept++;
    }
    chart.uv.resize(kept);
    for (auto& c : chart.corners) c = {vertex[c[0]], vertex[c[1]], vertex[c[2]]};
  }

  const Topology& topology_;
  JoinOptions options_;
  std::vector<ChartMesh>& charts_;
  std::vector<std::uint32_t> chart_of_, local_;
  std::vector<OrientedBox> boxes_;
  std::vector<double> costs_;
  std::vector<std::uint32_t> version_;
  std::vector<std::unique_ptr<SegmentBands>> bands_;
  std::size_t work_ = 0;
  using Entry = std::tuple<double, std::uint32_t, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

void joinCharts(const Topology& topology, const JoinOptions& options, std::vector<ChartMesh>& charts) {
  Joiner(topology, options, charts).run();
}

}  // namespace relume::atlas
