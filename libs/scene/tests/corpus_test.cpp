// SPDX-License-Identifier: MIT
// Scenes and malformed files of others. They are not part of the repository: RELUME_SHARED names the folder
// that holds them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "fake_bake.h"
#include "gltf_builder.h"

namespace relume::scene::gltf {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> filesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

class Corpus : public testing::Test {
 protected:
  void SetUp() override {
    const char* shared = std::getenv("RELUME_SHARED");
    if (!shared || !fs::exists(fs::path(shared) / "scenes")) GTEST_SKIP() << "RELUME_SHARED is not set";
    shared_ = shared;
  }
  fs::path shared_;
};

TEST_F(Corpus, EverySceneComesInWithItsTriangles) {
  // Triangles with instancing, as an independent importer counts them.
  const std::map<std::string, std::size_t> expected = {{"furnished_living_room.gltf", 35447},
                                                       {"CornellBox.glb", 36},
                                                       {"cornell_greenberg.gltf", 32},
                                                       {"garage.gltf", 11358},
                                                       {"garage-quantize.glb", 11358},
                                                       {"garage-draco.glb", 11358},
                                                       {"garage-meshopt.glb", 11358},
                                                       {"vr-gallery.glb", 1930},
                                                       {"house.glb", 10497},
                                                       {"MixedLightingExample.gltf", 40898},
                                                       {"VolumetricFogExample.glb", 360},
                                                       {"tps_lights.glb", 5440},
                                                       {"wicked_lights.glb", 14},
                                                       {"scene.gltf", 51200},
                                                       {"FlightHelmet.gltf", 94722},
                                                       {"mengerSponge3.glb", 21598},
                                                       {"zdm2.glb", 58772},
                                                       {"chess-board.glb", 178848},
                                                       {"backrooms_plain.glb", 1202},
                                                       {"backrooms.optimized.glb", 1202},
                                                       {"love.glb", 46552}};
  for (const fs::path& file : filesIn(shared_ / "scenes")) {
    const auto found = expected.find(file.filename().string());
    if (found == expected.end()) continue;
    Warnings warnings;
    EXPECT_EQ(import(Document::read(file), warnings).triangleCount(), found->second) << file;
    EXPECT_TRUE(warnings.empty()) << file << " " << warnings[0].text();
  }
}

TEST_F(Corpus, EverySceneGoesOutAndComesBack) {
  for (const fs::path& file : filesIn(shared_ / "scenes")) {
    Warnings warnings;
    const Document document = Document::read(file);
    const Scene scene = import(document, warnings, {.textures = TextureUse::kNone});
    for (const bool split : {false, true}) {
      const auto out = exportGlb(document, scene, fakeBake(scene, {.split = split, .pages = 2}));
      const Scene back =
          import(Document::parse(out, "back.glb", {}), warnings, {.textures = TextureUse::kNone});
      ASSERT_EQ(back.instances.size(), scene.instances.size()) << file;
      EXPECT_EQ(back.triangleCount(), scene.triangleCount()) << file;
      EXPECT_EQ(back.bounds().lo, scene.bounds().lo) << file;
      EXPECT_EQ(back.bounds().hi, scene.bounds().hi) << file;
    }
  }
}

/// Corners of all triangles in the world, each rounded to `step`, in an order that does not depend on the
/// file's.
std::vector<std::array<long, 3>> roundedCentres(const Scene& scene, double step) {
  std::vector<std::array<long, 3>> out;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
    for (std::uint32_t t = 0; t < scene.meshes[scene.instances[i].mesh].triangles.size(); ++t) {
      const Point p = worldPosition(scene, {i, t, 1 / 3.0f, 1 / 3.0f});
      out.push_back({std::lround(p.x / step), std::lround(p.y / step), std::lround(p.z / step)});
    }
  std::ranges::sort(out);
  return out;
}

// The same garage as it was and compressed in three ways. Quantized to 14 bits over 7.5 m, positions move by
// up to a quarter of a millimetre; the centres of triangles, in cells of 20 cm, then rarely change cell.
TEST_F(Corpus, CompressedGaragesAreTheGarage) {
  const auto centres = [&](const char* name) {
    Warnings warnings;
    return roundedCentres(import(Document::read(shared_ / "scenes" / name), warnings), 0.2);
  };
  const auto plain = centres("garage/garage.gltf");
  for (const char* name : {"quantize", "draco", "meshopt"}) {
    const auto packed = centres(("garage-compressed/garage-" + std::string(name) + ".glb").c_str());
    ASSERT_EQ(packed.size(), plain.size());
    std::vector<std::array<long, 3>> common;
    std::ranges::set_intersection(plain, packed, std::back_inserter(common));
    EXPECT_GT(common.size(), plain.size() * 97 / 100) << name;
  }
}

TEST_F(Corpus, MalformedFilesNeverCrash) {
  for (const fs::path& file : filesIn(shared_ / "badgltf")) {
    SCOPED_TRACE(file);
    errorOf([&] {
      Warnings warnings;
      const Document document = Document::read(file);
      const Scene scene = import(document, warnings);
      exportGlb(document, scene, fakeBake(scene));
    });
  }
}

}  // namespace
}  // namespace relume::scene::gltf
