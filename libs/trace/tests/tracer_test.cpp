// SPDX-License-Identifier: MIT
#include "relume/trace/tracer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <vector>

#include "made_scenes.h"
#include "relume/core/error.h"
#include "relume/core/frame.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume::trace {
namespace {

using made::addInstance;
using made::addMaterial;
using made::addMesh;
using made::addQuad;
using made::box;
using made::sceneOf;

scene::Mesh unitQuad() {
  scene::Mesh mesh;
  addQuad(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  return mesh;
}

void addBlend(scene::Scene& scene, float opacity) {
  scene::Material& glass = addMaterial(scene);
  glass.base_colour.a = opacity, glass.alpha_mode = scene::AlphaMode::kBlend;
}

const Ray kDown{{0.25f, 0.125f, 2.0f}, {0, 0, -1}};

TEST(Tracer, HitTellsDistanceTriangleAndBarycentrics) {
  const scene::Scene scene = sceneOf(unitQuad());
  const RayHit hit = Tracer(scene).intersect(kDown);
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit.t, 2.0f);
  EXPECT_EQ(hit.where.instance, 0u);
  EXPECT_EQ(hit.where.triangle, 0u);
  EXPECT_FLOAT_EQ(hit.where.b1, 0.125f);  // (0.25, 0.125) = b1 (1, 0) + b2 (1, 1)
  EXPECT_FLOAT_EQ(hit.where.b2, 0.125f);
  EXPECT_FALSE(hit.back_face);
}

TEST(Tracer, RaysEndAtTheirLimit) {
  const scene::Scene scene = sceneOf(unitQuad());
  const Tracer tracer(scene);
  for (const auto& [limit, expected] : {std::pair{1.99f, false}, {2.01f, true}, {kInfinity, true}}) {
    EXPECT_EQ(static_cast<bool>(tracer.intersect({kDown.origin, kDown.direction, limit})), expected) << limit;
    EXPECT_EQ(tracer.occluded({kDown.origin, kDown.direction, limit}), expected) << limit;
  }
}

TEST(Tracer, EmptyAndDegenerateScenesAreNeverHit) {
  const scene::Scene empty;
  EXPECT_FALSE(Tracer(empty).intersect(kDown));
  EXPECT_FALSE(Tracer(empty).occluded(kDown));

  scene::Mesh degenerate;
  const float nan = std::nanf("");
  degenerate.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {nan, 0, 0}, {kInfinity, 0, 0}};
  degenerate.triangles = {{0, 0, 0}, {0, 1, 1}, {0, 3, 1}, {0, 1, 4}};
  scene::Scene scene = sceneOf(degenerate);
  addInstance(scene, addMesh(scene, {}));                     // no triangles at all
  addInstance(scene, addMesh(scene, unitQuad()), Mat4(nan));  // a node whose matrix is no matrix
  addInstance(scene, 2, Mat4(0.0f));
  const Tracer tracer(scene);
  for (const Vec2 at : {Vec2(0.25f, 0.125f), Vec2(0.5f, 0.0f), Vec2(0.0f, 0.0f)}) {
    EXPECT_FALSE(tracer.intersect({{at, 2.0f}, {0, 0, -1}}));
    EXPECT_FALSE(tracer.occluded({{at, 2.0f}, {0, 0, -1}}));
  }
}

