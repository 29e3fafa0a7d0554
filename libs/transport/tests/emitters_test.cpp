// SPDX-License-Identifier: MIT
// Sampling of light: direct irradiance by light sampling alone against closed forms, densities against what
// they are densities of, and the light tree. Statistical tests allow 5 standard errors of independent samples
// (false alarms below 1e-6 each); seeds are fixed.
#include "relume/transport/emitters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "light_tree.h"
#include "made_scenes.h"
#include "relume/core/polygon.h"
#include "relume/core/sampling.h"
#include "relume/scene/sky.h"
#include "relume/trace/tracer.h"

namespace relume::transport {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  float one() { return uniform_(engine_); }
  Vec2 two() {
    const float x = one();
    return {x, one()};
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<float> uniform_{0.0f, 0x1.fffffep-1f};
};

/// Mean and standard error of the red irradiance at p, nothing hidden.
struct Estimate {
  double mean = 0, error = 0;
};
Estimate irradiance(const Emitters& emitters, Point p, Normal n, int samples = 40000) {
  Random random(1);
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    double x = 0;
    for (const Reach reach : {Reach::kLocal, Reach::kDistant}) {
      const LightSample s = emitters.sample(reach, p, n, random.two(), random.one());
      if (s.pdf > 0) x += s.value.r * std::max(glm::dot(n, s.direction), 0.0f) / s.pdf;
    }
    sum += x, squares += x * x;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(squares / samples - mean * mean, 0.0) / samples)};
}

void expectIrradiance(const scene::Scene& scene, Point p, Normal n, double expected) {
  const Estimate e = irradiance(Emitters(scene), p, n);
  EXPECT_NEAR(e.mean, expected, 5 * e.error + 2e-5 * expected);
  EXPECT_LT(e.error, 0.02 * expected);
}

Light lightOf(Light::Kind kind, float intensity) {
  Light light;
  light.kind = kind, light.intensity = intensity;
  return light;
}

scene::Scene rectangle(Point p, Vec3 e1, Vec3 e2, float radiance) {
  scene::Mesh mesh;
  made::addQuad(mesh, p, e1, e2);
  scene::Scene scene = made::sceneOf(std::move(mesh));
  scene.materials[0].emission = Vec3(radiance);
  return scene;
}

TEST(Emitters, PunctualLightsGiveTheirInverseSquare) {
  scene::Scene scene;
  scene.lights.push_back(lightOf(Light::Kind::kPoint, 50));
  scene.lights[0].position = {1, 1.5f, 2};
  expectIrradiance(scene, {0.3f, -0.2f, 0}, {0, 0, 1}, 4.987873806451968);
  scene.lights[0].range = 6;
  expectIrradiance(scene, {0.3f, -0.2f, 0}, {0, 0, 1}, 4.778258409735824);
  Light& spot = scene.lights[0] = lightOf(Light::Kind::kSpot, 80);
  spot.position = {0, 0, 2}, spot.direction = glm::normalize(Vec3(0.1f, 0, -1));
  spot.inner_cone = 0.3f, spot.outer_cone = 0.7f;
  expectIrradiance(scene, {0.9f, 0.4f, 0}, {0, 0, 1}, 11.2313352685035);
}

TEST(Emitters, ASunHasItsIrradianceWhateverItsSize) {
  for (const float radius : {0.0f, 0.00465f, 0.3f}) {
    scene::Scene scene;
    scene.lights.push_back(lightOf(Light::Kind::kDirectional, 3.5f));
    scene.lights[0].direction = -glm::normalize(Vec3(0.4f, 0.3f, 0.8f));
    scene.lights[0].angular_radius = radius;
    expectIrradiance(scene, {0, 0, 0}, glm::normalize(Vec3(0, 0.2f, 1)), 3.1286344465968132);
  }
}

