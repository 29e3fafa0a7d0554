// SPDX-License-Identifier: MIT
// The GGX microfacet lobe in the local frame of the surface (normal +z), without Fresnel's factor, and how
// much light it reflects. Based on:
//   [glTF] Khronos. glTF 2.0, appendix B: F0 = 0.04 or base colour, alpha = roughness^2, Schlick.
//   [Heitz14] Heitz. Understanding the Masking-Shadowing Function. JCGT 3(2), 2014: height-correlated Smith.
//   [DB23] Dupuy, Benyoub. Sampling Visible GGX Normals with Spherical Caps. CGF 42(8), 2023.
//   [Tur19] Turquin. Practical Multiple Scattering Compensation for Microfacet Models. 2019: (16).
#pragma once
#include "relume/core/vec.h"

namespace relume::basis::ggx {

inline constexpr float kLeastAlpha = 1e-3f;  ///< a mirror is a very sharp lobe
inline constexpr float kDielectric = 0.04f;  ///< F0 of index 1.5 ([glTF])

/// D(h) ([glTF] B.3.2); h unit, h.z > 0.
float distribution(Vec3 h, float alpha);
/// Smith's G1 of one direction.
float masking(float cosine, float alpha);
/// G2 / (4 cos_i cos_o), height-correlated ([Heitz14] 99).
float visibility(float cos_i, float cos_o, float alpha);
/// A normal among those visible from `o` ([DB23]); its density is G1(o) D(h) (o.h) / cos_o.
Vec3 sampleVisibleNormal(Vec3 o, float alpha, Vec2 u);

/// Directional albedo of the lobe with Schlick's Fresnel factor: F0 * scale + bias; scale + bias is that of a
/// perfect reflector. From a table of 32 x 32 made at first use; look-ups are right to 0.005.
struct Reflected {
  float scale, bias;
  /// Stands for light that microfacets reflect more than once ([Tur19] 16).
  Vec3 compensation(Vec3 f0) const { return Vec3(1.0f) + f0 * (1 / (scale + bias) - 1); }
  /// Of the compensated lobe.
  Vec3 albedo(Vec3 f0) const { return (f0 * scale + bias) * compensation(f0); }
};
Reflected reflected(float cos_o, float alpha);

}  // namespace relume::basis::ggx
