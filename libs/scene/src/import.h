// SPDX-License-Identifier: MIT
// The steps of import. Each reads one kind of thing of the document.
#pragma once
#include <string>
#include <vector>

#include "access.h"
#include "relume/scene/gltf.h"

namespace relume::scene::gltf {

/// A node of the default scene, in depth-first order.
struct PlacedNode {
  std::uint32_t index = 0;
  std::string name;
  Mat4 world_from_local{1.0f};
  bool dynamic = false;
};

/// Throws Error kCyclicNodes, kInvalidReference. Hidden nodes (KHR_node_visibility) are left out with what
/// hangs from them.
std::vector<PlacedNode> placeNodes(Access& access, Warnings& warnings);

/// Cameras and punctual lights that nodes carry; the scale of nodes does not count.
void importCameras(Access& access, const std::vector<PlacedNode>& nodes, Scene& scene);
void importLights(Access& access, const std::vector<PlacedNode>& nodes, Scene& scene);
/// extras.relume.lightBox of nodes: [x, y, z], lengths of a box about the node along its axes.
void importLightBoxes(Access& access, const std::vector<PlacedNode>& nodes, Scene& scene);

/// All materials of the document and the default one; the textures that they name, not yet decoded. Scene
/// texture t comes of the result's image t (kNone: none) and is normal-mapped where `normal` says so.
struct TextureSource {
  std::uint32_t image = kNone;
  std::uint32_t texture = kNone;
  bool srgb = false;
};
std::vector<TextureSource> importMaterials(Access& access, Scene& scene, Warnings& warnings);

/// Decodes what used materials need, each image once.
void importImages(Access& access, const std::vector<TextureSource>& sources, const ImportOptions& options,
                  Scene& scene, Warnings& warnings);

/// Meshes of the placed nodes, each once, and an instance of each per node or copy of it.
void importMeshes(Access& access, const std::vector<PlacedNode>& nodes, const ImportOptions& options,
                  Scene& scene, Warnings& warnings);

/// Transforms of the copies that EXT_mesh_gpu_instancing makes of a node's mesh.
std::vector<Mat4> instancingTransforms(Access& access, const Value& extension);

/// The bytes of an image: of a buffer view, a data URI or a file. Throws Error.
std::vector<std::byte> imageBytes(Access& access, std::uint32_t image);

}  // namespace relume::scene::gltf
