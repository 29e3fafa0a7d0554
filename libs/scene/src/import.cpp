// SPDX-License-Identifier: MIT
#include "import.h"

namespace relume::scene::gltf {

Scene import(const Document& document, Warnings& warnings, const ImportOptions& options) {
  Access access(document);
  Scene scene;
  scene.name = document.name();
  const std::vector<PlacedNode> nodes = placeNodes(access, warnings);
  const std::vector<TextureSource> sources = importMaterials(access, scene, warnings);
  importMeshes(access, nodes, options, scene, warnings);
  importLights(access, nodes, scene);
  importLightBoxes(access, nodes, scene);
  importCameras(access, nodes, scene);
  importImages(access, sources, options, scene, warnings);
  if (scene.instances.empty())
    throw Error(ErrorCode::kEmptyScene, document.name(), "its scene has no triangles",
                "export it with its meshes");
  return scene;
}

}  // namespace relume::scene::gltf
