// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "made_scenes.h"
#include "relume/core/progress.h"
#include "relume/core/sampling.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

std::vector<std::uint8_t> allValid(const atlas::Texels& texels) {
  return std::vector<std::uint8_t>(texels.points.size(), 1);
}

float noise(std::uint32_t i) { return static_cast<float>(hashCombine(i, 17) >> 8) * 0x1p-24f - 0.5f; }

/// Smooths value + noise of deviation `sigma` and returns the values.
std::vector<float> filtered(const atlas::Texels& texels, std::vector<float> values, float sigma) {
  const std::vector<float> error(texels.points.size(), sigma);
  filterTexels(texels, error, allValid(texels), 1, values);
  return values;
}

// Floor beside the wall of ao.wall.infinite: k_A = (1 + d / sqrt(d^2 + h^2)) / 2 at every distance; the texel
// mean in closed form.
TEST(FilterTexels, LowersTheErrorBesideAWall) {
  scene::Mesh mesh;
  made::addQuad(mesh, {0, -2000, 0}, {0, 4000, 0}, {0, 0, 1});
  const scene::Scene scene = made::sceneOf(std::move(mesh));
  const atlas::Texels texels = made::texelGrid(64, 64, {0, -2, 0}, {1.0f / 32, 0, 0}, {0, 1.0f / 16, 0});
  SilentProgress silent;
  for (const std::uint32_t n : {16u, 64u}) {
    OcclusionOptions options;
    options.min_samples = options.max_samples = n;
    options.smoothed = true;
    const OcclusionResult result = solveOcclusion(trace::Tracer(scene), texels, options, silent);
    std::vector<float> before;
    for (const Vec3& v : result.value) before.push_back(v.x);
    std::vector<float> after = before;
    filterTexels(texels, result.error, allValid(texels), 1, after);
    double raw = 0, smooth = 0, bias = 0;
    for (std::size_t i = 0; i < texels.points.size(); ++i) {
      const double x0 = static_cast<double>(texels.points[i].texel % 64) / 32.0, x1 = x0 + 1.0 / 32.0;
      const double exact = 0.5 * (1.0 + (std::sqrt(x1 * x1 + 1) - std::sqrt(x0 * x0 + 1)) / (x1 - x0));
      raw += std::pow(before[i] - exact, 2), smooth += std::pow(after[i] - exact, 2),
          bias += after[i] - exact;
    }
    const double points = static_cast<double>(texels.points.size());
    EXPECT_LT(std::sqrt(smooth / raw), 0.5) << n << " rays";
    // All blocks have the same samples, so their error does not average out over the floor.
    EXPECT_LT(std::abs(bias / points), 0.05 / n);
  }
}

TEST(FilterTexels, LeavesGradientsAlone) {
  const atlas::Texels texels = made::texelGrid(16, 16, {}, {1, 0, 0}, {0, 1, 0});
  std::vector<float> ramp;
  for (const atlas::SurfacePoint& p : texels.points)
    ramp.push_back(0.1f + 0.01f * p.position.x + 0.02f * p.position.y);
  const std::vector<float> after = filtered(texels, ramp, 0.1f);
  for (std::size_t i = 0; i < ramp.size(); ++i) EXPECT_NEAR(after[i], ramp[i], 1e-6f);
}

/// Two halves of different value, split in some way that the filter must respect; noise is smoothed inside
/// each.
void expectNoMixing(const atlas::Texels& texels, bool left(std::uint32_t x)) {
  std::vector<float> values;
  for (std::size_t i = 0; i < texels.points.size(); ++i) {
    const bool is_left = left(texels.points[i].texel % static_cast<std::uint32_t>(texels.width));
    values.push_back((is_left ? 0.2f : 0.3f) + 0.05f * noise(static_cast<std::uint32_t>(i)));
  }
  const std::vector<float> after = filtered(texels, values, 0.1f);  // the error alone would let them mix
  double spread_before = 0, spread_after = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float expected =
        left(texels.points[i].texel % static_cast<std::uint32_t>(texels.width)) ? 0.2f : 0.3f;
    EXPECT_NEAR(after[i], expected, 0.026f);
    spread_before += std::pow(values[i] - expected, 2), spread_after += std::pow(after[i] - expected, 2);
  }
  EXPECT_LT(spread_after, 0.5 * spread_before);
}

