// SPDX-License-Identifier: MIT
// Closed forms and invariants of rasterize and footprintPosition.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "relume/atlas/texels.h"
#include "relume/core/parallel.h"
#include "texels_scene.h"

namespace relume::atlas {
namespace {

using testing::HandMade;

Texels texelsOf(const HandMade& made) {
  SilentProgress progress;
  return rasterize(made.scene, made.atlas, progress);
}

const SurfacePoint* at(const Texels& texels, int x, int y, std::uint32_t page = 0) {
  const auto texel = (page * static_cast<std::uint32_t>(texels.height) + static_cast<std::uint32_t>(y)) *
                         static_cast<std::uint32_t>(texels.width) +
                     static_cast<std::uint32_t>(x);
  for (const SurfacePoint& p : texels.points) {
    if (p.texel == texel) return &p;
  }
  return nullptr;
}

const SurfacePoint* at(const Texels&&, int, int,
                       std::uint32_t = 0) = delete;  // would point into what is gone

/// z = 0.1 sin(5x) cos(4y) over [0, 1]^2 as n x n cells in one chart; a turned, off-grid square of the page.
HandMade bumpySheet(std::uint32_t n, float texels, int size) {
  HandMade made(size);
  std::vector<Point> positions;
  std::vector<Vec2> uv;
  std::vector<UVec3> triangles;
  const Vec2 axis = texels * Vec2(std::cos(0.3f), std::sin(0.3f));
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const float x = static_cast<float>(i) / static_cast<float>(n),
                  y = static_cast<float>(j) / static_cast<float>(n);
      positions.push_back({x, y, 0.1f * std::sin(5 * x) * std::cos(4 * y)});
      uv.push_back(Vec2(0.4f * texels + 1.7f, 1.3f) + x * axis + y * Vec2(-axis.y, axis.x));
      const std::uint32_t v = j * (n + 1) + i;
      if (i < n && j < n) {
        triangles.push_back({v, v + 1, v + n + 2});
        triangles.push_back({v, v + n + 2, v + n + 1});
      }
    }
  }
  made.add(positions, uv, triangles, std::vector<std::uint32_t>(triangles.size(), 0));
  return made;
}

TEST(Rasterize, AHalfCoveredTexelHasHalfTheCoverageAndArea) {
  HandMade made(4);
  // Half of texel (1, 2), cut along its diagonal; 2 m by 3 m per texel.
  made.add({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, {{1, 2}, {2, 2}, {1, 3}}, {{0, 1, 2}}, {0});
  const Texels texels = texelsOf(made);
  ASSERT_EQ(texels.points.size(), 1u);
  const SurfacePoint& p = texels.points[0];
  EXPECT_EQ(p.texel, 2u * 4 + 1);
  EXPECT_NEAR(p.coverage, 0.5f, 1e-6f);
  EXPECT_NEAR(p.area, 3.0f, 1e-5f);
  EXPECT_NEAR(glm::length(p.dp_dx - Vec3(2, 0, 0)), 0, 1e-6f);
  EXPECT_NEAR(glm::length(p.dp_dy - Vec3(0, 3, 0)), 0, 1e-6f);
  EXPECT_NEAR(glm::length(p.geometric_normal - Vec3(0, 0, 1)), 0, 1e-6f);
  EXPECT_GT(p.sample_count, 0u);
  EXPECT_LE(p.sample_count, 16u);
}

TEST(Rasterize, ATexelWhollyInsideIsItsParallelogram) {
  HandMade made(8);
  made.addQuad({1, 2, 3}, {6, 0, 0}, {0, 0, 3}, {1, 1}, {6, 6});
  const Texels texels = texelsOf(made);
  EXPECT_EQ(texels.points.size(), 36u);
  for (const SurfacePoint& p : texels.points) {
    const float x = static_cast<float>(p.texel % 8) + 0.5f, y = static_cast<float>(p.texel / 8) + 0.5f;
    EXPECT_EQ(p.coverage, 1.0f);
    EXPECT_EQ(p.sample_count, 0u) << "two triangles of one plane and one map are one parallelogram";
    EXPECT_NEAR(p.area, 0.5f, 1e-6f);
    EXPECT_NEAR(glm::length(p.position - Point(1 + (x - 1), 2, 3 + 0.5f * (y - 1))), 0, 2e-6f);
    const Point corner = footprintPosition(texels, p, {0, 0});
    EXPECT_LT(glm::length(corner - (p.position - 0.5f * p.dp_dx - 0.5f * p.dp_dy)), 0.01f);
    EXPECT_GT(corner.x, p.position.x - 0.5f) << "never on the edge itself";
  }
}

TEST(Rasterize, AreasAddUpToTheSurfaceAndCoverageToThePage) {
  for (const std::uint32_t n : {1u, 3u, 20u, 150u}) {
    SCOPED_TRACE(n);
    const HandMade made = bumpySheet(n, 31.0f, 48);
    const Texels texels = texelsOf(made);
    double surface = 0, area = 0, coverage = 0;
    const scene::Mesh& mesh = made.scene.meshes[0];
    for (const UVec3 t : mesh.triangles) {
      const Point a = mesh.positions[t.x];
      surface += 0.5 * static_cast<double>(
                           glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a)));
    }
    for (const SurfacePoint& p : texels.points)
      area += static_cast<double>(p.area), coverage += static_cast<double>(p.coverage);
    EXPECT_NEAR(area / surface, 1.0, 1e-5);
    EXPECT_NEAR(coverage / (31.0 * 31.0), 1.0, 1e-5);
  }
}

