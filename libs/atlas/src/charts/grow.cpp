// SPDX-License-Identifier: MIT
// Breadth-first clusters, then a bottom-up hierarchy over them.
// Based on:
//   [IKSZ03] Iones, Krupkin, Sbert, Zhukov. Fast, Realistic Lighting for Video Games. 2003. Section 3:
//   breadth-first growth under a
//            discontinuity angle.
//   [GWH01]  Garland, Willmott, Heckbert. Hierarchical Face Clustering on Polygonal Surfaces. 2001: pairs
//   join by least cost. [CAD04]  Cohen-Steiner, Alliez, Desbrun. Variational Shape Approximation. 2004: the
//   L^{2,1} measure of flatness.
// The cost of joining clusters of vector areas N1, N2 along a border of length l is (|N1| + |N2| - |N1 + N2|)
// / l: how much flatness is lost per metre of seam saved. [IKSZ03] grows whole charts in one sweep about a
// world axis; growing small facets first and joining them by cost leaves fewer slivers between charts.
// Limits: the cone is tested against the bounds of the facets, so it is kept up to the facets' own angle
// (0.05 rad) or better.
#include "charts/grow.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>

namespace relume::atlas {
namespace {

constexpr float kFacetAngle = 0.05f;  // radians
constexpr int kStraightenings = 12;   // passes at most

float angleBetween(Vec3 a, Vec3 b) {
  const double length = glm::length(glm::dvec3(a)) * glm::length(glm::dvec3(b));
  return length > 0 ? static_cast<float>(
                          std::acos(std::clamp(glm::dot(glm::dvec3(a), glm::dvec3(b)) / length, -1.0, 1.0)))
                    : kPi;
}

float edgeLength(const Topology& topology, std::uint32_t h) {
  return glm::distance(topology.position[topology.vertex(h)],
                       topology.position[topology.vertex(nextHalfEdge(h))]);
}

/// A cluster while clusters join. A slot outlives its joins: the cluster joined to another gives up its own
/// slot.
struct Cluster {
  Vec3 vector_area{0.0f};
  float area = 0;
  float cone = 0;  // bound on the angle between faces and the mean normal
  std::uint32_t first_facet = kNone, last_facet = kNone;  // list of member facets
  std::uint32_t node = kNone;                             // of the forest
  struct Border {
    std::uint32_t slot;  // of the neighbour, perhaps given up since
    float length;        // negative: the two cannot join
  };
  std::vector<Border> borders;
};

struct Joint {
  float cost;
  std::uint32_t slot, node, other;  // proposed by `slot` when it was `node`
  bool operator>(const Joint& o) const {
    return std::tie(cost, slot, other) > std::tie(o.cost, o.slot, o.other);
  }
};

class Hierarchy {
 public:
  Hierarchy(const Topology& topology, ClusterForest& forest, float cone_angle, float discontinuity_angle)
      : forest_(forest),
        cone_angle_(cone_angle),
        clusters_(forest.facets),
        parent_(forest.facets),
        facet_next_(forest.facets, kNone),
        facet_cone_(forest.facets, 0.0f) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (std::uint32_t t = 0; t < topology.triangleCount(); ++t) {
      if (forest.facet[t] == kNone) continue;
      Cluster& cluster = clusters_[forest.facet[t]];
      cluster.area += topology.area[t];
      cluster.vector_area += topology.normal[t] * topology.area[t];
    }
    for (std::uint32_t t = 0; t < topology.triangleCount(); ++t) {
      if (forest.facet[t] == kNone) continue;
      Cluster& cluster = clusters_[forest.facet[t]];
      cluster.cone = std::max(cluster.cone, angleBetween(cluster.vector_area, topology.normal[t]));
    }
    for (std::uint32_t f = 0; f < forest.facets; ++f) {
      Cluster& cluster = clusters_[f];
      cluster.first_facet = cluster.last_facet = cluster.node = f;
      facet_axis_.push_back(cluster.vector_area);
      facet_cone_[f] = cluster.cone;
    }
    collectBorders(topology, std::cos(discontinuity_angle));
  }

  /// The slot that holds a facet, and the mean normal of a slot's cluster.
  std::uint32_t slotOf(std::uint32_t facet) { return find(facet); }
  Vec3 axis(std::uint32_t slot) const { return glm::normalize(clusters_[slot].vector_area); }

