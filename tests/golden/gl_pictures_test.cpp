// SPDX-License-Identifier: MIT
// The pictures of OpenGL against those of rays, view by view: the same stored images, the same places of
// samples. What differs are edges of shadows, which maps make wider, and the last bits of colours.
#include <gtest/gtest.h>

#include "gl_test.h"
#include "golden.h"
#include "relume/image/colour.h"
#include "relume/render/renderer.h"
#include "stage.h"

namespace relume::picture {
namespace {

struct GlCase {
  View view;
  render::View shown;
  golden::Tolerance tolerance;
};

struct GlPicture : render::GlTest, testing::WithParamInterface<GlCase> {};

TEST_P(GlPicture, IsThatOfRays) {
  const scene::Scene scene = stage();
  const asset::Asset bake = stageBake();
  render::Renderer renderer(scene, {.cube_size = 512, .plane_size = 512});
  renderer.setValues(bake.atlas, bake.layers[0].plane("value"));
  renderer.setBent(bake.atlas, bake.layers[0].plane("bent"));
  std::vector<Vec3> labels;
  for (std::size_t i = 0; i < bake.atlas.texel.size(); ++i)
    labels.push_back(GetParam().view == View::kCharts ? image::labelColour(bake.atlas.chart[i])
                     : bake.atlas.valid[i]            ? Vec3(0.5f)
                                                      : Vec3(1, 0, 0));
  renderer.setLabels(bake.atlas, labels, GetParam().view == View::kCharts ? Vec3(0.2f) : Vec3(1, 0, 1));
  render::FrameSettings frame;
  frame.size = {192, 144};
  const Viewpoint view = stageView();
  frame.camera = {view.world_from_camera, view.vertical_fov, view.ortho_height};
  frame.view = GetParam().shown;
  frame.background = Vec3(0.1f);
  frame.ambient = Irradiance(kPi);
  if (GetParam().view == View::kLit) frame.ambient = Irradiance(0.4f), frame.lights = stageLights();
  const std::filesystem::path reference =
      std::filesystem::path(RELUME_GOLDEN_DIR) / ("stage-" + std::string(name(GetParam().view)) + ".png");
  ASSERT_TRUE(std::filesystem::exists(reference));
  if (golden::updating()) GTEST_SKIP() << "stored images are those of rays";
  EXPECT_TRUE(golden::matches(renderer.picture(frame, 16), reference, GetParam().tolerance));
}

constexpr golden::Tolerance kSame{.mean = 0.005, .p99 = 0.05}, kShadows{.mean = 0.02, .p99 = 0.2};

TEST_F(GlPicture, OfAllTermsOfRelitLightIsThatOfRays) {
  const asset::Asset bake = stageRelitBake();
  const PictureOptions options = composedStage();
  render::Renderer renderer(stage(), {.cube_size = 512, .plane_size = 512});
  renderer.setValues(bake.atlas, bake.layers[1].plane("value"));
  renderer.setObscurance(bake.atlas, bake.layers[2].plane("value"));
  render::FrameSettings frame;
  frame.size = {options.width, options.height};
  const Viewpoint view = stageView();
  frame.camera = {view.world_from_camera, view.vertical_fov, 0};
  frame.view = render::View::kRelit;
  frame.background = options.background;
  frame.lights = options.lights;
  frame.obscurance_gain = options.obscurance, frame.bounce_gain = options.bounce;
  const auto reference = std::filesystem::path(RELUME_GOLDEN_DIR) / "stage-composed.png";
  if (golden::updating()) GTEST_SKIP() << "stored images are those of rays";
  EXPECT_TRUE(golden::matches(renderer.picture(frame, 16), reference, kShadows));
}

INSTANTIATE_TEST_SUITE_P(Views, GlPicture,
                         testing::Values(GlCase{View::kObscurance, render::View::kObscurance, kSame},
                                         GlCase{View::kOcclusion, render::View::kOcclusion, kSame},
                                         GlCase{View::kLit, render::View::kLit, kShadows},
                                         GlCase{View::kAlbedo, render::View::kAlbedo, kSame},
                                         GlCase{View::kNormal, render::View::kNormal, kSame},
                                         GlCase{View::kBentNormal, render::View::kBentNormal, kSame},
                                         GlCase{View::kTexels, render::View::kTexels, kSame},
                                         GlCase{View::kCharts, render::View::kLabels, kSame},
                                         GlCase{View::kValidity, render::View::kLabels, kSame}),
                         [](const auto& view) {
                           std::string text = name(view.param.view);
                           std::erase(text, '-');
                           return text;
                         });

}  // namespace
}  // namespace relume::picture