TEST(Tracer, BackFacesAreToldByWindingAlsoWhenMirrored) {
  const Ray up{{0.25f, 0.125f, -2.0f}, {0, 0, 1}};
  const Mat4 mirror_x = glm::scale(glm::translate(Mat4(1.0f), Vec3(1, 0, 0)), Vec3(-1, 1, 1));
  const Mat4 mirror_z = glm::scale(Mat4(1.0f), Vec3(1, 1, -1));
  for (const bool double_sided : {false, true}) {
    for (const bool referenced : {false, true}) {
      SCOPED_TRACE(testing::Message() << "double sided " << double_sided << ", referenced " << referenced);
      for (const auto& [matrix, outside_is_up] :
           {std::pair{Mat4(1.0f), true}, {mirror_x, true}, {mirror_z, false}}) {
        scene::Scene scene;
        addMaterial(scene).double_sided = double_sided;
        scene::Mesh mesh = unitQuad();
        if (referenced) {
          // Enough triangles that a second use would cost too much: one long strip far away.
          const scene::Mesh far = made::sphere({0, 0, -1000}, 1, 1024, 520);
          const auto base = static_cast<std::uint32_t>(mesh.positions.size());
          mesh.positions.insert(mesh.positions.end(), far.positions.begin(), far.positions.end());
          for (const UVec3& t : far.triangles) mesh.triangles.push_back(t + base);
        }
        addMesh(scene, mesh);
        addInstance(scene, 0, matrix);
        if (referenced) addInstance(scene, 0, glm::translate(Mat4(1.0f), Vec3(50, 0, 0)));
        const Tracer tracer(scene);
        const RayHit from_above = tracer.intersect(kDown), from_below = tracer.intersect(up);
        ASSERT_TRUE(from_above && from_below);
        EXPECT_EQ(from_above.back_face, !double_sided && !outside_is_up);
        EXPECT_EQ(from_below.back_face, !double_sided && outside_is_up);
        RayPacket packet{};
        std::fill(std::begin(packet.t_max), std::end(packet.t_max), -1.0f);
        packet.origin_x[3] = 0.25f, packet.origin_y[3] = 0.125f, packet.origin_z[3] = 2.0f;
        packet.direction_z[3] = -1.0f, packet.t_max[3] = kInfinity;
        HitPacket hits;
        tracer.intersectPacket(packet, hits);
        EXPECT_EQ(hits.hit, 8u);
        EXPECT_EQ(hits.back_face, from_above.back_face ? 8u : 0u);
        EXPECT_EQ(hits.instance[3], 0u);
        if (!referenced) break;
      }
    }
  }
}

TEST(Tracer, DynamicInstancesAreLeftOutUnlessAskedFor) {
  scene::Scene scene = sceneOf(unitQuad());
  scene.instances[0].dynamic = true;
  EXPECT_FALSE(Tracer(scene).intersect(kDown));
  EXPECT_TRUE(Tracer(scene, {.isa = "", .include_dynamic = true}).intersect(kDown));
}

TEST(Tracer, TransformedInstancesAreHitWhereTheyStand) {
  scene::Scene scene;
  addMesh(scene, unitQuad());
  addInstance(scene, 0, glm::translate(Mat4(1.0f), Vec3(10, 0, 1)));
  const std::uint32_t second = addInstance(scene, 0, glm::scale(Mat4(1.0f), Vec3(3, 3, 1)));
  const Tracer tracer(scene);
  const RayHit hit = tracer.intersect({{2.5f, 0.5f, 2.0f}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.where.instance, second);
  EXPECT_FLOAT_EQ(tracer.intersect({{10.5f, 0.25f, 2.0f}, {0, 0, -1}}).t, 1.0f);
}

TEST(Tracer, UnknownInstructionSetIsTheUsersMistake) {
  const scene::Scene scene = sceneOf(unitQuad());
  try {
    Tracer(scene, {.isa = "mmx", .include_dynamic = false});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kUsage);
  }
  EXPECT_TRUE(Tracer(scene, {.isa = "sse2", .include_dynamic = false}).intersect(kDown));
}

TEST(Tracer, CountsItsBytes) {
  const scene::Scene scene = made::temple(20000);
  const Tracer tracer(scene);
  const double per_triangle =
      static_cast<double>(tracer.bytes()) / static_cast<double>(scene.triangleCount());
  EXPECT_GT(per_triangle, 20.0);
  EXPECT_LT(per_triangle, 140.0);
}