TEST(Rasterize, EveryTexelThatASurfaceTouchesIsCovered) {
  // Against a slow reference: a texel whose square contains any of many points of the chart must be there.
  const HandMade made = bumpySheet(7, 29.0f, 48);
  const Texels texels = texelsOf(made);
  std::vector<int> found(48 * 48, 0);
  for (const SurfacePoint& p : texels.points) found[p.texel] = 1;
  const InstanceUv& uv = made.atlas.instances[0];
  for (const UVec3 t : uv.triangles) {
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; j <= 60 - i; ++j) {
        const float b1 = (static_cast<float>(i) + 0.01f) / 60.1f,
                    b2 = (static_cast<float>(j) + 0.01f) / 60.1f;
        const Vec2 p = (1 - b1 - b2) * uv.uv[t.x] + b1 * uv.uv[t.y] + b2 * uv.uv[t.z];
        ASSERT_TRUE(found[static_cast<std::size_t>(p.y) * 48 + static_cast<std::size_t>(p.x)])
            << p.x << " " << p.y;
      }
    }
  }
  for (std::size_t i = 1; i < texels.points.size(); ++i)
    EXPECT_LT(texels.points[i - 1].texel, texels.points[i].texel);
}

TEST(Rasterize, PositionsAndSamplesLieOnTheSurfaceInTheirTexel) {
  // On a sheet the inverse map is known: (x, y) of a position gives its place on the page.
  const HandMade made = bumpySheet(9, 30.0f, 48);
  const Texels texels = texelsOf(made);
  const InstanceUv& uv = made.atlas.instances[0];
  const auto page = [&](Point p) {
    return uv.uv[0] + p.x * (uv.uv[9] - uv.uv[0]) + p.y * (uv.uv[90] - uv.uv[0]);
  };
  const scene::Mesh& mesh = made.scene.meshes[0];
  const auto offPlane = [&](Point p, std::uint32_t triangle) {
    const UVec3 t = mesh.triangles[triangle];
    const Point a = mesh.positions[t.x];
    return std::abs(
        glm::dot(p - a, glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a))));
  };
  for (const SurfacePoint& p : texels.points) {
    const Vec2 corner(static_cast<float>(p.texel % 48), static_cast<float>(p.texel / 48));
    const auto inTexel = [&](Vec2 q) {
      return q.x > corner.x - 1e-3f && q.y > corner.y - 1e-3f && q.x < corner.x + 1.001f &&
             q.y < corner.y + 1.001f;
    };
    EXPECT_TRUE(inTexel(page(p.position)));
    EXPECT_LT(offPlane(p.position, p.triangle), 3e-7f);
    EXPECT_LE(p.sample_count, 16u);
    for (std::uint32_t i = 0; i < p.sample_count; ++i) {
      const SubSample& s = texels.samples[p.first_sample + i];
      EXPECT_TRUE(inTexel(page(s.position)));
      EXPECT_LT(offPlane(s.position, s.triangle), 3e-7f);
    }
    if (p.coverage > 0.999f) {
      EXPECT_LT(glm::length(page(p.position) - corner - 0.5f), 0.02f);
    }
  }
}

