// SPDX-License-Identifier: MIT
#include "vertex.h"

namespace relume::transport {

Vertex vertexAt(const scene::Scene& scene, const scene::Hit& hit, Direction outgoing, Materials materials) {
  const scene::Material& material =
      scene.materials[scene.meshes[scene.instances[hit.instance].mesh].material];
  Vertex vertex;
  vertex.position = scene::worldPosition(scene, hit);
  vertex.geometric = scene::geometricNormal(scene, hit.instance, hit.triangle);
  if (material.unlit || vertex.geometric == Normal(0)) return vertex;
  const bool full = materials == Materials::kFull;
  Normal shading = full ? scene::mappedNormal(scene, hit) : scene::shadingNormal(scene, hit);
  vertex.behind = glm::dot(vertex.geometric, outgoing) < 0;
  if (vertex.behind) vertex.geometric = -vertex.geometric, shading = -shading;
  const scene::Surface surface = scene::surfaceAt(scene, hit);
  if (full) {
    shading = validShadingNormal(shading, vertex.geometric, outgoing);
    vertex.bsdf = Bsdf::metallicRoughness(shading, surface, material.transmission, outgoing);
    vertex.transmittance = vertex.bsdf.transmittance();
  } else {
    const Vec3 albedo = surface.albedo().rgb;
    vertex.bsdf = Bsdf::lambert(shading, albedo * (1 - material.transmission));
    vertex.transmittance = albedo * material.transmission;
  }
  return vertex;
}

}  // namespace relume::transport