// Watertight: from inside a closed box (corners shared exactly, transforms that round), rays at every edge
// and at its diagonals, within a few float spacings of the edge, all end at a wall.
TEST(Tracer, NoRayEscapesAtSharedEdges) {
  const Mat4 turned = glm::translate(
      glm::rotate(glm::scale(Mat4(1.0f), Vec3(1.3f, 0.7f, 2.1f)), 0.7f, glm::normalize(Vec3(1, 2, 3))),
      Vec3(12.7f, -3.3f, 4.1f));
  for (const Mat4& world_from_local : {Mat4(1.0f), turned}) {
    scene::Scene scene;
    addMesh(scene, box({-1, -1, -1}, {1, 1, 1}));
    addInstance(scene, 0, world_from_local);
    const Tracer tracer(scene);
    std::vector<Point> corners;
    for (const Point& p : scene.meshes[0].positions) corners.emplace_back(world_from_local * Vec4(p, 1));
    std::uint64_t escaped = 0, escaped_in_packets = 0;
    std::uint32_t index = 0;
    for (const UVec3& t : scene.meshes[0].triangles) {
      for (const auto& [a, b] : {std::pair{t.x, t.y}, {t.y, t.z}, {t.z, t.x}}) {
        RayPacket packet{};
        for (std::uint32_t i = 0; i < 4096; ++i, ++index) {
          const Vec2 u = sobol2(index, 1), v = sobol2(index, 2);
          const Point origin(world_from_local *
                             Vec4(1.8f * u.x - 0.9f, 1.8f * u.y - 0.9f, 1.8f * v.x - 0.9f, 1));
          Vec3 d = glm::normalize(glm::mix(corners[a], corners[b], v.y) - origin);
          for (int axis = 0; axis < 3; ++axis) {
            const std::uint32_t hash = hashCombine(index, static_cast<std::uint32_t>(axis));
            d[axis] *= 1.0f + 1e-7f * static_cast<float>(static_cast<int>(hash % 5) - 2);
          }
          escaped += !tracer.intersect({origin, d});
          escaped += !tracer.occluded({origin, d});
          const std::size_t lane = i % RayPacket::kSize;
          packet.origin_x[lane] = origin.x, packet.origin_y[lane] = origin.y,
          packet.origin_z[lane] = origin.z;
          packet.direction_x[lane] = d.x, packet.direction_y[lane] = d.y, packet.direction_z[lane] = d.z;
          packet.t_max[lane] = kInfinity;
          if (lane + 1 == RayPacket::kSize) {
            HitPacket hits;
            tracer.intersectPacket(packet, hits);
            escaped_in_packets += hits.hit != 0xffffu;
            escaped_in_packets += tracer.occludedPacket(packet) != 0xffffu;
          }
        }
      }
    }
    EXPECT_EQ(escaped, 0u);
    EXPECT_EQ(escaped_in_packets, 0u);
  }
}

// A ray that leaves any place of a surface, even at a grazing angle, does not hit that surface: near and far
// from the origin, at every size.
TEST(OffsetOrigin, LeavesTheSurface) {
  for (const float size : {1e-2f, 1.0f, 1e3f}) {
    for (const float distance : {0.0f, 10.0f, 1e4f}) {
      if (size < 1e-4f * distance) continue;  // finer than the coordinates can tell
      SCOPED_TRACE(testing::Message() << "size " << size << " at " << distance);
      scene::Scene scene;
      addMesh(scene, made::sphere(Point(distance, -distance, 0.5f * distance), size, 16, 32));
      addInstance(scene, 0);
      const Tracer tracer(scene);
      const scene::Mesh& mesh = scene.meshes[0];
      int hits = 0;
      for (std::uint32_t i = 0; i < 20000; ++i) {
        const UVec3& t = mesh.triangles[i % mesh.triangles.size()];
        Vec2 u = sobol2(i, 5);
        if (u.x + u.y > 1.0f) u = 1.0f - u;
        const Point a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const Normal n = glm::normalize(glm::cross(b - a, c - a));
        const Point p = (1 - u.x - u.y) * a + u.x * b + u.y * c;
        const Direction d = Frame::about(n).toWorld(squareToCosineHemisphere(sobol2(i, 6)));
        hits += tracer.occluded({offsetOrigin(p, n), d});
      }
      EXPECT_EQ(hits, 0);  // a convex body seen from its own surface
    }
  }
}

