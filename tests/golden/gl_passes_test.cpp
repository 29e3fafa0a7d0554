// SPDX-License-Identifier: MIT
// Golden pictures of passes as OpenGL draws them: shadow maps by their shadows, indirect light with its
// obscurance and last bounce, relief, and things that move. Stored as Mesa's software renderer draws them;
// the tolerance, in FLIP, is for other devices' rounding of textures and edges. Other passes are held against
// rays (gl_pictures_test.cpp) and closed forms (libs/render/tests).
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "gl_test.h"
#include "golden.h"
#include "relume/render/renderer.h"
#include "relume/scene/merge.h"
#include "stage.h"

namespace relume::picture {
namespace {

struct GlPass : render::GlTest {};

constexpr golden::Tolerance kDevices{.mean = 0.01, .p99 = 0.1};

render::FrameSettings stageFrame() {
  render::FrameSettings frame;
  frame.size = {128, 96};
  const Viewpoint view = stageView();
  frame.camera = {view.world_from_camera, view.vertical_fov, 0};
  frame.view = render::View::kRelit;
  frame.full_materials = true;
  frame.background = Vec3(0.1f);
  frame.lights = stageLights();
  return frame;
}

testing::AssertionResult asStored(render::Renderer& renderer, const render::FrameSettings& frame,
                                  const char* name) {
  return golden::matches(renderer.picture(frame, 4), std::filesystem::path(RELUME_GOLDEN_DIR) / name,
                         kDevices);
}

TEST_F(GlPass, ShadowsByCubes) {
  render::Renderer renderer(stage(), {.cube_size = 256, .plane_size = 64});
  render::FrameSettings frame = stageFrame();
  frame.view = render::View::kDirect;
  frame.full_materials = false;
  EXPECT_TRUE(asStored(renderer, frame, "gl-direct.png"));
}

TEST_F(GlPass, IndirectLight) {
  const asset::Asset bake = stageRelitBake();
  render::Renderer renderer(stage(), {.cube_size = 128, .plane_size = 64});
  renderer.setValues(bake.atlas, bake.layers[1].plane("value"));
  renderer.setObscurance(bake.atlas, bake.layers[2].plane("value"));
  render::FrameSettings frame = stageFrame();
  frame.view = render::View::kIndirect;
  frame.full_materials = false;
  EXPECT_TRUE(asStored(renderer, frame, "gl-indirect.png"));
  frame.obscurance_gain = 1, frame.bounce_gain = 0.2f;
  EXPECT_TRUE(asStored(renderer, frame, "gl-indirect-composed.png"));
}

TEST_F(GlPass, Relief) {
  scene::Scene scene = stage();
  auto heights = std::make_shared<image::Image8>();
  heights->width = heights->height = 64, heights->channels = 1;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const float u = std::sin(kPi * static_cast<float>(x % 16) / 16),
                  v = std::sin(kPi * static_cast<float>(y % 16) / 16);
      heights->data.push_back(static_cast<unsigned char>(255 * std::sqrt(u * v)));
    }
  scene.textures.push_back({.image = heights});
  for (scene::Mesh& mesh : scene.meshes) mesh.uv[0] = mesh.uv[1];
  for (scene::Material& material : scene.materials)
    material.height_texture.texture = 0, material.height_scale = 0.08f;
  const asset::Asset bake = stageRelitBake();
  render::Renderer renderer(scene, {.cube_size = 256, .plane_size = 64});
  renderer.setValues(bake.atlas, bake.layers[1].plane("value"));
  EXPECT_TRUE(asStored(renderer, stageFrame(), "gl-relief.png"));
}

TEST_F(GlPass, Objects) {
  scene::Scene scene = stage();
  Mat4 place(0.3f);
  place[3] = Vec4(0.35f, 0.3f, 0.3f, 1);
  scene::Scene shiny = ball(16, 24);
  shiny.materials[0].metallic = 0.8f, shiny.materials[0].roughness = 0.3f;
  const auto instances = scene::addObject(scene, shiny, place);
  const asset::Asset bake = stageRelitBake();
  render::Renderer renderer(scene, {.cube_size = 256, .plane_size = 64});
  renderer.setValues(bake.atlas, bake.layers[1].plane("value"));
  renderer.addObject({.instances = instances});
  EXPECT_TRUE(asStored(renderer, stageFrame(), "gl-object.png"));
}

}  // namespace
}  // namespace relume::picture
