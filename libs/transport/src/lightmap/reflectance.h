// SPDX-License-Identifier: MIT
// How much of the light that falls on a texel leaves it again.
#pragma once
#include <cstdint>
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/basis/ggx.h"
#include "relume/transport/reference.h"

namespace relume::transport {
namespace ggx = basis::ggx;

/// Of light that comes at the angle of cosine c the share
///   diffuse + scale * reflected(c).scale + bias * reflected(c).bias
/// leaves (bsdf.h, integrated over outgoing directions). It is all taken to leave as from a diffuse
/// reflector: the energy is right, the direction of what glossy lobes send out is not.
struct Reflectance {
  Vec3 diffuse{0.0f}, scale{0.0f}, bias{0.0f};
  float direct = 1.0f;         ///< factor more for light straight from emitters: see reflectances()
  std::uint8_t roughness = 0;  ///< index for GlossTable
  /// Luminance of what glossy lobes reflect of light from all sides.
  float glossiness = 0.0f;
  bool glossy() const { return scale != Vec3(0.0f) || bias != Vec3(0.0f); }
};

/// ggx::reflected for some roughnesses and a given set of cosines.
class GlossTable {
 public:
  static constexpr std::size_t kRoughnesses = 32;
  static std::uint8_t indexOf(float roughness);
  static float alphaOf(std::uint8_t index);

  explicit GlossTable(const std::vector<float>& cosines);
  ggx::Reflected at(std::uint8_t roughness, std::size_t cosine) const {
    return values_[roughness * count_ + cosine];
  }

 private:
  std::size_t count_;
  std::vector<ggx::Reflected> values_;
};

/// By point. kLambert: the diffuse albedo alone. Gloss and normal map by one look at a texel's middle. A
/// normal map costs light: turned by an angle of cosine c, its normal gets (1 + c) / 2 of what the surface
/// gets from all around, and of light from one side, whichever, c on the average.
std::vector<Reflectance> reflectances(const scene::Scene& scene, const atlas::Texels& texels,
                                      Materials materials);

/// By point: for light that comes evenly from everywhere, and the factor for direct light (Reflectance).
struct MeanReflectance {
  std::vector<Vec3> value;
  std::vector<float> direct;
};
MeanReflectance meanReflectance(const scene::Scene& scene, const atlas::Texels& texels, Materials materials);

}  // namespace relume::transport
