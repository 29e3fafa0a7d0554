// SPDX-License-Identifier: MIT
// "directions:n": directional light maps. One set of directions for all surfaces of a scene, so that there is
// no seam where they meet; a texel holds, for each that it faces, the irradiance on a plane perpendicular to
// it of the light that comes from nearest to it. E and gloss: so many directional lights.
//   [HP02] Hey, Purgathofer. Real-Time Rendering of Globally Illuminated Soft Glossy Scenes With Directional
//   Light Maps. 2002. Section 3; kFacing says what differs.
#include "bases/bases.h"
#include "bases/triples.h"
#include "relume/basis/direction_set.h"

namespace relume::basis {
namespace {

class DirectionsBasis final : public PositiveBasis {
 public:
  explicit DirectionsBasis(std::size_t n)
      : PositiveBasis("directions:" + std::to_string(n), n), set_(minimalEnergy(n)) {}

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

  Radiance glossy(const Receiver&, std::span<const float> c, const GlossyLobe& lobe) const override {
    Vec3 sum(0.0f);
    for (std::size_t i = 0; i < set_.size(); ++i)
      if (const Vec3 light = triple(c, i); light != Vec3(0.0f)) sum += lobe.evaluate(set_[i]) * light;
    return Radiance(sum);
  }

 private:
  std::vector<Direction> set_;
};

}  // namespace

std::unique_ptr<Basis> makeDirections(std::size_t n) { return std::make_unique<DirectionsBasis>(n); }

}  // namespace relume::basis
