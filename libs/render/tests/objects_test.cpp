// SPDX-License-Identifier: MIT
// Things that move, where what reaches them and what they hide is known in closed form: inside a box of
// panels that shine, and a ball over a floor under a white sky.
#include <cmath>

#include "gl_test.h"
#include "relume/render/renderer.h"

namespace relume::render {
namespace {

using Objects = GlTest;

std::uint32_t addQuad(scene::Scene& scene, Point corner, Vec3 u, Vec3 v, std::uint32_t material,
                      bool dynamic) {
  scene::Mesh mesh;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.flat_normals = true;
  mesh.material = material;
  const auto index = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(mesh);
  scene.instances.push_back({.mesh = index, .dynamic = dynamic});
  return index;
}

scene::Material shining(float radiance) {
  return {.base_colour = Vec4(0, 0, 0, 1), .metallic = 0, .emission = Vec3(radiance)};
}

/// A box of 4 m: the wall at x = 2 shines with `right`, all else with `rest`. Materials 0 and 1; then white
/// (2) and polished metal (3).
scene::Scene shiningBox(float right, float rest) {
  scene::Scene scene;
  scene.materials = {shining(right), shining(rest), {.metallic = 0}, {.metallic = 1, .roughness = 0.1f}};
  addQuad(scene, {2, -2, -2}, {0, 4, 0}, {0, 0, 4}, 0, false);
  addQuad(scene, {-2, -2, -2}, {0, 0, 4}, {0, 4, 0}, 1, false);
  addQuad(scene, {-2, -2, -2}, {4, 0, 0}, {0, 0, 4}, 1, false);
  addQuad(scene, {-2, 2, -2}, {0, 0, 4}, {4, 0, 0}, 1, false);
  addQuad(scene, {-2, -2, -2}, {0, 4, 0}, {4, 0, 0}, 1, false);
  addQuad(scene, {-2, -2, 2}, {4, 0, 0}, {0, 4, 0}, 1, false);
  return scene;
}

/// A small card at p that faces along n, in the middle of the picture.
float radianceOfCard(scene::Scene scene, Point middle, Point p, Direction n, std::uint32_t material) {
  const Vec3 u = std::abs(n.y) > 0.9f ? Vec3(1, 0, 0) : glm::normalize(glm::cross(Vec3(0, 1, 0), n)),
             v = glm::cross(n, u);
  Object object;
  object.instances.push_back(addQuad(scene, p - 0.02f * (u + v), 0.04f * u, 0.04f * v, material, true));
  // The other end of the object, so that the middle of its cube map is where it should be.
  object.instances.push_back(addQuad(scene, 2.0f * middle - p, {1e-3f, 0, 0}, {0, 1e-3f, 0}, material, true));
  Renderer renderer(scene, {.cube_size = 64, .plane_size = 64});
  renderer.addObject(object);
  FrameSettings frame;
  frame.size = {9, 9};
  frame.full_materials = true;
  const Vec3 back = n;
  frame.camera.world_from_camera = Mat4(Vec4(u, 0), Vec4(v, 0), Vec4(back, 0), Vec4(p + 0.1f * back, 1));
  frame.camera.ortho_height = 0.02f;
  renderer.draw(frame);
  return renderer.read().rgb(4, 4).x;
}

TEST_F(Objects, ShineAsWhatIsAboutThemWhereThatIsAlikeOnAllSides) {
  for (const std::uint32_t material : {2u, 3u})
    for (const Point p : {Point(0), Point(0.8f, 0.4f, -0.5f), Point(-1.2f, 0.9f, 0)})
      for (const Direction n : {Direction(1, 0, 0), Direction(0, -1, 0), glm::normalize(Direction(1, 1, 1))})
        EXPECT_NEAR(radianceOfCard(shiningBox(0.7f, 0.7f), Point(0), p, n, material), 0.7f, 0.07f)
            << material << " at " << p.x << " facing " << n.x << " " << n.y;
}

/// Form factor from a small card to a parallel square above its middle, both 4 m apart by `height`.
double toSquare(double half, double height) {
  const double a = half / height, q = a / std::sqrt(1 + a * a);
  return 4 * (2 * q * std::atan(q)) / (2 * 3.14159265358979);
}

TEST_F(Objects, AreLitByTheWallThatTheyComeNearTo) {
  // The middle of the cube map stays; the card moves towards the wall that shines.
  for (const float x : {-1.0f, 0.0f, 1.0f}) {
    const double expected = toSquare(2, 2 - x);
    EXPECT_NEAR(radianceOfCard(shiningBox(1, 0), Point(0), {x, 0, 0}, {1, 0, 0}, 2), expected,
                0.15 * expected)
        << x;
  }
}

TEST_F(Objects, MirrorWhatStandsWhereTheRayEnds) {
  // From x = 1.5 a mirror that faces up and right sees the wall's upper part; from the middle it would see it
  // too, from x = -1.5 the ceiling.
  const Direction n = glm::normalize(Vec3(0.45f, 0.9f, 0));
  EXPECT_GT(radianceOfCard(shiningBox(1, 0), Point(0), {1.5f, 0, 0}, {1, 0, 0}, 3), 0.8f);
  EXPECT_LT(radianceOfCard(shiningBox(1, 0), Point(0), {-1.5f, 1, 0}, n, 3), 0.2f);
}

/// A ball of radius r at `middle`, its occlusion by its solid angle.
Object::Occlusion ballOcclusion(Point middle, float r) {
  Object::Occlusion out;
  out.side = 16;
  out.box = {middle - Vec3(3 * r), middle + Vec3(3 * r)};
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const Point p = out.box.lo + (Vec3(x, y, z) + 0.5f) * (6 * r / 16);
        const float d = std::max(glm::distance(p, middle), r);
        out.cells.emplace_back(glm::normalize(middle - p), 0.5f * (1 - std::sqrt(1 - r * r / (d * d))));
      }
  return out;
}

TEST_F(Objects, HideTheSkyFromTheFloor) {
  constexpr float kRadius = 0.5f, kHeight = 0.9f;
  scene::Scene scene;
  scene.materials = {{.metallic = 0}};
  addQuad(scene, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, 0, false);
  Object object;
  object.instances = {addQuad(scene, {9, 9, 9}, {1e-3f, 0, 0}, {0, 1e-3f, 0}, 0, true)};
  object.occlusion = ballOcclusion({0, kHeight, 0}, kRadius);
  Renderer renderer(scene, {.cube_size = 64, .plane_size = 64});
  const std::size_t ball = renderer.addObject(object);
  FrameSettings frame;
  frame.size = {64, 64};
  frame.view = View::kIndirect;
  frame.object_light = ObjectLight::kNone;
  frame.ambient = Irradiance(kPi);
  frame.camera.world_from_camera =
      Mat4(Vec4(1, 0, 0, 0), Vec4(0, 0, -1, 0), Vec4(0, 1, 0, 0), Vec4(0, 5, 0, 1));
  frame.camera.ortho_height = 2;
  for (const float moved : {0.0f, 0.5f}) {
    Mat4 place(1);
    place[3] = Vec4(moved, 0, 0, 1);
    renderer.placeObject(ball, place);
    renderer.draw(frame);
    const image::Image picture = renderer.read();
    for (int y = 0; y < 64; y += 3)
      for (int x = 0; x < 64; x += 3) {
        const Point p((static_cast<float>(x) + 0.5f) / 32 - 1, 0, (static_cast<float>(y) + 0.5f) / 32 - 1);
        const float d = glm::distance(p, {moved, kHeight, 0});
        if (std::abs(p.x - moved) > 1.0f || std::abs(p.z) > 1.0f) continue;  // where the volume fades out
        const float hidden = kRadius * kRadius / (d * d) * (kHeight / d);
        ASSERT_NEAR(picture.rgb(x, y).x, 1 - hidden, 0.02f) << p.x << " " << p.z;
      }
  }
  frame.object_occlusion_gain = 0;
  renderer.draw(frame);
  EXPECT_NEAR(renderer.read().rgb(32, 32).x, 1, 1e-4f);
}

TEST_F(Objects, AreEightAtMost) {
  scene::Scene scene;
  scene.materials = {{.metallic = 0}};
  const std::uint32_t card = addQuad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0, true);
  Renderer renderer(scene, {.cube_size = 64, .plane_size = 64});
  for (int i = 0; i < 8; ++i) renderer.addObject({.instances = {card}});
  EXPECT_THROW(renderer.addObject({.instances = {card}}), Error);
}

}  // namespace
}  // namespace relume::render
