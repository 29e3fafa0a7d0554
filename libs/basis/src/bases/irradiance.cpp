// SPDX-License-Identifier: MIT
// "irradiance": E on the surface as it is, the same for every normal; what a plain lightmap holds. Gloss sees
// it as if it came from everywhere.
#include "bases/bases.h"
#include "bases/triples.h"

namespace relume::basis {
namespace {

class IrradianceBasis final : public PositiveBasis {
 public:
  IrradianceBasis() : PositiveBasis("irradiance", 1) {}
  std::size_t sums() const override { return 3; }
  void add(const Receiver&, const Arrival& light, std::span<double> sums) const override {
    addTriple(sums, 0, light.e.rgb);
  }
  void finish(const Receiver&, std::span<const float> sums, std::span<float> coefficients) const override {
    std::copy(sums.begin(), sums.end(), coefficients.begin());
  }
  Irradiance irradiance(const Receiver&, std::span<const float> c, Normal) const override {
    return notNegative(triple(c, 0));
  }
  Radiance glossy(const Receiver& at, std::span<const float> c, const GlossyLobe& lobe) const override {
    return Radiance(lobe.albedo() * irradiance(at, c, lobe.normal()).rgb * kInvPi);
  }
};

}  // namespace

std::unique_ptr<Basis> makeIrradiance() { return std::make_unique<IrradianceBasis>(); }

}  // namespace relume::basis
