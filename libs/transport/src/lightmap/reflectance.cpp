// SPDX-License-Identifier: MIT
#include "lightmap/reflectance.h"

#include <algorithm>
#include <cmath>

#include "relume/core/parallel.h"
#include "relume/core/quantity.h"

namespace relume::transport {
namespace {

/// Means over cosine-weighted directions, by index of roughness.
std::vector<ggx::Reflected> meansByRoughness() {
  constexpr int kSteps = 64;
  std::vector<ggx::Reflected> means(GlossTable::kRoughnesses, ggx::Reflected{0, 0});
  for (std::size_t r = 0; r < means.size(); ++r)
    for (int i = 0; i < kSteps; ++i) {
      // cos^2 is uniform.
      const float cosine = std::sqrt((static_cast<float>(i) + 0.5f) / kSteps);
      const ggx::Reflected e = ggx::reflected(cosine, GlossTable::alphaOf(static_cast<std::uint8_t>(r)));
      means[r].scale += e.scale / kSteps, means[r].bias += e.bias / kSteps;
    }
  return means;
}

/// Of the surface at a point, which lies in a triangle.
scene::Hit hitOf(const scene::Scene& scene, const atlas::SurfacePoint& point) {
  const auto corner = [&](float b1, float b2) {
    return scene::worldPosition(scene, {point.instance, point.triangle, b1, b2});
  };
  const Vec3 a = corner(0, 0), e1 = corner(1, 0) - a, e2 = corner(0, 1) - a, d = point.position - a;
  const float e11 = glm::dot(e1, e1), e12 = glm::dot(e1, e2), e22 = glm::dot(e2, e2), d1 = glm::dot(d, e1),
              d2 = glm::dot(d, e2), det = e11 * e22 - e12 * e12;
  if (!(det > 0)) return {point.instance, point.triangle, 1.0f / 3, 1.0f / 3};
  const float b1 = std::clamp((d1 * e22 - d2 * e12) / det, 0.0f, 1.0f);
  return {point.instance, point.triangle, b1, std::clamp((d2 * e11 - d1 * e12) / det, 0.0f, 1.0f - b1)};
}

}  // namespace

std::uint8_t GlossTable::indexOf(float roughness) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(roughness, 0.0f, 1.0f) * (kRoughnesses - 1)));
}
float GlossTable::alphaOf(std::uint8_t index) {
  const float roughness = static_cast<float>(index) / (kRoughnesses - 1);
  return std::max(roughness * roughness, ggx::kLeastAlpha);
}
GlossTable::GlossTable(const std::vector<float>& cosines) : count_(cosines.size()) {
  values_.reserve(kRoughnesses * count_);
  for (std::size_t r = 0; r < kRoughnesses; ++r)
    for (const float cosine : cosines)
      values_.push_back(ggx::reflected(cosine, alphaOf(static_cast<std::uint8_t>(r))));
}

std::vector<Reflectance> reflectances(const scene::Scene& scene, const atlas::Texels& texels,
                                      Materials materials) {
  std::vector<Reflectance> result(texels.points.size());
  const std::vector<ggx::Reflected> means =
      materials == Materials::kFull ? meansByRoughness() : std::vector<ggx::Reflected>();
  parallelFor(result.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const atlas::SurfacePoint& point = texels.points[i];
      const scene::Material& material =
          scene.materials[scene.meshes[scene.instances[point.instance].mesh].material];
      if (material.unlit) continue;
      Reflectance& r = result[i];
      // Transmission is no matter here: its share of the rays does not end on the surface.
      r.diffuse = point.albedo.rgb;
      if (materials == Materials::kLambert) continue;
      const bool look =
          material.metallic > 0 || material.metallic_roughness_texture || material.normal_texture;
      const scene::Hit hit = look ? hitOf(scene, point) : scene::Hit();
      const scene::Surface surface =
          look ? scene::surfaceAt(scene, hit) : scene::Surface{Vec4(1), 0, material.roughness, {}};
      r.roughness = GlossTable::indexOf(surface.roughness);
      const ggx::Reflected& mean = means[r.roughness];
      const Vec3 coat(ggx::kDielectric), metal(surface.base_colour);
      const float m = surface.metallic;
      r.diffuse *= Vec3(1.0f) - mean.albedo(coat);
      r.scale = (1.0f - m) * mean.compensation(coat) * coat + m * mean.compensation(metal) * metal;
      r.bias = (1.0f - m) * mean.compensation(coat) + m * mean.compensation(metal);
      r.glossiness = luminance(r.scale * mean.scale + r.bias * mean.bias);
      if (!material.normal_texture) continue;
      const float c =
          std::clamp(glm::dot(scene::mappedNormal(scene, hit), scene::shadingNormal(scene, hit)), 0.0f, 1.0f);
      const float kept = 0.5f * (1.0f + c);
      r.diffuse *= kept, r.scale *= kept, r.bias *= kept;
      r.direct = c / kept;
    }
  });
  return result;
}

MeanReflectance meanReflectance(const scene::Scene& scene, const atlas::Texels& texels, Materials materials) {
  const std::vector<ggx::Reflected> means = meansByRoughness();
  const std::vector<Reflectance> all = reflectances(scene, texels, materials);
  MeanReflectance result;
  result.value.reserve(all.size()), result.direct.reserve(all.size());
  for (const Reflectance& r : all) {
    const ggx::Reflected& mean = means[r.roughness];
    result.value.push_back(glm::min(r.diffuse + r.scale * mean.scale + r.bias * mean.bias, Vec3(1.0f)));
    result.direct.push_back(r.direct);
  }
  return result;
}

}  // namespace relume::transport
