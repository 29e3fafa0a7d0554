// SPDX-License-Identifier: MIT
// The public test scenes in the folder RELUME_SHARED, where there is one: the bars of a 1024 x 1024 atlas.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "charts_check.h"
#include "relume/scene/gltf.h"

namespace relume::atlas {
namespace {

TEST(ChartsScenes, EverySceneIsCoveredWithoutOverlap) {
  const char* shared = std::getenv("RELUME_SHARED");
  if (!shared) GTEST_SKIP() << "RELUME_SHARED is not set";
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(shared) / "scenes")) {
    if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::printf("%-28s %9s %7s %8s %7s %7s %6s %9s %9s\n", "scene", "triangles", "charts", "coverage", "mean",
              "max", "kept", "import ms", "atlas ms");
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename().string());
    const auto milliseconds = [](auto since) {
      return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
    };
    const auto start = std::chrono::steady_clock::now();
    Warnings warnings;
    SilentProgress progress;
    const scene::Scene scene = scene::gltf::import(scene::gltf::Document::read(file), warnings);
    const double import_ms = milliseconds(start);
    for (const bool reuse : {false, true}) {
      AtlasOptions options;
      options.reuse_uv1 = reuse;
      const auto began = std::chrono::steady_clock::now();
      const Atlas atlas = buildAtlas(scene, options, warnings, progress);
      const double atlas_ms = milliseconds(began);
      const AtlasStatistics& s = atlas.statistics;
      std::size_t triangles = 0, kept = 0;
      for (const InstanceUv& uv : atlas.instances) triangles += uv.triangles.size(), kept += uv.reused;
      if (reuse && kept == 0) continue;
      std::printf("%-28s %9zu %7zu %8.4f %7.4f %7.3f %6zu %9.0f %9.0f\n", file.filename().c_str(), triangles,
                  s.charts, s.coverage, s.mean_stretch, s.max_stretch, kept, import_ms, atlas_ms);
      EXPECT_EQ(s.overlapping_texels, 0u);
      EXPECT_LE(s.mean_stretch, 1.15);
      EXPECT_EQ(atlas.pages, 1u);
      if (reuse) continue;
      EXPECT_GE(s.coverage, 0.70);
      const std::vector<std::uint32_t> owner = test::coveredBy(atlas);
      EXPECT_EQ(test::narrowestGutter(atlas, owner, options.gutter), options.gutter);
      EXPECT_EQ(test::centresClaimedTwice(atlas), 0u);
    }
  }
}

}  // namespace
}  // namespace relume::atlas