// A wall at x = 0 that a node moved there from hundreds of metres away: its points are right to some 1e-5,
// which is nothing beside their other coordinates, but much beside x.
TEST(OffsetOrigin, LeavesAWallThatANodeMoved) {
  scene::Mesh wall;
  addQuad(wall, {277.3f, -274.4f, -279.6f}, {0, 548.8f, 0}, {0, 0, 559.2f});
  const auto last = static_cast<std::uint32_t>(wall.triangles.size());
  for (const Vec3 to : {Vec3(-277.3f, 0, 0), Vec3(-277.3f, 274.4f, 279.6f)}) {
    scene::Scene scene;
    addInstance(scene, addMesh(scene, wall), glm::translate(Mat4(1.0f), to));
    const Tracer tracer(scene);
    int hits = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      Vec2 u = sobol2(i, 5);
      if (u.x + u.y > 1.0f) u = 1.0f - u;
      const scene::Hit place{0, i % last, u.x, u.y};
      const Normal n = scene::geometricNormal(scene, 0, place.triangle);
      const Direction d = Frame::about(n).toWorld(squareToCosineHemisphere(sobol2(i, 6)));
      hits += tracer.occluded({offsetOrigin(scene::worldPosition(scene, place), n), d, 1000.0f});
    }
    EXPECT_EQ(hits, 0);
  }
}

// Which side of a surface a ray meets is told for double-sided ones too, though they have no back face.
TEST(Tracer, PacketsTellTheSide) {
  for (const bool double_sided : {false, true}) {
    scene::Mesh quad;
    addQuad(quad, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});  // faces +z
    scene::Scene scene = sceneOf(std::move(quad));
    scene.materials[0].double_sided = double_sided;
    for (const float mirror : {1.0f, -1.0f}) {
      scene.instances[0].world_from_local = glm::scale(Mat4(1.0f), Vec3(mirror, 1, 1));
      const Tracer tracer(scene);
      RayPacket rays{};
      for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        rays.origin_z[i] = rays.direction_z[i] = i == 0 ? 1.0f : -1.0f;  // lane 0 from the front
        rays.direction_z[i] *= -1.0f;
        rays.t_max[i] = i < 2 ? kInfinity : -1.0f;
        rays.origin_x[i] = 0.3f, rays.origin_y[i] = 0.1f;
      }
      HitPacket hits;
      tracer.intersectPacket(rays, hits);
      EXPECT_EQ(hits.hit, 3u);
      EXPECT_EQ(hits.behind, 2u) << "mirror " << mirror;
      EXPECT_EQ(hits.back_face, double_sided ? 0u : 2u);
    }
  }
}

TEST(OffsetOrigin, MovesOffAlongTheNormal) {
  for (const Point p : {Point(0), Point(5, -7, 1000), Point(-1e-3f, 1e-3f, 40)}) {
    for (const Normal n : {Normal(0, 0, 1), Normal(0, 0, -1), glm::normalize(Normal(1, -2, 0.5f))}) {
      const Vec3 moved = offsetOrigin(p, n) - p;
      EXPECT_GT(glm::dot(moved, n), 0.0f);
      EXPECT_LT(glm::length(moved), 1e-4f * std::max(1.0f, glm::length(p)));
    }
  }
}