TEST(Emitters, RectanglesGiveLambertsFormula) {
  const scene::Scene light = rectangle({-0.5f, -0.5f, 2}, {0, 1, 0}, {1, 0, 0}, 12);
  expectIrradiance(light, {0, 0, 0}, {0, 0, 1}, 2.7700415727620493);
  expectIrradiance(light, {1.5f, 0.3f, 0}, {0, 0, 1}, 1.1984836672291261);
  expectIrradiance(light, {0.2f, -2.5f, 0}, {0, 0, 1}, 0.46523697850323253);
  expectIrradiance(light, {0, 0, 1.7f}, {0, 0, 1}, 29.17512149265842);
  expectIrradiance(rectangle({1, -1, -0.7f}, {0.2f, 0, 2}, {0, 2, 0}, 5), {0, 0, 0}, {0, 0, 1},
                   1.7761465593141663);
  // From behind there is none.
  EXPECT_EQ(irradiance(Emitters(light), {0, 0, 3}, {0, 0, -1}, 100).mean, 0);
}

TEST(Emitters, ADiskOnItsAxis) {
  scene::Scene scene;
  scene.lights.push_back(lightOf(Light::Kind::kArea, 7));
  scene.lights[0].position = {0, 0, 0.8f}, scene.lights[0].direction = {0, 0, -1};
  scene.lights[0].area = kPi * 0.25f;
  expectIrradiance(scene, {0, 0, 0}, {0, 0, 1}, 6.177288925597907);
}

/// Lambert's formula: irradiance at p of a flat polygon that is wholly above the horizon and shines with
/// radiance 1; signed by its sense, so that it holds for outlines that are not convex too.
double lambert(const std::vector<Point>& corners, Point p, Normal n) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(glm::dvec3(corners[i] - p)),
                     b = glm::normalize(glm::dvec3(corners[(i + 1) % corners.size()] - p));
    sum += std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0)) * glm::normalize(glm::cross(a, b));
  }
  return std::abs(0.5 * glm::dot(sum, glm::dvec3(n)));
}

const std::vector<Point> kL = {{-1, -1, 2}, {-1, 1, 2}, {0, 1, 2}, {0, 0, 2}, {2, 0, 2}, {2, -1, 2}};

/// kL as a light that shines downwards.
Light polygonLight(float radiance) {
  Light light = lightOf(Light::Kind::kArea, radiance);
  light.triangles = triangulate(kL), light.area = 4, light.direction = {0, 0, -1}, light.position = kL[0];
  return light;
}

TEST(Emitters, PolygonsGiveLambertsFormula) {
  scene::Scene scene;
  scene.lights = {polygonLight(3)};
  for (const Point p : {Point(0, 0, 0), Point(1.5f, 1.5f, 0.5f), Point(0.3f, 0.4f, 1.9f), Point(-20, 5, 1)}) {
    expectIrradiance(scene, p, {0, 0, 1}, 3 * lambert(kL, p, {0, 0, 1}));
    const Normal tilted = glm::normalize(Vec3(0.1f, 0.2f, 1));
    if (p.z < 1.5f && p.x > -10) expectIrradiance(scene, p, tilted, 3 * lambert(kL, p, tilted));
  }
  // A receiver that stands upright at x = 0 sees what lies beyond: one of the two arms.
  const std::vector<Point> arm = {{0, -1, 2}, {0, 0, 2}, {2, 0, 2}, {2, -1, 2}};
  expectIrradiance(scene, {0, 0.5f, 0}, {1, 0, 0}, 3 * lambert(arm, {0, 0.5f, 0}, {1, 0, 0}));
  // From above there is light when it has two sides only.
  EXPECT_EQ(irradiance(Emitters(scene), {0, 0, 3}, {0, 0, -1}, 100).mean, 0);
  scene.lights[0].two_sided = true;
  expectIrradiance(scene, {0.2f, 0, 3}, {0, 0, -1}, 3 * lambert(kL, {0.2f, 0, 3}, {0, 0, -1}));
}

TEST(Emitters, ADiskMayShineToBothSides) {
  scene::Scene scene;
  scene.lights.push_back(lightOf(Light::Kind::kArea, 7));
  scene.lights[0].position = {0, 0, -0.8f}, scene.lights[0].direction = {0, 0, -1};
  scene.lights[0].area = kPi * 0.25f, scene.lights[0].two_sided = true;
  expectIrradiance(scene, {0, 0, 0}, {0, 0, -1}, 6.177288925597907);
}

