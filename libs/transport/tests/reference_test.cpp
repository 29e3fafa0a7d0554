// SPDX-License-Identifier: MIT
// The reference against closed forms and against itself. Expected values: closed forms are in comments; those
// of the 2 m room are a converged radiosity solution (empty; error below 0.2 %) and path tracing with 18
// million paths by another program (with a block; standard error below 0.05 %). A statistical comparison
// allows 6 of the estimate's own standard errors (16 runs, so Student's t with 15 degrees of freedom: a false
// alarm in 40,000 per value) and the tolerance of the expected value. Seeds are fixed.
#include "relume/transport/reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "made_rooms.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"
#include "relume/transport/bsdf.h"

namespace relume::transport {
namespace {

constexpr double kSigmas = 6;

Receiver receiver(Point p, Normal n) { return {p, n, n}; }

ReferenceIrradiance solve(const scene::Scene& scene, std::vector<Receiver> receivers,
                          const ReferenceOptions& options) {
  SilentProgress silent;
  return Reference(scene).irradiance(receivers, options, silent);
}

void expectE(const ReferenceIrradiance& result, std::size_t i, glm::dvec3 expected, double tolerance,
             const char* what = "") {
  EXPECT_LE(result.error[i].rgb.r, 0.01 * expected.r) << what << " point " << i << " is too noisy to tell";
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(result.value[i].rgb[c], expected[c],
                kSigmas * result.error[i].rgb[c] + tolerance * expected[c])
        << what << " point " << i << " channel " << c;
}

trace::Ray along(Point from, Point to) { return {from, glm::normalize(to - from)}; }

/// Mean radiance of one ray, as a 4 x 4 picture all of whose pixels are that ray, and its standard error.
struct Seen {
  glm::dvec3 mean{0};
  double error = 0;
};
Seen look(const scene::Scene& scene, trace::Ray ray, ReferenceOptions options) {
  SilentProgress silent;
  const ReferenceImage image = Reference(scene).image(
      4, 4, [&](Vec2) { return ray; }, options, silent);
  Seen seen;
  for (std::size_t i = 0; i < 16; ++i) {
    seen.mean += glm::dvec3(image.radiance.data[3 * i], image.radiance.data[3 * i + 1],
                            image.radiance.data[3 * i + 2]) /
                 16.0;
    seen.error += image.error.data[i] * image.error.data[i] / 256.0;
  }
  seen.error = std::sqrt(seen.error);
  return seen;
}

TEST(Reference, APointLightIsExact) {
  scene::Scene scene = made::floor();
  Light& light = scene.lights.emplace_back();
  light.position = {1, 1.5f, 2}, light.intensity = 50;
  ReferenceOptions options{.samples = 16, .max_bounces = 0};
  const auto e = solve(scene, {receiver({0.3f, -0.2f, 0}, {0, 0, 1})}, options);
  EXPECT_NEAR(e.value[0].rgb.r, 4.987873806451968, 1e-5);
  EXPECT_EQ(e.samples, 16u);
}

TEST(Reference, LambertsFormulaWithAndWithoutAShade) {
  scene::Scene scene = made::floor();
  made::addRoomFace(scene, Vec3(0), {-0.5f, -0.5f, 2}, {0, 1, 0}, {1, 0, 0}, Vec3(12));
  const std::vector<Receiver> points = {receiver({0, 0, 0}, {0, 0, 1}), receiver({1.5f, 0.3f, 0}, {0, 0, 1}),
                                        receiver({0.2f, -2.5f, 0}, {0, 0, 1}),
                                        receiver({0, 0, 1.7f}, {0, 0, 1})};
  const double exact[] = {2.7700415727620493, 1.1984836672291261, 0.46523697850323253, 29.17512149265842};
  for (const Estimator estimator : {Estimator::kMis, Estimator::kLightOnly, Estimator::kBsdfOnly}) {
    const auto e = solve(scene, points,
                         {.samples = estimator == Estimator::kBsdfOnly ? 1u << 18 : 1u << 12,
                          .estimator = estimator,
                          .part = Part::kDirect});
    for (std::size_t i = 0; i < points.size(); ++i) expectE(e, i, glm::dvec3(exact[i]), 1e-4);
    if (estimator == Estimator::kMis) {
      EXPECT_LT(e.error[0].rgb.r, 0.002f * e.value[0].rgb.r);
    }
  }
  // A half-plane at height 0.8 that ends at x = 0.03: 1.1690964628341654.
  made::addRoomFace(scene, Vec3(0), {-200, -200, 0.8f}, {200.03f, 0, 0}, {0, 400, 0});
  const auto shaded = solve(scene, {points[0]}, {.samples = 16384, .part = Part::kDirect});
  expectE(shaded, 0, glm::dvec3(1.1690964628341654), 2e-4);
}

TEST(Reference, AFurnaceAndItsBounces) {
  // Exitance 2, reflectance 0.75: E = B = 2 / (1 - 0.75) = 8; after k bounces 8 (1 - 0.75^(k + 1)).
  const scene::Scene scene = made::box({4, 3, 2.5f}, Vec3(0.75f), Vec3(2 / kPi));
  const std::vector<Receiver> points = {receiver({1, 1, 0}, {0, 0, 1}),
                                        receiver({4, 0.2f, 2.3f}, {-1, 0, 0})};
  for (const int bounces : {0, 1, 2, 7, ReferenceOptions::kUnlimited}) {
    const auto e =
        solve(scene, points, {.samples = 16384, .max_bounces = bounces, .materials = Materials::kLambert});
    const double exact = bounces < 0 ? 8 : 8 * (1 - std::pow(0.75, bounces + 1));
    for (std::size_t i = 0; i < points.size(); ++i) expectE(e, i, glm::dvec3(exact), 1e-4);
  }
}

TEST(Reference, AnIntegratingSphere) {
  // Direct by the inverse square; bounce k gives rho^k I / R^2 everywhere: 1.5, 0.9 ..., together 3.75.
  scene::Scene scene = made::cavity(2, 0, Vec3(0.6f));
  Light& light = scene.lights.emplace_back();
  light.position = {0.5f, 0, 0.8f}, light.intensity = 10;
  const std::vector<Receiver> points = {receiver({1.999f, 0, 0}, {-1, 0, 0})};
  ReferenceOptions options{.samples = 64, .materials = Materials::kLambert, .part = Part::kDirect};
  expectE(solve(scene, points, options), 0, glm::dvec3(3.0531243639324246), 2e-3);
  options.samples = 32768, options.part = Part::kIndirect;
  expectE(solve(scene, points, options), 0, glm::dvec3(3.75), 3e-3);
  options.max_bounces = 1;
  expectE(solve(scene, points, options), 0, glm::dvec3(1.5), 3e-3);
}

TEST(Reference, ACavityUnderASky) {
  // Open to the share f = 0.3 of its sphere: E = pi f / (1 - rho (1 - f)) everywhere.
  scene::Scene scene = made::cavity(1, std::acos(0.4f), {0.8f, 0.5f, 0.2f});
  scene.environment.radiance = Radiance(1.0f);
  const float t = 2.5f;
  const Vec3 d(std::sin(t), 0, std::cos(t));
  for (const Estimator estimator : {Estimator::kMis, Estimator::kBsdfOnly, Estimator::kLightOnly})
    expectE(solve(scene, {receiver(0.999f * d, -d)},
                  {.samples = 16384, .estimator = estimator, .materials = Materials::kLambert}),
            0, {2.1419949910839495, 1.449965840118366, 1.095904414042951}, 3e-3);
}

TEST(Reference, TheColouredRoomAgreesWithRadiosity) {
  const scene::Scene room = made::colouredRoom(false);
  std::vector<Receiver> points;
  for (const made::RoomCase& c : made::kColouredRoom) points.push_back(receiver(c.p, c.n));
  ReferenceOptions options{.samples = 8192, .materials = Materials::kLambert};
  const auto total = solve(room, points, options);
  options.part = Part::kDirect;
  const auto direct = solve(room, points, options);
  options.part = Part::kIndirect;
  const auto indirect = solve(room, points, options);
  for (std::size_t i = 0; i < points.size(); ++i) {
    expectE(total, i, made::kColouredRoom[i].total, 2e-3, "total");
    expectE(direct, i, made::kColouredRoom[i].direct, 1e-4, "direct");
    expectE(indirect, i, made::kColouredRoom[i].total - made::kColouredRoom[i].direct, 5e-3, "indirect");
    EXPECT_LT(total.error[i].rgb.g, 0.01f * total.value[i].rgb.g);
  }
}

TEST(Reference, TheRoomWithABlockAgreesWithAnotherPathTracer) {
  const auto e = solve(made::colouredRoom(true),
                       {receiver({1.3f, 0.9f, 0}, {0, 0, 1}), receiver({0.2f, 1.3f, 0}, {0, 0, 1}),
                        receiver({0.6f, 2, 0.6f}, {0, -1, 0}), receiver({0.65f, 1.3f, 1.2f}, {0, 0, 1})},
                       {.samples = 16384, .materials = Materials::kLambert});
  expectE(e, 0, {1.63762720, 1.17615725, 0.32760439}, 1e-3);
  expectE(e, 1, {0.49434045, 0.11661503, 0.03026759}, 2e-3);
  expectE(e, 2, {0.74623925, 0.43226462, 0.11147470}, 2e-3);
  expectE(e, 3, {4.44208196, 2.95670403, 0.95071046}, 1e-3);
}

TEST(Reference, EstimatorsAgreeOnGlossySurfaces) {
  scene::Scene scene = made::colouredRoom(true);
  for (scene::Material& m : scene.materials) m.roughness = 0.6f;
  scene.materials.back().metallic = 1, scene.materials.back().roughness = 0.4f;
  scene.materials[4].roughness = 0.3f;
  const trace::Ray rays[] = {along({1, 0.1f, 1}, {0.65f, 1, 0.5f}), along({1, 0.1f, 1}, {1.2f, 1.5f, 0})};
  for (const trace::Ray& ray : rays) {
    const Seen mis = look(scene, ray, {.samples = 2048}),
               bsdf = look(scene, ray, {.samples = 8192, .estimator = Estimator::kBsdfOnly}),
               light = look(scene, ray, {.samples = 8192, .estimator = Estimator::kLightOnly});
    EXPECT_GT(mis.mean.r, 0.05);
    // 64 runs each: normal, 6 standard errors of the difference of luminances.
    const auto differ = [](const Seen& a, const Seen& b) {
      return std::abs(luminance(Vec3(a.mean)) - luminance(Vec3(b.mean))) / std::hypot(a.error, b.error);
    };
    EXPECT_LT(differ(mis, bsdf), kSigmas);
    EXPECT_LT(differ(mis, light), kSigmas);
    EXPECT_LT(mis.error, bsdf.error);
  }
}

TEST(Reference, AWhiteMetalUnderAWhiteSkyCannotBeSeen) {
  for (const float roughness : {0.0f, 0.15f, 0.5f, 1.0f}) {
    scene::Scene scene = made::floor(0);
    scene.materials[0].metallic = 1, scene.materials[0].roughness = roughness;
    scene.environment.radiance = Radiance(1.0f);
    for (const Point eye : {Point(0, 0, 3), Point(4, 0, 1)}) {
      const Seen seen = look(scene, along(eye, Point(0)), {.samples = 512});
      EXPECT_NEAR(seen.mean.r, 1, 0.01 + kSigmas * seen.error) << roughness;
    }
  }
}

TEST(Reference, ARoomOfMirrorsKeepsItsEnergy) {
  // Walls of white metal, one of which emits: no light is lost, so every bounce adds as much as the first on
  // the whole; limited to k bounces the mean of E over the walls is k + 1 times the direct one.
  scene::Scene scene = made::box(Vec3(2), Vec3(1), Vec3(0));
  for (scene::Material& m : scene.materials) m.metallic = 1, m.roughness = 0.3f;
  scene.materials[5].emission = Vec3(1);
  std::vector<Receiver> points;
  constexpr std::uint32_t kPoints = 512;
  const Vec3 corner[6] = {{0, 0, 0}, {2, 0, 0}, {0, 0, 0}, {0, 2, 0}, {0, 0, 0}, {0, 0, 2}};
  const Normal normal[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int face = 0; face < 6; ++face)
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      const Vec2 u = 2.0f * sobol2(i, 3);
      const int axis = face / 2;
      Point p = corner[face];
      p[(axis + 1) % 3] += u.x, p[(axis + 2) % 3] += u.y;
      points.push_back(receiver(p, normal[face]));
    }
  for (const int bounces : {0, 3}) {
    const auto e = solve(scene, points, {.samples = 32, .max_bounces = bounces});
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      sum += e.value[i].rgb.r, squares += e.error[i].rgb.r * e.error[i].rgb.r;
    // Power pi L A of one face of six; the compensated lobe is right to half a percent a bounce.
    const double exact = (bounces + 1) * M_PI / 6, count = static_cast<double>(points.size());
    EXPECT_NEAR(sum / count, exact, kSigmas * std::sqrt(squares) / count + (0.003 + 0.005 * bounces) * exact);
  }
}

TEST(Reference, PanesTintAndDim) {
  scene::Scene scene = made::floor(-1);
  Light& light = scene.lights.emplace_back();
  light.position = {0.4f, 0.2f, 2}, light.intensity = 8;
  const std::vector<Receiver> points = {receiver({0.4f, 0.2f, 0}, {0, 0, 1})};
  const std::size_t pane = scene.materials.size();
  made::addRoomFace(scene, {0.5f, 1, 1}, {-9, -9, 1}, {18, 0, 0}, {0, 18, 0});
  scene.materials[pane].transmission = 0.75f, scene.materials[pane].roughness = 0.2f;
  ReferenceOptions options{.samples = 256, .part = Part::kDirect};
  scene::Surface glass;
  glass.base_colour = {0.5f, 1, 1, 1}, glass.metallic = 0, glass.roughness = 0.2f;
  const Vec3 passes = Bsdf::metallicRoughness({0, 0, 1}, glass, 0.75f, {0, 0, 1}).transmittance();
  expectE(solve(scene, points, options), 0, glm::dvec3(2.0f * passes), 1e-4);
  options.materials = Materials::kLambert;
  expectE(solve(scene, points, options), 0, 2.0 * 0.75 * glm::dvec3(0.5, 1, 1), 1e-4);
  // Light found by chance passes like light that is sampled.
  scene.lights.clear();
  scene.environment.radiance = Radiance(1.0f);
  options.materials = Materials::kFull, options.samples = 8192;
  options.estimator = Estimator::kLightOnly;
  const auto sampled = solve(scene, points, options);
  options.estimator = Estimator::kBsdfOnly;
  expectE(solve(scene, points, options), 0, glm::dvec3(sampled.value[0].rgb), 2e-3);
  EXPECT_LT(sampled.value[0].rgb.r, 0.55f * sampled.value[0].rgb.g);
  // Alpha lets its share through.
  scene.environment.radiance = Radiance(0.0f);
  scene.lights.push_back({}), scene.lights[0].position = {0.4f, 0.2f, 2}, scene.lights[0].intensity = 8;
  scene.materials[pane].transmission = 0, scene.materials[pane].base_colour.a = 0.25f;
  scene.materials[pane].alpha_mode = scene::AlphaMode::kBlend;
  options.estimator = Estimator::kMis;
  expectE(solve(scene, points, options), 0, glm::dvec3(2 * 0.75), 1e-4);
}

TEST(Reference, LampsWithoutABodyAreSeenAndMirrored) {
  scene::Scene scene = made::floor(0);
  scene.materials[0].metallic = 1, scene.materials[0].roughness = 0;
  Light& lamp = scene.lights.emplace_back();
  lamp.kind = Light::Kind::kArea, lamp.area = 1, lamp.intensity = 5;
  lamp.position = {1, 0, 2}, lamp.direction = {0, 0, -1};
  EXPECT_NEAR(look(scene, along({-1, 0, 1}, {1, 0, 2}), {.samples = 4}).mean.r, 5, 1e-4);
  const Seen mirrored = look(scene, along({-1, 0, 2}, {0, 0, 0}), {.samples = 256});
  EXPECT_NEAR(mirrored.mean.r, 5, 0.03 + kSigmas * mirrored.error);
  // From behind there is nothing.
  EXPECT_LT(look(scene, along({-1, 0, 3}, {1.2f, 0, 2}), {.samples = 4, .max_bounces = 0}).mean.r, 1e-6);
}

TEST(Reference, UnlitShowsItsColourToTheEyeAlone) {
  scene::Scene scene = made::floor(0);
  scene.materials[0].unlit = true, scene.materials[0].base_colour = {0.2f, 0.4f, 0.6f, 1};
  EXPECT_NEAR(look(scene, along({0, 0, 1}, {0, 0, 0}), {.samples = 4}).mean.g, 0.4, 1e-6);
  EXPECT_EQ(solve(scene, {receiver({0, 0, 1}, {0, 0, -1})}, {.samples = 64}).value[0].rgb, Vec3(0));
}

TEST(Reference, BackgroundIsSeenButDoesNotShine) {
  scene::Scene scene = made::floor(0);
  const ReferenceOptions options{.samples = 16, .background = {0.1f, 0.2f, 0.3f}};
  EXPECT_NEAR(look(scene, along({0, 0, 1}, {0, 0, 2}), options).mean.b, 0.3, 1e-6);
  EXPECT_EQ(look(scene, along({0, 0, 1}, {0, 0, 0}), options).mean.b, 0);
}

TEST(Reference, ItsErrorBarsHold) {
  // 256 estimates of one value by 64 paths each: the mean square of (value - truth) / error has the
  // expectation 15 / 13 and a standard error of about 0.11.
  const scene::Scene room = made::colouredRoom(true);
  const std::vector<Receiver> points(256, receiver({1.3f, 0.9f, 0}, {0, 0, 1}));
  const auto e = solve(room, points, {.samples = 64, .materials = Materials::kLambert});
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double z = (e.value[i].rgb.g - 1.17615725) / e.error[i].rgb.g;
    sum += z * z;
  }
  EXPECT_NEAR(sum / 256, 15.0 / 13, 0.6);
}

