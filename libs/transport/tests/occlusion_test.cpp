// SPDX-License-Identifier: MIT
#include "relume/transport/occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "made_scenes.h"
#include "plain_occlusion.h"
#include "ray_frame.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"
#include "relume/core/progress.h"

namespace relume::transport {
namespace {

using Shape = DistanceWeight::Shape;

OcclusionResult solve(const scene::Scene& scene, const atlas::Texels& texels, const OcclusionOptions& options,
                      std::span<const std::uint32_t> which = {}) {
  SilentProgress silent;
  return solveOcclusion(trace::Tracer(scene), texels, options, silent, which);
}

scene::Scene wallScene(float d, float h) {
  scene::Mesh mesh;
  made::addQuad(mesh, {d, -2000, 0}, {0, 0, h}, {0, 4000, 0});  // faces -x, towards the origin
  return made::sceneOf(std::move(mesh));
}

TEST(DistanceWeight, IsExactAtZeroAndBeyondTheLimitAndConcaveBetween) {
  for (const Shape shape :
       {Shape::kExponential, Shape::kExponentialCut, Shape::kLinear, Shape::kSqrt, Shape::kStep}) {
    const DistanceWeight rho{shape, 0.7f, 2.5f};
    SCOPED_TRACE(static_cast<int>(shape));
    EXPECT_EQ(rho(0.0f), 0.0f);
    EXPECT_EQ(rho(2.5f), 1.0f);
    EXPECT_EQ(rho(1e30f), 1.0f);
    EXPECT_EQ(rho(kInfinity), 1.0f);
    float last = 0.0f, last_rise = kInfinity;
    for (int i = 1; i < 100; ++i) {
      const float value = rho(0.025f * static_cast<float>(i));
      EXPECT_GE(value, last);
      EXPECT_LE(value, 1.0f);
      EXPECT_LE(value - last, last_rise + 1e-6f);
      last_rise = value - last, last = value;
    }
  }
  const DistanceWeight endless{Shape::kExponential, 0.7f, kInfinity};
  EXPECT_EQ(endless(0.0f), 0.0f);
  EXPECT_NEAR(endless(0.7f), 1.0 - std::exp(-1.0), 1e-6);
  EXPECT_EQ(endless(kInfinity), 1.0f);
  EXPECT_NEAR(endless(1e-7f), 1e-7f / 0.7f, 1e-12f);  // no cancellation near a contact
}

TEST(RayFrame, FollowsTheShadingNormalOnTheGeometricSide) {
  const Normal geometric(0, 0, 1), leaning = glm::normalize(Normal(1, 0, 2));
  EXPECT_EQ(RayFrame(leaning, geometric).shading.n, leaning);
  EXPECT_EQ(RayFrame(-leaning, geometric).shading.n, geometric);
  EXPECT_TRUE(RayFrame::above({0, 0, 1}, geometric));
  EXPECT_FALSE(RayFrame::above({1, 0, 0}, geometric));
  EXPECT_FALSE(RayFrame::above(glm::normalize(Vec3(1, 0, -0.1f)), geometric));
}

// A ball of 48 faces, shaded smoothly: no face may see the ball, whatever the lean of the normals.
TEST(SolveOcclusion, SmoothConvexBodyIsUnoccluded) {
  scene::Mesh mesh;
  made::addSphere(mesh, {3, -2, 5}, 1.5f, 4, 6);
  const scene::Scene scene = made::sceneOf(mesh);
  atlas::Texels texels = made::repeatedPoint(static_cast<int>(mesh.triangles.size()) * 3, {});
  for (std::size_t i = 0; i < texels.points.size(); ++i) {
    atlas::SurfacePoint& point = texels.points[i];
    point.triangle = static_cast<std::uint32_t>(i / 3);
    const Vec3 weights[3] = {{0.9f, 0.05f, 0.05f}, {0.05f, 0.9f, 0.05f}, {0.4f, 0.3f, 0.3f}};
    const Vec3 b = weights[i % 3];
    const scene::Hit hit{0, point.triangle, b.y, b.z};
    point.position = scene::worldPosition(scene, hit);
    point.geometric_normal = scene::geometricNormal(scene, 0, point.triangle);
    point.shading_normal = scene::shadingNormal(scene, hit);
    ASSERT_LT(glm::dot(point.geometric_normal, point.shading_normal), 0.9999f);
  }
  OcclusionOptions options;
  const OcclusionResult result = solve(scene, texels, options);
  for (const Vec3& value : result.value) EXPECT_EQ(value, Vec3(1.0f));
  EXPECT_LT(result.rays, 256u * texels.points.size());  // those below the faces were not traced
}

// The fast path against one plain ray at a time, on a scene with everything in it. Both are estimates: their
// difference is within 5 of its standard errors, which one texel in a million would miss were the errors
// exact and normal.
TEST(SolveOcclusion, AgreesWithThePlainEstimator) {
  scene::Scene scene = made::room();
  made::addMaterial(scene, {0.9f, 0.4f, 0.1f});
  made::addMaterial(scene, {0.2f, 0.3f, 0.9f}).double_sided = true;
  scene::Mesh red, veil;
  made::addQuad(red, {-0.2f, -1.5f, 0.3f}, {0, 1, 0}, {0, 0.4f, 1});
  made::addQuad(veil, {-1.5f, -1.5f, 1}, {1, 0, 0.2f}, {0, 1, 0});
  made::addInstance(scene, red, 1), made::addInstance(scene, veil, 2);
  const trace::Tracer tracer(scene);
  const atlas::Texels texels = made::texelGrid(9, 7, {-1.9f, -1.9f, 0}, {0.19f, 0, 0}, {0, 0.2f, 0});
  SilentProgress silent;
  for (const OcclusionKind kind : {OcclusionKind::kScalar, OcclusionKind::kSpectral}) {
    for (const Shape shape : {Shape::kStep, Shape::kExponential, Shape::kSqrt}) {
      OcclusionOptions options;
      options.kind = kind;
      options.weight = {shape, 1.0f, 3.0f};
      options.mean_albedo = Albedo(Vec3(0.5f, 0.4f, 0.3f));
      options.max_samples = 1024;
      const OcclusionResult fast = solveOcclusion(tracer, texels, options, silent);
      for (std::size_t i = 0; i < texels.points.size(); ++i) {
        const plain::Estimate slow =
            plain::occlusion(tracer, texels.points[i], options, 1024, static_cast<std::uint32_t>(i));
        const float mean = (fast.value[i].x + fast.value[i].y + fast.value[i].z) / 3.0f;
        const float expected = (slow.value.x + slow.value.y + slow.value.z) / 3.0f;
        EXPECT_NEAR(mean, expected, 5.0f * std::sqrt(2.0f) * fast.error[i]) << "texel " << i;
        if (shape != Shape::kStep || kind == OcclusionKind::kSpectral) {
          EXPECT_NEAR(fast.back_share[i], slow.back_share, 0.03f);
        }
      }
    }
  }
}

TEST(SolveOcclusion, BitsDoNotDependOnThreadsOrOnTheSelection) {
  scene::Scene scene = made::temple(8000);
  made::addMaterial(scene).alpha_mode = scene::AlphaMode::kBlend;
  scene.materials.back().base_colour.a = 0.4f;
  scene::Mesh veil;
  made::addQuad(veil, {-3, -3, 1}, {6, 0, 0}, {0, 6, 0});
  made::addInstance(scene, std::move(veil), 1);
  atlas::Texels texels = made::texelGrid(50, 37, {-5, -3, 0}, {0.2f, 0.02f, 0}, {0, 0.2f, 0});
  std::erase_if(texels.points, [](const atlas::SurfacePoint& p) { return p.texel % 7 == 3; });
  for (atlas::SurfacePoint& p : texels.points) p.chart = p.texel % 50 < 21 ? 0 : 1;
  std::vector<std::uint32_t> which;
  for (std::uint32_t i = 5; i < texels.points.size(); i += 11 + i % 5)
    which.push_back((i * 7919u) % texels.points.size());
  for (const Shape shape : {Shape::kStep, Shape::kExponential}) {
    for (const float target : {0.0f, 0.02f}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(shape) << " target " << target);
      OcclusionOptions options;
      options.weight = {shape, 1.0f, 4.0f};
      options.bent_normal = true;
      options.min_samples = 16, options.max_samples = 128, options.target_error = target;
      OcclusionResult one;
      {
        const ThreadLimit limit(1);
        one = solve(scene, texels, options);
      }
      const OcclusionResult many = solve(scene, texels, options);
      EXPECT_EQ(one.value, many.value);
      EXPECT_EQ(one.bent, many.bent);
      EXPECT_EQ(one.error, many.error);
      EXPECT_EQ(one.back_share, many.back_share);
      EXPECT_EQ(one.rays, many.rays);
      const OcclusionResult some = solve(scene, texels, options, which);
      ASSERT_EQ(some.value.size(), which.size());
      for (std::size_t i = 0; i < which.size(); ++i) {
        EXPECT_EQ(some.value[i], one.value[which[i]]);
        EXPECT_EQ(some.bent[i], one.bent[which[i]]);
        EXPECT_EQ(some.error[i], one.error[which[i]]);
        EXPECT_EQ(some.back_share[i], one.back_share[which[i]]);
      }
    }
  }
}

TEST(SolveOcclusion, AdvancesProgressByOneForEveryResult) {
  struct Counter : SilentProgress {
    void advance(std::uint64_t items) override { done += items; }
    std::atomic<std::uint64_t> done{0};
  } counter;
  const scene::Scene scene = wallScene(1, 1);
  const trace::Tracer tracer(scene);
  const atlas::Texels texels = made::texelGrid(9, 7, {-1.9f, -1.9f, 0}, {0.19f, 0, 0}, {0, 0.2f, 0});
  solveOcclusion(tracer, texels, {}, counter);
  EXPECT_EQ(counter.done, 63u);
  solveOcclusion(tracer, texels, {}, counter, std::array<std::uint32_t, 3>{0, 5, 40});
  EXPECT_EQ(counter.done, 66u);
  counter.cancel();
  EXPECT_THROW(solveOcclusion(tracer, texels, {}, counter), Error);
}

TEST(SolveOcclusion, SeedsAndTexelsAreIndependent) {
  const scene::Scene scene = wallScene(0.5f, 2.0f);
  const atlas::Texels texels = made::repeatedPoint(16, {});
  OcclusionOptions options;
  options.max_samples = 64;
  const OcclusionResult a = solve(scene, texels, options);
  options.seed = 2;
  const OcclusionResult b = solve(scene, texels, options);
  EXPECT_NE(a.value, b.value);
  EXPECT_TRUE(std::any_of(a.value.begin(), a.value.end(), [&](Vec3 v) { return v != a.value[0]; }));
}

// What lies beyond the limit does not exist: not one bit changes.
TEST(SolveOcclusion, NothingBeyondTheLimitMatters) {
  scene::Scene scene = wallScene(0.5f, 2.0f);
  const atlas::Texels texels = made::texelGrid(8, 8, {-0.4f, -0.4f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0});
  OcclusionOptions options;
  for (const Shape shape : {Shape::kStep, Shape::kExponential}) {
    options.weight = {shape, 1.0f, 3.0f};
    const OcclusionResult without = solve(scene, texels, options);
    scene::Scene more = scene;
    scene::Mesh roof;
    made::addQuad(roof, {-100, -100, 3.01f}, {0, 200, 0}, {200, 0, 0});
    made::addInstance(more, std::move(roof));
    const OcclusionResult with = solve(more, texels, options);
    EXPECT_EQ(without.value, with.value);
    EXPECT_EQ(without.back_share, with.back_share);
  }
}

TEST(SolveOcclusion,
     ContactIsBlack) {  // rho(0) = 0: a lid that lies on the floor leaves nothing of any weight
  scene::Mesh lid;
  made::addQuad(lid, {-1, -1, 1e-3f}, {0, 2, 0}, {2, 0, 0});
  const scene::Scene scene = made::sceneOf(std::move(lid));
  OcclusionOptions options;
  for (const Shape shape : {Shape::kExponential, Shape::kExponentialCut, Shape::kLinear, Shape::kStep}) {
    options.weight = {shape, 1.0f, 4.0f};
    EXPECT_LT(solve(scene, made::repeatedPoint(4, {}), options).value[0].x, 0.01f);
  }
}

TEST(SolveOcclusion, BuriedTexelsAreFound) {
  scene::Mesh box;
  made::addBox(box, {-1, -1, -0.5f}, {1, 1, 1});
  const scene::Scene scene = made::sceneOf(std::move(box));
  atlas::Texels texels = made::texelGrid(16, 4, {-4, -0.2f, 0}, {0.5f, 0, 0}, {0, 0.1f, 0});
  for (const Shape shape : {Shape::kStep, Shape::kExponential}) {
    OcclusionOptions options;
    options.weight.shape = shape;
    const OcclusionResult result = solve(scene, texels, options);
    for (std::size_t i = 0; i < texels.points.size(); ++i) {
      const float x = texels.points[i].position.x;
      EXPECT_EQ(result.back_share[i], std::abs(x) < 1.0f ? 1.0f : 0.0f) << x;
    }
  }
}

TEST(SolveOcclusion, HalfBuriedTexelsAreFound) {
  scene::Mesh box;
  made::addBox(box, {0, -4, -0.5f}, {2, 4, 1});
  const scene::Scene scene = made::sceneOf(std::move(box));
  for (const float buried : {0.1f, 0.4f, 0.7f}) {  // so much of each texel lies in the box
    const atlas::Texels texels =
        made::texelGrid(4, 16, {buried - 0.5f, -0.7f, 0}, {0, 0.01f, 0}, {0, 0.1f, 0});
    atlas::Texels wide = texels;
    for (atlas::SurfacePoint& p : wide.points) p.dp_dx = {1, 0, 0}, p.dp_dy = {0, 0.05f, 0};
    for (const Shape shape : {Shape::kStep, Shape::kExponential}) {
      OcclusionOptions options;
      options.weight.shape = shape;
      const OcclusionResult result = solve(scene, wide, options);
      // 32 stratified rays of each texel when any hit will do; blocked rays below a quarter are not asked.
      const float tolerance = shape == Shape::kStep ? 0.15f : 0.05f;
      for (const float share : result.back_share) EXPECT_NEAR(share, buried, tolerance);
    }
  }
}

TEST(SolveOcclusion, FrontFacesAreNotTakenForBackFaces) {
  const scene::Scene scene = made::room();  // a floor texel in the corner sees front faces only
  OcclusionOptions options;
  const OcclusionResult result =
      solve(scene, made::texelGrid(4, 4, {-1.9f, 1.2f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}), options);
  for (const float share : result.back_share) EXPECT_EQ(share, 0.0f);
  for (const Vec3& v : result.value) EXPECT_LT(v.x, 0.5f);
}

TEST(SolveOcclusion, BackFacesAreBlackUnlessDoubleSided) {
  for (const bool double_sided : {false, true}) {
    scene::Scene scene;
    made::addMaterial(scene, {0.6f, 0.3f, 0.0f}).double_sided = double_sided;
    scene::Mesh ceiling;
    made::addQuad(ceiling, {-2000, -2000, 1}, {4000, 0, 0}, {0, 4000, 0});  // faces up: seen from behind
    made::addInstance(scene, std::move(ceiling));
    OcclusionOptions options;
    options.kind = OcclusionKind::kSpectral;
    options.weight = {Shape::kLinear, 1.0f, 1e9f};
    options.weight.shape = Shape::kSqrt;
    options.weight.limit = 3000.0f;
    options.mean_albedo = Albedo(Vec3(0.3f, 0.3f, 0.0f));
    const OcclusionResult result = solve(scene, made::repeatedPoint(1, {}), options);
    EXPECT_EQ(result.back_share[0], double_sided ? 0.0f : 1.0f);
    if (double_sided) {
      EXPECT_GT(result.value[0].x, 0.0f);
      EXPECT_NEAR(result.value[0].x, 2.0f * result.value[0].y, 1e-5f);
    } else {
      EXPECT_EQ(result.value[0].x, 0.0f);
    }
    EXPECT_EQ(result.value[0].z, 0.0f);  // 0/0
  }
}

// Under a veil of opacity 0.3 that covers the sky, k_A = 0.7: 16 texels of 1024 rays, each ray an independent
// decision: 4 sigma.
TEST(SolveOcclusion, BlendedSurfacesBlockTheirShare) {
  scene::Scene scene;
  scene::Material& veil = made::addMaterial(scene);
  veil.base_colour.a = 0.3f, veil.alpha_mode = scene::AlphaMode::kBlend;
  scene::Mesh mesh;
  made::addQuad(mesh, {-2000, -2000, 0.1f}, {0, 4000, 0}, {4000, 0, 0});
  made::addInstance(scene, std::move(mesh));
  OcclusionOptions options;
  options.max_samples = 1024;
  const OcclusionResult result = solve(scene, made::repeatedPoint(16, {}), options);
  double mean = 0;
  for (const Vec3& v : result.value) mean += v.x / 16.0;
  EXPECT_NEAR(mean, 0.7, 4.0 * std::sqrt(0.3 * 0.7 / 16384));
}

TEST(SolveOcclusion, BentNormalIsTheShadingNormalWhereNothingIsOpen) {
  scene::Mesh box;
  made::addBox(box, {-1, -1, -1}, {1, 1, 1});
  const scene::Scene scene = made::sceneOf(std::move(box));
  atlas::Texels texels = made::repeatedPoint(1, {});
  texels.points[0].shading_normal = glm::normalize(Vec3(0.2f, 0, 1));
  OcclusionOptions options;
  options.bent_normal = true;
  const OcclusionResult result = solve(scene, texels, options);
  EXPECT_EQ(result.value[0].x, 0.0f);
  EXPECT_EQ(result.bent[0], texels.points[0].shading_normal);
}

TEST(SolveOcclusion, UnevenFootprintsUseTheirSubSamples) {
  // Two sub-samples of a texel, one under a lid, one in the open: the mean of both.
  scene::Mesh floor, lid;
  made::addQuad(floor, {-10, -10, 0}, {20, 0, 0}, {0, 20, 0});
  made::addQuad(lid, {-2, -2, 0.01f}, {0, 4, 0}, {4, 0, 0});
  scene::Scene scene;
  made::addInstance(scene, std::move(floor)), made::addInstance(scene, std::move(lid));
  atlas::Texels texels = made::repeatedPoint(4, {0, 0, 0});
  texels.samples = {{{0, 0, 0}, 0}, {{8, 0, 0}, 0}};
  for (atlas::SurfacePoint& p : texels.points) p.first_sample = 0, p.sample_count = 2;
  OcclusionOptions options;
  const OcclusionResult result = solve(scene, texels, options);
  for (const Vec3& v : result.value) EXPECT_NEAR(v.x, 0.5f, 0.01f);
}

// A chart may go round an edge inside a texel. Nothing shades a convex body, so neither face may see the
// other's inside; a ray with one face's hemisphere and origin on the other would start into the body.
TEST(SolveOcclusion, FoldsOfAConvexBodyAreUnoccluded) {
  scene::Mesh box;
  made::addBox(box, {-1, -1, -1}, {1, 1, 1});
  const scene::Scene scene = made::sceneOf(std::move(box));
  constexpr std::uint32_t kRight = 2, kTop = 10;  // triangles facing +x, +z
  ASSERT_EQ(scene::geometricNormal(scene, 0, kRight), Normal(1, 0, 0));
  ASSERT_EQ(scene::geometricNormal(scene, 0, kTop), Normal(0, 0, 1));
  atlas::Texels texels = made::repeatedPoint(4, {0.98f, 0, 1});
  texels.samples = {{{0.98f, 0, 1}, kTop}, {{1, 0, 0.98f}, kRight}};
  for (atlas::SurfacePoint& p : texels.points) p.triangle = kTop, p.first_sample = 0, p.sample_count = 2;
  const OcclusionResult result = solve(scene, texels, {});
  for (const Vec3& v : result.value) EXPECT_EQ(v, Vec3(1.0f));
}

// The same where two faces meet in a corner: an endless wall takes half of the hemisphere, weighted by the
// cosine, from a floor beside it.
TEST(SolveOcclusion, FoldsOfACornerAreTheMeanOfBothFaces) {
  scene::Mesh corner;
  made::addQuad(corner, {0, -1000, 0}, {1000, 0, 0}, {0, 2000, 0});
  made::addQuad(corner, {0, -1000, 0}, {0, 2000, 0}, {0, 0, 1000});
  const scene::Scene scene = made::sceneOf(std::move(corner));
  ASSERT_EQ(scene::geometricNormal(scene, 0, 2), Normal(1, 0, 0));
  atlas::Texels texels = made::repeatedPoint(4, {0.01f, 0, 0});
  texels.samples = {{{0.01f, 0, 0}, 0}, {{0, 0, 0.01f}, 2}};
  for (atlas::SurfacePoint& p : texels.points) p.first_sample = 0, p.sample_count = 2;
  const OcclusionResult result = solve(scene, texels, {});
  for (const Vec3& v : result.value) EXPECT_NEAR(v.x, 0.5f, 0.02f);
}

TEST(SolveOcclusion, TexelsThatHaveConvergedStop) {
  const scene::Scene scene = wallScene(1.0f, 1.0f);
  // From beside the wall to 60 m away, where there is nothing left to see.
  const atlas::Texels texels = made::texelGrid(64, 4, {0.9f, 0, 0}, {-1, 0, 0}, {0, 1, 0});
  OcclusionOptions options;
  options.min_samples = 64, options.max_samples = 4096, options.target_error = 0.005f;
  const OcclusionResult result = solve(scene, texels, options);
  for (const float e : result.error) EXPECT_LT(e, options.target_error);
  EXPECT_LT(result.rays, 512u * texels.points.size());
  EXPECT_GT(result.rays, 64u * texels.points.size());
  options.max_samples = 128;  // not enough for all: they end there
  const OcclusionResult capped = solve(scene, texels, options);
  EXPECT_LE(capped.rays, 128u * texels.points.size());
}

TEST(SolveOcclusion, EmptySceneIsOpen) {
  const scene::Scene scene;
  const OcclusionResult result = solve(scene, made::texelGrid(3, 5, {}, {1, 0, 0}, {0, 1, 0}), {});
  ASSERT_EQ(result.value.size(), 15u);
  for (const Vec3& v : result.value) EXPECT_EQ(v, Vec3(1.0f));
  EXPECT_TRUE(solve(scene, {}, {}).value.empty());
}

TEST(MeanAlbedo, IsWeightedByArea) {
  atlas::Texels texels = made::repeatedPoint(2, {});
  texels.points[0].area = 3, texels.points[0].albedo = Albedo(Vec3(1, 0, 0.5f));
  texels.points[1].area = 1, texels.points[1].albedo = Albedo(Vec3(0, 1, 0.5f));
  EXPECT_EQ(meanAlbedo(texels), Albedo(Vec3(0.75f, 0.25f, 0.5f)));
  EXPECT_EQ(meanAlbedo({}), Albedo());
}

}  // namespace
}  // namespace relume::transport