TEST(FilterTexels, DoesNotCrossCharts) {
  atlas::Texels texels = made::texelGrid(16, 16, {}, {1, 0, 0}, {0, 1, 0});
  for (atlas::SurfacePoint& p : texels.points) p.chart = p.texel % 16 < 8 ? 0 : 1;
  expectNoMixing(texels, [](std::uint32_t x) { return x < 8; });
}

TEST(FilterTexels, DoesNotCrossCreases) {
  atlas::Texels texels = made::texelGrid(16, 16, {}, {1, 0, 0}, {0, 1, 0});
  for (atlas::SurfacePoint& p : texels.points) {
    if (p.texel % 16 < 8) continue;
    p.shading_normal = p.geometric_normal = glm::normalize(Vec3(-1, 0, 1.2f));
    p.position.z = (p.position.x - 8) / 1.2f;
  }
  expectNoMixing(texels, [](std::uint32_t x) { return x < 8; });
}

TEST(FilterTexels, DoesNotCrossSteps) {
  atlas::Texels texels = made::texelGrid(16, 16, {}, {1, 0, 0}, {0, 1, 0});
  for (atlas::SurfacePoint& p : texels.points) {
    p.triangle = p.texel % 16 < 8 ? 0 : 1;
    p.position.z = p.triangle == 0 ? 0.0f : 5.0f;
  }
  expectNoMixing(texels, [](std::uint32_t x) { return x < 8; });
}

TEST(FilterTexels, KeepsWhatNoiseDoesNotExplain) {
  const atlas::Texels texels = made::texelGrid(16, 16, {}, {1, 0, 0}, {0, 1, 0});
  std::vector<float> values;
  for (const atlas::SurfacePoint& p : texels.points) values.push_back(p.texel % 16 < 8 ? 0.2f : 0.8f);
  const std::vector<float> after = filtered(texels, values, 0.01f);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(after[i], values[i], 1e-6f);
}

TEST(FilterTexels, InvalidTexelsNeitherGiveNorTake) {
  const atlas::Texels texels = made::texelGrid(8, 8, {}, {1, 0, 0}, {0, 1, 0});
  std::vector<float> values(64, 0.5f);
  std::vector<std::uint8_t> valid(64, 1);
  const std::vector<float> error(64, 10.0f);
  values[27] = 9.0f, valid[27] = 0;
  const std::vector<float> before = values;
  filterTexels(texels, error, valid, 1, values);
  EXPECT_EQ(values, before);
}

TEST(FilterTexels, TellsTheErrorThatIsLeft) {
  const atlas::Texels texels = made::texelGrid(64, 64, {}, {1, 0, 0}, {0, 1, 0});
  const float sigma = std::sqrt(1.0f / 12.0f);  // of noise()
  std::vector<float> values, left(texels.points.size());
  for (std::uint32_t i = 0; i < texels.points.size(); ++i) values.push_back(noise(i));
  const std::vector<float> error(texels.points.size(), sigma);
  filterTexels(texels, error, allValid(texels), 1, values, left);
  double truth = 0, told = 0;
  for (std::size_t i = 0; i < values.size(); ++i) truth += values[i] * values[i], told += left[i] * left[i];
  EXPECT_LT(truth, 0.15 * 64 * 64 * sigma * sigma);
  EXPECT_NEAR(std::sqrt(told / truth), 1.0, 0.1);
}

TEST(FilterTexels, ChannelsShareTheirWeights) {
  const atlas::Texels texels = made::texelGrid(12, 12, {}, {1, 0, 0}, {0, 1, 0});
  std::vector<float> values;
  for (std::uint32_t i = 0; i < 144; ++i) {
    for (const float scale : {1.0f, 2.0f, -1.0f}) values.push_back(scale * (0.5f + 0.1f * noise(i)));
  }
  const std::vector<float> error(144, 0.1f);
  filterTexels(texels, error, allValid(texels), 3, values);
  for (std::size_t i = 0; i < 144; ++i) {
    EXPECT_NEAR(values[3 * i + 1], 2.0f * values[3 * i], 1e-5f);
    EXPECT_NEAR(values[3 * i + 2], -values[3 * i], 1e-5f);
  }
}

}  // namespace
}  // namespace relume::transport