TEST(Reference, ATargetErrorIsReached) {
  const scene::Scene room = made::colouredRoom(true);
  const std::vector<Receiver> points = {receiver({1.3f, 0.9f, 0}, {0, 0, 1}),
                                        receiver({0.65f, 1.3f, 1.2f}, {0, 0, 1})};
  const auto e = solve(room, points, {.samples = 1 << 16, .target_error = 0.02f});
  EXPECT_LT(e.samples, 2u << 14);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT(luminance(e.error[i].rgb), 0.025f * luminance(e.value[i].rgb));
}

TEST(Reference, BitsDoNotDependOnThreads) {
  const scene::Scene room = made::colouredRoom(true);
  SilentProgress silent;
  const Reference reference(room);
  const auto render = [&](int threads) {
    const ThreadLimit limit(threads);
    return reference.image(
        37, 21,
        [](Vec2 p) {
          return along({1, 0.05f, 1}, {p.x / 18, 2, 2 - p.y / 10});
        },
        {.samples = 64, .target_error = 0.2f}, silent);
  };
  const ReferenceImage one = render(1), many = render(0);
  EXPECT_EQ(one.radiance.data, many.radiance.data);
  EXPECT_EQ(one.error.data, many.error.data);
  EXPECT_EQ(one.samples, many.samples);
}

TEST(Reference, CanBeInterrupted) {
  SilentProgress progress;
  progress.cancel();
  const scene::Scene scene = made::floor(0);
  const std::vector<Receiver> points(4, receiver({0, 0, 1}, {0, 0, 1}));
  EXPECT_THROW(Reference(scene).irradiance(points, {}, progress), Error);
}

}  // namespace
}  // namespace relume::transport
