// SPDX-License-Identifier: MIT
// Where two borders of charts run along each other in space, with normals that agree, light ought to agree
// too. Every pair of border edges that are collinear within their tolerance and overlap is looked at, whether
// of one mesh, of two objects, equal in length, or cut differently (T-junctions). The shading normals at the
// middle of the overlap decide, so a crease is no seam. Limits: an edge whose two sides are lit differently
// because a third surface stands on it (a wall on a line between tiles) is a seam here; tell stitchSeams
// which texels are covered, so that buried ones follow.
#include <array>
#include <cmath>

#include "relume/atlas/texels.h"
#include "relume/core/parallel.h"
#include "texels/chart_edges.h"
#include "texels/edge_grid.h"

namespace relume::atlas {
namespace {

constexpr float kLeastCosine = 0.93969262f;  // 20 degrees
constexpr float kLeastOverlap = 1e-3f;       // of the shorter edge
constexpr float kSamePlace = 0.01f;          // texels: both sides look up the same

/// The common part of two edges, as parameters of each.
struct Overlap {
  float a0, a1, b0, b1;
};

/// `a` is the shorter one.
bool overlap(const ChartEdge& a, const ChartEdge& b, Overlap& out) {
  const float tolerance = std::min(a.tolerance, b.tolerance);
  const Vec3 along = b.p1 - b.p0;
  const float length2 = glm::dot(along, along);
  const float t0 = glm::dot(a.p0 - b.p0, along) / length2, t1 = glm::dot(a.p1 - b.p0, along) / length2;
  const auto near = [&](Point p, float t) {
    const Vec3 off = p - (b.p0 + t * along);
    return glm::dot(off, off) <= tolerance * tolerance;
  };
  if (!near(a.p0, t0) || !near(a.p1, t1)) return false;
  const float lo = std::max(0.0f, std::min(t0, t1)), hi = std::min(1.0f, std::max(t0, t1));
  const float metres = (hi - lo) * std::sqrt(length2);
  if (!(metres > std::max(2 * tolerance, kLeastOverlap * a.length()))) return false;
  const auto on_a = [&](float t) { return std::clamp((t - t0) / (t1 - t0), 0.0f, 1.0f); };
  out = {on_a(lo), on_a(hi), lo, hi};
  return true;
}

class SeamFinder {
 public:
  SeamFinder(const scene::Scene& scene, const Atlas& atlas)
      : scene_(scene), atlas_(atlas), edges_(chartEdges(scene, atlas)), grid_(edges_) {}

  std::size_t edges() const { return edges_.size(); }

  void seamsOf(std::uint32_t index, std::vector<SeamSample>& samples) const {
    const ChartEdge& edge = edges_[index];
    struct Partner {
      std::uint32_t edge;
      Overlap common;
    };
    std::vector<Partner> partners;
    grid_.candidates(edge, [&](std::uint32_t other) {
      // Each pair once, from its shorter edge.
      const ChartEdge& longer = edges_[other];
      const auto rank = [](const ChartEdge& e, std::uint32_t i) {
        return std::pair(glm::dot(e.p1 - e.p0, e.p1 - e.p0), i);
      };
      Overlap common;
      if (rank(edge, index) < rank(longer, other) && overlap(edge, longer, common))
        partners.push_back({other, common});
    });
    std::sort(partners.begin(), partners.end(),
              [](const Partner& a, const Partner& b) { return a.edge < b.edge; });
    const auto same = [](const Partner& a, const Partner& b) { return a.edge == b.edge; };
    partners.erase(std::unique(partners.begin(), partners.end(), same), partners.end());
    for (const Partner& partner : partners) addSeam(edge, edges_[partner.edge], partner.common, samples);
  }