// Packets, single rays and both kinds of query are one tracer. Only rays within rounding of an edge may
// decide differently.
TEST(Tracer, PacketsAgreeWithSingleRays) {
  const scene::Scene scene = made::temple(20000);
  const Tracer tracer(scene);
  int rays_total = 0, different = 0;
  for (std::uint32_t block = 0; block < 400; ++block) {
    std::array<Ray, 13> rays;
    std::array<std::uint32_t, 13> seeds{};
    std::array<RayHit, 13> hits;
    std::array<bool, 13> blocked;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      const Vec2 u = sobol2(block, 1), v = sobol2(block * 13 + i, 2);
      rays[i] = {{18 * u.x - 9, 18 * u.y - 9, 2.0f}, squareToSphere(v), i % 3 ? kInfinity : 1.5f};
      if (i == 7) rays[i].t_max = -1.0f;
    }
    tracer.intersectPacket(rays, seeds, hits);
    tracer.occludedPacket(rays, seeds, blocked);
    RayPacket lanes{};
    std::fill(std::begin(lanes.t_max), std::end(lanes.t_max), -1.0f);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto& [origin, direction, t_max] = rays[i];
      lanes.origin_x[i] = origin.x, lanes.origin_y[i] = origin.y, lanes.origin_z[i] = origin.z;
      lanes.direction_x[i] = direction.x, lanes.direction_y[i] = direction.y;
      lanes.direction_z[i] = direction.z, lanes.t_max[i] = t_max;
    }
    HitPacket wide;
    tracer.intersectPacket(lanes, wide, Bundle::kWide);
    EXPECT_EQ((wide.hit >> 7) & 1u, 0u);
    EXPECT_FALSE(hits[7]);
    EXPECT_FALSE(blocked[7]);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (i == 7) continue;
      ++rays_total;
      const RayHit single = tracer.intersect(rays[i]);
      different += static_cast<bool>(single) != blocked[i] ||
                   single.where.instance != hits[i].where.instance ||
                   (single && std::abs(single.t - hits[i].t) > 1e-4f * single.t) ||
                   single.back_face != hits[i].back_face || tracer.occluded(rays[i]) != blocked[i];
      const bool met = ((wide.hit >> i) & 1u) != 0;
      different += met != static_cast<bool>(single) ||
                   (met && (wide.instance[i] != single.where.instance ||
                            std::abs(single.t - wide.t[i]) > 1e-4f * single.t ||
                            (((wide.back_face >> i) & 1u) != 0) != single.back_face));
    }
  }
  EXPECT_LE(different, rays_total / 1000);
}

// Mean over seeds is the opacity: 20000 independent decisions per value; a fair tracer fails once in 15000
// runs (4 sigma), and the seeds are fixed.
TEST(Alpha, BlendPassesRaysInProportion) {
  constexpr int kSeeds = 20000;
  for (const float opacity : {0.0f, 0.2f, 0.75f, 1.0f}) {
    scene::Scene scene;
    addBlend(scene, opacity);
    addInstance(scene, addMesh(scene, unitQuad()));
    const Tracer tracer(scene);
    int intersected = 0, occluded = 0, in_packets = 0, differences = 0;
    RayPacket packet{};
    for (int i = 0; i < kSeeds; ++i) {
      const auto seed = static_cast<std::uint32_t>(i);
      const bool hit = static_cast<bool>(tracer.intersect(kDown, seed));
      intersected += hit;
      occluded += tracer.occluded(kDown, seed);
      const auto lane = static_cast<std::size_t>(i) % RayPacket::kSize;
      packet.origin_x[lane] = kDown.origin.x, packet.origin_y[lane] = kDown.origin.y;
      packet.origin_z[lane] = kDown.origin.z, packet.direction_z[lane] = -1.0f;
      packet.t_max[lane] = kInfinity, packet.alpha_seed[lane] = seed;
      if (lane + 1 == RayPacket::kSize) {
        HitPacket hits;
        tracer.intersectPacket(packet, hits);
        in_packets += __builtin_popcount(hits.hit);
        differences += hits.hit != tracer.occludedPacket(packet);
        tracer.intersectPacket(packet, hits, Bundle::kWide);
        differences += hits.hit != tracer.occludedPacket(packet);
      }
    }
    EXPECT_EQ(intersected, occluded);
    EXPECT_EQ(intersected, in_packets);
    EXPECT_EQ(differences, 0);
    const double sigma = std::sqrt(static_cast<double>(opacity) * (1.0 - opacity) * kSeeds);
    EXPECT_NEAR(intersected, static_cast<double>(opacity) * kSeeds, 4.0 * sigma);
  }
}

TEST(Alpha, TransmissionPassesRaysUnlessTheyStopAtIt) {
  constexpr int kSeeds = 20000;
  scene::Scene scene;
  addMaterial(scene).transmission = 0.6f;
  addInstance(scene, addMesh(scene, unitQuad()));
  const Tracer passing(scene), stopping(scene, {.stop_at_transmission = true});
  int passed = 0, stopped = 0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    passed += !passing.occluded(kDown, seed);
    stopped += static_cast<bool>(stopping.intersect(kDown, seed));
  }
  EXPECT_NEAR(passed, 0.6 * kSeeds, 4.0 * std::sqrt(0.6 * 0.4 * kSeeds));
  EXPECT_EQ(stopped, kSeeds);
}