// What rays over the whole hemisphere meet of a light is its irradiance; none passes between two triangles.
TEST(Emitters, RaysMeetPolygonsWithoutGaps) {
  scene::Scene scene;
  scene.lights = {polygonLight(3)};
  const Emitters emitters(scene);
  const Point p(0.2f, -0.3f, 0.4f);
  constexpr std::uint32_t kRays = 1u << 16;
  std::vector<LightSeen> seen;
  double sum = 0;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const Direction d = squareToCosineHemisphere(sobol2(i, 3));
    seen.clear();
    emitters.onRay(p, {0, 0, 1}, d, 0, kInfinity, seen);
    EXPECT_LE(seen.size(), 1u);
    for (const LightSeen& light : seen) sum += static_cast<double>(kPi * light.radiance.rgb.r) / kRays;
  }
  const double exact = 3 * lambert(kL, p, {0, 0, 1});
  EXPECT_NEAR(sum, exact, 2e-3 * exact);
  // Along the edges between the triangles.
  for (const auto& [a, b, c] : scene.lights[0].triangles)
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}})
      for (int k = 1; k < 1000; ++k) {
        const Point q = from + static_cast<float>(k) / 1000 * (to - from);
        const auto inside = [&](Point x) {
          return x.x > -0.999f && x.y > -0.999f &&
                 (x.x < -1e-3f ? x.y < 0.999f : x.x < 1.999f && x.y < -1e-3f);
        };
        if (!inside(q)) continue;  // on the outline
        seen.clear();
        emitters.onRay(p, {0, 0, 1}, glm::normalize(q - p), 0, kInfinity, seen);
        EXPECT_FALSE(seen.empty()) << q.x << " " << q.y;
      }
}

TEST(Emitters, EnvironmentsGiveTheirIntegral) {
  scene::Scene scene;
  scene.environment.radiance = Radiance(2.0f);
  expectIrradiance(scene, {0, 0, 0}, {0, 0, 1}, 2 * M_PI);
  // L = 1 + y: pi (1 + 2/3 n_y), within what a grid of 128 x 64 pixels can tell.
  auto map = std::make_shared<image::Image>(128, 64, 3);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x)
      map->setRgb(x, y, Vec3(1 + std::cos(kPi * (static_cast<float>(y) + 0.5f) / 64)));
  scene.environment.radiance = Radiance(1.0f), scene.environment.map = map;
  for (const float angle : {0.0f, 1.0f, 3.0f}) {
    const Estimate e = irradiance(Emitters(scene), {0, 0, 0}, {std::sin(angle), std::cos(angle), 0});
    const double exact = M_PI * (1 + 2.0 / 3 * std::cos(angle));
    EXPECT_NEAR(e.mean, exact, 5 * e.error + 1e-3 * exact);
  }
}

