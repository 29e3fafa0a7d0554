// SPDX-License-Identifier: MIT
// What a bake depends on, as digests: everything but where the instances stand, and where they stand.
#pragma once
#include <vector>

#include "relume/atlas/atlas.h"
#include "relume/core/hash.h"
#include "relume/scene/scene.h"

namespace relume::bake {

/// A material's use of a texture, with its pixels as far as they were read.
void addTexture(Hasher& hasher, const scene::Scene& scene, const scene::TextureRef& use);

/// Meshes, materials and textures of the static instances and their layout in the atlas; not their
/// transforms.
Digest structureDigest(const scene::Scene& scene, const atlas::Atlas& atlas);

/// Where a static instance stands.
struct Placement {
  std::uint32_t instance = 0;
  Mat4 world_from_local{1.0f};
  Box3 bounds;  ///< world
};
std::vector<Placement> placements(const scene::Scene& scene);

}  // namespace relume::bake
