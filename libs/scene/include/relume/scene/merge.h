// SPDX-License-Identifier: MIT
// Things that were not there when a scene was baked.
#pragma once
#include <cstdint>
#include <vector>

#include "relume/scene/scene.h"

namespace relume::scene {

/// Adds the instances of `object` to `scene` as dynamic ones, moved by `world_from_object`: they are drawn
/// and throw shadows, and no bake knows them. Lights, cameras and environment stay behind. Returns their
/// indices in Scene::instances.
std::vector<std::uint32_t> addObject(Scene& scene, const Scene& object, const Mat4& world_from_object);

/// World box of some instances.
Box3 boundsOf(const Scene& scene, const std::vector<std::uint32_t>& instances);

}  // namespace relume::scene
