// SPDX-License-Identifier: MIT
// "sg5" to "sg9": radiance as spherical Gaussians about fixed directions of the hemisphere, in the frame of
// Receiver. Amplitudes: least squares over the sphere, dark below the surface, with none below 0; then scaled
// so that E is exact on the surface as it is. E: each Gaussian's integral with the clamped cosine, by its
// zonal harmonics (8 bands: they are broad). Gloss: its product with a Gaussian of the lobe's shape.
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.5.2, after Neubelt,
//   Pettineo: The Order: 1886.
#include <array>
#include <cmath>

#include "bases/bases.h"
#include "bases/triples.h"
#include "relume/basis/direction_set.h"
#include "relume/basis/sh.h"

namespace relume::basis {
namespace {

constexpr std::size_t kMostLobes = 9;
constexpr std::size_t kQuadrature = 8192;   // directions, for what lobes share
constexpr float kSharpnessPerLobe = 0.75f;  // of 0.3 to 1.5, the least error under normal maps

/// Directions that share the hemisphere: one up where there are many, the others in a ring or a spiral below.
std::vector<Direction> hemisphereSet(std::size_t n) {
  std::vector<Direction> set;
  for (const Direction d : sphericalFibonacci(2 * n))
    if (d.z > 0) set.push_back(d);
  set.resize(n);
  return set;
}

class GaussianBasis final : public PositiveBasis {
 public:
  explicit GaussianBasis(std::size_t lobes)
      : PositiveBasis("sg" + std::to_string(lobes), lobes),
        axes_(hemisphereSet(lobes)),
        sharpness_(kSharpnessPerLobe * static_cast<float>(lobes)) {
    const double weight = 4 * M_PI / kQuadrature;
    for (const Direction d : sphericalFibonacci(kQuadrature)) {
      std::array<double, kMostLobes> g{};
      for (std::size_t i = 0; i < lobes; ++i) g[i] = static_cast<double>(lobe(i)(d));
      for (std::size_t i = 0; i < lobes; ++i)
        for (std::size_t j = 0; j < lobes; ++j) shared_[i][j] += weight * g[i] * g[j];
    }
    const auto moment = legendreMoments(static_cast<double>(sharpness_));
    const double whole = static_cast<double>(integral(lobe(0)));
    for (std::size_t l = 0; l < kCosineFactor.size(); ++l)
      zonal_[l] = static_cast<float>(whole * moment[l] * (2 * static_cast<double>(l) + 1) / (4 * M_PI)) *
                  kCosineFactor[l];
  }

  std::size_t sums() const override { return 3 * (triples() + 1); }

  void add(const Receiver& at, const Arrival& light, std::span<double> sums) const override {
    const Direction d = at.frame.toLocal(light.from);
    const Vec3 flux = basis::flux(light);
    for (std::size_t i = 0; i < triples(); ++i) addTriple(sums, i, flux * lobe(i)(d));
    addTriple(sums, triples(), light.e.rgb);
  }

  void finish(const Receiver&, std::span<const float> sums, std::span<float> c) const override {
    // Coordinate descent: each amplitude in turn is the best for what the others leave.
    constexpr int kMostRounds = 2000;
    const std::size_t n = triples();
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<double, kMostLobes> x{};
      for (int round = 0; round < kMostRounds; ++round) {
        double moved = 0, largest = 0;
        for (std::size_t i = 0; i < n; ++i) {
          double rest = static_cast<double>(sums[3 * i + k]);
          for (std::size_t j = 0; j < n; ++j) rest -= j == i ? 0 : shared_[i][j] * x[j];
          const double next = std::max(rest / shared_[i][i], 0.0);
          moved = std::max(moved, std::abs(next - x[i])), largest = std::max(largest, next);
          x[i] = next;
        }
        if (moved <= 1e-6 * largest) break;
      }
      double flat = 0;
      for (std::size_t i = 0; i < n; ++i) flat += x[i] * static_cast<double>(cosineShare(axes_[i].z));
      const double scale = flat > 0 ? static_cast<double>(sums[3 * n + k]) / flat : 0;
      for (std::size_t i = 0; i < n; ++i) c[3 * i + k] = static_cast<float>(x[i] * scale);
    }
  }

  Irradiance irradiance(const Receiver& at, std::span<const float> c, Normal n) const override {
    const Normal local = at.frame.toLocal(n);
    Vec3 e(0.0f);
    for (std::size_t i = 0; i < triples(); ++i) e += cosineShare(glm::dot(local, axes_[i])) * triple(c, i);
    return notNegative(e);
  }

  Radiance glossy(const Receiver& at, std::span<const float> c, const GlossyLobe& lobe) const override {
    const Gaussian& world = lobe.shape();
    const Gaussian shape{at.frame.toLocal(world.axis), world.sharpness, world.amplitude};
    Vec3 sum(0.0f);
    for (std::size_t i = 0; i < triples(); ++i) sum += integral(product(this->lobe(i), shape)) * triple(c, i);
    return Radiance(lobe.albedo() * sum / lobe.shareAbove(at.normal));
  }

 private:
  Gaussian lobe(std::size_t i) const { return {axes_[i], sharpness_, 1.0f}; }

  /// Sum of zonal_[l] P_l(x): bands 0, 1, 2, 4, 6, 8.
  float cosineShare(float x) const {
    const float z = x * x;
    return zonal_[0] + zonal_[1] * x + zonal_[2] * (1.5f * z - 0.5f) +
           zonal_[4] * ((4.375f * z - 3.75f) * z + 0.375f) +
           zonal_[6] * (((14.4375f * z - 19.6875f) * z + 6.5625f) * z - 0.3125f) +
           zonal_[8] * ((((50.2734375f * z - 93.84375f) * z + 54.140625f) * z - 9.84375f) * z + 0.2734375f);
  }

  std::vector<Direction> axes_;
  float sharpness_;
  std::array<std::array<double, kMostLobes>, kMostLobes> shared_{};
  std::array<float, 9> zonal_{};
};

}  // namespace

std::unique_ptr<Basis> makeGaussians(std::size_t lobes) { return std::make_unique<GaussianBasis>(lobes); }

}  // namespace relume::basis
