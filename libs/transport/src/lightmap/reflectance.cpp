// SPDX-License-Identifier: MIT
#include "lightmap/reflectance.h"

#include <algorithm>

#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

// Schlick's F0 + (1 - F0) (1 - cos)^5, cosine-weighted over the hemisphere: 2 integral (1 - c)^5 c dc = 1
// / 21.
Vec3 averageFresnel(Vec3 f0) { return f0 + (Vec3(1.0f) - f0) / 21.0f; }
constexpr float kDielectric = 0.04f;

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

std::vector<Vec3> reflectances(const scene::Scene& scene, const atlas::Texels& texels, Materials materials) {
  std::vector<Vec3> result(texels.points.size());
  parallelFor(result.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const atlas::SurfacePoint& point = texels.points[i];
      const scene::Material& material =
          scene.materials[scene.meshes[scene.instances[point.instance].mesh].material];
      const Vec3 albedo = point.albedo.rgb;
      // Transmission is no matter here: its share of the rays does not end on the surface.
      result[i] = material.unlit ? Vec3(0.0f) : albedo;
      if (material.unlit || materials == Materials::kLambert) continue;
      // Of the diffuse lobe what the coat lets through; of metal by one look at the texel's middle.
      const scene::Surface surface = material.metallic > 0 ? scene::surfaceAt(scene, hitOf(scene, point))
                                                           : scene::Surface{Vec4(1), 0, 1, {}};
      const float coat = averageFresnel(Vec3(kDielectric)).x * (1.0f - surface.metallic);
      result[i] = glm::min(result[i] * (1.0f - averageFresnel(Vec3(kDielectric)).x) + Vec3(coat) +
                               averageFresnel(Vec3(surface.base_colour)) * surface.metallic,
                           Vec3(1.0f));
    }
  });
  return result;
}

}  // namespace relume::transport
