// SPDX-License-Identifier: MIT
#include "relume/scene/merge.h"

#include <gtest/gtest.h>

namespace relume::scene {
namespace {

Scene oneTriangle(Vec3 colour) {
  Scene scene;
  scene.textures.emplace_back();
  scene.materials.push_back({.base_colour = Vec4(colour, 1)});
  scene.materials[0].normal_texture.texture = 0;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.atlas_page = 3;
  scene.meshes.push_back(mesh);
  Instance instance;
  instance.world_from_local[3] = Vec4(0, 0, 2, 1);
  scene.instances = {instance, instance};
  return scene;
}

TEST(AddObject, KeepsWhatThingsReferTo) {
  Scene scene = oneTriangle({1, 0, 0});
  Mat4 place(1);
  place[3] = Vec4(10, 0, 0, 1);
  const auto added = addObject(scene, oneTriangle({0, 1, 0}), place);
  EXPECT_EQ(added, (std::vector<std::uint32_t>{2, 3}));
  const Instance& one = scene.instances[3];
  EXPECT_TRUE(one.dynamic);
  EXPECT_FALSE(scene.instances[0].dynamic);
  const Mesh& mesh = scene.meshes[one.mesh];
  EXPECT_EQ(mesh.atlas_page, kNone);
  EXPECT_EQ(scene.materials[mesh.material].base_colour.y, 1);
  EXPECT_EQ(scene.materials[mesh.material].normal_texture.texture, 1u);
  const Box3 box = boundsOf(scene, added);
  EXPECT_EQ(box.lo, Point(10, 0, 2));
  EXPECT_EQ(box.hi, Point(11, 1, 2));
}

}  // namespace
}  // namespace relume::scene
