// SPDX-License-Identifier: MIT
// "directions:n": directional light maps. One set of directions for all surfaces of a scene, so that there is
// no seam where they meet; a texel holds, for each that it faces, the irradiance on a plane perpendicular to
// it of the light that comes from nearest to it. E: so many directional lights, as published. Gloss: light
// from all over a direction's share of the sphere, as even as it takes to give the same irradiance. A
// directional light instead leaves a highlight where it happens to lie and none between; and one that grazes
// the surface, whose light mostly comes from higher up, mirrors far too much. In a room with soft gloss (14
// directions) that halves the error.
//   [HP02] Hey, Purgathofer. Real-Time Rendering of Globally Illuminated Soft Glossy Scenes With Directional
//   Light Maps. 2002. Section 3; kFacing says what else differs.
#include <algorithm>
#include <array>
#include <numeric>

#include "bases/bases.h"
#include "bases/triples.h"
#include "relume/basis/direction_set.h"
#include "relume/core/check.h"

namespace relume::basis {
namespace {

constexpr std::size_t kMost = 64;           // directions
constexpr std::size_t kPointsOfShare = 24;  // directions of which light from a share is made
constexpr float kSharpnessOfPoint = 1.0f;   // each of them a Gaussian as wide, of their number

class DirectionsBasis final : public PositiveBasis {
 public:
  explicit DirectionsBasis(std::vector<Direction> set)
      : PositiveBasis("directions:" + std::to_string(set.size()), set.size()),
        set_(std::move(set)),
        points_(sphericalFibonacci(kPointsOfShare * set_.size())) {
    RELUME_CHECK_LE(set_.size(), kMost);
    std::vector<std::uint8_t> order(set_.size());
    for (const Direction d : points_) {
      std::iota(order.begin(), order.end(), std::uint8_t{0});
      std::stable_sort(order.begin(), order.end(), [&](std::uint8_t a, std::uint8_t b) {
        return glm::dot(set_[a], d) > glm::dot(set_[b], d);
      });
      nearest_.insert(nearest_.end(), order.begin(), order.end());
    }
  }

  std::size_t sums() const override { return coefficients(); }

  void add(const Receiver& at, const Arrival& light, std::span<double> sums) const override {
    addTriple(sums, nearestFacing(set_, light.from, at.normal), light.e.rgb);
  }

  void finish(const Receiver& at, std::span<const float> sums, std::span<float> c) const override {
    for (std::size_t i = 0; i < set_.size(); ++i) {
      const float cosine = glm::dot(set_[i], at.normal);
      setTriple(c, i, cosine > kFacing ? triple(sums, i) / cosine : Vec3(0.0f));
    }
  }

  Irradiance irradiance(const Receiver&, std::span<const float> c, Normal n) const override {
    Vec3 e(0.0f);
    for (std::size_t i = 0; i < set_.size(); ++i) e += std::max(glm::dot(set_[i], n), 0.0f) * triple(c, i);
    return Irradiance(e);
  }

  Radiance glossy(const Receiver& at, std::span<const float> c, const GlossyLobe& lobe) const override {
    const GlossyLobe wide = lobe.widened(kSharpnessOfPoint * static_cast<float>(points_.size()));
    const std::size_t n = set_.size();
    std::array<float, kMost> cosine{}, shared{};  // of directions; sums of those of their points
    std::array<Vec3, kMost> mirrored{};
    for (std::size_t i = 0; i < n; ++i) cosine[i] = glm::dot(set_[i], at.normal);
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const float z = glm::dot(points_[k], at.normal);
      if (!(z > 0)) continue;
      std::size_t rank = 0;
      while (rank < n && !(cosine[nearest_[k * n + rank]] > kFacing)) ++rank;
      if (rank == n) continue;
      const std::size_t i = nearest_[k * n + rank];
      shared[i] += z, mirrored[i] += wide.evaluate(points_[k]);
    }
    Vec3 sum(0.0f);
    for (std::size_t i = 0; i < n; ++i)
      if (shared[i] > 0) sum += mirrored[i] * triple(c, i) * (cosine[i] / shared[i]);
    return Radiance(sum);
  }

 private:
  std::vector<Direction> set_, points_;
  std::vector<std::uint8_t> nearest_;  // shape [points][set]: the set, nearest first
};

}  // namespace

std::unique_ptr<Basis> makeDirections(std::vector<Direction> set) {
  return std::make_unique<DirectionsBasis>(std::move(set));
}

}  // namespace relume::basis