TEST(Rasterize, PositionIsTheNearestPlaceToTheCentre) {
  HandMade made(4);
  // x >= 1.75 of texel (1, 1): nearest to its centre (1.5, 1.5) is (1.75, 1.5), pulled inside by a hundredth.
  made.addQuad({1.75f, 1, 0}, {2, 0, 0}, {0, 2, 0}, {1.75f, 1}, {2, 2});
  const Texels texels = texelsOf(made);
  const SurfacePoint* p = at(texels, 1, 1);
  ASSERT_NE(p, nullptr);
  EXPECT_NEAR(p->position.x, 1.75f, 0.011f);
  EXPECT_GT(p->position.x, 1.75f);
  EXPECT_NEAR(p->position.y, 1.5f, 0.011f);
  EXPECT_NEAR(p->coverage, 0.25f, 1e-6f);
}

TEST(Rasterize, FootprintMeanIsTheCentroidOfWhatIsCovered) {
  // Edges at several angles through texel (1, 1); the covered part and its centroid come from clipping a fine
  // grid.
  for (int k = 0; k < 12; ++k) {
    const float angle = 0.05f + 0.5f * static_cast<float>(k);
    SCOPED_TRACE(angle);
    const Vec2 n(std::cos(angle), std::sin(angle)), along(-n.y, n.x), middle = Vec2(1.5f) + 0.15f * n;
    const Vec2 a = middle - 4.0f * along, b = middle + 4.0f * along, c = middle + 8.0f * n;
    HandMade made(16);
    const Vec2 shift(6, 6);  // the triangle must not leave the page
    made.add({Point(a, 0), Point(b, 0), Point(c, 0)}, {a + shift, b + shift, c + shift}, {{0, 1, 2}}, {0});
    const Texels texels = texelsOf(made);
    const SurfacePoint* p = at(texels, 7, 7);
    ASSERT_NE(p, nullptr);
    Vec2 centroid(0);
    float count = 0;
    for (int i = 0; i < 400; ++i) {
      for (int j = 0; j < 400; ++j) {
        const Vec2 q = 1.0f + (Vec2(i, j) + 0.5f) / 400.0f;
        if (glm::dot(q - middle, n) > 0) centroid += q, count += 1;
      }
    }
    centroid /= count;
    EXPECT_NEAR(p->coverage, count / 160000, 2e-3f);
    Vec2 mean(0);
    for (int i = 0; i < 1024; ++i)
      mean += Vec2(footprintPosition(texels, *p, {(static_cast<float>(i) + 0.5f) / 1024, 0.3f})) / 1024.0f;
    EXPECT_LT(glm::length(mean - centroid), 0.06f);
  }
}

TEST(Rasterize, SamplesSpreadOverTheWholePart) {
  // A right triangle with legs of one texel: second moments about its centroid are 1/18.
  HandMade made(4);
  made.add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{1, 1}, {2, 1}, {1, 2}}, {{0, 1, 2}}, {0});
  const Texels texels = texelsOf(made);
  ASSERT_EQ(texels.samples.size(), 8u);
  Vec3 moment(0);
  for (const SubSample& s : texels.samples) {
    const Vec3 d = s.position - Point(1.0f / 3, 1.0f / 3, 0);
    moment += d * d / 8.0f;
  }
  EXPECT_NEAR(moment.x, 1.0f / 18, 0.02f);
  EXPECT_NEAR(moment.y, 1.0f / 18, 0.02f);
}

