// SPDX-License-Identifier: MIT
// "dominant": the light of Halo 3: a directional light, and what is left of three bands of spherical
// harmonics without it, of which two bands are kept. Gloss: the light, and the rest blurred by the lobe.
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.5.2, after Chen. Lighting
//   and Material of Halo 3. GDC 2008.
#include <array>
#include <cmath>

#include "bases/bases.h"
#include "bases/light_and_rest.h"

namespace relume::basis {
namespace {

constexpr std::size_t kSh = 9, kKept = 4;

class DominantBasis final : public Basis {
 public:
  std::string name() const override { return "dominant"; }
  std::size_t sums() const override { return 3 * kSh; }
  std::size_t coefficients() const override { return 3 * (2 + kKept); }

  void add(const Receiver&, const Arrival& light, std::span<double> sums) const override {
    std::array<float, kSh> y;
    shValues(light.from, y);
    const Vec3 flux = basis::flux(light);
    for (std::size_t i = 0; i < kSh; ++i) addTriple(sums, i, flux * y[i]);
  }

  void finish(const Receiver& at, std::span<const float> sums, std::span<float> c) const override {
    const Direction d = lightDirection(sums, at.normal).direction;
    std::array<float, kSh> y;
    shValues(d, y);
    Vec3 light(0.0f);
    float squares = 0;
    for (std::size_t i = 0; i < kSh; ++i) light += y[i] * triple(sums, i), squares += y[i] * y[i];
    light = glm::max(light / squares, Vec3(0.0f));
    setTriple(c, 0, light), setTriple(c, 1, d);
    for (std::size_t i = 0; i < kKept; ++i) setTriple(c, 2 + i, triple(sums, i) - y[i] * light);
  }

  Irradiance irradiance(const Receiver&, std::span<const float> c, Normal n) const override {
    return notNegative(triple(c, 0) * std::max(glm::dot(n, triple(c, 1)), 0.0f) +
                       shIrradiance(c.subspan(6), n).rgb);
  }

  Radiance glossy(const Receiver&, std::span<const float> c, const GlossyLobe& lobe) const override {
    const Gaussian& shape = lobe.shape();
    const float s = shape.sharpness;
    const float blur = s > 0.5f ? 1.0f / std::tanh(s) - 1.0f / s : s / 3;
    std::array<float, kKept> y;
    shValues(shape.axis, y);
    Vec3 rest = y[0] * triple(c, 2);
    for (std::size_t i = 1; i < kKept; ++i) rest += blur * y[i] * triple(c, 2 + i);
    const Vec3 light = lobe.widened(kLightSharpness).evaluate(triple(c, 1)) * triple(c, 0);
    return Radiance(glm::max(lobe.albedo() * rest + light, Vec3(0.0f)));
  }

  std::vector<TexturePlane> planes(Packing) const override {
    std::vector<TexturePlane> planes = {
        {.name = "light"},
        {.name = "direction", .format = TexturePlane::Format::kUnorm8, .lo = -1, .hi = 1, .direction = true}};
    for (std::size_t i = 0; i < kKept; ++i) planes.push_back({.name = "rest" + std::to_string(i)});
    return planes;
  }
  void pack(std::span<const float> c, Packing, std::span<float> stored) const override {
    std::copy(c.begin(), c.end(), stored.begin());
  }
  void unpack(std::span<const float> stored, Packing, std::span<float> c) const override {
    std::copy(stored.begin(), stored.end(), c.begin());
    const Vec3 d = triple(stored, 1);
    const float length = glm::length(d);
    if (length > 0) setTriple(c, 1, d / length);
  }
};

}  // namespace

std::unique_ptr<Basis> makeDominant() { return std::make_unique<DominantBasis>(); }

}  // namespace relume::basis