TEST(Emitters, TexturedEmissionIsSampledAsItIs) {
  scene::Scene scene = rectangle({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, 4);
  scene.meshes[0].uv[0] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  scene::Texture texture;
  texture.image = std::make_shared<const image::Image8>(image::Image8{2, 1, 1, {0, 255}});
  texture.wrap_u = texture.wrap_v = scene::Wrap::kClamp;
  scene.textures.push_back(texture);
  scene.materials[0].emission_texture.texture = 0;
  // Bilinear from 0 at u = 1/4 to 1 at 3/4: numerically integrated over the square.
  double exact = 0;
  constexpr int kCells = 400;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const double x = (i + 0.5) / kCells, y = (j + 0.5) / kCells;
      const double px = 2 * x - 1, py = 2 * y - 1, r2 = px * px + py * py + 1;
      exact += 4 * std::clamp(2 * x - 0.5, 0.0, 1.0) / (r2 * r2) * 4 / (kCells * kCells);
    }
  const Estimate e = irradiance(Emitters(scene), {0, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(e.mean, exact, 5 * e.error + 1e-4 * exact);
}

TEST(Emitters, ARayThatMeetsALightKnowsItsDensity) {
  scene::Scene scene = made::room();
  scene.materials.push_back(scene.materials[0]);
  scene.meshes[1].material = 1;
  scene.materials[1].emission = Vec3(3);
  Light sun = lightOf(Light::Kind::kDirectional, 2), disk = lightOf(Light::Kind::kArea, 5);
  sun.direction = glm::normalize(Vec3(0.2f, 1, -0.1f)), sun.angular_radius = 0.2f;
  disk.position = {0, -1, 3}, disk.direction = {0, 0, -1}, disk.area = 0.3f;
  Light polygon = polygonLight(1.5f);
  for (auto& triangle : polygon.triangles)
    for (Point& corner : triangle) corner = 0.3f * corner + Vec3(0.5f, -1.2f, 2.2f);
  scene.lights = {sun, disk, lightOf(Light::Kind::kPoint, 1), polygon};
  scene.lights[2].position = {1, -1.5f, 2};
  scene.environment.radiance = Radiance(0.5f);
  const trace::Tracer tracer(scene);
  const Emitters emitters(scene);
  const Point p(0, -1.5f, 0.7f);
  const Normal n = glm::normalize(Vec3(0.1f, 0.3f, 1));
  Random random(2);
  int seen_surfaces = 0, seen_others = 0, delta = 0;
  std::vector<LightSeen> seen;
  for (int i = 0; i < 4000; ++i) {
    const LightSample s =
        emitters.sample(i % 2 ? Reach::kLocal : Reach::kDistant, p, n, random.two(), random.one());
    if (!(s.pdf > 0)) continue;
    if (s.delta) {
      ++delta;
      continue;
    }
    const trace::RayHit hit = tracer.intersect({p, s.direction});
    float same = kInfinity;
    const auto compare = [&](const LightSeen& light) {
      if (glm::length(light.radiance.rgb - s.value) < 1e-4f * glm::length(s.value))
        same = std::min(same, std::abs(light.pdf / s.pdf - 1));
    };
    if (hit) compare(emitters.onSurface(p, n, s.direction, hit.where, hit.t, hit.back_face));
    seen.clear();
    emitters.onRay(p, n, s.direction, 0, hit.t, seen);
    for (const LightSeen& light : seen) compare(light);
    if (same == kInfinity) continue;  // hidden
    EXPECT_LT(same, 2e-3f);
    ++(s.endless ? seen_others : seen_surfaces);
  }
  EXPECT_GT(seen_surfaces, 300);
  EXPECT_GT(seen_others, 300);
  EXPECT_GT(delta, 20);
}

TEST(LightTree, ChoosesWithTheProbabilityThatItTells) {
  Random random(3);
  std::vector<EmitterBounds> lights(200);
  for (EmitterBounds& light : lights) {
    const Point p(10 * random.one(), 10 * random.one(), 10 * random.one());
    light.box.add(p), light.box.add(p + Vec3(0.1f * random.one()));
    light.axis = squareToSphere(random.two());
    light.intensity = random.one() < 0.1f ? 0.0f : random.one();
  }
  const LightTree tree(lights);
  const Point p(4, 5, 6);
  const Normal n(0, 0, 1);
  std::vector<int> counts(lights.size());
  constexpr int kSamples = 200000;
  int none = 0;
  for (int i = 0; i < kSamples; ++i) {
    const LightTree::Choice c = tree.choose(p, n, (static_cast<float>(i) + 0.5f) / kSamples);
    if (!(c.probability > 0)) {
      ++none;
      continue;
    }
    ++counts[c.emitter];
    EXPECT_NEAR(tree.probability(p, n, c.emitter), c.probability, 1e-4f * c.probability);
  }
  double sum = static_cast<double>(none) / kSamples;
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const double probability = tree.probability(p, n, i);
    sum += probability;
    EXPECT_NEAR(static_cast<double>(counts[i]) / kSamples, probability, 1e-3 * probability + 2e-5);
    // Whoever can shine here can be chosen.
    const Vec3 way = p - lights[i].box.centre();
    if (lights[i].intensity > 0 && glm::dot(lights[i].axis, way) > 0.2f && glm::dot(n, way) < -0.2f) {
      EXPECT_GT(probability, 0.0);
    }
  }
  EXPECT_NEAR(sum, 1, 1e-4);
}

// Nodes weigh eight groups at once by vector code; one by one must come to the same.
TEST(LightTree, NodesWeighAsSingleGroupsDo) {
  std::vector<EmitterBounds> lights;
  for (std::uint32_t i = 0; i < 8; ++i) {
    EmitterBounds& b = lights.emplace_back();
    const Vec2 u = sobol2(i, 1), v = sobol2(i, 2);
    b.box.add(Point(4 * u.x, 4 * u.y, v.x)), b.box.add(Point(4 * u.x + v.y, 4 * u.y + 0.2f, v.x + u.x));
    b.axis = squareToSphere(v);
    b.cos_spread = std::cos(u.x * 3), b.cos_emission = std::cos(0.5f + u.y);
    b.two_sided = i % 3 == 0, b.intensity = 0.5f + u.x;
  }
  const LightTree tree(lights);
  for (std::uint32_t k = 0; k < 500; ++k) {
    const Vec2 u = sobol2(k, 3);
    const Point p(8 * u.x - 2, 8 * u.y - 2, 4 * sobol2(k, 4).x - 2);
    const Normal n = k % 5 == 0 ? Normal(0) : squareToSphere(sobol2(k, 5));
    float sum = 0;
    for (const EmitterBounds& b : lights) sum += b.importance(p, n);
    for (std::uint32_t i = 0; i < lights.size(); ++i)
      EXPECT_NEAR(tree.probability(p, n, i), sum > 0 ? lights[i].importance(p, n) / sum : 0.0f, 2e-5f);
  }
}

TEST(LightTree, AThousandLightsMakeHardlyMoreNoiseThanTen) {
  const auto relativeNoise = [](int count) {
    scene::Scene scene;
    Random random(4);
    for (int i = 0; i < count; ++i) {
      scene.lights.push_back(lightOf(Light::Kind::kPoint, 1));
      scene.lights.back().position = {50 * random.one(), 50 * random.one(), 1 + random.one()};
    }
    const Emitters emitters(scene);
    double sum = 0;
    for (int k = 0; k < 20; ++k) {
      const Estimate e = irradiance(emitters, {50 * random.one(), 50 * random.one(), 0}, {0, 0, 1}, 1000);
      sum += e.error / e.mean;
    }
    return sum / 20;
  };
  EXPECT_LT(relativeNoise(1000), 2 * relativeNoise(10));
}

TEST(Sky, IsBluestAndBrightestWhereItShouldBe) {
  const Direction to_sun = glm::normalize(Vec3(0.5f, 0.6f, 0.2f));
  const Vec3 zenith = scene::skyLuminance(to_sun, 3, {0, 1, 0}),
             beside_sun = scene::skyLuminance(to_sun, 3, to_sun),
             opposite = scene::skyLuminance(to_sun, 3, glm::normalize(to_sun * Vec3(-1, 1, -1)));
  EXPECT_GT(zenith.b, 1.5f * zenith.r);
  EXPECT_GT(luminance(beside_sun), 3 * luminance(zenith));
  EXPECT_GT(luminance(beside_sun), 3 * luminance(opposite));
  // The zenith's luminance is the model's own (A.2): 1000 ((4.0453 T - 4.9710) tan chi - 0.2155 T + 2.4192).
  const double theta = std::acos(to_sun.y), chi = (4.0 / 9 - 3.0 / 120) * (M_PI - 2 * theta);
  EXPECT_NEAR(luminance(zenith), 1000 * ((4.0453 * 3 - 4.9710) * std::tan(chi) - 0.2155 * 3 + 2.4192), 5);
  EXPECT_EQ(scene::skyLuminance(to_sun, 3, {0.6f, -0.8f, 0}), Vec3(0));
}

}  // namespace
}  // namespace relume::transport