TEST(Rasterize, AFoldInsideATexelIsNotFlat) {
  // A right-angled fold along the middle of the texels of column 2: half of the samples lie on each side.
  HandMade made(8);
  made.add({{0, 0, 0}, {1.5f, 0, 0}, {1.5f, 4, 0}, {0, 4, 0}, {1.5f, 0, 1.5f}, {1.5f, 4, 1.5f}},
           {{1, 1}, {2.5f, 1}, {2.5f, 5}, {1, 5}, {4, 1}, {4, 5}},
           {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}, {0, 0, 0, 0});
  const Texels texels = texelsOf(made);
  for (int y = 1; y < 5; ++y) {
    const SurfacePoint* p = at(texels, 2, y);
    ASSERT_NE(p, nullptr);
    EXPECT_NEAR(p->coverage, 1, 1e-5f);
    EXPECT_EQ(p->sample_count, 8u);
    int floor = 0;
    for (std::uint32_t i = 0; i < p->sample_count; ++i) {
      const SubSample& s = texels.samples[p->first_sample + i];
      EXPECT_TRUE(std::abs(s.position.z) < 1e-6f || std::abs(s.position.x - 1.5f) < 1e-6f);
      floor += s.triangle < 2;
    }
    EXPECT_NEAR(floor, 4, 1);
  }
}

TEST(Rasterize, OnlyOnePlaneWithOneMapIsOneParallelogram) {
  // Column 2 lies across two quads: one flat floor; bent by a third of a degree; one floor, mapped 3 % denser
  // on one side.
  struct Case {
    float rise, length;
    std::uint32_t samples;
  };
  for (const Case c : {Case{0, 1.5f, 0}, Case{0.008f, 1.5f, 8}, Case{0, 1.545f, 8}}) {
    HandMade made(8);
    const float x = 1.5f + c.length;
    made.add({{0, 0, 0}, {1.5f, 0, 0}, {1.5f, 4, 0}, {0, 4, 0}, {x, 0, c.rise}, {x, 4, c.rise}},
             {{1, 1}, {2.5f, 1}, {2.5f, 5}, {1, 5}, {4, 1}, {4, 5}},
             {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}, {0, 0, 0, 0});
    const Texels texels = texelsOf(made);
    EXPECT_EQ(at(texels, 2, 2)->sample_count, c.samples) << c.rise << " " << c.length;
  }
}

TEST(Rasterize, EachPointFindsItsOwnSamples) {
  // Many charts, so that the samples of one do not begin at zero: each sample lies in its texel of its quad.
  HandMade made(64);
  for (int i = 0; i < 16; ++i) {
    const float x = static_cast<float>(i % 4) * 16 + 1.3f, y = static_cast<float>(i / 4) * 16 + 1.6f;
    made.addQuad({x, y, static_cast<float>(i)}, {11.1f, 0, 0}, {0, 12.7f, 0}, {x, y}, {11.1f, 12.7f});
  }
  const Texels texels = texelsOf(made);
  for (const SurfacePoint& p : texels.points) {
    const Vec2 corner(static_cast<float>(p.texel % 64), static_cast<float>(p.texel / 64));
    for (std::uint32_t i = 0; i < p.sample_count; ++i) {
      const Point q = texels.samples[p.first_sample + i].position;
      EXPECT_EQ(q.z, static_cast<float>(p.chart));
      EXPECT_LT(glm::length(Vec2(q) - corner - 0.5f), 0.71f);
    }
  }
}

TEST(Rasterize, EqualSharesOfTheUnitSquareAreEqualSharesOfTheSamples) {
  const HandMade made = bumpySheet(9, 30.0f, 48);
  const Texels texels = texelsOf(made);
  int looked = 0;
  for (const SurfacePoint& p : texels.points) {
    if (p.sample_count < 2) continue;
    ++looked;
    std::vector<int> hits(p.sample_count, 0);
    for (std::uint32_t i = 0; i < 16 * p.sample_count; ++i) {
      const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(16 * p.sample_count);
      const Point q = footprintPosition(texels, p, {u, 0.9f});
      for (std::uint32_t s = 0; s < p.sample_count; ++s)
        hits[s] += texels.samples[p.first_sample + s].position == q;
    }
    for (const int h : hits) EXPECT_GE(h, 16);
    EXPECT_EQ(footprintPosition(texels, p, {std::nextafter(1.0f, 0.0f), 0}),
              texels.samples[p.first_sample + p.sample_count - 1].position);
  }
  EXPECT_GT(looked, 50);
}

