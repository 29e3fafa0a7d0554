// SPDX-License-Identifier: MIT
#include "relume/relight/obscurance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

struct Texel {
  Point position;
  Normal normal;
  std::vector<float> w;  ///< 1 or 3 channels
};

/// One row of texels; every second one of the page is not covered.
asset::Asset bakeOf(const std::vector<Texel>& texels) {
  asset::Asset a;
  a.atlas.width = static_cast<int>(2 * texels.size());
  a.atlas.height = a.atlas.pages = 1;
  asset::Layer layer;
  layer.name = layer.kind = "obscurance";
  layer.planes = {{.name = "value", .channels = static_cast<int>(texels[0].w.size()), .values = {}}};
  for (std::uint32_t i = 0; i < texels.size(); ++i) {
    a.atlas.texel.push_back(2 * i);
    a.atlas.position.push_back(texels[i].position);
    a.atlas.normal.push_back(texels[i].normal);
    auto& values = layer.planes[0].values;
    values.insert(values.end(), texels[i].w.begin(), texels[i].w.end());
    values.insert(values.end(), texels[i].w.size(), -1e9f);
  }
  a.layers = {layer};
  return a;
}

std::vector<Texel> randomTexels(std::size_t count, std::size_t channels) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit;
  std::vector<Texel> texels(count);
  for (Texel& t : texels) {
    t.position = 3.0f * Vec3(normal(random), normal(random), normal(random));
    t.normal = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    for (std::size_t c = 0; c < channels; ++c) t.w.push_back(unit(random));
  }
  return texels;
}

LightSet randomLights(std::size_t count) {
  std::mt19937 random(6);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit;
  LightSet lights(count);
  for (std::size_t i = 0; i < count; ++i) {
    Light& l = lights[i];
    l.kind = static_cast<Light::Kind>(i % 4);
    l.colour = {unit(random), unit(random), unit(random)};
    l.intensity = 10 * unit(random);
    l.position = 4.0f * Vec3(normal(random), normal(random), normal(random));
    l.direction = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    if (i % 3 == 0) l.range = 1 + 10 * unit(random);
    l.inner_cone = 0.5f * unit(random);
    l.outer_cone = 0.6f + unit(random) * 0.9f;
    l.area = unit(random);
    l.two_sided = i % 8 >= 4;
  }
  return lights;
}

Vec3 reference(const Texel& t, const LightSet& lights, const ObscuranceOptions& options,
               const std::vector<float>& visible) {
  Vec3 direct(0), incident(0);
  for (std::size_t j = 0; j < lights.size(); ++j) {
    direct += visible[j] * directIrradiance(lights[j], t.position, t.normal).rgb;
    incident += incidentIrradiance(lights[j], t.position).rgb;
  }
  const Vec3 w = t.w.size() == 3 ? Vec3(t.w[0], t.w[1], t.w[2]) : Vec3(t.w[0]);
  return (options.ambient.rgb + options.beta * incident) * w + direct;
}

void expectNear(Vec3 got, Vec3 want, float relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], relative * (std::abs(want[c]) + 1e-3f));
}

// Two lamps at distances 2 and 3 under cosines 0.6 and 0.9, the second one hidden; by hand I_S = 10/4 0.6
// = 1.5, I'_S = 0.2 (10/4 + 6/9), I = (0.4 + I'_S) 0.7 0.55 + 0.65 I_S.
TEST(Obscurance, WorkedExampleOfEquations5To7) {
  const double k_a = 0.7, k_d = 0.65, w = 0.55;
  const asset::Asset bake = bakeOf({{Point(0), {0, 1, 0}, {static_cast<float>(w)}}});
  ObscuranceRelighter relighter(bake, bake.layers[0]);
  LightSet lights(2);
  lights[0].intensity = 10;
  lights[0].position = 2.0f * Vec3(0.8f, 0.6f, 0);
  lights[1].intensity = 6;
  lights[1].position = 3.0f * Vec3(0, 0.9f, std::sqrt(1 - 0.81f));
  const VisibilitySource second_hidden = [](std::size_t light, std::span<float> v) {
    std::fill(v.begin(), v.end(), light == 1 ? 0.0f : 1.0f);
  };
  const ObscuranceOptions options{Irradiance(0.4f), 0.2f};
  EXPECT_NEAR(relighter.evaluate(lights, options, second_hidden)[0].rgb.g,
              (0.4 + 0.6333333333333333) * w + 1.5, 1e-6);
  // Its parts, to which the two reflectances belong: without ambient and beta there is I_S alone.
  const double direct = relighter.evaluate(lights, {Irradiance(0.0f), 0.0f}, second_hidden)[0].rgb.g;
  const double ambient = relighter.evaluate(lights, options, second_hidden)[0].rgb.g - direct;
  EXPECT_NEAR(direct, 1.5, 1e-6);
  EXPECT_NEAR(k_a * ambient + k_d * direct, 1.3728333333333333, 1e-6);
}

