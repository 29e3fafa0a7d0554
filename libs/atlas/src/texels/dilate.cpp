// SPDX-License-Identifier: MIT
// Values for the texels that have none.
//   1  Invalid texels of a chart, ring by ring from the valid texels of the same chart (a buried texel must
//   look like what
//      is seen beside it, and charts that touch on the page do not touch in space).
//   2  kRings rings of gutter about each chart: the mean of the filled 8-neighbours of one chart, the one
//   with most of them
//      (the lower index of equals). These are the texels that bilinear and mip-mapped look-ups at the chart's
//      edge read.
//   3  The rest by push-pull: smooth, so that coarser mip levels and compressors find nothing to trip over.
// A ring reads only texels that were filled before it, so the order within a ring does not matter.
// Limits: a chart without any valid texel is filled from its surroundings on the page; a page without any
// stays zero.
#include <algorithm>
#include <array>
#include <bit>

#include "relume/atlas/texels.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "texels/push_pull.h"

namespace relume::atlas {
namespace {

constexpr int kRings = 4;
constexpr std::uint32_t kNobody = scene::kNone;

class PageFill {
 public:
  PageFill(int width, int height, std::size_t channels, std::span<float> values,
           std::span<std::uint8_t> known)
      : width_(width),
        height_(height),
        channels_(channels),
        values_(values),
        known_(known),
        owner_(known.size(), kNobody) {}

  /// points: of this page, first_texel: of this page.
  void setOwners(std::span<const SurfacePoint> points, std::size_t first_texel) {
    for (const SurfacePoint& p : points) owner_[p.texel - first_texel] = p.chart;
  }
  void setOneOwner() {
    for (std::size_t i = 0; i < known_.size(); ++i) owner_[i] = known_[i] ? 0 : kNobody;
  }

  void fillCharts() {
    std::vector<std::uint32_t> front = startOf([&](std::uint32_t t) { return owner_[t] != kNobody; });
    while (!front.empty()) {
      fill(front);
      front = nextOf(front, [&](std::uint32_t t, std::uint32_t from) { return owner_[t] == owner_[from]; });
    }
  }

  void fillGutters() {
    // Chart texels that nothing valid reaches in their own chart are gutter to the others.
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (!known_[i]) owner_[i] = kNobody;
    }
    std::vector<std::uint32_t> front = startOf([](std::uint32_t) { return true; });
    for (int ring = 0; ring < kRings && !front.empty(); ++ring) {
      fill(front);
      front = nextOf(front, [](std::uint32_t, std::uint32_t) { return true; });
    }
    for (const std::uint32_t t : front) known_[t] = 0;
  }

  void fillRest() {
    owner_ = {};
    pushPull(width_, height_, static_cast<int>(channels_), values_, known_);
  }

 private:
  static constexpr std::uint8_t kQueued = 2;

  template <class Body>
  void forEachNeighbour(std::uint32_t texel, const Body& body) const {
    const int x = static_cast<int>(texel) % width_, y = static_cast<int>(texel) / width_;
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, height_ - 1); ++ny) {
      for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width_ - 1); ++nx) {
        if (nx != x || ny != y) body(static_cast<std::uint32_t>(ny * width_ + nx));
      }
    }
  }

  /// The unknown texels that pass `wanted` and have a known neighbour to take from; queued.
  template <class Wanted>
  std::vector<std::uint32_t> startOf(const Wanted& wanted) {
    std::vector<std::uint32_t> front;
    for (std::uint32_t t = 0; t < known_.size(); ++t) {
      if (known_[t] || !wanted(t)) continue;
      bool reached = false;
      forEachNeighbour(t, [&](std::uint32_t n) { reached |= known_[n] == 1 && mayTake(t, n); });
      if (reached) front.push_back(t);
    }
    for (const std::uint32_t t : front) known_[t] = kQueued;
    return front;
  }

  /// Marks the front as known and returns its unknown neighbours that pass `wanted`; queued.
  template <class Wanted>
  std::vector<std::uint32_t> nextOf(const std::vector<std::uint32_t>& front, const Wanted& wanted) {
    for (const std::uint32_t t : front) known_[t] = 1;
    std::vector<std::uint32_t> next;
    for (const std::uint32_t t : front) {
      forEachNeighbour(t, [&](std::uint32_t n) {
        if (known_[n] != 0 || !wanted(n, t)) return;
        known_[n] = kQueued;
        next.push_back(n);
      });
    }
    return next;
  }

  bool mayTake(std::uint32_t texel, std::uint32_t from) const {
    return owner_[texel] == kNobody || owner_[texel] == owner_[from];
  }

  void fill(const std::vector<std::uint32_t>& front) {
    parallelFor(front.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) fillOne(front[i]);
    });
  }

  void fillOne(std::uint32_t texel) {
    std::array<std::uint32_t, 8> from;
    std::size_t count = 0;
    forEachNeighbour(texel, [&](std::uint32_t n) {
      if (known_[n] == 1 && mayTake(texel, n)) from[count++] = n;
    });
    std::uint32_t owner = owner_[texel];
    if (owner == kNobody) {
      std::size_t most = 0;
      for (std::size_t i = 0; i < count; ++i) {
        std::size_t same = 0;
        for (std::size_t j = 0; j < count; ++j) same += owner_[from[j]] == owner_[from[i]];
        if (same > most || (same == most && owner_[from[i]] < owner)) most = same, owner = owner_[from[i]];
      }
      owner_[texel] = owner;
    }
    float* to = values_.data() + texel * channels_;
    std::fill_n(to, channels_, 0.0f);
    int taken = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (owner_[from[i]] != owner) continue;
      ++taken;
      for (std::size_t c = 0; c < channels_; ++c) to[c] += values_[from[i] * channels_ + c];
    }
    for (std::size_t c = 0; c < channels_; ++c) to[c] /= static_cast<float>(taken);
  }

  int width_, height_;
  std::size_t channels_;
  std::span<float> values_;
  std::span<std::uint8_t> known_;     // 0, 1 or kQueued
  std::vector<std::uint32_t> owner_;  // chart of each texel, or whose gutter it became
};

}  // namespace

void dilate(int width, int height, std::uint32_t pages, int channels, std::vector<float>& values,
            std::vector<std::uint8_t> covered, const Texels* texels) {
  const std::size_t page = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::size_t stride = static_cast<std::size_t>(channels);
  RELUME_CHECK_EQ(covered.size(), page * pages);
  RELUME_CHECK_EQ(values.size(), page * pages * stride);
  RELUME_CHECK_LT(page, std::size_t{scene::kNone});
  for (std::uint8_t& c : covered) c = c != 0;
  for (std::size_t p = 0; p < pages; ++p) {
    const std::size_t first = p * page;
    PageFill fill(width, height, stride, std::span(values).subspan(first * stride, page * stride),
                  std::span(covered).subspan(first, page));
    if (texels) {
      const auto from = [&](std::size_t texel) {
        return std::lower_bound(texels->points.begin(), texels->points.end(), texel,
                                [](const SurfacePoint& a, std::size_t b) { return a.texel < b; });
      };
      fill.setOwners(std::span(from(first), from(first + page)), first);
      fill.fillCharts();
    } else {
      fill.setOneOwner();
    }
    fill.fillGutters();
    fill.fillRest();
  }
}

}  // namespace relume::atlas
