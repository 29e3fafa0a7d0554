// SPDX-License-Identifier: MIT
// "hl2", "cube", "dice": irradiance along a few directions, blended by weights that sum to 1 (ambient.h).
// What is stored is such that E is exact along those directions of the cube and the dice; of hl2 it is scaled
// so that E is exact on the surface as it is, where the three meet (an open sky would lose a fifth there).
// Gloss: irradiance towards the mirror direction, as blurred as that is, over what of it
// the surface leaves open.
#include <array>
#include <cmath>

#include "bases/bases.h"
#include "bases/triples.h"
#include "relume/basis/ambient.h"

namespace relume::basis {
namespace {

/// How a set knows its directions: in the frame of the surface, or in the world.
enum class Space : std::uint8_t { kSurface, kWorld };

template <std::size_t kCount>
using Weights = std::array<float, kCount> (*)(Direction);

/// Solves a x = b; a is well conditioned.
template <std::size_t n>
std::array<std::array<double, n>, n> inverse(std::array<std::array<double, n>, n> a) {
  std::array<std::array<double, n>, n> out{};
  for (std::size_t i = 0; i < n; ++i) out[i][i] = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const double pivot = a[i][i];
    for (std::size_t k = 0; k < n; ++k) a[i][k] /= pivot, out[i][k] /= pivot;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i) continue;
      const double f = a[j][i];
      for (std::size_t k = 0; k < n; ++k) a[j][k] -= f * a[i][k], out[j][k] -= f * out[i][k];
    }
  }
  return out;
}

template <std::size_t kCount, Space kSpace>
class BlendedBasis final : public PositiveBasis {
 public:
  BlendedBasis(std::string name, const std::array<Direction, kCount>& directions, Weights<kCount> weights)
      : PositiveBasis(std::move(name), kCount), directions_(directions), weights_(weights) {
    std::array<std::array<double, kCount>, kCount> blend;
    for (std::size_t i = 0; i < kCount; ++i) {
      const auto w = weights(directions[i]);
      for (std::size_t j = 0; j < kCount; ++j) blend[i][j] = static_cast<double>(w[j]);
    }
    unblend_ = inverse(blend);
  }

  std::size_t sums() const override { return 3 * (kCount + 1); }

  void add(const Receiver& at, const Arrival& light, std::span<double> sums) const override {
    const Direction d = local(at, light.from);
    const Vec3 flux = basis::flux(light);
    for (std::size_t i = 0; i < kCount; ++i)
      if (const float c = glm::dot(d, directions_[i]); c > 0) addTriple(sums, i, flux * c);
    addTriple(sums, kCount, light.e.rgb);
  }

  void finish(const Receiver&, std::span<const float> sums, std::span<float> coefficients) const override {
    for (std::size_t i = 0; i < kCount; ++i) {
      glm::dvec3 sum(0);
      for (std::size_t j = 0; j < kCount; ++j) sum += unblend_[i][j] * glm::dvec3(triple(sums, j));
      setTriple(coefficients, i, glm::max(Vec3(sum), Vec3(0.0f)));
    }
    if (kSpace == Space::kWorld) return;
    const auto weights = weights_({0, 0, 1});
    Vec3 flat(0.0f);
    for (std::size_t i = 0; i < kCount; ++i) flat += weights[i] * triple(coefficients, i);
    const Vec3 exact = triple(sums, kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
      const Vec3 c = triple(coefficients, i);
      Vec3 scaled;
      for (int k = 0; k < 3; ++k) scaled[k] = flat[k] > 0 ? c[k] * exact[k] / flat[k] : exact[k];
      setTriple(coefficients, i, scaled);
    }
  }

  Irradiance irradiance(const Receiver& at, std::span<const float> c, Normal n) const override {
    const auto w = weights_(local(at, n));
    Vec3 e(0.0f);
    for (std::size_t i = 0; i < kCount; ++i) e += w[i] * triple(c, i);
    return Irradiance(e);
  }

  Radiance glossy(const Receiver& at, std::span<const float> c, const GlossyLobe& lobe) const override {
    const Direction mirrored = lobe.shape().axis;
    const Irradiance e = irradiance(at, c, mirrored);
    // What hl2 blends does not fall towards the horizon.
    if (kSpace == Space::kSurface) return Radiance(lobe.albedo() * e.rgb * kInvPi);
    return Radiance(lobe.albedo() * meanRadiance(e, mirrored, at));
  }

 private:
  static Direction local(const Receiver& at, Direction d) {
    return kSpace == Space::kSurface ? at.frame.toLocal(d) : d;
  }

  std::array<Direction, kCount> directions_;
  Weights<kCount> weights_;
  std::array<std::array<double, kCount>, kCount> unblend_;
};

}  // namespace

std::unique_ptr<Basis> makeHl2() {
  return std::make_unique<BlendedBasis<3, Space::kSurface>>("hl2", kHl2, hl2Weights);
}
std::unique_ptr<Basis> makeCube() {
  return std::make_unique<BlendedBasis<6, Space::kWorld>>("cube", kCube, cubeWeights);
}
std::unique_ptr<Basis> makeDice() {
  return std::make_unique<BlendedBasis<12, Space::kWorld>>("dice", kDice, diceWeights);
}

}  // namespace relume::basis