// Lights of every kind, texels more than a block and not a whole number of vectors, against core/light.h.
TEST(Obscurance, AgreesWithTheDefinition) {
  for (const std::size_t channels : {1u, 3u}) {
    const auto texels = randomTexels(777, channels);
    const LightSet lights = randomLights(40);
    const asset::Asset bake = bakeOf(texels);
    ObscuranceRelighter relighter(bake, bake.layers[0]);
    const ObscuranceOptions options{Irradiance({0.1f, 0.2f, 0.3f}), 0.15f};
    ASSERT_EQ(relighter.texelCount(), texels.size());
    const auto all = relighter.evaluate(lights, options);
    for (std::size_t i = 0; i < texels.size(); ++i)
      expectNear(all[i].rgb, reference(texels[i], lights, options, std::vector<float>(40, 1.0f)), 2e-5f);
    const auto visibility = [](std::size_t light, std::size_t texel) {
      return static_cast<float>((light * 7 + texel) % 5) / 4;
    };
    const auto some = relighter.evaluate(lights, options, [&](std::size_t light, std::span<float> v) {
      for (std::size_t i = 0; i < v.size(); ++i) v[i] = visibility(light, i);
    });
    for (std::size_t i = 0; i < texels.size(); ++i) {
      std::vector<float> visible(40);
      for (std::size_t j = 0; j < 40; ++j) visible[j] = visibility(j, i);
      expectNear(some[i].rgb, reference(texels[i], lights, options, visible), 2e-5f);
    }
  }
}

TEST(Obscurance, IsLinearInTheLights) {
  const asset::Asset bake = bakeOf(randomTexels(300, 3));
  ObscuranceRelighter relighter(bake, bake.layers[0]);
  const LightSet both = randomLights(8);
  const LightSet first(both.begin(), both.begin() + 3), rest(both.begin() + 3, both.end());
  const auto copy = [&](const LightSet& lights) {
    const auto e = relighter.evaluate(lights, {});
    return std::vector<Irradiance>(e.begin(), e.end());
  };
  LightSet doubled = both;
  for (Light& l : doubled) l.intensity *= 2;
  const auto a = copy(first), b = copy(rest), sum = copy(both), twice = copy(doubled);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    expectNear(a[i].rgb + b[i].rgb, sum[i].rgb, 1e-5f);
    expectNear(twice[i].rgb, 2.0f * sum[i].rgb, 1e-6f);
  }
}

TEST(Obscurance, DarkWithoutLightAndAmbientTimesWUnderTheSky) {
  const auto texels = randomTexels(20, 1);
  const asset::Asset bake = bakeOf(texels);
  ObscuranceRelighter relighter(bake, bake.layers[0]);
  for (const Irradiance& e : relighter.evaluate({}, {})) EXPECT_EQ(e.rgb, Vec3(0));
  const auto sky = relighter.evaluate({}, {.ambient = Irradiance({1, 2, 3})});
  for (std::size_t i = 0; i < texels.size(); ++i) EXPECT_EQ(sky[i].rgb, texels[i].w[0] * Vec3(1, 2, 3));
}

TEST(Obscurance, SameBitsWhateverTheThreadsAndTheHistory) {
  const asset::Asset bake = bakeOf(randomTexels(5000, 1));
  ObscuranceRelighter relighter(bake, bake.layers[0]);
  LightSet lights = randomLights(30);
  const auto first = relighter.evaluate(lights, {});
  const std::vector<Irradiance> before(first.begin(), first.end());
  const ThreadLimit one(1);
  lights[3].intensity = 1e6f;
  relighter.evaluate(lights, {});
  const auto again = relighter.evaluate(randomLights(30), {});
  EXPECT_TRUE(std::equal(again.begin(), again.end(), before.begin()));
  // A source that hides nothing is the same as none.
  const auto seen = relighter.evaluate(
      randomLights(30), {}, [](std::size_t, std::span<float> v) { std::fill(v.begin(), v.end(), 1.0f); });
  EXPECT_TRUE(std::equal(seen.begin(), seen.end(), before.begin()));
}

TEST(Obscurance, LampInTheSurfaceStaysFinite) {
  const asset::Asset bake = bakeOf({{Point(1, 2, 3), {0, 1, 0}, {1.0f}}});
  ObscuranceRelighter relighter(bake, bake.layers[0]);
  for (const auto kind : {Light::Kind::kPoint, Light::Kind::kSpot, Light::Kind::kArea})
    for (const float away : {0.0f, 1e-30f, 1e-7f, 1e-5f}) {
      Light light{.kind = kind, .position = {1, 2 + away, 3}, .direction = {0, -1, 0}, .area = 1e-3f};
      light.intensity = 1e4f;
      const Vec3 e = relighter.evaluate({light}, {})[0].rgb;
      EXPECT_TRUE(isFinite(e));
      if (away < 1e-6f) {
        EXPECT_EQ(e, Vec3(0)) << "nearer than a micrometre";
      }
    }
}

TEST(Obscurance, RefusesLayersThatAreNotObscurance) {
  asset::Asset bake = bakeOf(randomTexels(4, 1));
  const auto code = [&] {
    try {
      ObscuranceRelighter(bake, bake.layers[0]);
    } catch (const Error& e) {
      return e.code();
    }
    return ErrorCode::kInterrupted;
  };
  bake.layers[0].planes[0].channels = 2;
  EXPECT_EQ(code(), ErrorCode::kMismatch);
  bake.layers[0].planes[0].channels = 3;
  EXPECT_EQ(code(), ErrorCode::kMismatch);
  bake.layers[0].planes.clear();
  EXPECT_EQ(code(), ErrorCode::kMismatch);
}

}  // namespace
}  // namespace relume::relight
