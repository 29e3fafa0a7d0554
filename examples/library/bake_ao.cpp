// SPDX-License-Identifier: MIT
// bake_ao IN.glb OUT.glb: ambient occlusion within two metres, baked into the scene.
#include <relume/bake/bake.h>
#include <relume/core/file.h>

#include <cstdio>

int main(int argc, char** argv) try {
  if (argc != 3)
    throw relume::Error(relume::ErrorCode::kUsage, "bake_ao", "needs two files", "bake_ao IN.glb OUT.glb");
  const auto document = relume::scene::gltf::Document::read(argv[1]);
  relume::bake::BakeOptions options;
  options.layers = {relume::bake::parseLayerSpec("ao:distance=2")};
  options.quality = relume::bake::Quality::kDraft;
  relume::SilentProgress progress;
  const auto result = relume::bake::bake(document, options, progress);
  relume::writeFileAtomically(argv[2], result.glb);
  std::printf("%zu texels\n", result.statistics.texels);
} catch (const relume::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return relume::exitStatus(error.code());
}
