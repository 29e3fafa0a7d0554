// SPDX-License-Identifier: MIT
// "farcry": one colour for light from everywhere and from one direction, and the share k of the latter:
//   E(n) = C (1 - k + k (n . d)+) / (1 - k + k (N . d)+),  C = E on the surface with its own normal N.
// k = |band 1| / (sqrt 3 band 0) of the luminance makes both ends right: light from one direction (k = 1),
// and an open sky over the surface (k = 1/2). Ten bytes a texel. Gloss: a directional light and an even one.
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.5.2, after Mittring.
#include <array>

#include "bases/bases.h"
#include "bases/light_and_rest.h"

namespace relume::basis {
namespace {

constexpr std::size_t kSh = 4;
constexpr float kLeastFlat = 0.1f;  // of the divisor: a light that only grazes the surface says little of E

class FarCryBasis final : public Basis {
 public:
  std::string name() const override { return "farcry"; }
  std::size_t sums() const override { return 3 * (kSh + 1); }
  std::size_t coefficients() const override { return 7; }

  void add(const Receiver&, const Arrival& light, std::span<double> sums) const override {
    std::array<float, kSh> y;
    shValues(light.from, y);
    const Vec3 flux = basis::flux(light);
    for (std::size_t i = 0; i < kSh; ++i) addTriple(sums, i, flux * y[i]);
    addTriple(sums, kSh, light.e.rgb);
  }

  void finish(const Receiver& at, std::span<const float> sums, std::span<float> c) const override {
    const LightDirection light = lightDirection(sums, at.normal);
    setTriple(c, 0, triple(sums, kSh)), setTriple(c, 1, light.direction), c[6] = light.share;
  }

  Irradiance irradiance(const Receiver& at, std::span<const float> c, Normal n) const override {
    const Vec3 scale = perLobe(at, c);
    return Irradiance(scale * (1 - c[6] + c[6] * std::max(glm::dot(n, triple(c, 1)), 0.0f)));
  }

  Radiance glossy(const Receiver& at, std::span<const float> c, const GlossyLobe& lobe) const override {
    const Vec3 scale = perLobe(at, c);
    return Radiance(scale * ((1 - c[6]) * kInvPi * lobe.albedo() +
                             c[6] * lobe.widened(kLightSharpness).evaluate(triple(c, 1))));
  }

  std::vector<TexturePlane> planes(Packing) const override {
    using Format = TexturePlane::Format;
    return {{.name = "colour"},
            {.name = "direction", .format = Format::kUnorm8, .lo = -1, .hi = 1, .direction = true},
            {.name = "directionality", .channels = 1, .format = Format::kUnorm8}};
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

 private:
  static Vec3 perLobe(const Receiver& at, std::span<const float> c) {
    const float flat = 1 - c[6] + c[6] * std::max(glm::dot(at.normal, triple(c, 1)), 0.0f);
    return triple(c, 0) / std::max(flat, kLeastFlat);
  }
};

}  // namespace

std::unique_ptr<Basis> makeFarCry() { return std::make_unique<FarCryBasis>(); }

}  // namespace relume::basis