 private:
  void addSeam(const ChartEdge& a, const ChartEdge& b, const Overlap& common,
               std::vector<SeamSample>& samples) const {
    const Normal na = scene::shadingNormal(scene_, hitAt(atlas_, a, 0.5f * (common.a0 + common.a1)));
    const Normal nb = scene::shadingNormal(scene_, hitAt(atlas_, b, 0.5f * (common.b0 + common.b1)));
    if (!(glm::dot(na, nb) >= kLeastCosine)) return;
    const Vec2 a0 = pageAt(atlas_, a, common.a0), a1 = pageAt(atlas_, a, common.a1);
    const Vec2 b0 = pageAt(atlas_, b, common.b0), b1 = pageAt(atlas_, b, common.b1);
    const std::uint32_t a_page = atlas_.instances[a.uv].page, b_page = atlas_.instances[b.uv].page;
    if (a_page == b_page && glm::length(a0 - b0) < kSamePlace && glm::length(a1 - b1) < kSamePlace) return;
    const float texels = std::max(glm::length(a1 - a0), glm::length(b1 - b0));
    const int count = std::max(1, static_cast<int>(std::ceil(texels - 1e-3f)));
    for (int i = 0; i < count; ++i) {
      const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
      SeamSample sample;
      lookUp(a_page, (1 - t) * a0 + t * a1, sample.texel[0], sample.weight[0]);
      lookUp(b_page, (1 - t) * b0 + t * b1, sample.texel[1], sample.weight[1]);
      samples.push_back(sample);
    }
  }

  /// Bilinear, clamped to the page; texel centres lie at + 0.5.
  void lookUp(std::uint32_t page, Vec2 p, std::uint32_t (&texel)[4], float (&weight)[4]) const {
    const Vec2 size(static_cast<float>(atlas_.width - 1), static_cast<float>(atlas_.height - 1));
    p = glm::clamp(p - 0.5f, Vec2(0.0f), size);
    const glm::uvec2 lo(glm::floor(p)), hi = glm::min(lo + 1u, glm::uvec2(size));
    const Vec2 f = p - Vec2(lo);
    const auto width = static_cast<std::uint32_t>(atlas_.width),
               height = static_cast<std::uint32_t>(atlas_.height);
    const auto at = [&](std::uint32_t x, std::uint32_t y) { return (page * height + y) * width + x; };
    const std::array<std::uint32_t, 4> texels{at(lo.x, lo.y), at(hi.x, lo.y), at(lo.x, hi.y), at(hi.x, hi.y)};
    const std::array<float, 4> weights{(1 - f.x) * (1 - f.y), f.x * (1 - f.y), (1 - f.x) * f.y, f.x * f.y};
    std::copy(texels.begin(), texels.end(), texel);
    std::copy(weights.begin(), weights.end(), weight);
  }

  const scene::Scene& scene_;
  const Atlas& atlas_;
  std::vector<ChartEdge> edges_;
  EdgeGrid grid_;
};

}  // namespace

std::vector<SeamSample> findSeams(const scene::Scene& scene, const Atlas& atlas, Progress& progress) {
  constexpr std::size_t kGrain = 256;
  const SeamFinder finder(scene, atlas);
  const Stage stage(progress, "seams", finder.edges());
  std::vector<std::vector<SeamSample>> chunks((finder.edges() + kGrain - 1) / kGrain);
  parallelFor(
      finder.edges(), kGrain,
      [&](std::size_t begin, std::size_t end) {
        auto& samples = chunks[begin / kGrain];
        for (std::size_t i = begin; i < end; ++i) finder.seamsOf(static_cast<std::uint32_t>(i), samples);
        samples.shrink_to_fit();
      },
      &progress);
  std::size_t total = 0;
  for (const auto& chunk : chunks) total += chunk.size();
  std::vector<SeamSample> all;
  all.reserve(total);
  for (auto& chunk : chunks) {
    all.insert(all.end(), chunk.begin(), chunk.end());
    std::vector<SeamSample>().swap(chunk);
  }
  return all;
}

}  // namespace relume::atlas
