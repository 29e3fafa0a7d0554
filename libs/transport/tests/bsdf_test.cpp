// SPDX-License-Identifier: MIT
// The material model: Lambert exactly, reciprocity of the GGX lobe, samples against the density that they
// claim (chi-square), albedo by two ways, the white furnace.
#include "relume/transport/bsdf.h"
#include "relume/basis/ggx.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "relume/core/sampling.h"

namespace relume::transport {
namespace ggx = basis::ggx;
namespace {

scene::Surface surfaceOf(Vec3 base, float metallic, float roughness) {
  scene::Surface s;
  s.base_colour = Vec4(base, 1), s.metallic = metallic, s.roughness = roughness;
  return s;
}

Direction tilted(float cosine, float azimuth = 0.3f) {
  const float sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

constexpr Normal kUp{0, 0, 1};

Vec3 albedoBySampling(const Bsdf& bsdf, std::uint32_t samples = 1 << 14) {
  glm::dvec3 sum(0);
  for (std::uint32_t i = 0; i < samples; ++i)
    sum += glm::dvec3(bsdf.sample(sobol2(i, 1), sobol2(i, 2).x).weight);
  return sum / static_cast<double>(samples);
}

TEST(Bsdf, LambertIsAlbedoOverPi) {
  const Normal n = glm::normalize(Vec3(1, 2, 3));
  const Bsdf bsdf = Bsdf::lambert(n, {0.2f, 0.5f, 0.8f});
  const Direction in = glm::normalize(Vec3(1, 3, 2));
  EXPECT_LT(glm::length(bsdf.evaluate(in) - Vec3(0.2f, 0.5f, 0.8f) * (glm::dot(n, in) / kPi)), 1e-6f);
  EXPECT_EQ(bsdf.evaluate(-in), Vec3(0));
  EXPECT_FLOAT_EQ(bsdf.pdf(in), glm::dot(n, in) / kPi);
  const BsdfSample s = bsdf.sample({0.3f, 0.7f}, 0.5f);
  EXPECT_LT(glm::length(s.weight - Vec3(0.2f, 0.5f, 0.8f)), 1e-6f);
  EXPECT_TRUE(Bsdf::lambert(n, Vec3(0)).black());
}

TEST(Bsdf, TheMicrofacetLobeIsReciprocal) {
  for (const float alpha : {0.01f, 0.2f, 1.0f}) {
    for (const float i : {0.1f, 0.5f, 0.95f}) {
      for (const float o : {0.05f, 0.6f}) {
        EXPECT_FLOAT_EQ(ggx::visibility(i, o, alpha), ggx::visibility(o, i, alpha));
      }
    }
  }
  // A metal of full roughness, its compensation divided out, seen both ways.
  const scene::Surface gold = surfaceOf({1.0f, 0.8f, 0.3f}, 1, 0.6f);
  const Direction a = tilted(0.3f), b = tilted(0.8f, 2.0f);
  const auto single = [&](Direction in, Direction out) {
    const ggx::Reflected r = ggx::reflected(out.z, 0.36f);
    const Vec3 k = Vec3(1) + Vec3(gold.base_colour) * (1 / (r.scale + r.bias) - 1);
    return Bsdf::metallicRoughness(kUp, gold, 0, out).evaluate(in) / (in.z * k);
  };
  EXPECT_LT(glm::length(single(a, b) - single(b, a)), 1e-4f * glm::length(single(a, b)));
}

struct Case {
  Vec3 base;
  float metallic, roughness, cosine;
};
const std::vector<Case> kCases = {{{0.8f, 0.5f, 0.2f}, 0, 0.3f, 0.9f},
                                  {{0.8f, 0.5f, 0.2f}, 0, 1.0f, 0.2f},
                                  {{0.9f, 0.6f, 0.3f}, 1, 0.5f, 0.6f},
                                  {{0.9f, 0.6f, 0.3f}, 1, 0.9f, 0.1f},
                                  {{0.9f, 0.6f, 0.3f}, 0.5f, 0.7f, 0.4f}};

// Samples in 12 x 24 cells of the hemisphere (even in cos and azimuth) against the pdf integrated over the
// cells. Wilson and Hilferty's normal value of chi-square below 4.5: a false alarm in 300,000 for each case.
TEST(Bsdf, SamplesAreDistributedAsThePdfSays) {
  constexpr int kRows = 12, kColumns = 24, kSub = 24;
  constexpr std::uint32_t kSamples = 100000;
  for (const Case& c : kCases) {
    const Bsdf bsdf =
        Bsdf::metallicRoughness(kUp, surfaceOf(c.base, c.metallic, c.roughness), 0, tilted(c.cosine));
    std::vector<double> expected(kRows * kColumns), counts(kRows * kColumns);
    double inside = 0, lost = kSamples;
    for (int r = 0; r < kRows * kSub; ++r) {
      for (int k = 0; k < kColumns * kSub; ++k) {
        const Direction d = tilted((static_cast<float>(r) + 0.5f) / (kRows * kSub),
                                   2 * kPi * (static_cast<float>(k) + 0.5f) / (kColumns * kSub));
        const double share = bsdf.pdf(d) * 2 * M_PI / (kRows * kSub * kColumns * kSub);
        expected[static_cast<std::size_t>((r / kSub) * kColumns + k / kSub)] += share * kSamples;
        inside += share;
      }
    }
    EXPECT_LT(inside, 1.002);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      // Independent numbers: a net would fill the cells too evenly for the test.
      const Vec2 u = sobol2(0, hashCombine(i, 17)), lobe = sobol2(0, hashCombine(i, 18));
      const BsdfSample s = bsdf.sample(u, lobe.x);
      if (!(s.pdf > 0)) continue;
      float azimuth = std::atan2(s.direction.y, s.direction.x);
      if (azimuth < 0) azimuth += 2 * kPi;
      const int r = std::min(static_cast<int>(s.direction.z * kRows), kRows - 1),
                k = std::min(static_cast<int>(azimuth / (2 * kPi) * kColumns), kColumns - 1);
      ++counts[static_cast<std::size_t>(r * kColumns + k)];
      --lost;
    }
    // What is lost below the plane is one more cell.
    expected.push_back((1 - inside) * kSamples), counts.push_back(lost);
    double chi2 = 0, rest_expected = 0, rest_count = 0;
    int cells = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (expected[i] < 20) {
        rest_expected += expected[i], rest_count += counts[i];
        continue;
      }
      chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i], ++cells;
    }
    if (rest_expected > 20)
      chi2 += (rest_count - rest_expected) * (rest_count - rest_expected) / rest_expected, ++cells;
    const double k = cells - 1, w = 2 / (9 * k);
    const double normal = (std::cbrt(chi2 / k) - (1 - w)) / std::sqrt(w);
    EXPECT_LT(normal, 4.5) << fmt::format("metallic {} roughness {} cos {}: chi2 {} of {}", c.metallic,
                                          c.roughness, c.cosine, chi2, k);
  }
}

