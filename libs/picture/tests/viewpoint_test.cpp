// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "framing.h"
#include "hand_made.h"
#include "relume/core/error.h"
#include "relume/picture/primary_rays.h"

namespace relume::picture {
namespace {

/// The six sides of a box; `inward`: seen from inside. `sides` leaves some out: bits -x +x -y +y -z +z.
std::vector<Quad> boxOf(const Box3& box, bool inward, unsigned int sides = 0x3f) {
  std::vector<Quad> quads;
  const Vec3 e = box.extent();
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      if (!(sides >> (2 * axis + side) & 1u)) continue;
      Vec3 u(0), v(0);
      u[(axis + 1) % 3] = e[(axis + 1) % 3];
      v[(axis + 2) % 3] = e[(axis + 2) % 3];
      Quad quad;
      quad.corner = box.lo;
      if (side) quad.corner[axis] = box.hi[axis];
      const bool outward_is_uv = side == 1;
      quad.edge_u = outward_is_uv != inward ? u : v;
      quad.edge_v = outward_is_uv != inward ? v : u;
      quads.push_back(quad);
    }
  return quads;
}

/// Largest |coordinate| of the box's corners in the picture, where 1 is the edge; infinite for one behind the
/// eye.
Vec2 filled(const Viewpoint& view, const Box3& box, float aspect) {
  const Mat4 camera_from_world = glm::inverse(view.world_from_camera);
  Vec2 most(0);
  for (int corner = 0; corner < 8; ++corner) {
    const Point p = {corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                     corner & 4 ? box.hi.z : box.lo.z};
    const Vec3 c = Vec3(camera_from_world * Vec4(p, 1));
    if (c.z >= 0) return Vec2(kInfinity);
    const float t = std::tan(0.5f * view.vertical_fov);
    most = glm::max(most, glm::abs(Vec2(c) / (-c.z * t * Vec2(aspect, 1))));
  }
  return most;
}

TEST(LookAt, LooksAlongMinusZWithYUp) {
  const Viewpoint view = lookAt({1, 2, 3}, {4, 1, -2}, 0.7f);
  const Mat3 axes(view.world_from_camera);
  EXPECT_NEAR(glm::determinant(axes), 1.0f, 1e-5f);
  EXPECT_NEAR(glm::dot(-axes[2], glm::normalize(Vec3(3, -1, -5))), 1.0f, 1e-6f);
  EXPECT_NEAR(axes[0].y, 0.0f, 1e-6f);
  EXPECT_GT(axes[1].y, 0.0f);
  EXPECT_EQ(Vec3(view.world_from_camera[3]), Vec3(1, 2, 3));
  EXPECT_EQ(view.vertical_fov, 0.7f);
}

TEST(LookAt, VerticalAndEmptyLooksAreSound) {
  for (const Point target : {Point(0, 5, 0), Point(0, -5, 0), Point(0, 0, 0)}) {
    const Mat3 axes(lookAt({0, 0, 0}, target, 0.7f).world_from_camera);
    EXPECT_NEAR(glm::determinant(axes), 1.0f, 1e-5f);
  }
}

TEST(DefaultViewpoint, IsTheScenesCamera) {
  scene::Scene scene = sceneOf({{}});
  scene::Camera camera;
  camera.world_from_camera[3] = {7, 8, 9, 1};
  camera.vertical_fov = 0.5f;
  scene.cameras.push_back(camera);
  camera.orthographic = true;
  camera.ortho_height = 3.0f;
  scene.cameras.push_back(camera);
  const trace::Tracer tracer(scene);
  const Viewpoint first = defaultViewpoint(tracer, 0), second = defaultViewpoint(tracer, 1);
  EXPECT_EQ(Vec3(first.world_from_camera[3]), Vec3(7, 8, 9));
  EXPECT_EQ(first.vertical_fov, 0.5f);
  EXPECT_EQ(first.ortho_height, 0.0f);
  EXPECT_EQ(second.ortho_height, 3.0f);
  EXPECT_EQ(Vec3(defaultViewpoint(tracer, -1).world_from_camera[3]), Vec3(7, 8, 9));
  EXPECT_NE(Vec3(frameScene(tracer).world_from_camera[3]), Vec3(7, 8, 9));
}

TEST(DefaultViewpoint, RefusesACameraThatIsNotThere) {
  scene::Scene scene = sceneOf({{}});
  for (const int cameras : {0, 1}) {
    scene.cameras.resize(static_cast<std::size_t>(cameras));
    const trace::Tracer tracer(scene);
    EXPECT_NO_THROW(defaultViewpoint(tracer, -1));
    EXPECT_NO_THROW(defaultViewpoint(tracer, 0));
    for (const int camera : {1, -2}) {
      try {
        defaultViewpoint(tracer, camera);
        ADD_FAILURE() << "nothing was thrown";
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kUsage);
      }
    }
  }
}

