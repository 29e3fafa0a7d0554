// SPDX-License-Identifier: MIT
#include "photons/photon_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/core/parallel.h"
#include "relume/scene/scene.h"

namespace relume::transport {
namespace {

constexpr int kMostRadius = 8;         // texels
constexpr float kCreaseCosine = 0.9f;  // as in filter.cpp
constexpr std::size_t kGrain = 256;

/// Weights of texels 0, 1, 2... away in one dimension.
using Taps = std::array<float, kMostRadius + 1>;

/// A pyramid `width` texels from rim to rim, averaged over where in its texel a path may land.
Taps pyramid(float width) {
  constexpr int kPlaces = 64;
  Taps taps{};
  for (int k = 0; k < kPlaces; ++k) {
    const float at = (static_cast<float>(k) + 0.5f) / kPlaces - 0.5f;
    Taps one{};
    float sum = 0;
    for (int d = -kMostRadius; d <= kMostRadius; ++d) {
      const float w = std::max(1.0f - std::abs(static_cast<float>(d) - at) / (0.5f * width), 0.0f);
      one[static_cast<std::size_t>(std::abs(d))] += d == 0 ? w : 0.5f * w;
      sum += w;
    }
    for (std::size_t d = 0; d < taps.size(); ++d) taps[d] += sum > 0 ? one[d] / (sum * kPlaces) : 0.0f;
  }
  return taps;
}

Taps box() {
  Taps taps{};
  taps[0] = 1.0f;
  return taps;
}

class DensityEstimator {
 public:
  DensityEstimator(const PhotonMap& map, double unit, const atlas::Texels& texels, const TexelLookup& lookup,
                   const PhotonKernel& kernel)
      : map_(map), unit_(unit), texels_(texels), lookup_(lookup), kernel_(kernel) {
    using Shape = PhotonKernel::Shape;
    if (kernel.shape == Shape::kBox) taps_ = {box()};
    if (kernel.shape == Shape::kPyramid) taps_ = {pyramid(kernel.width)};
    if (kernel.shape == Shape::kAdaptive) {
      taps_ = {box()};
      for (int r = 1; r <= kMostRadius; ++r) taps_.push_back(pyramid(2.0f * static_cast<float>(r) + 1.0f));
    }
    sums_.resize(map.sums());
  }

  void estimate(std::uint32_t point, PhotonResult& result) {
    const Taps* taps = &taps_.front();
    for (const Taps& wider : taps_) {
      taps = &wider;
      if (kernel_.shape != PhotonKernel::Shape::kAdaptive || pathsWithin(point, wider) >= kernel_.paths)
        break;
    }
    double area = 0, variance = 0;
    glm::dvec3 flux(0);
    std::fill(sums_.begin(), sums_.end(), 0.0);
    forNeighbours(point, *taps, [&](std::uint32_t other, double w) {
      area += w * static_cast<double>(texels_.points[other].area);
      variance += w * w * map_.variance(other);
      for (int c = 0; c < 3; ++c)
        flux[c] += w * static_cast<double>(map_.flux(other)[static_cast<std::size_t>(c)]);
      for (std::size_t k = 0; k < sums_.size(); ++k) sums_[k] += w * map_.directional(other, k);
    });
    if (!(area > 0)) return;
    result.value[point] = Irradiance(Vec3(flux * (unit_ / area)));
    result.error[point] = static_cast<float>(std::sqrt(variance) * unit_ / area);
    for (std::size_t k = 0; k < sums_.size(); ++k)
      result.sums[point * sums_.size() + k] = static_cast<float>(sums_[k] * unit_ / area);
  }

 private:
  /// Calls visit(point, weight) for the point itself and all neighbours that the kernel reaches.
  template <class Visit>
  void forNeighbours(std::uint32_t point, const Taps& taps, const Visit& visit) const {
    const atlas::SurfacePoint& p = texels_.points[point];
    const auto width = static_cast<std::uint32_t>(texels_.width),
               height = static_cast<std::uint32_t>(texels_.height);
    const std::uint32_t page = p.texel / (width * height), in_page = p.texel % (width * height);
    const int x = static_cast<int>(in_page % width), y = static_cast<int>(in_page / width);
    int reach = 0;
    while (reach < kMostRadius && taps[static_cast<std::size_t>(reach) + 1] > 0) ++reach;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        const int u = x + dx, v = y + dy;
        if (u < 0 || v < 0 || u >= texels_.width || v >= texels_.height) continue;
        const std::uint32_t other = lookup_.pointOf(
            page * width * height + static_cast<std::uint32_t>(v) * width + static_cast<std::uint32_t>(u));
        if (other == scene::kNone) continue;
        const atlas::SurfacePoint& q = texels_.points[other];
        if (q.chart != p.chart || glm::dot(q.shading_normal, p.shading_normal) < kCreaseCosine) continue;
        visit(other, static_cast<double>(taps[static_cast<std::size_t>(std::abs(dx))] *
                                         taps[static_cast<std::size_t>(std::abs(dy))]));
      }
  }

  std::int64_t pathsWithin(std::uint32_t point, const Taps& taps) const {
    std::int64_t paths = 0;
    forNeighbours(point, taps, [&](std::uint32_t other, double) { paths += map_.paths(other); });
    return paths;
  }

  const PhotonMap& map_;
  const double unit_;
  const atlas::Texels& texels_;
  const TexelLookup& lookup_;
  const PhotonKernel& kernel_;
  std::vector<Taps> taps_;  // from narrow to wide
  std::vector<double> sums_;
};

}  // namespace

void estimateDensity(const PhotonMap& map, double unit, const atlas::Texels& texels,
                     const TexelLookup& lookup, const PhotonKernel& kernel, PhotonResult& result) {
  const std::size_t points = texels.points.size();
  result.value.resize(points), result.error.resize(points), result.sums.resize(points * map.sums());
  parallelFor(points, kGrain, [&](std::size_t begin, std::size_t end) {
    DensityEstimator estimator(map, unit, texels, lookup, kernel);
    for (std::size_t i = begin; i < end; ++i) estimator.estimate(static_cast<std::uint32_t>(i), result);
  });
}

}  // namespace relume::transport