  void joinAll() {
    for (std::uint32_t n = 0; n < clusters_.size(); ++n) propose(n);
    while (!joints_.empty()) {
      const Joint joint = joints_.top();
      joints_.pop();
      if (clusters_[joint.slot].node != joint.node) continue;  // joined since, and has proposed anew
      if (find(joint.other) != joint.other) {
        propose(joint.slot);
        continue;
      }
      const float cone = unionCone(clusters_[joint.slot], clusters_[joint.other]);
      if (cone <= cone_angle_) {
        join(std::min(joint.slot, joint.other), std::max(joint.slot, joint.other), cone);
      } else {
        block(joint.slot, joint.other);
        block(joint.other, joint.slot);
        propose(joint.slot);
      }
    }
    for (std::uint32_t s = 0; s < clusters_.size(); ++s) {
      if (parent_[s] == s) forest_.roots.push_back(clusters_[s].node);
      clusters_[s].borders = {};
    }
    std::sort(forest_.roots.begin(), forest_.roots.end());
  }

 private:
  void collectBorders(const Topology& topology, float least_cosine) {
    const auto forEachBorder = [&](auto&& f) {
      for (std::uint32_t h = 0; h < topology.mate.size(); ++h) {
        const std::uint32_t m = topology.mate[h];
        if (m == kNone) continue;
        const std::uint32_t a = forest_.facet[h / 3], b = forest_.facet[m / 3];
        if (a == b || glm::dot(topology.normal[h / 3], topology.normal[m / 3]) < least_cosine) continue;
        f(a, b, h);
      }
    };
    std::vector<std::uint32_t> count(clusters_.size(), 0);
    forEachBorder([&](std::uint32_t a, std::uint32_t, std::uint32_t) { ++count[a]; });
    for (std::size_t f = 0; f < clusters_.size(); ++f) clusters_[f].borders.reserve(count[f]);
    forEachBorder([&](std::uint32_t a, std::uint32_t b, std::uint32_t h) {
      clusters_[a].borders.push_back({b, edgeLength(topology, h)});
    });
    for (Cluster& cluster : clusters_) combine(cluster.borders);
  }

  std::uint32_t find(std::uint32_t slot) {
    while (parent_[slot] != slot) slot = parent_[slot] = parent_[parent_[slot]];
    return slot;
  }

  /// One entry per neighbour. What cannot join a part cannot join the whole.
  static void combine(std::vector<Cluster::Border>& borders) {
    std::stable_sort(borders.begin(), borders.end(),
                     [](const auto& x, const auto& y) { return x.slot < y.slot; });
    std::size_t kept = 0;
    for (const Cluster::Border& border : borders) {
      if (kept > 0 && borders[kept - 1].slot == border.slot) {
        Cluster::Border& sum = borders[kept - 1];
        const bool blocked = sum.length < 0 || border.length < 0;
        sum.length = (std::abs(sum.length) + std::abs(border.length)) * (blocked ? -1.0f : 1.0f);
      } else {
        borders[kept++] = border;
      }
    }
    borders.resize(kept);
  }

  void renewBorders(std::uint32_t slot) {
    auto& borders = clusters_[slot].borders;
    for (auto& border : borders) border.slot = find(border.slot);
    std::erase_if(borders, [&](const auto& border) { return border.slot == slot; });
    combine(borders);
  }

  void block(std::uint32_t slot, std::uint32_t other) {
    for (auto& border : clusters_[slot].borders) {
      if (find(border.slot) == other) border.length = -std::abs(border.length);
    }
  }

  /// Queues the cheapest join of a cluster, if there is one.
  void propose(std::uint32_t slot) {
    renewBorders(slot);
    const Cluster& cluster = clusters_[slot];
    Joint best{kInfinity, slot, cluster.node, kNone};
    for (const auto& [other, length] : cluster.borders) {
      if (length <= 0) continue;
      const Cluster& neighbour = clusters_[other];
      const float lost = glm::length(cluster.vector_area) + glm::length(neighbour.vector_area) -
                         glm::length(cluster.vector_area + neighbour.vector_area);
      // The small term orders joins that lose nothing: long borders of small clusters first.
      const float cost = (std::max(lost, 0.0f) + 1e-5f * (cluster.area + neighbour.area)) / length;
      if (cost < best.cost) best.cost = cost, best.other = other;
    }
    if (best.other != kNone) joints_.push(best);
  }

  float unionCone(const Cluster& a, const Cluster& b) const {
    const Vec3 axis = a.vector_area + b.vector_area;
    const float bound =
        std::max(angleBetween(axis, a.vector_area) + a.cone, angleBetween(axis, b.vector_area) + b.cone);
    if (bound <= cone_angle_) return bound;
    float exact = 0;
    for (const Cluster* cluster : {&a, &b}) {
      for (std::uint32_t f = cluster->first_facet; f != kNone; f = facet_next_[f]) {
        exact = std::max(exact, angleBetween(axis, facet_axis_[f]) + facet_cone_[f]);
        if (exact > cone_angle_) return exact;
      }
    }
    return exact;
  }

