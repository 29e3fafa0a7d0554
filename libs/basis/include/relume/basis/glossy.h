// SPDX-License-Identifier: MIT
// What a glossy surface reflects towards the eye, for light that is known only roughly: the lobe itself, its
// albedo, and a Gaussian of its shape. Based on:
//   ggx.h: GGX with what microfacets reflect more than once, as the path tracer has it.
//   [HP02] Hey, Purgathofer. Directional Light Maps. 2002: Phong's lobe; here normalized, so that `specular`
//   is its albedo where light comes along the normal.
//   [WRGSG09] Wang et al. All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance. 2009: a Gaussian
//   of the lobe's shape, about the mirror direction, narrower where the lobe leans.
#pragma once
#include "relume/basis/gaussian.h"
#include "relume/core/quantity.h"

namespace relume::basis {

class GlossyLobe {
 public:
  /// All unit; `outgoing` to the eye. roughness in [0, 1], taken for at least 0.04.
  static GlossyLobe ggx(Normal normal, Direction outgoing, float roughness, Vec3 f0);
  static GlossyLobe phong(Normal normal, Direction outgoing, float exponent, Vec3 specular);

  /// The same of a surface so much rougher that light from one direction looks as if it came from a Gaussian
  /// of that sharpness about it: variances add.
  GlossyLobe widened(float sharpness) const;

  /// f cos of the incoming direction, per steradian; 0 below the surface.
  Vec3 evaluate(Direction incoming) const;
  /// Share of light that is reflected to the eye, were it to come from all sides alike.
  Vec3 albedo() const { return albedo_; }
  /// The shape of evaluate(), amplitude such that its integral is 1.
  const Gaussian& shape() const { return shape_; }
  Normal normal() const { return normal_; }
  /// Share of shape() that lies on the side of n, about. A basis that knows no light from below a surface
  /// divides by it: the lobe itself has nothing there.
  float shareAbove(Normal n) const;

 private:
  enum class Kind : std::uint8_t { kGgx, kPhong };
  Kind kind_ = Kind::kGgx;
  Normal normal_{0, 0, 1};
  Direction outgoing_{0, 0, 1};
  float width_ = 1;  // alpha, or exponent
  Vec3 f0_{0}, scale_{1}, albedo_{0};
  Gaussian shape_;
};

}  // namespace relume::basis
