// SPDX-License-Identifier: MIT
#include "relume/scene/light_groups.h"

#include <algorithm>

namespace relume::scene {
namespace {

std::string firstOf(const std::string& group, const std::string& name, const char* otherwise) {
  return !group.empty() ? group : !name.empty() ? name : otherwise;
}

}  // namespace

std::string groupOf(const Light& light) { return firstOf(light.group, light.name, "light"); }
std::string groupOf(const Material& material) { return firstOf(material.group, material.name, "material"); }

std::vector<std::string> lightGroups(const Scene& scene) {
  std::vector<std::string> groups;
  const auto add = [&](std::string group) {
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(std::move(group));
  };
  for (const Light& light : scene.lights)
    if (light.colour * light.intensity != Vec3(0)) add(groupOf(light));
  for (const Instance& instance : scene.instances) {
    const Material& material = scene.materials[scene.meshes[instance.mesh].material];
    if (!instance.dynamic && !material.unlit && material.emission != Vec3(0)) add(groupOf(material));
  }
  if (!scene.environment.dark()) add(kEnvironmentGroup);
  return groups;
}

}  // namespace relume::scene
