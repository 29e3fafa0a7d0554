// SPDX-License-Identifier: MIT
#include "charts/reuse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "charts_check.h"
#include "charts_meshes.h"

namespace relume::atlas {
namespace {

using namespace test;
using testing::HasSubstr;

/// A cube whose sides lie in a 3 x 2 table, each taking `side` of its cell.
scene::Mesh unwrappedCube(float side = 0.8f, float margin = 0.1f) {
  scene::Mesh mesh = cube();
  for (std::uint32_t v = 0; v < 24; ++v) {
    const std::uint32_t face = v / 4, corner = v % 4;
    const Vec2 local(corner == 1 || corner == 2 ? side : 0.0f, corner >= 2 ? side : 0.0f);
    mesh.uv[1].push_back((Vec2(face % 3, face / 3) + margin + local) / 3.0f);
  }
  return mesh;
}

Fault faultOf(const scene::Mesh& mesh) {
  Fault fault;
  const bool valid = reuseLayout(mesh, Mat3(1.0f), fault).has_value();
  EXPECT_EQ(valid, fault.empty());
  return fault;
}

TEST(ChartsReuse, ASoundLayoutIsKept) {
  Fault fault;
  const std::optional<Reused> reused = reuseLayout(unwrappedCube(), Mat3(1.0f), fault);
  ASSERT_TRUE(reused) << fault;
  EXPECT_EQ(reused->layout.charts.size(), 6u);
  EXPECT_NEAR(reused->metres_per_unit, 3 / 0.8, 1e-4);
  EXPECT_NEAR(reused->extent.x, (2 + 0.8f) / 3, 1e-5);
  for (const FlatChart& chart : reused->layout.charts) EXPECT_NEAR(chart.mean_stretch, 1, 1e-4);
}

TEST(ChartsReuse, FaultsAreNamedWithNumbers) {
  EXPECT_EQ(faultOf(unwrappedCube()), "");

  scene::Mesh outside = unwrappedCube();
  for (Vec2& p : outside.uv[1]) p.x += 0.5f;
  EXPECT_THAT(faultOf(outside), HasSubstr("outside [0, 1]"));

  scene::Mesh unfinished = unwrappedCube();
  unfinished.uv[1][7].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(faultOf(unfinished), HasSubstr("vertex 7"));

  scene::Mesh overlapping = unwrappedCube();
  for (std::size_t v = 0; v < 4; ++v) overlapping.uv[1][v] = overlapping.uv[1][v + 4];
  EXPECT_THAT(faultOf(overlapping), HasSubstr("20.00 % of its texels overlap"));

  scene::Mesh flat = unwrappedCube();
  for (std::size_t v = 0; v < 4; ++v) flat.uv[1][v] = Vec2(0.5f);
  EXPECT_THAT(faultOf(flat), HasSubstr("16.7 % of the surface has no area"));

  scene::Mesh uneven = unwrappedCube();
  for (std::size_t v = 1; v < 4; ++v)
    uneven.uv[1][v] = uneven.uv[1][0] + 0.1f * (uneven.uv[1][v] - uneven.uv[1][0]);
  EXPECT_THAT(faultOf(uneven), HasSubstr("varies 10.0 times"));

  scene::Mesh stretched = unwrappedCube();
  for (Vec2& p : stretched.uv[1]) p.y *= 0.05f;
  EXPECT_THAT(faultOf(stretched), HasSubstr("stretches the surface"));
}

// Edges that touch, and the diagonal of each quad, are no overlap.
TEST(ChartsReuse, IslandsMayTouchWithoutOverlapping) { EXPECT_EQ(faultOf(unwrappedCube(1.0f, 0.0f)), ""); }

TEST(ChartsReuse, GuttersDependOnTheSize) {
  Fault fault;
  // A tenth of a third between islands on each side: 2 x texels / 30 of gap.
  const std::optional<Reused> reused = reuseLayout(unwrappedCube(), Mat3(1.0f), fault);
  ASSERT_TRUE(reused);
  EXPECT_TRUE(guttersSuffice(*reused, 300, 2, fault));
  EXPECT_TRUE(guttersSuffice(*reused, 75, 2, fault));
  EXPECT_FALSE(guttersSuffice(*reused, 25, 2, fault));
  EXPECT_THAT(fault, HasSubstr("within 2 texels of another island when it is 25 texels wide"));
  EXPECT_TRUE(guttersSuffice(*reused, 25, 0, fault));
}

TEST(ChartsReuse, KeptLayoutsAreScaledIntoTheirPlace) {
  const scene::Scene scene = sceneOf({unwrappedCube(), room()});
  AtlasOptions options;
  options.page_size = 256;
  Warnings warnings;
  const Atlas atlas = build(scene, options, &warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_TRUE(atlas.instances[0].reused);
  EXPECT_FALSE(atlas.instances[1].reused);
  checkAtlas(scene, atlas, options);
  // A similarity: every edge keeps its share.
  const auto& uv = atlas.instances[0].uv;
  const auto& was = scene.meshes[0].uv[1];
  EXPECT_EQ(uv.size(), was.size());
  const float scale = glm::distance(uv[0], uv[2]) / glm::distance(was[0], was[2]);
  for (std::size_t v = 1; v < uv.size(); ++v) {
    EXPECT_NEAR(glm::distance(uv[0], uv[v]), scale * glm::distance(was[0], was[v]), 1e-3f);
  }
  EXPECT_NEAR(scale * 0.8f / 3, atlas.statistics.texels_per_metre, 0.01f * atlas.statistics.texels_per_metre);
}

TEST(ChartsReuse, RefusedLayoutsAreReplacedWithAWarning) {
  scene::Mesh bad = unwrappedCube();
  bad.name = "Crate";
  for (std::size_t v = 0; v < 4; ++v) bad.uv[1][v] = bad.uv[1][v + 4];
  const scene::Scene scene = sceneOf({bad});
  AtlasOptions options;
  options.page_size = 128;
  Warnings warnings;
  const Atlas atlas = build(scene, options, &warnings);
  EXPECT_FALSE(atlas.instances[0].reused);
  checkAtlas(scene, atlas, options);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0].subject, HasSubstr("Crate"));
  EXPECT_THAT(warnings[0].problem, HasSubstr("20.00 %"));

  warnings.clear();
  options.reuse_uv1 = false;
  build(scene, options, &warnings);
  EXPECT_TRUE(warnings.empty());
}

// Sound at the size that was expected, too narrow at the one that was found: given up after packing.
TEST(ChartsReuse, GuttersAreCheckedAtTheFinalSize) {
  const scene::Scene scene = sceneOf({unwrappedCube(0.96f, 0.02f)});
  for (const int page : {64, 128, 256, 512}) {
    AtlasOptions options;
    options.page_size = page;
    const Atlas atlas = build(scene, options);
    checkAtlas(scene, atlas, options);
  }
}

}  // namespace
}  // namespace relume::atlas
