// SPDX-License-Identifier: MIT
// "hbasis4", "hbasis6": irradiance over the hemisphere of the surface, in the frame of Receiver, from
// radiance in spherical harmonics of three bands. Gloss: irradiance towards the mirror direction, as blurred
// as that is.
//   [HW10] Habel, Wimmer. Efficient Irradiance Normal Mapping. I3D 2010.
#include <array>
#include <cmath>

#include "bases/bases.h"
#include "bases/triples.h"
#include "bases/window.h"
#include "relume/basis/h_basis.h"
#include "relume/basis/sh.h"

namespace relume::basis {
namespace {

constexpr std::size_t kSh = 9;

/// Of irradiance in three bands of SH, the weighted fit: kHMost rows of kSh.
using Fit = std::array<std::array<float, kSh>, kHMost>;

Fit weightedFit(std::size_t functions) {
  constexpr std::size_t kNormals = 8192;
  std::array<std::array<double, kHMost>, kHMost> shared{};
  std::array<std::array<double, kSh>, kHMost> right{};
  std::array<float, kSh> y;
  for (const Normal n : sphericalFibonacci(kNormals)) {
    if (n.z < 0) continue;
    const auto h = hValues(n);
    shValues(n, y);
    const auto weight = static_cast<double>(n.z * n.z);
    for (std::size_t i = 0; i < functions; ++i) {
      const double w = weight * static_cast<double>(h[i]);
      for (std::size_t j = 0; j < functions; ++j) shared[i][j] += w * static_cast<double>(h[j]);
      for (std::size_t j = 0; j < kSh; ++j) right[i][j] += w * static_cast<double>(y[j]);
    }
  }
  for (std::size_t i = 0; i < functions; ++i)  // Gauss, Jordan; positive definite
    for (std::size_t j = 0; j < functions; ++j) {
      if (j == i) continue;
      const double f = shared[j][i] / shared[i][i];
      for (std::size_t k = 0; k < functions; ++k) shared[j][k] -= f * shared[i][k];
      for (std::size_t k = 0; k < kSh; ++k) right[j][k] -= f * right[i][k];
    }
  Fit fit{};
  for (std::size_t i = 0; i < functions; ++i)
    for (std::size_t k = 0; k < kSh; ++k) fit[i][k] = static_cast<float>(right[i][k] / shared[i][i]);
  return fit;
}

class HBasis final : public RatioBasis {
 public:
  HBasis(std::size_t functions, bool window)
      : RatioBasis("hbasis" + std::to_string(functions), functions),
        window_(window),
        fit_(weightedFit(functions)) {
    // Of light from one direction, the most that a ratio can be; of all light it is no more.
    std::array<float, kSh> y;
    for (const Direction d : hemisphereNormals()) {
      shValues(d, y);
      std::array<float, 3 * kSh> sums{};
      for (std::size_t i = 0; i < kSh; ++i) sums[3 * i] = y[i];
      std::array<float, 3 * kHMost> c{};
      fit(sums, 0.0f, std::span(c).first(3 * functions));
      for (std::size_t i = 1; i < functions; ++i) bound_[i] = std::max(bound_[i], std::abs(c[3 * i] / c[0]));
    }
  }

  std::size_t sums() const override { return 3 * kSh; }

  void add(const Receiver& at, const Arrival& light, std::span<double> sums) const override {
    std::array<float, kSh> y;
    shValues(at.frame.toLocal(light.from), y);
    const Vec3 flux = basis::flux(light);
    for (std::size_t i = 0; i < kSh; ++i) addTriple(sums, i, flux * y[i]);
  }

  void finish(const Receiver&, std::span<const float> sums, std::span<float> coefficients) const override {
    fit(sums, 0.0f, coefficients);
    if (!window_) return;
    const float lambda = leastWindow([&](float l) {
      fit(sums, l, coefficients);
      float lowest = 0;
      for (const Normal n : hemisphereNormals()) {
        const Vec3 e = value(coefficients, n);
        lowest = std::min({lowest, e.x, e.y, e.z});
      }
      return lowest;
    });
    fit(sums, lambda, coefficients);
  }

  Irradiance irradiance(const Receiver& at, std::span<const float> c, Normal n) const override {
    return notNegative(value(c, at.frame.toLocal(n)));
  }

  Radiance glossy(const Receiver& at, std::span<const float> c, const GlossyLobe& lobe) const override {
    const Direction mirrored = lobe.shape().axis;
    return Radiance(lobe.albedo() * meanRadiance(irradiance(at, c, mirrored), mirrored, at));
  }

 protected:
  float bound(std::size_t index) const override { return bound_[index]; }

 private:
  void fit(std::span<const float> sums, float lambda, std::span<float> coefficients) const {
    for (std::size_t i = 0; 3 * i < coefficients.size(); ++i) {
      Vec3 h(0.0f);
      for (std::size_t k = 0; k < kSh; ++k)
        h += fit_[i][k] * kCosineFactor[bandOf(k)] * windowFactor(bandOf(k), lambda) * triple(sums, k);
      setTriple(coefficients, i, h);
    }
  }

  static Vec3 value(std::span<const float> c, Direction local) {
    const auto h = hValues(local);
    Vec3 e(0.0f);
    for (std::size_t i = 0; 3 * i < c.size(); ++i) e += h[i] * triple(c, i);
    return e;
  }

  bool window_;
  Fit fit_;
  std::array<float, kHMost> bound_{};
};

}  // namespace

std::unique_ptr<Basis> makeH(std::size_t functions, bool window) {
  return std::make_unique<HBasis>(functions, window);
}

}  // namespace relume::basis
