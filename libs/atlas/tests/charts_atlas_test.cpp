// SPDX-License-Identifier: MIT
// Whole atlases of made scenes: what must hold whatever the mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "charts_check.h"
#include "charts_meshes.h"
#include "relume/core/parallel.h"

namespace relume::atlas {
namespace {

using namespace test;
using testing::HasSubstr;

AtlasOptions sized(int page, float texels_per_metre = 0) {
  AtlasOptions options;
  options.page_size = page;
  options.texels_per_metre = texels_per_metre;
  return options;
}

class EveryMesh : public testing::TestWithParam<scene::Mesh> {};

TEST_P(EveryMesh, GivesASoundAtlas) {
  const scene::Scene scene = sceneOf({GetParam()});
  for (const int page : {64, 256}) {
    for (const int gutter : {0, 2, 3}) {
      AtlasOptions options = sized(page);
      options.gutter = gutter;
      SCOPED_TRACE(testing::Message() << "page " << page << ", gutter " << gutter);
      const Atlas atlas = build(scene, options);
      EXPECT_EQ(atlas.pages, 1u);
      EXPECT_EQ(atlas.statistics.charts, atlas.charts.size());
      const Measured measured = checkAtlas(scene, atlas, options);
      // Charts are scaled to the area they have, so the density is met but for what closing slits moves.
      EXPECT_NEAR(measured.texels_per_metre / atlas.statistics.texels_per_metre, 1, 1e-3);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Charts, EveryMesh,
                         testing::Values(grid(), cube(), room(), icosphere(0), icosphere(3), torus(),
                                         cylinder(), twoSided(), frame(), helix(), bumps(), soup(150, 1),
                                         book()),
                         [](const auto& mesh) {
                           std::string name = mesh.param.name + std::to_string(mesh.index);
                           std::erase_if(name,
                                         [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

// One square on one page: all texels but the border of half a gutter, whatever its size in the world.
TEST(ChartsAtlas, ASquareFillsItsPage) {
  for (const float size : {1e-3f, 1.0f, 5e4f}) {
    const scene::Scene scene = sceneOf({grid(3, size)});
    const Atlas atlas = build(scene, sized(128));
    EXPECT_EQ(atlas.charts.size(), 1u);
    EXPECT_NEAR(atlas.statistics.texels_per_metre * size, 126, 0.1);
    EXPECT_NEAR(atlas.statistics.coverage, 126.0 * 126 / (128 * 128), 1e-6);
    EXPECT_NEAR(atlas.statistics.mean_stretch, 1, 1e-5);
  }
}

TEST(ChartsAtlas, GivenDensityIsMetOnAsManyPagesAsItTakes) {
  std::vector<scene::Mesh> meshes;
  for (int i = 0; i < 40; ++i) meshes.push_back(cube(0.5f + 0.01f * static_cast<float>(i)));
  const scene::Scene scene = sceneOf(std::move(meshes));
  const AtlasOptions options = sized(256, 80);  // 12 pages and a half by area alone
  Warnings warnings;
  const Atlas atlas = build(scene, options, &warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_GE(atlas.pages, 12u);
  EXPECT_LE(atlas.pages, 20u) << "whole cubes leave room";
  EXPECT_EQ(atlas.statistics.texels_per_metre, 80);
  EXPECT_NEAR(checkAtlas(scene, atlas, options).texels_per_metre, 80, 1e-2);
}

TEST(ChartsAtlas, WhatIsLargerThanAPageIsScaledDownWithAWarning) {
  scene::Scene scene = sceneOf({grid(4, 10), cube(1)});
  scene.instances[0].name = "Terrain";
  const AtlasOptions options = sized(128, 30);
  Warnings warnings;
  const Atlas atlas = build(scene, options, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0].subject, HasSubstr("Terrain"));
  EXPECT_THAT(warnings[0].problem, HasSubstr("30 texels per metre"));
  EXPECT_NEAR(atlas.charts[0].mean_stretch, 300.0 / 126, 0.05)
      << "stretch is relative to the density asked for";
  const std::vector<std::uint32_t> owner = coveredBy(atlas);
  EXPECT_EQ(narrowestGutter(atlas, owner, 2), 2);
}

// A slip in the density must not take all memory: 20 cubes of 6 m^2 at 1000 texels/m are 20 whole pages.
TEST(ChartsAtlas, MoreTexelsThanThereMayBeAreRefused) {
  const scene::Scene scene = sceneOf(std::vector<scene::Mesh>(20, cube(1)));
  AtlasOptions options = sized(256, 1000);
  options.most_texels = 1'000'000;
  try {
    build(scene, options);
    FAIL() << "20 pages of 65536 texels were accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutOfMemory);
    EXPECT_THAT(error.remedy(), HasSubstr("--texel-density"));
  }
  options.most_texels = 2'000'000;
  EXPECT_EQ(build(scene, options).pages, 20u);
  options = sized(2048);
  options.most_texels = 2'000'000;
  EXPECT_THROW(build(scene, options), Error);
}

TEST(ChartsAtlas, InstancesThatDifferByASimilarityShareCharts) {
  scene::Scene scene = sceneOf({bumps(24)});
  scene.instances.clear();
  const Mat4 moved = glm::translate(Mat4(1.0f), Vec3(10, 2, -5));
  const Mat4 turned = glm::rotate(moved, 1.1f, glm::normalize(Vec3(1, 2, 3)));
  addUse(scene, 0, Mat4(1.0f));
  addUse(scene, 0, glm::scale(turned, Vec3(2.5f)));
  addUse(scene, 0, glm::scale(turned, Vec3(-1, 1, 1)));
  addUse(scene, 0, glm::scale(moved, Vec3(1, 3, 1)));
  const AtlasOptions options = sized(512);
  const Atlas atlas = build(scene, options);
  checkAtlas(scene, atlas, options);
  ASSERT_EQ(atlas.instances.size(), 4u);
  const auto same = [&](std::size_t i) {
    return atlas.instances[i].source_vertex == atlas.instances[0].source_vertex &&
           atlas.instances[i].triangles == atlas.instances[0].triangles;
  };
  EXPECT_TRUE(same(1));
  EXPECT_TRUE(same(2)) << "a mirror image has the same charts";
  EXPECT_FALSE(same(3)) << "a stretched one has its own";
  // Each in world scale: the larger use takes 2.5^2 the texels.
  const auto texels = [&](std::size_t i) {
    double sum = 0;
    for (std::size_t t = 0; t < atlas.instances[i].triangles.size(); ++t)
      sum += texelArea(atlas.instances[i], t);
    return sum;
  };
  EXPECT_NEAR(texels(1) / texels(0), 6.25, 1e-3);
  EXPECT_NEAR(texels(2) / texels(0), 1, 1e-3);
}

TEST(ChartsAtlas, TransformsWithoutVolumeWork) {
  scene::Scene scene = sceneOf({cube(), icosphere(1)});
  scene.instances[0].world_from_local = glm::scale(Mat4(1.0f), Vec3(1, 0, 1));
  scene.instances[1].world_from_local = glm::scale(Mat4(1.0f), Vec3(0, 0, 0));
  const AtlasOptions options = sized(128);
  const Atlas atlas = build(scene, options);
  checkAtlas(scene, atlas, options);
  for (const std::uint32_t c : atlas.instances[1].triangle_chart) EXPECT_EQ(c, kNone);
}

TEST(ChartsAtlas, DynamicInstancesAreLeftOut) {
  scene::Scene scene = sceneOf({cube(), grid(), room()});
  scene.instances[1].dynamic = true;
  const AtlasOptions options = sized(128);
  const Atlas atlas = build(scene, options);
  ASSERT_EQ(atlas.instances.size(), 2u);
  EXPECT_EQ(atlas.instances[1].instance, 2u);
  checkAtlas(scene, atlas, options);
}

TEST(ChartsAtlas, DegenerateTrianglesKeepTheirVerticesAndHaveNoChart) {
  scene::Mesh mesh = cube();
  addTriangle(mesh, {0, 0, 0}, {2, 2, 2}, {1, 1, 1});
  mesh.triangles.push_back({3, 3, 4});
  const scene::Scene scene = sceneOf({mesh});
  const AtlasOptions options = sized(128);
  const Atlas atlas = build(scene, options);
  checkAtlas(scene, atlas, options);
  EXPECT_EQ(atlas.instances[0].triangle_chart[12], kNone);
  EXPECT_EQ(atlas.instances[0].triangle_chart[13], kNone);
}

TEST(ChartsAtlas, NothingToBakeIsAnError) {
  const auto codeOf = [](const scene::Scene& scene, const AtlasOptions& options = {}) {
    try {
      build(scene, options);
    } catch (const Error& e) {
      return e.code();
    }
    return ErrorCode::kMismatch;
  };
  EXPECT_EQ(codeOf(scene::Scene{}), ErrorCode::kEmptyScene);
  scene::Scene moving = sceneOf({cube()});
  moving.instances[0].dynamic = true;
  EXPECT_EQ(codeOf(moving), ErrorCode::kEmptyScene);
  scene::Mesh needle = emptyMesh("needle");
  addTriangle(needle, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
  EXPECT_EQ(codeOf(sceneOf({needle})), ErrorCode::kEmptyScene);

  const scene::Scene scene = sceneOf({cube()});
  EXPECT_EQ(codeOf(scene, sized(0)), ErrorCode::kUsage);
  EXPECT_EQ(codeOf(scene, sized(130)), ErrorCode::kUsage);
  EXPECT_EQ(codeOf(scene, sized(128, -1)), ErrorCode::kUsage);
  AtlasOptions options = sized(128);
  options.gutter = -1;
  EXPECT_EQ(codeOf(scene, options), ErrorCode::kUsage);
  options = sized(128);
  options.cone_angle = 2;
  EXPECT_EQ(codeOf(scene, options), ErrorCode::kUsage);
}

TEST(ChartsAtlas, CancellingStopsIt) {
  const scene::Scene scene = sceneOf({bumps()});
  Warnings warnings;
  SilentProgress progress;
  progress.cancel();
  try {
    buildAtlas(scene, {}, warnings, progress);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kInterrupted);
  }
}

TEST(ChartsAtlas, TheNumberOfThreadsChangesNothing) {
  scene::Scene scene = sceneOf({bumps(), icosphere(4), torus(), room(), soup(300, 9), helix()});
  addUse(scene, 1, glm::scale(Mat4(1.0f), Vec3(0.3f)));
  const AtlasOptions options = sized(512);
  const auto built = [&](int threads) {
    const ThreadLimit limit(threads);
    return build(scene, options);
  };
  const Atlas one = built(1), many = built(0);
  ASSERT_EQ(one.charts.size(), many.charts.size());
  ASSERT_EQ(one.instances.size(), many.instances.size());
  for (std::size_t i = 0; i < one.instances.size(); ++i) {
    EXPECT_EQ(one.instances[i].uv, many.instances[i].uv);
    EXPECT_EQ(one.instances[i].triangles, many.instances[i].triangles);
    EXPECT_EQ(one.instances[i].source_vertex, many.instances[i].source_vertex);
    EXPECT_EQ(one.instances[i].triangle_chart, many.instances[i].triangle_chart);
  }
  EXPECT_EQ(one.statistics.coverage, many.statistics.coverage);
}

// Rotating an instance changes no chart: only its shape counts.
TEST(ChartsAtlas, ChartsDoNotDependOnWhereAnInstanceStands) {
  scene::Scene here = sceneOf({icosphere(3)}), there = here;
  there.instances[0].world_from_local =
      glm::rotate(glm::translate(Mat4(1.0f), Vec3(100, 0, 7)), 2.0f, glm::normalize(Vec3(3, 1, 2)));
  const Atlas a = build(here, sized(256)), b = build(there, sized(256));
  EXPECT_EQ(a.instances[0].uv, b.instances[0].uv);
  EXPECT_EQ(a.instances[0].triangles, b.instances[0].triangles);
}

// At 1024 texels the bars of a real scene hold for made ones too.
TEST(ChartsAtlas, CurvedSurfacesAreCoveredWellWithLittleStretch) {
  const scene::Scene scene = sceneOf({bumps(), icosphere(4), torus(), cylinder(), room()});
  const AtlasOptions options = sized(1024);
  const Atlas atlas = build(scene, options);
  const Measured measured = checkAtlas(scene, atlas, options);
  EXPECT_GT(measured.coverage, 0.70);
  EXPECT_LT(atlas.statistics.mean_stretch, 1.02);
}

}  // namespace
}  // namespace relume::atlas
