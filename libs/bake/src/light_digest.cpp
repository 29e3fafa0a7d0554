// SPDX-License-Identifier: MIT
#include "light_digest.h"

#include "scene_digest.h"

namespace relume::bake {

void addLightsAndNormals(Hasher& hasher, const scene::Scene& scene) {
  hasher.add(scene.lights.size());
  for (const Light& l : scene.lights)
    hasher.add(std::string_view(l.group))
        .add(l.kind)
        .add(l.colour)
        .add(l.intensity)
        .add(l.range)
        .add(l.inner_cone)
        .add(l.outer_cone)
        .add(l.position)
        .add(l.direction)
        .add(l.area)
        .add(l.two_sided)
        .addAll(l.triangles)
        .add(l.angular_radius);
  const scene::Environment& e = scene.environment;
  hasher.add(e.radiance.rgb).add(e.rotation).add(e.map != nullptr);
  if (e.map) hasher.add(e.map->width).add(e.map->height).add(e.map->channels).addAll(e.map->data);
  for (const scene::Material& m : scene.materials) {
    hasher.add(m.normal_scale);
    addTexture(hasher, scene, m.normal_texture);
  }
}

}  // namespace relume::bake
