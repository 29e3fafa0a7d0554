// SPDX-License-Identifier: MIT
#include "scene_digest.h"

namespace relume::bake {

void addTexture(Hasher& hasher, const scene::Scene& scene, const scene::TextureRef& use) {
  hasher.add(use.texture != scene::kNone);
  if (use.texture == scene::kNone) return;
  hasher.add(use.uv_set).add(use.offset).add(use.scale).add(use.rotation);
  const scene::Texture& texture = scene.textures[use.texture];
  hasher.add(texture.srgb).add(texture.wrap_u).add(texture.wrap_v).add(texture.image != nullptr);
  if (texture.image)
    hasher.add(texture.image->width)
        .add(texture.image->height)
        .add(texture.image->channels)
        .addAll(texture.image->data);
}

namespace {

Digest digestOf(const scene::Scene& scene, const scene::Material& m) {
  Hasher hasher;
  hasher.add(m.base_colour)
      .add(m.metallic)
      .add(m.roughness)
      .add(m.emission)
      .add(m.alpha_mode)
      .add(m.alpha_cutoff);
  hasher.add(m.double_sided).add(m.unlit).add(m.transmission);
  addTexture(hasher, scene, m.base_colour_texture);
  addTexture(hasher, scene, m.metallic_roughness_texture);
  addTexture(hasher, scene, m.emission_texture);
  return hasher.digest();
}

Digest digestOf(const scene::Mesh& mesh) {
  Hasher hasher;
  hasher.addAll(mesh.positions)
      .addAll(mesh.normals)
      .addAll(mesh.uv[0])
      .addAll(mesh.uv[1])
      .addAll(mesh.colours);
  hasher.addAll(mesh.triangles).add(mesh.flat_normals);
  return hasher.digest();
}

}  // namespace

Digest structureDigest(const scene::Scene& scene, const atlas::Atlas& atlas) {
  std::vector<Digest> meshes(scene.meshes.size()), materials(scene.materials.size());
  std::vector<bool> mesh_done(meshes.size()), material_done(materials.size());
  Hasher hasher;
  for (const scene::Instance& instance : scene.instances) {
    if (instance.dynamic) continue;
    const scene::Mesh& mesh = scene.meshes[instance.mesh];
    if (!mesh_done[instance.mesh]) meshes[instance.mesh] = digestOf(mesh), mesh_done[instance.mesh] = true;
    if (!material_done[mesh.material])
      materials[mesh.material] = digestOf(scene, scene.materials[mesh.material]),
      material_done[mesh.material] = true;
    hasher.add(meshes[instance.mesh]).add(materials[mesh.material]);
  }
  hasher.add(atlas.width).add(atlas.height).add(atlas.pages);
  for (const atlas::InstanceUv& uv : atlas.instances)
    hasher.add(uv.page).addAll(uv.uv).addAll(uv.triangles).addAll(uv.triangle_chart);
  return hasher.digest();
}

std::vector<Placement> placements(const scene::Scene& scene) {
  std::vector<Placement> result;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    if (instance.dynamic) continue;
    Placement placement{.instance = i, .world_from_local = instance.world_from_local, .bounds = {}};
    for (const Point& p : scene.meshes[instance.mesh].positions)
      placement.bounds.add(Point(instance.world_from_local * Vec4(p, 1)));
    result.push_back(placement);
  }
  return result;
}

}  // namespace relume::bake
