// SPDX-License-Identifier: MIT
// How a surface reflects: glTF's metallic-roughness material. Based on:
//   [glTF] Khronos. glTF 2.0, appendix B: parameters, F0 = 0.04 or base colour, alpha = roughness^2, Schlick.
//   [Heitz14] Heitz. Understanding the Masking-Shadowing Function. JCGT 3(2), 2014: height-correlated Smith.
//   [DB23] Dupuy, Benyoub. Sampling Visible GGX Normals with Spherical Caps. CGF 42(8), 2023.
//   [Tur19] Turquin. Practical Multiple Scattering Compensation for Microfacet Models. 2019: (16).
//
// f = m f_metal + (1 - m) f_dielectric, m = metallic; f_metal = k f_ggx with F0 = base colour; f_dielectric =
// (k f_ggx with F0 = 0.04) + (1 - E(o)) (1 - transmission) base colour / pi. k = 1 + F0 (1/E_ggx(o) - 1)
// ([Tur19] 16) stands for the light that microfacets reflect more than once; E_ggx(o) is the share that they
// reflect at once without Fresnel's loss, from a table; E(o) the share that the compensated lobe reflects.
// What differs from [glTF]: the diffuse lobe gets what the specular lobe leaves on the whole, 1 - E,
// instead of 1 - F(v.h); the lobe of multiple scattering. So nothing reflects more than it receives, and a
// white metal reflects everything. Both factors depend on the outgoing direction alone: f as a whole is not
// reciprocal (its Lambert and GGX parts are), which a path tracer from the eye does not need. Limits: alpha
// is at least 0.001, so a mirror is a very sharp lobe; no anisotropy, clear coat or sheen. Thin transmission
// (KHR_materials_transmission) is not part of f: see transmittance().
#pragma once
#include "relume/core/frame.h"
#include "relume/core/quantity.h"
#include "relume/core/vec.h"
#include "relume/scene/scene.h"

namespace relume::transport {

struct BsdfSample {
  Direction direction{0, 0, 1};
  Vec3 weight{0.0f};  ///< f |cos| / pdf; 0: absorbed
  float pdf = 0.0f;   ///< per steradian, about the shading normal
};

class Bsdf {
 public:
  /// An ideal diffuse reflector: f = albedo / pi.
  static Bsdf lambert(Normal shading_normal, Vec3 albedo);
  /// `outgoing`: unit, to where the light goes; on the side of the shading normal.
  static Bsdf metallicRoughness(Normal shading_normal, const scene::Surface& surface, float transmission,
                                Direction outgoing);

  /// f(incoming, outgoing) cos of the incoming direction; 0 below the shading plane.
  Vec3 evaluate(Direction incoming) const;
  float pdf(Direction incoming) const;
  /// u, lobe in [0, 1).
  BsdfSample sample(Vec2 u, float lobe) const;

  /// The same without its diffuse lobe.
  Bsdf glossy() const;
  /// Share of light that the specular lobes reflect towards the outgoing direction, were it to come from all
  /// sides alike.
  Vec3 glossyAlbedo() const { return glossy_albedo_; }

  /// Share of light that passes straight through a thin surface of KHR_materials_transmission: what the
  /// specular lobe leaves, times base colour (1 - metallic) transmission. The pane's roughness does not blur
  /// what is behind it.
  Vec3 transmittance() const { return transmittance_; }
  /// Nothing is reflected.
  bool black() const { return diffuse_ == Vec3(0) && !specular_; }

 private:
  explicit Bsdf(Normal n) : frame_(Frame::about(n)) {}
  float ggxPdf(Vec3 incoming) const;

  Frame frame_;
  Vec3 outgoing_{0, 0, 1};  // local
  Vec3 diffuse_{0.0f};      // albedo of the diffuse lobe
  bool specular_ = false;
  float alpha_ = 1.0f;
  // Fresnel's term with its compensation: at normal incidence, and what Schlick's weight adds.
  Vec3 at_normal_{0.0f}, towards_grazing_{0.0f};
  Vec3 glossy_albedo_{0.0f};
  float choose_specular_ = 0.0f;  // probability
  Vec3 transmittance_{0.0f};
};

/// `shading`, moved towards `geometric` as far as it takes for the mirror image of `outgoing` to leave the
/// surface. All unit, outgoing on the side of the geometric normal.
Normal validShadingNormal(Normal shading, Normal geometric, Direction outgoing);

}  // namespace relume::transport