struct OutsideCase {
  const char* name;
  Box3 box;
};

class Outside : public testing::TestWithParam<OutsideCase> {};

TEST_P(Outside, TheWholeBoxIsInThePicture) {
  const Box3& box = GetParam().box;
  const scene::Scene scene = sceneOf(boxOf(box, false));
  const trace::Tracer tracer(scene);
  for (const float aspect : {0.5f, 1.0f, 16.0f / 9, 4.0f}) {
    SCOPED_TRACE(testing::Message() << "aspect " << aspect);
    const Viewpoint view = defaultViewpoint(tracer, -1, aspect);
    const Vec2 most = filled(view, box, aspect);
    EXPECT_LE(std::max(most.x, most.y), 0.96f);
    EXPECT_GE(std::max(most.x, most.y), 0.6f);
    EXPECT_GT(view.world_from_camera[3].y, box.centre().y);
  }
}

INSTANTIATE_TEST_SUITE_P(Boxes, Outside,
                         testing::Values(OutsideCase{"cube", {{-1, -1, -1}, {1, 1, 1}}},
                                         OutsideCase{"tiny", {{-1e-4f, 0, 0}, {1e-4f, 1e-4f, 3e-4f}}},
                                         OutsideCase{"huge", {{-1e5f, -1e4f, -1e5f}, {1e5f, 3e4f, 2e5f}}},
                                         OutsideCase{"plane", {{-50, 0, -50}, {50, 0.01f, 50}}},
                                         OutsideCase{"tower", {{-1, 0, -1}, {1, 100, 1}}},
                                         OutsideCase{"wall", {{-10, 0, -0.01f}, {10, 5, 0.01f}}},
                                         OutsideCase{"far", {{1000, 2000, -3000}, {1010, 2005, -2990}}}),
                         [](const auto& outside) { return outside.param.name; });

TEST(DefaultViewpoint, AFlatSceneIsSeenFromItsFront) {
  // A square that faces -z: from +z one would see its back.
  const scene::Scene scene = sceneOf({{.edge_u = {0, 1, 0}, .edge_v = {1, 0, 0}}});
  const trace::Tracer tracer(scene);
  const Viewpoint view = defaultViewpoint(tracer, -1);
  EXPECT_LT(view.world_from_camera[3].z, 0);
  const Vec2 most = filled(view, scene.bounds(), 16.0f / 9);
  EXPECT_LE(std::max(most.x, most.y), 0.96f);
}

TEST(DefaultViewpoint, AnEmptyOrDynamicSceneIsSound) {
  scene::Scene dynamic = sceneOf({{.corner = {5, 5, 5}, .dynamic = true}});
  for (const scene::Scene& scene : {scene::Scene{}, dynamic}) {
    const trace::Tracer tracer(scene);
    const Viewpoint view = defaultViewpoint(tracer, -1);
    for (int column = 0; column < 4; ++column)
      EXPECT_TRUE(isFinite(Vec3(view.world_from_camera[column]))) << column;
  }
  const trace::Tracer tracer(dynamic);
  EXPECT_LE(filled(defaultViewpoint(tracer, -1), {{5, 5, 5}, {6, 6, 5}}, 16.0f / 9).x, 0.96f);
}

