// SPDX-License-Identifier: MIT
// Golden pictures of a small stage made by hand: what each view looks like. The renderer repeats its bits, so
// that the tolerance is for other instruction sets and compilers, in which hits at edges may differ, and for
// the 8 bits of the stored files.
#include <gtest/gtest.h>

#include "golden.h"
#include "hand_made.h"
#include "stage.h"

namespace relume::picture {
namespace {

constexpr golden::Tolerance kTolerance{.mean = 0.005, .p99 = 0.05};

/// Darker towards the page's edges, as corners are; a chart for each quarter of a page, one of them invalid.
asset::Asset stageBake() {
  constexpr int kSize = 16;
  asset::Asset bake = emptyBake(kSize, kSize, 2);
  std::vector<float> values, bent;
  for (std::uint32_t page = 0; page < 2; ++page)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const Vec2 p = (Vec2(x, y) + 0.5f) * 2.0f / static_cast<float>(kSize) - 1.0f;
        values.push_back((1 - 0.7f * p.x * p.x) * (1 - 0.7f * p.y * p.y));
        const Normal n = glm::normalize(Vec3(-p.x, 1.5f, p.y));
        bent.insert(bent.end(), {n.x, n.y, n.z});
        const auto entry = values.size() - 1;
        bake.atlas.chart[entry] = 4 * page + (x >= kSize / 2 ? 1u : 0u) + (y >= kSize / 2 ? 2u : 0u);
        bake.atlas.valid[entry] = x < 3 && y < 3 ? 0 : 1;
      }
  addLayer(bake, "obscurance", "value", values);
  bake.layers[0].planes.push_back({"bent", 3, asset::Storage::kFloat32, -1, 1, bent});
  return bake;
}

class GoldenPicture : public testing::TestWithParam<View> {};

TEST_P(GoldenPicture, LooksAsItDid) {
  const scene::Scene scene = stage();
  const asset::Asset bake = stageBake();
  const trace::Tracer tracer(scene);
  PictureOptions options;
  options.width = 192;
  options.height = 144;
  options.samples = 16;
  options.view = GetParam();
  options.background = Vec3(0.1f);
  Light lamp;
  lamp.kind = Light::Kind::kArea;
  lamp.position = {0, 1.95f, 0.2f};
  lamp.direction = {0, -1, 0};
  lamp.area = 0.2f;
  lamp.intensity = 25.0f;
  options.lights = {lamp, {.colour = {1, 0.6f, 0.3f}, .intensity = 1.2f, .position = {0.7f, 0.4f, -0.6f}}};
  if (options.view == View::kLit) options.ambient = Irradiance(0.4f);
  SilentProgress silent;
  const image::Image picture =
      render(tracer, &bake, lookAt({0.6f, 1.3f, 4.4f}, {0, 0.9f, 0}, 0.65f), options, silent);
  EXPECT_TRUE(golden::matches(
      picture, std::filesystem::path(RELUME_GOLDEN_DIR) / ("stage-" + std::string(name(GetParam())) + ".png"),
      kTolerance));
}

INSTANTIATE_TEST_SUITE_P(Views, GoldenPicture,
                         testing::Values(View::kObscurance, View::kOcclusion, View::kLit, View::kAlbedo,
                                         View::kNormal, View::kBentNormal, View::kTexels, View::kCharts,
                                         View::kValidity),
                         [](const auto& view) {
                           std::string text = name(view.param);
                           std::erase(text, '-');
                           return text;
                         });

}  // namespace
}  // namespace relume::picture
