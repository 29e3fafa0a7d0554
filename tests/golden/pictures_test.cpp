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
  options.lights = stageLights();
  if (options.view == View::kLit) options.ambient = Irradiance(0.4f);
  SilentProgress silent;
  const image::Image picture = render(tracer, &bake, stageView(), options, silent);
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

TEST(GoldenComposition, LooksAsItDid) {
  const asset::Asset bake = stageRelitBake();
  const scene::Scene scene = stage();
  const trace::Tracer tracer(scene);
  SilentProgress silent;
  EXPECT_TRUE(golden::matches(render(tracer, &bake, stageView(), composedStage(), silent),
                              std::filesystem::path(RELUME_GOLDEN_DIR) / "stage-composed.png", kTolerance));
}

}  // namespace
}  // namespace relume::picture
