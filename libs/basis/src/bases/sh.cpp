// SPDX-License-Identifier: MIT
// "sh2", "sh3", "sh4": radiance in spherical harmonics of bands 0 to 1, 2, 3, world frame. E from three bands
// is off by 1 % on average and 9 % at most ([RH01]); the third band adds nothing to E, but to gloss. Bilinear
// filters and sums of texels are right. Gloss: the bands, each blurred as a Gaussian of the lobe's shape
// does.
//   [RH01] Ramamoorthi, Hanrahan. An Efficient Representation for Irradiance Environment Maps. 2001.
#include <array>
#include <cmath>

#include "bases/bases.h"
#include "bases/triples.h"
#include "bases/window.h"
#include "relume/basis/sh.h"

namespace relume::basis {
namespace {

class ShBasis final : public RatioBasis {
 public:
  ShBasis(std::size_t bands, bool window)
      : RatioBasis("sh" + std::to_string(bands), bands * bands), window_(window) {}

  std::size_t sums() const override { return coefficients(); }

  void add(const Receiver&, const Arrival& light, std::span<double> sums) const override {
    std::array<float, kShMost> y;
    shValues(light.from, std::span(y).first(triples()));
    const Vec3 flux = basis::flux(light);
    for (std::size_t i = 0; i < triples(); ++i) addTriple(sums, i, flux * y[i]);
  }

  void finish(const Receiver& at, std::span<const float> sums, std::span<float> coefficients) const override {
    std::copy(sums.begin(), sums.end(), coefficients.begin());
    if (!window_) return;
    const float lambda = leastWindow([&](float l) {
      float lowest = 0;
      std::array<float, 3 * kShMost> faded;
      for (std::size_t i = 0; i < sums.size(); ++i) faded[i] = sums[i] * windowFactor(bandOf(i / 3), l);
      for (const Normal n : hemisphereNormals()) {
        const Vec3 e = shIrradiance(std::span(faded).first(sums.size()), at.frame.toWorld(n)).rgb;
        lowest = std::min({lowest, e.x, e.y, e.z});
      }
      return lowest;
    });
    for (std::size_t i = 0; i < sums.size(); ++i) coefficients[i] *= windowFactor(bandOf(i / 3), lambda);
  }

  Irradiance irradiance(const Receiver&, std::span<const float> c, Normal n) const override {
    return notNegative(shIrradiance(c, n).rgb);
  }

  Radiance glossy(const Receiver& at, std::span<const float> c, const GlossyLobe& lobe) const override {
    const Gaussian& shape = lobe.shape();
    // Means of Legendre's polynomials under the lobe: the recurrence upwards from the closed form of the
    // first, or for wide lobes, where that cancels, from its series.
    const float s = shape.sharpness;
    std::array<float, 4> blur{1.0f};
    blur[1] = s > 0.5f ? 1.0f / std::tanh(s) - 1.0f / s : s / 3 - s * s * s / 45;
    blur[2] = s > 1.0f ? 1 - 3 * blur[1] / s : s * s / 15 - 2 * s * s * s * s / 315;
    blur[3] = s > 2.0f ? blur[1] - 5 * blur[2] / s : s * s * s / 105;
    std::array<float, kShMost> y;
    shValues(shape.axis, std::span(y).first(triples()));
    Vec3 sum(0.0f);
    for (std::size_t i = 0; i < triples(); ++i) sum += blur[bandOf(i)] * y[i] * triple(c, i);
    return Radiance(lobe.albedo() * glm::max(sum, Vec3(0.0f)) / lobe.shareAbove(at.normal));
  }

 protected:
  /// Of light from one side alone, the most that a ratio can be: max |Y_lm| / Y_00.
  float bound(std::size_t index) const override {
    constexpr std::array<float, 16> kLargest = {
        0.282095f, 0.488603f, 0.488603f, 0.488603f, 0.546275f, 0.546275f, 0.630784f, 0.546275f,
        0.546275f, 0.590044f, 0.556298f, 0.6295f,   0.746353f, 0.6295f,   0.556298f, 0.590044f};
    return kLargest[index] / kLargest[0];
  }

 private:
  bool window_;
};

}  // namespace

std::unique_ptr<Basis> makeSh(std::size_t bands, bool window) {
  return std::make_unique<ShBasis>(bands, window);
}

}  // namespace relume::basis
