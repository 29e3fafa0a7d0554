// SPDX-License-Identifier: MIT
// Textures at the edges of triangles, where half of a block of pixels only helps with derivatives.
#include "gl_test.h"
#include "relume/render/renderer.h"

namespace relume::render {
namespace {

using Textures = GlTest;

// A floor of two triangles whose texture is black on one half: smoothed by its coarsest level it would be
// grey along the diagonal and where something stands before it.
TEST_F(Textures, AreNoSmootherAtEdgesOfTriangles) {
  scene::Scene scene;
  auto image = std::make_shared<image::Image8>();
  image->width = image->height = 64, image->channels = 1;
  for (int i = 0; i < 64 * 64; ++i) image->data.push_back(i % 64 < 56 ? 0 : 255);
  scene.textures.push_back({.image = image});
  scene.materials = {{.metallic = 0}, {.base_colour = Vec4(0, 0, 0, 1), .metallic = 0}};
  scene.materials[0].base_colour_texture.texture = 0;
  const auto quad = [&](float half, float z, std::uint32_t material) {
    scene::Mesh mesh;
    mesh.positions = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
    mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.flat_normals = true;
    mesh.material = material;
    scene.instances.push_back({.mesh = static_cast<std::uint32_t>(scene.meshes.size())});
    scene.meshes.push_back(mesh);
  };
  quad(1, 0, 0);
  quad(0.313f, 0.5f, 1);
  Renderer renderer(scene, {.cube_size = 64, .plane_size = 64});
  FrameSettings frame;
  frame.size = {63, 63};
  frame.view = View::kAlbedo;
  frame.camera.world_from_camera[3] = Vec4(0, 0, 2, 1);
  frame.camera.ortho_height = 2;
  renderer.draw(frame);
  const image::Image picture = renderer.read();
  for (int y = 0; y < 63; ++y)
    for (int x = 2; x < 50; ++x) ASSERT_LT(picture.rgb(x, y).x, 0.01f) << x << " " << y;
  EXPECT_GT(picture.rgb(59, 20).x, 0.9f);
}

}  // namespace
}  // namespace relume::render