// Layers of glass are independent: three of them pass (1 - opacity)^3.
TEST(Alpha, LayersAreIndependent) {
  constexpr int kSeeds = 20000;
  scene::Scene scene;
  addBlend(scene, 0.4f);
  addMesh(scene, unitQuad());
  for (const float z : {0.0f, 0.5f, 1.0f}) addInstance(scene, 0, glm::translate(Mat4(1.0f), Vec3(0, 0, z)));
  const Tracer tracer(scene);
  int passed = 0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) passed += !tracer.occluded(kDown, seed);
  const double p = 0.6 * 0.6 * 0.6;
  EXPECT_NEAR(passed, p * kSeeds, 4.0 * std::sqrt(p * (1 - p) * kSeeds));
}

TEST(Alpha, MaskCutsTexturesAndTheNextSurfaceIsFound) {
  scene::Scene scene;
  // Two texels side by side: the left transparent, the right opaque.
  auto image = std::make_shared<image::Image8>();
  image->width = 2, image->height = 1, image->channels = 4;
  image->data = {255, 255, 255, 0, 255, 255, 255, 255};
  scene.textures.push_back({image, false, scene::Wrap::kClamp, scene::Wrap::kClamp});
  scene::Material& leaves = addMaterial(scene);
  leaves.base_colour_texture.texture = 0, leaves.alpha_mode = scene::AlphaMode::kMask;
  addMaterial(scene);
  scene::Mesh leaf = unitQuad();
  leaf.uv[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  addInstance(scene, addMesh(scene, leaf, 0), glm::translate(Mat4(1.0f), Vec3(0, 0, 1)));
  const std::uint32_t ground = addInstance(scene, addMesh(scene, unitQuad(), 1));
  const Tracer tracer(scene);
  const RayHit through = tracer.intersect({{0.1f, 0.5f, 2.0f}, {0, 0, -1}});
  const RayHit stopped = tracer.intersect({{0.9f, 0.5f, 2.0f}, {0, 0, -1}});
  EXPECT_EQ(through.where.instance, ground);
  EXPECT_FLOAT_EQ(through.t, 2.0f);
  EXPECT_EQ(stopped.where.instance, 0u);
  EXPECT_FALSE(tracer.occluded({{0.1f, 0.5f, 2.0f}, {0, 0, -1}, 1.5f}));
  EXPECT_TRUE(tracer.occluded({{0.9f, 0.5f, 2.0f}, {0, 0, -1}, 1.5f}));
}

// Coincident faces are the hard case: which of them is hit depends on the order in the structure, which must
// not depend on the number of threads that built it.
TEST(Tracer, HitsDoNotDependOnTheNumberOfThreads) {
  scene::Scene scene;
  scene::Mesh soup;
  for (std::uint32_t i = 0; i < 60000; ++i) {
    const Vec2 u = sobol2(i / 3, 1);  // three coincident quads at each place
    addQuad(soup, {10 * u.x, 10 * u.y, std::floor(4.0f * sobol2(i / 3, 2).x)}, {0.3f, 0, 0}, {0, 0.3f, 0});
  }
  addInstance(scene, addMesh(scene, std::move(soup)));
  std::vector<RayHit> hits[2];
  for (const int threads : {1, 0}) {
    const ThreadLimit limit(threads);
    const Tracer tracer(scene);
    for (std::uint32_t i = 0; i < 20000; ++i) {
      hits[threads == 0].push_back(tracer.intersect({Point(10.0f * sobol2(i, 7), 5.0f), {0, 0, -1}}));
    }
  }
  int different = 0;
  for (std::size_t i = 0; i < hits[0].size(); ++i) {
    different += hits[0][i].where.triangle != hits[1][i].where.triangle || hits[0][i].t != hits[1][i].t;
  }
  EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace relume::trace
