// SPDX-License-Identifier: MIT
// What shaders make of a picture, against what the image library makes of it; and shaders that are wrong.
#include <cmath>

#include "gl_objects.h"
#include "gl_test.h"
#include "relume/image/colour.h"
#include "relume/render/renderer.h"
#include "shader_text.h"

namespace relume::render {
namespace {

using Present = GlTest;

/// A floor of colours: emission of small quads, from black to far too bright.
scene::Scene steps() {
  scene::Scene scene;
  for (int i = 0; i < 16; ++i) {
    scene::Mesh mesh;
    const Point at(0.25f * static_cast<float>(i) - 2, 0, 0);
    mesh.positions = {at, at + Vec3(0.25f, 0, 0), at + Vec3(0.25f, 1, 0), at + Vec3(0, 1, 0)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.flat_normals = true;
    mesh.material = static_cast<std::uint32_t>(i);
    scene.instances.push_back({.mesh = mesh.material});
    scene.meshes.push_back(mesh);
    const float v = 0.004f * std::exp2(0.75f * static_cast<float>(i));
    scene.materials.push_back({.base_colour = Vec4(0, 0, 0, 1), .emission = {v, 0.5f * v, 3 * v}});
  }
  return scene;
}

struct Shown {
  image::Image linear;
  std::vector<unsigned char> rgba;
};

Shown show(const Renderer::Present& how) {
  const IVec2 size(64, 16);
  Renderer renderer(steps(), {.cube_size = 64, .plane_size = 64});
  FrameSettings frame;
  frame.size = size;
  frame.camera.world_from_camera[3] = Vec4(0, 0.5f, 2, 1);
  frame.camera.ortho_height = 1;
  renderer.draw(frame);
  Shown shown{renderer.read(), std::vector<unsigned char>(4 * 64 * 16)};
  const Texture screen = Texture::make2d(GL_RGBA8, size);
  Framebuffer target = Framebuffer::make();
  target.attach(GL_COLOR_ATTACHMENT0, screen);
  Renderer::Present here = how;
  here.framebuffer = target.name();
  renderer.present(here);
  glGetTextureImage(screen.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(shown.rgba.size()),
                    shown.rgba.data());
  return shown;
}

TEST_F(Present, HasTheCurvesOfTheImageLibrary) {
  for (const bool filmic : {false, true})
    for (const float stops : {0.0f, -1.5f}) {
      const Shown shown = show({.exposure_stops = stops, .filmic = filmic, .fxaa = false});
      const image::Image expected =
          image::toneMap(shown.linear, filmic ? image::ToneCurve::kFilmic : image::ToneCurve::kPlain, stops);
      ASSERT_GT(shown.linear.rgb(62, 8).z, 20.0f);
      for (int x = 0; x < 64; ++x)
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(shown.rgba[static_cast<std::size_t>(4 * (8 * 64 + x) + c)],
                      255 * image::linearToSrgb(expected.rgb(x, 8)[c]), 0.6f)
              << filmic << stops << " " << x;
    }
}

TEST_F(Present, SmoothsEdgesAndLeavesWhatIsFlat) {
  const Shown plain = show({.filmic = true, .fxaa = false}), smooth = show({.filmic = true, .fxaa = true});
  // Quads are four pixels wide: their second pixel sees no edge.
  for (int x = 1; x < 62; x += 4)
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(plain.rgba[static_cast<std::size_t>(4 * (8 * 64 + x) + c)],
                smooth.rgba[static_cast<std::size_t>(4 * (8 * 64 + x) + c)]);
}

TEST_F(Present, ShadersThatTheDriverRefusesAreNamed) {
  try {
    Program::draw("fullscreen.vert.glsl", "tone.frag.glsl", "#define v_uv nowhere + \n");
    FAIL() << "compiled";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kUnsupported);
    EXPECT_NE(std::string(e.what()).find("fullscreen.vert.glsl"), std::string::npos) << e.what();
  }
}

TEST(ShaderText, IncludesEachFileOnceAndKeepsNumbersOfLines) {
  const std::string text = shaderText("surface.frag.glsl", "#define A 1\n");
  EXPECT_TRUE(text.starts_with("#version 450 core\n#define A 1\n"));
  EXPECT_EQ(text.find("#include"), std::string::npos);
  const auto first = text.find("struct Light {");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("struct Light {", first + 1), std::string::npos);
}

}  // namespace
}  // namespace relume::render