  void join(std::uint32_t keep, std::uint32_t gone, float cone) {
    Cluster& a = clusters_[keep];
    Cluster& b = clusters_[gone];
    forest_.children.push_back({a.node, b.node});
    a.vector_area += b.vector_area;
    a.area += b.area;
    a.cone = cone;
    facet_next_[a.last_facet] = b.first_facet;
    a.last_facet = b.last_facet;
    a.node = forest_.facets + static_cast<std::uint32_t>(forest_.children.size()) - 1;
    b.node = kNone;
    a.borders.insert(a.borders.end(), b.borders.begin(), b.borders.end());
    b.borders = {};
    parent_[gone] = keep;
    propose(keep);
  }

  ClusterForest& forest_;
  float cone_angle_;
  std::vector<Cluster> clusters_;
  std::vector<std::uint32_t> parent_, facet_next_;
  std::vector<Vec3> facet_axis_;
  std::vector<float> facet_cone_;
  std::priority_queue<Joint, std::vector<Joint>, std::greater<>> joints_;
};

void growFacets(const Topology& topology, float discontinuity_angle, ClusterForest& forest) {
  const float facet_cosine = std::cos(kFacetAngle);
  const float edge_cosine = std::cos(discontinuity_angle);
  forest.facet.assign(topology.triangleCount(), kNone);
  std::vector<std::uint32_t> queue;
  for (std::uint32_t seed = 0; seed < topology.triangleCount(); ++seed) {
    if (topology.degenerate(seed) || forest.facet[seed] != kNone) continue;
    const Vec3 axis = topology.normal[seed];
    queue.assign(1, seed);
    forest.facet[seed] = forest.facets;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t t = queue[i];
      for (std::uint32_t e = 0; e < 3; ++e) {
        const std::uint32_t mate = topology.mate[3 * t + e];
        if (mate == kNone || forest.facet[mate / 3] != kNone) continue;
        const Vec3 normal = topology.normal[mate / 3];
        if (glm::dot(normal, axis) < facet_cosine || glm::dot(normal, topology.normal[t]) < edge_cosine)
          continue;
        forest.facet[mate / 3] = forest.facets;
        queue.push_back(mate / 3);
      }
    }
    ++forest.facets;
  }
}

/// Shortens the borders between clusters: a triangle that has more of its edges in the neighbouring cluster
/// than in its own moves there. Such a triangle hangs on its own cluster by one edge at most, so nothing
/// falls apart.
void straightenBorders(const Topology& topology, float discontinuity_angle, float cone_angle,
                       Hierarchy& hierarchy, ClusterForest& forest) {
  const float edge_cosine = std::cos(discontinuity_angle), cone_cosine = std::cos(cone_angle);
  std::vector<std::uint32_t> slot(topology.triangleCount(), kNone);
  for (std::uint32_t t = 0; t < slot.size(); ++t) {
    if (forest.facet[t] != kNone) slot[t] = hierarchy.slotOf(forest.facet[t]);
  }
  for (int pass = 0; pass < kStraightenings; ++pass) {
    bool moved = false;
    for (std::uint32_t t = 0; t < slot.size(); ++t) {
      if (slot[t] == kNone) continue;
      float own = 0;
      int own_edges = 0;
      float length[3] = {0, 0, 0};
      std::uint32_t other[3] = {kNone, kNone, kNone};
      for (std::uint32_t e = 0; e < 3; ++e) {
        const std::uint32_t mate = topology.mate[3 * t + e];
        if (mate == kNone) continue;
        other[e] = slot[mate / 3];
        const bool smooth = glm::dot(topology.normal[t], topology.normal[mate / 3]) >= edge_cosine;
        length[e] = smooth ? edgeLength(topology, 3 * t + e) : 0.0f;
        if (other[e] == slot[t]) own += length[e], ++own_edges;
      }
      if (own_edges > 1) continue;
      for (std::uint32_t e = 0; e < 3; ++e) {
        if (length[e] == 0 || other[e] == slot[t]) continue;
        float there = 0;
        for (std::uint32_t f = 0; f < 3; ++f) there += other[f] == other[e] ? length[f] : 0.0f;
        if (there <= own * 1.0001f || glm::dot(topology.normal[t], hierarchy.axis(other[e])) < cone_cosine)
          continue;
        slot[t] = other[e];
        forest.facet[t] = forest.facet[topology.mate[3 * t + e] / 3];
        moved = true;
        break;
      }
    }
    if (!moved) break;
  }
}

}  // namespace

ClusterForest growClusters(const Topology& topology, float discontinuity_angle, float cone_angle) {
  ClusterForest forest;
  growFacets(topology, discontinuity_angle, forest);
  Hierarchy hierarchy(topology, forest, cone_angle, discontinuity_angle);
  hierarchy.joinAll();
  straightenBorders(topology, discontinuity_angle, cone_angle, hierarchy, forest);
  return forest;
}

}  // namespace relume::atlas