TEST(Rasterize, OfTwoChartsTheLargerCoverageOwnsATexel) {
  HandMade made(4);
  made.addQuad({0, 0, 0}, {1.3f, 0, 0}, {0, 2, 0}, {0, 0}, {1.3f, 2});     // chart 0: 0.3 of texel (1, *)
  made.addQuad({5, 0, 0}, {1.6f, 0, 0}, {0, 2, 0}, {1.4f, 0}, {1.6f, 2});  // chart 1: 0.6 of it
  made.addQuad({9, 0, 0}, {0.3f, 0, 0}, {0, 2, 0}, {0.7f, 0}, {0.3f, 2});  // chart 2: loses in texel (0, *)
  const Texels texels = texelsOf(made);
  EXPECT_EQ(at(texels, 0, 0)->chart, 0u);
  EXPECT_EQ(at(texels, 1, 0)->chart, 1u);
  EXPECT_NEAR(at(texels, 1, 0)->coverage, 0.6f, 1e-5f);
  EXPECT_EQ(at(texels, 1, 1)->instance, 1u);
}

TEST(Rasterize, EqualClaimsGoToTheFirstChart) {
  HandMade made(4);
  made.addQuad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1}, {2, 2});
  made.addQuad({5, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1}, {2, 2});
  for (const SurfacePoint& p : texelsOf(made).points) EXPECT_EQ(p.chart, 0u);
}

TEST(Rasterize, ColoursAreMeansOverTheFootprint) {
  HandMade made(4);
  // Vertex colours linear in x over a triangle that covers half of texel (0, 0): the mean is the colour at
  // the centroid, 1/3.
  scene::Mesh& mesh = made.add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}, {0});
  mesh.colours = {{0, 0.5f, 1, 1}, {1, 0.5f, 1, 1}, {0, 0.5f, 1, 1}};
  const Texels texels = texelsOf(made);
  EXPECT_NEAR(texels.points[0].albedo.rgb.x, 1.0f / 3, 1e-5f);
  EXPECT_NEAR(texels.points[0].albedo.rgb.y, 0.5f, 1e-6f);
}

TEST(Rasterize, FineTexturesAreFiltered) {
  // A checkerboard of 8 x 8 texture texels in each texel of the page: means near 1/2, where one look-up gives
  // 0 or 1.
  HandMade made(16);
  auto image = std::make_shared<image::Image8>();
  image->width = image->height = 64;
  image->channels = 3;
  for (int i = 0; i < 64 * 64; ++i) {
    const unsigned char c = ((i % 64) ^ (i / 64)) & 2 ? 255 : 0;
    image->data.insert(image->data.end(), {c, c, c});
  }
  scene::Texture texture;
  texture.image = image;
  made.scene.textures.push_back(texture);
  made.scene.materials[0].base_colour_texture.texture = 0;
  scene::Mesh& mesh = made.addQuad({0, 0, 0}, {8.3f, 0, 0}, {0, 8.3f, 0}, {1.2f, 1.6f}, {8.3f, 8.3f});
  mesh.uv[0] = {{0, 0}, {1.0375f, 0}, {1.0375f, 1.0375f}, {0, 1.0375f}};
  double sum = 0, square = 0;
  const Texels texels = texelsOf(made);
  double count = 0;
  for (const SurfacePoint& p : texels.points) {
    if (p.coverage < 0.5f) continue;
    const double a = static_cast<double>(p.albedo.rgb.x);
    sum += a, square += a * a, count += 1;
  }
  const double mean = sum / count, deviation = std::sqrt(square / count - mean * mean);
  EXPECT_NEAR(mean, 0.5, 0.05);
  EXPECT_LT(deviation, 0.15) << "16 stratified look-ups of a 0-1 pattern deviate by at most 0.125";
}

