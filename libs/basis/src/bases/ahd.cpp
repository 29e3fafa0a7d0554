// SPDX-License-Identifier: MIT
// "ahd": ambient, highlight and its direction: E(n) = A + D (n . d)+. The direction is that of most light
// ([Slo08]'s optimal linear one); A and D fit E, known from three bands of spherical harmonics, over the
// hemisphere of normals, neither below 0; then both are scaled so that E is exact on the surface as it is.
// Mixing texels is not exact, because directions do not add up ([RTR] 11.5.2). Gloss: a directional light and
// an even one.
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.5.2.
#include <array>

#include "bases/bases.h"
#include "bases/light_and_rest.h"
#include "bases/window.h"

namespace relume::basis {
namespace {

constexpr std::size_t kSh = 9;

class AhdBasis final : public Basis {
 public:
  std::string name() const override { return "ahd"; }
  std::size_t sums() const override { return 3 * (kSh + 1); }
  std::size_t coefficients() const override { return 9; }

  void add(const Receiver&, const Arrival& light, std::span<double> sums) const override {
    std::array<float, kSh> y;
    shValues(light.from, y);
    const Vec3 flux = basis::flux(light);
    for (std::size_t i = 0; i < kSh; ++i) addTriple(sums, i, flux * y[i]);
    addTriple(sums, kSh, light.e.rgb);
  }

  void finish(const Receiver& at, std::span<const float> sums, std::span<float> c) const override {
    const auto sh = sums.first(3 * kSh);
    const Direction d = lightDirection(sh, at.normal).direction;
    // Normal equations of the fit, over normals that weigh alike; e: per channel.
    double one = 0, lobe = 0, lobe2 = 0;
    glm::dvec3 e1(0), el(0);
    for (const Normal n : hemisphereNormals()) {
      const Normal world = at.frame.toWorld(n);
      const double l = static_cast<double>(std::max(glm::dot(world, d), 0.0f));
      const glm::dvec3 e(shIrradiance(sh, world).rgb);
      one += 1, lobe += l, lobe2 += l * l, e1 += e, el += l * e;
    }
    const Vec3 exact = triple(sums, kSh);
    const double determinant = one * lobe2 - lobe * lobe;
    Vec3 ambient, direct;
    for (int k = 0; k < 3; ++k) {
      double a = 0, b = 0;
      if (determinant > 1e-9 * one * one) {
        a = (lobe2 * e1[k] - lobe * el[k]) / determinant;
        b = (one * el[k] - lobe * e1[k]) / determinant;
      }
      if (a < 0) a = 0, b = lobe2 > 0 ? std::max(el[k] / lobe2, 0.0) : 0;
      if (b < 0) a = std::max(e1[k] / one, 0.0), b = 0;
      const double flat = a + b * static_cast<double>(std::max(glm::dot(at.normal, d), 0.0f));
      const double scale = flat > 0 ? static_cast<double>(exact[k]) / flat : 0;
      ambient[k] = static_cast<float>(flat > 0 ? a * scale : static_cast<double>(exact[k]));
      direct[k] = static_cast<float>(b * scale);
    }
    setTriple(c, 0, ambient), setTriple(c, 1, direct), setTriple(c, 2, d);
  }

  Irradiance irradiance(const Receiver&, std::span<const float> c, Normal n) const override {
    return notNegative(triple(c, 0) + triple(c, 1) * std::max(glm::dot(n, triple(c, 2)), 0.0f));
  }

  Radiance glossy(const Receiver&, std::span<const float> c, const GlossyLobe& lobe) const override {
    return Radiance(lobe.albedo() * triple(c, 0) * kInvPi +
                    lobe.widened(kLightSharpness).evaluate(triple(c, 2)) * triple(c, 1));
  }

  std::vector<TexturePlane> planes(Packing) const override {
    return {
        {.name = "ambient"},
        {.name = "direct"},
        {.name = "direction", .format = TexturePlane::Format::kUnorm8, .lo = -1, .hi = 1, .direction = true}};
  }
  void pack(std::span<const float> c, Packing, std::span<float> stored) const override {
    std::copy(c.begin(), c.end(), stored.begin());
  }
  void unpack(std::span<const float> stored, Packing, std::span<float> c) const override {
    std::copy(stored.begin(), stored.end(), c.begin());
    const Vec3 d = triple(stored, 2);
    const float length = glm::length(d);
    if (length > 0) setTriple(c, 2, d / length);
  }
};

}  // namespace

std::unique_ptr<Basis> makeAhd() { return std::make_unique<AhdBasis>(); }

}  // namespace relume::basis
