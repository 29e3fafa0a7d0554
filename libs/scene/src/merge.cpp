// SPDX-License-Identifier: MIT
#include "relume/scene/merge.h"

namespace relume::scene {

std::vector<std::uint32_t> addObject(Scene& scene, const Scene& object, const Mat4& world_from_object) {
  const auto textures = static_cast<std::uint32_t>(scene.textures.size()),
             materials = static_cast<std::uint32_t>(scene.materials.size()),
             meshes = static_cast<std::uint32_t>(scene.meshes.size());
  scene.textures.insert(scene.textures.end(), object.textures.begin(), object.textures.end());
  for (Material material : object.materials) {
    for (TextureRef* ref : {&material.base_colour_texture, &material.metallic_roughness_texture,
                            &material.normal_texture, &material.height_texture, &material.emission_texture})
      if (*ref) ref->texture += textures;
    scene.materials.push_back(material);
  }
  for (Mesh mesh : object.meshes) {
    mesh.material += materials;
    mesh.atlas_page = kNone;
    scene.meshes.push_back(std::move(mesh));
  }
  std::vector<std::uint32_t> added;
  for (Instance instance : object.instances) {
    instance.mesh += meshes;
    instance.node = kNone;
    instance.dynamic = true;
    instance.world_from_local = world_from_object * instance.world_from_local;
    added.push_back(static_cast<std::uint32_t>(scene.instances.size()));
    scene.instances.push_back(std::move(instance));
  }
  return added;
}

Box3 boundsOf(const Scene& scene, const std::vector<std::uint32_t>& instances) {
  Box3 box;
  for (const std::uint32_t i : instances)
    for (const Point& p : scene.meshes[scene.instances[i].mesh].positions)
      box.add(Point(scene.instances[i].world_from_local * Vec4(p, 1)));
  return box;
}

}  // namespace relume::scene