TEST(Bsdf, AlbedoBySamplingIsTheIntegralOfTheLobe) {
  for (const Case& c : kCases) {
    const Bsdf bsdf =
        Bsdf::metallicRoughness(kUp, surfaceOf(c.base, c.metallic, c.roughness), 0, tilted(c.cosine));
    glm::dvec3 integral(0);
    constexpr int kRows = 512, kColumns = 1024;
    for (int r = 0; r < kRows; ++r)
      for (int k = 0; k < kColumns; ++k)
        integral += glm::dvec3(bsdf.evaluate(tilted((static_cast<float>(r) + 0.5f) / kRows,
                                                    2 * kPi * (static_cast<float>(k) + 0.5f) / kColumns)));
    integral *= 2 * M_PI / (kRows * kColumns);
    EXPECT_LT(glm::length(integral - glm::dvec3(albedoBySampling(bsdf, 1 << 17))), 2e-3);
  }
}

TEST(Bsdf, WhiteReflectsAllAndNothingMore) {
  for (const float metallic : {0.0f, 0.5f, 1.0f}) {
    for (const float roughness : {0.0f, 0.1f, 0.37f, 0.7f, 1.0f}) {
      for (const float cosine : {0.03f, 0.2f, 0.55f, 1.0f}) {
        const Bsdf bsdf =
            Bsdf::metallicRoughness(kUp, surfaceOf(Vec3(1), metallic, roughness), 0, tilted(cosine));
        EXPECT_NEAR(albedoBySampling(bsdf).r, 1, 0.01)
            << fmt::format("metallic {} roughness {} cos {}", metallic, roughness, cosine);
      }
    }
  }
  // Without compensation a rough metal would lose a good part.
  const ggx::Reflected rough = ggx::reflected(0.5f, 1.0f);
  EXPECT_LT(rough.scale + rough.bias, 0.7f);
}

TEST(Bsdf, TheTableIsRightBetweenItsEntries) {
  for (const float alpha : {0.013f, 0.11f, 0.4f, 0.83f}) {
    for (const float cosine : {0.07f, 0.33f, 0.71f}) {
      const Vec3 o = tilted(cosine, 0);
      double sum = 0;
      constexpr std::uint32_t kSamples = 1 << 15;
      for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3 h = ggx::sampleVisibleNormal(o, alpha, sobol2(i, 9));
        const Vec3 in = 2 * glm::dot(o, h) * h - o;
        if (in.z > 0) sum += ggx::visibility(in.z, o.z, alpha) * 4 * in.z * o.z / ggx::masking(o.z, alpha);
      }
      const ggx::Reflected r = ggx::reflected(cosine, alpha);
      EXPECT_NEAR(r.scale + r.bias, sum / kSamples, 0.005) << alpha << " " << cosine;
    }
  }
}

TEST(Bsdf, ThinTransmissionTakesFromTheDiffuseLobe) {
  const scene::Surface glass = surfaceOf({0.5f, 1, 1}, 0, 0.1f);
  const Bsdf bsdf = Bsdf::metallicRoughness(kUp, glass, 0.75f, tilted(0.8f));
  const Vec3 all = albedoBySampling(bsdf) + bsdf.transmittance();
  EXPECT_NEAR(all.g, 1, 0.01);
  EXPECT_NEAR(bsdf.transmittance().r, 0.5f * bsdf.transmittance().g, 1e-6f);
  EXPECT_NEAR(bsdf.transmittance().g, 0.75f * 0.96f, 0.005f);
  EXPECT_EQ(Bsdf::metallicRoughness(kUp, surfaceOf(Vec3(1), 1, 0), 1, kUp).transmittance(), Vec3(0));
}

TEST(Bsdf, BentNormalsKeepMirrorImagesAboveTheSurface) {
  const Normal geometric(0, 0, 1);
  for (const float cosine : {0.02f, 0.3f, 0.9f}) {
    const Direction out = tilted(cosine, 0);
    EXPECT_EQ(validShadingNormal(geometric, geometric, out), geometric);
    for (const float bend : {-1.4f, -0.7f, 0.2f, 1.2f}) {
      const Normal n = validShadingNormal({std::sin(bend), 0, std::cos(bend)}, geometric, out);
      EXPECT_GT(glm::dot(n, out), 0.0f);
      EXPECT_GT((2 * glm::dot(n, out) * n - out).z, 0.0f);
      EXPECT_NEAR(glm::length(n), 1, 1e-5);
    }
  }
}

}  // namespace
}  // namespace relume::transport