class Inside : public testing::TestWithParam<float> {};

TEST_P(Inside, ARoomIsSeenFromWithinAcrossIt) {
  const float scale = GetParam();
  const Box3 room{scale * Point(-4, 0, -3), scale * Point(4, 3, 3)};
  std::vector<Quad> quads = boxOf(room, true);
  for (const Quad& q : boxOf({scale * Point(-1, 0, -1), scale * Point(1, 0.8f, 0)}, false))
    quads.push_back(q);
  const scene::Scene scene = sceneOf(quads);
  const trace::Tracer tracer(scene);
  const Viewpoint view = defaultViewpoint(tracer, -1);
  const Point eye = view.world_from_camera[3];
  EXPECT_EQ(room.distance(eye), 0.0f);
  EXPECT_NEAR(eye.y, 1.5f * scale, 0.5f * scale);
  // It stands aside and looks across: the middle of the picture is more than half the room away.
  const PrimaryRays rays(view, 16, 9);
  const trace::RayHit middle = tracer.intersect(rays.at({8, 4.5f}));
  ASSERT_TRUE(middle);
  EXPECT_GT(middle.t, 4 * scale);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 16; ++x) {
      const trace::RayHit hit = tracer.intersect(rays.at(Vec2(x, y) + 0.5f));
      EXPECT_TRUE(hit && !hit.back_face) << x << ", " << y;
    }
}

INSTANTIATE_TEST_SUITE_P(Scales, Inside, testing::Values(1.0f, 1e-3f, 1e3f));

TEST(DefaultViewpoint, AStageIsSeenStraightThroughItsOpenSide) {
  const Box3 box{{-1, 0, -1}, {1, 2, 1}};
  for (const unsigned int side : {0u, 1u, 4u, 5u}) {  // -x +x -z +z
    SCOPED_TRACE(testing::Message() << "side " << side);
    const scene::Scene scene = sceneOf(boxOf(box, true, 0x3fu & ~(1u << side)));
    const trace::Tracer tracer(scene);
    const Viewpoint view = defaultViewpoint(tracer, -1);
    Vec3 outward(0);
    outward[static_cast<int>(side / 2)] = side % 2 ? 1.0f : -1.0f;
    EXPECT_NEAR(glm::dot(Vec3(view.world_from_camera[2]), outward), 1.0f, 1e-5f);
    const Vec2 most = filled(view, box, 16.0f / 9);
    EXPECT_LE(std::max(most.x, most.y), 0.96f);
    EXPECT_GE(std::max(most.x, most.y), 0.9f);
  }
}

TEST(DefaultViewpoint, ADollsHouseIsSeenFromAbove) {
  const Box3 box{{-1, 0, -1}, {1, 1, 1}};
  const scene::Scene scene = sceneOf(boxOf(box, true, 0x37));  // without +y
  const trace::Tracer tracer(scene);
  const Viewpoint view = defaultViewpoint(tracer, -1);
  EXPECT_GT(view.world_from_camera[2].y, 0.7f);
  const PrimaryRays rays(view, 16, 9);
  const trace::RayHit middle = tracer.intersect(rays.at({8, 4.5f}));
  ASSERT_TRUE(middle);
  EXPECT_NEAR(scene::worldPosition(scene, middle.where).y, 0.0f, 1e-5f) << "the floor is seen";
}

// From within a hollow, two-sided ball everything is near and nothing is a floor.
TEST(DefaultViewpoint, AHollowBallIsSeenFromOutside) {
  scene::Scene scene = ball(16, 32);
  scene.materials[0].double_sided = true;
  const trace::Tracer tracer(scene);
  const Viewpoint view = defaultViewpoint(tracer, -1);
  EXPECT_GT(glm::length(Vec3(view.world_from_camera[3])), 2.0f);
}

}  // namespace
}  // namespace relume::picture
