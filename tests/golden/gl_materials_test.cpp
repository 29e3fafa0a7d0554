// SPDX-License-Identifier: MIT
// The metallic-roughness material of shaders/ggx.glsl against that of the reference path tracer,
// relume/transport/bsdf.h: a floor under one lamp, pixel by pixel.
#include <gtest/gtest.h>

#include <cmath>

#include "gl_test.h"
#include "relume/picture/primary_rays.h"
#include "relume/render/renderer.h"
#include "relume/transport/bsdf.h"

namespace relume::picture {
namespace {

struct MaterialCase {
  float metallic, roughness;
};
struct GlMaterial : render::GlTest, testing::WithParamInterface<MaterialCase> {};

scene::Scene floorOf(const scene::Material& material) {
  scene::Scene scene;
  scene::Mesh mesh;
  mesh.positions = {{-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.flat_normals = true;
  scene.meshes.push_back(mesh);
  scene.instances.push_back({.mesh = 0});
  scene.materials.push_back(material);
  return scene;
}

TEST_P(GlMaterial, ReflectsAsThePathTracerSays) {
  scene::Material material;
  material.base_colour = Vec4(0.8f, 0.5f, 0.2f, 1);
  material.metallic = GetParam().metallic, material.roughness = GetParam().roughness;
  const Light lamp{.intensity = 10, .position = {-0.3f, 1.5f, -1}};
  const Viewpoint viewpoint = lookAt({0.2f, 1.2f, 2.5f}, {0, 0, -0.2f}, 0.6f);
  render::Renderer renderer(floorOf(material), {.cube_size = 256, .plane_size = 64});
  render::FrameSettings frame;
  frame.size = {64, 48};
  frame.camera = {viewpoint.world_from_camera, viewpoint.vertical_fov, 0};
  frame.view = render::View::kDirect;
  frame.full_materials = true;
  frame.lights = {lamp};
  renderer.draw(frame);
  const image::Image picture = renderer.read();
  const PrimaryRays rays(viewpoint, frame.size.x, frame.size.y);
  scene::Surface surface;
  surface.base_colour = material.base_colour;
  surface.metallic = material.metallic, surface.roughness = material.roughness;
  for (int y = 0; y < frame.size.y; ++y)
    for (int x = 0; x < frame.size.x; ++x) {
      const trace::Ray ray = rays.at(Vec2(x, y) + 0.5f);
      if (ray.direction.y > -0.05f) continue;
      const Point p = ray.origin - ray.direction * (ray.origin.y / ray.direction.y);
      if (std::abs(p.x) > 2.9f || std::abs(p.z) > 2.9f) continue;
      const transport::Bsdf bsdf = transport::Bsdf::metallicRoughness({0, 1, 0}, surface, 0, -ray.direction);
      const Vec3 expected = bsdf.evaluate(directionTo(lamp, p)) * incidentIrradiance(lamp, p).rgb;
      for (int c = 0; c < 3; ++c)
        // Tables of the lobe's albedo are right to 0.005; sharp lobes magnify the rounding of places.
        ASSERT_NEAR(picture.rgb(x, y)[c], expected[c], 0.012f * expected[c] + 1e-3f) << x << " " << y;
    }
}

INSTANTIATE_TEST_SUITE_P(Materials, GlMaterial,
                         testing::Values(MaterialCase{0, 1}, MaterialCase{0, 0.3f}, MaterialCase{0.5f, 0.5f},
                                         MaterialCase{1, 0.25f}, MaterialCase{1, 0.9f}),
                         [](const auto& m) { return "case" + std::to_string(m.index); });

TEST_F(GlMaterial, IndirectLightFromAllSidesLeavesAWhiteMetalWhite) {
  scene::Material metal;
  metal.base_colour = Vec4(1), metal.metallic = 1, metal.roughness = 0.4f;
  render::Renderer renderer(floorOf(metal), {.cube_size = 64, .plane_size = 64});
  render::FrameSettings frame;
  frame.size = {16, 16};
  const Viewpoint above = lookAt({0.2f, 2, 0.3f}, {0, 0, 0}, 0.5f);
  frame.camera = {above.world_from_camera, above.vertical_fov, 0};
  frame.full_materials = true;
  frame.ambient = Irradiance(kPi);
  renderer.draw(frame);
  EXPECT_NEAR(renderer.read().rgb(8, 8).x, 1.0f, 0.01f);
}

}  // namespace
}  // namespace relume::picture