TEST(Rasterize, OnlyTheOpaquePartGivesColour) {
  HandMade made(4);
  scene::Mesh& mesh = made.addQuad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0}, {1, 1});
  auto image = std::make_shared<image::Image8>();
  image->width = image->height = 64, image->channels = 4;
  for (int i = 0; i < 64 * 64; ++i) {  // left: opaque red; right: transparent white
    const bool red = i % 64 < 32;
    image->data.insert(image->data.end(), {255, static_cast<unsigned char>(red ? 0 : 255),
                                           static_cast<unsigned char>(red ? 0 : 255),
                                           static_cast<unsigned char>(red ? 255 : 0)});
  }
  scene::Texture texture;
  texture.image = image;
  texture.wrap_u = texture.wrap_v = scene::Wrap::kClamp;
  made.scene.textures.push_back(texture);
  made.scene.materials[0].base_colour_texture.texture = 0;
  made.scene.materials[0].alpha_mode = scene::AlphaMode::kMask;
  mesh.uv[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const Texels texels = texelsOf(made);
  ASSERT_EQ(texels.points.size(), 1u);
  EXPECT_GT(texels.points[0].albedo.rgb.x, 0.99f);
  EXPECT_LT(texels.points[0].albedo.rgb.y, 0.01f);
}

TEST(Rasterize, EmissionAndPlacementOfTheInstance) {
  HandMade made(4);
  made.addQuad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1}, {2, 2});
  made.scene.materials[0].emission = {1, 2, 3};
  // Mirrored in x, scaled by 3 in y, moved: the outside stays outside.
  made.scene.instances[0].world_from_local = Mat4({-1, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 1, 0}, {10, 0, 0, 1});
  const Texels texels = texelsOf(made);
  const SurfacePoint* p = at(texels, 1, 1);
  EXPECT_EQ(p->emission, Radiance(Vec3(1, 2, 3)));
  EXPECT_NEAR(glm::length(p->position - Point(9.5f, 1.5f, 0)), 0, 1e-5f);
  EXPECT_NEAR(p->area, 3.0f, 1e-5f);
  EXPECT_NEAR(glm::length(p->dp_dx - Vec3(-1, 0, 0)), 0, 1e-6f);
  EXPECT_NEAR(std::abs(p->geometric_normal.z), 1.0f, 1e-6f);
}

TEST(Rasterize, DegenerateTrianglesAndPagesEdges) {
  HandMade made(4, 2);
  // A point in space, a line on the page, a triangle named degenerate, and one that hangs over the page's
  // edge on page 1.
  made.add({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}}, {{-2, 1}, {2, 1}, {2, 9}, {3, 3}},
           {{0, 0, 3}, {0, 1, 1}, {0, 2, 3}, {0, 1, 2}}, {0, 0, scene::kNone, 0}, 1);
  const Texels texels = texelsOf(made);
  EXPECT_EQ(texels.pages, 2u);
  ASSERT_FALSE(texels.points.empty());
  for (const SurfacePoint& p : texels.points) {
    EXPECT_GE(p.texel, 16u);
    EXPECT_LT(p.texel, 32u);
    EXPECT_EQ(p.triangle, 3u);
    EXPECT_TRUE(isFinite(p.position) && isFinite(p.dp_dx) && p.area > 0);
  }
  EXPECT_EQ(texelsOf(HandMade(4)).points.size(), 0u);
}

TEST(Rasterize, TheSameForAnyNumberOfThreads) {
  HandMade made = bumpySheet(60, 300.0f, 512);
  made.addQuad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5.5f, 3.25f}, {80, 300});  // overlaps
  Texels one, many;
  {
    const ThreadLimit limit(1);
    one = texelsOf(made);
  }
  many = texelsOf(made);
  ASSERT_EQ(one.points.size(), many.points.size());
  ASSERT_EQ(one.samples.size(), many.samples.size());
  EXPECT_EQ(std::memcmp(one.points.data(), many.points.data(), one.points.size() * sizeof(SurfacePoint)), 0);
  EXPECT_EQ(std::memcmp(one.samples.data(), many.samples.data(), one.samples.size() * sizeof(SubSample)), 0);
}

}  // namespace
}  // namespace relume::atlas
