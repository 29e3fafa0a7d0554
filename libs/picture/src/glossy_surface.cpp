// SPDX-License-Identifier: MIT
#include "glossy_surface.h"

#include <algorithm>

#include "relume/basis/ggx.h"

namespace relume::picture {
namespace {

constexpr float kLeastRoughness = 0.04f;

basis::GlossyLobe lobeOf(Normal normal, Direction to_viewer, float roughness, Vec3 f0, Gloss gloss) {
  if (gloss == Gloss::kGgx) return basis::GlossyLobe::ggx(normal, to_viewer, roughness, f0);
  const float alpha = std::max(roughness, kLeastRoughness) * std::max(roughness, kLeastRoughness);
  return basis::GlossyLobe::phong(normal, to_viewer, 0.5f / (alpha * alpha), f0);
}

}  // namespace

Vec3 reflectedLight(const basis::Basis& basis, const basis::Receiver& at, std::span<const float> coefficients,
                    const scene::Surface& surface, Normal normal, Direction to_viewer, Gloss gloss) {
  const Vec3 base(surface.base_colour);
  const float metallic = std::clamp(surface.metallic, 0.0f, 1.0f);
  Vec3 sum(0.0f);
  if (metallic > 0)
    sum += metallic *
           basis.glossy(at, coefficients, lobeOf(normal, to_viewer, surface.roughness, base, gloss)).rgb;
  if (metallic < 1) {
    const basis::GlossyLobe lobe =
        lobeOf(normal, to_viewer, surface.roughness, Vec3(basis::ggx::kDielectric), gloss);
    const Irradiance e = basis.irradiance(at, coefficients, normal);
    const Vec3 diffuse = (1.0f - lobe.albedo()) * reflected(Albedo(base), e).rgb;
    sum += (1 - metallic) * (diffuse + basis.glossy(at, coefficients, lobe).rgb);
  }
  return sum;
}

}  // namespace relume::picture
