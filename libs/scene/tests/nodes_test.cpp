// SPDX-License-Identifier: MIT
// The node hierarchy: placement, what counts as dynamic, lights and cameras, and graphs that are no trees.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "gltf_builder.h"
#include "relume/scene/light_groups.h"

namespace relume::scene::gltf {
namespace {

using Json = nlohmann::json;

Point originOf(const Instance& instance) { return Point(instance.world_from_local[3]); }

void expectNear(Vec3 a, Vec3 b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

TEST(Nodes, TransformsCompose) {
  GltfBuilder b;
  const auto mesh = b.mesh(b.trianglePrimitive());
  b.node({{"translation", {1, 0, 0}}, {"rotation", {0, 0, 0.70710678, 0.70710678}}, {"children", {1}}});
  b.push("nodes", {{"scale", {2, 3, -4}}, {"children", {2}}});
  b.push("nodes",
         {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 1, 1}}, {"mesh", mesh}, {"name", "leaf"}});
  const Scene scene = b.scene();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "leaf");
  EXPECT_EQ(scene.instances[0].node, 2u);
  // (1,1,1) scaled to (2,3,-4), turned about z by 90 degrees to (-3,2,-4), moved by (1,0,0).
  expectNear(originOf(scene.instances[0]), {-2, 2, -4});
  EXPECT_NEAR(glm::determinant(Mat3(scene.instances[0].world_from_local)), -24.0f, 1e-3f);
}

TEST(Nodes, TakesTheDefaultSceneOrTheFirstOrAllRoots) {
  GltfBuilder b;
  const auto mesh = b.mesh(b.trianglePrimitive());
  for (const char* name : {"a", "b", "c"}) b.push("nodes", {{"mesh", mesh}, {"name", name}});
  b.push("nodes", {{"mesh", mesh}, {"name", "child of c"}});
  b.doc["nodes"][2]["children"] = {3};
  EXPECT_EQ(b.scene().instances.size(), 4u);
  b.doc["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0, 2}}}};
  EXPECT_EQ(b.scene().instances[0].name, "b");
  b.doc["scene"] = 1;
  const Scene scene = b.scene();
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.instances[0].name, "a");
  EXPECT_EQ(scene.instances[2].name, "child of c");
  EXPECT_EQ(scene.meshes.size(), 1u);  // shared
  b.doc["scene"] = 2;
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-reference");
}

TEST(Nodes, RefusesGraphsThatAreNoTrees) {
  const auto error = [](const std::vector<std::vector<int>>& children) {
    GltfBuilder b;
    const auto mesh = b.mesh(b.trianglePrimitive());
    for (const auto& c : children) {
      b.push("nodes", {{"mesh", mesh}});
      if (!c.empty()) b.doc["nodes"].back()["children"] = c;
    }
    return errorOf([&] { b.scene(); });
  };
  EXPECT_EQ(error({{1}, {2}, {}}), "no error");
  EXPECT_EQ(error({{0}}), "cyclic-nodes");
  EXPECT_EQ(error({{1}, {0}}), "cyclic-nodes");
  EXPECT_EQ(error({{1}, {2}, {3}, {1}}), "cyclic-nodes");
  EXPECT_EQ(error({{}, {2}, {3}, {1}}), "cyclic-nodes");
  EXPECT_EQ(error({{2}, {2}, {}}), "invalid-reference");
  EXPECT_EQ(error({{1, 1}, {}}), "invalid-reference");
  EXPECT_EQ(error({{7}}), "invalid-reference");
}

// A recursive walk would overflow the stack.
TEST(Nodes, FollowsAChainOfAHundredThousand) {
  GltfBuilder b;
  const auto mesh = b.mesh(b.trianglePrimitive());
  constexpr int kNodes = 100000;
  for (int n = 0; n + 1 < kNodes; ++n)
    b.push("nodes", {{"children", {n + 1}}, {"translation", {0.001, 0, 0}}});
  b.push("nodes", {{"mesh", mesh}});
  expectNear(originOf(b.scene().instances.at(0)), {99.999f, 0, 0}, 0.5f);
}

TEST(Nodes, ARootThatIsAChildToIsPlacedByItsParent) {
  GltfBuilder b;
  b.triangle();
  b.doc["nodes"] = {{{"translation", {0, 5, 0}}, {"children", {1}}}, {{"mesh", 0}}};
  b.doc["scenes"][0]["nodes"] = {1, 0, 0};
  const Scene scene = b.scene();
  ASSERT_EQ(scene.instances.size(), 1u);
  expectNear(originOf(scene.instances[0]), {0, 5, 0});
  EXPECT_EQ(b.warnings.size(), 2u);
}

TEST(Nodes, RefusesPlacesThatAreNotFinite) {
  GltfBuilder b;
  b.triangle({{"translation", {1e39, 0, 0}}});
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-value");
  b.doc["nodes"] = {{{"scale", {1e30, 1, 1}}, {"children", {1}}}, {{"scale", {1e30, 1, 1}}, {"mesh", 0}}};
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-value");
}

TEST(Nodes, LeavesOutWhatIsAbsurdlyFar) {
  GltfBuilder b;
  b.triangle().triangle({{"translation", {1e20, 0, 0}}});
  EXPECT_EQ(b.scene().instances.size(), 1u);
  EXPECT_EQ(b.warnings.size(), 1u);
}

TEST(Nodes, HiddenNodesAreLeftOut) {
  GltfBuilder b;
  b.triangle().triangle({{"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  EXPECT_EQ(b.scene().instances.size(), 1u);
}

TEST(Dynamic, AnimatedSkinnedAndMorphedNodesAndTheirChildren) {
  GltfBuilder b;
  const auto mesh = b.mesh(b.trianglePrimitive());
  const auto morphed = b.mesh(b.trianglePrimitive());
  b.doc["meshes"][morphed]["weights"] = {0.0, 0.5};
  const auto add = [&](Json json, const char* name) {
    json["name"] = name;
    if (!json.contains("mesh")) json["mesh"] = mesh;
    return b.node(std::move(json));
  };
  add({}, "still");
  const auto mover = add({}, "animated");
  const auto child = b.push("nodes", {{"mesh", mesh}, {"name", "child of animated"}});
  b.doc["nodes"][mover]["children"] = {child};
  const auto joint = b.node({{"name", "joint"}});
  b.push("skins", {{"joints", {joint}}});
  add({{"skin", 0}}, "skinned");
  add({{"mesh", morphed}}, "morphed");
  add({{"mesh", morphed}, {"weights", {0, 0}}}, "morphed by zero");
  const auto pointed = add({}, "by pointer");
  const auto zero = b.accessor<float>({0}, "SCALAR");
  b.doc["animations"] = {
      {{"samplers", {{{"input", zero}, {"output", zero}}}},
       {"channels",
        {{{"sampler", 0}, {"target", {{"node", mover}, {"path", "rotation"}}}},
         {{"sampler", 0},
          {"target",
           {{"path", "pointer"},
            {"extensions",
             {{"KHR_animation_pointer",
               {{"pointer", "/nodes/" + std::to_string(pointed) + "/translation"}}}}}}}}}}}};
  std::map<std::string, bool> dynamic;
  const Scene scene = b.scene();
  for (const Instance& instance : scene.instances) dynamic[instance.name] = instance.dynamic;
  const std::map<std::string, bool> expected = {
      {"still", false},  {"animated", true},         {"child of animated", true}, {"skinned", true},
      {"morphed", true}, {"morphed by zero", false}, {"by pointer", true}};
  EXPECT_EQ(dynamic, expected);
  EXPECT_EQ(scene.triangleCount(), 2u);
}

TEST(Dynamic, TheNearestWordOfTheAuthorWins) {
  GltfBuilder b;
  const auto mesh = b.mesh(b.trianglePrimitive());
  const auto mark = [&](const char* key, bool value) { return Json{{"relume", {{key, value}}}}; };
  b.node({{"mesh", mesh}, {"extras", mark("dynamic", true)}, {"children", {1}}});  // dynamic
  b.push("nodes", {{"mesh", mesh}, {"children", {2}}});                            // dynamic, inherited
  b.push("nodes", {{"mesh", mesh}, {"extras", mark("static", true)}, {"children", {3}}});  // static
  b.push("nodes", {{"mesh", mesh}});                                         // static, inherited
  b.node({{"mesh", mesh}, {"extras", mark("static", true)}});                // animated, yet static
  b.node({{"mesh", mesh}, {"extras", {{"relume", {{"dynamic", "yes"}}}}}});  // nonsense
  const auto zero = b.accessor<float>({0}, "SCALAR");
  b.doc["animations"] = {{{"samplers", {{{"input", zero}, {"output", zero}}}},
                          {"channels", {{{"sampler", 0}, {"target", {{"node", 4}, {"path", "scale"}}}}}}}};
  const Scene scene = b.scene();
  std::vector<bool> dynamic;
  for (const Instance& instance : scene.instances) dynamic.push_back(instance.dynamic);
  EXPECT_EQ(dynamic, (std::vector<bool>{true, true, false, false, false, false}));
  EXPECT_EQ(b.warnings.size(), 1u);
}

// The specification ignores a skinned mesh's own node: it stands where its joints are.
TEST(Dynamic, ASkinnedMeshStandsWithItsFirstJoint) {
  GltfBuilder b;
  b.triangle({{"skin", 0}, {"translation", {100, 0, 0}}});
  const auto joint = b.node({{"translation", {0, 3, 0}}});
  const auto inverse_bind = b.accessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}, "MAT4");
  b.push("skins", {{"joints", {joint}}, {"inverseBindMatrices", inverse_bind}});
  expectNear(originOf(b.scene().instances[0]), {0, 2, 0});
}

TEST(Instancing, MakesACopyForEachTransform) {
  GltfBuilder b;
  b.triangle({{"translation", {0, 0, 1}}});
  const auto translations = b.accessor<float>({1, 0, 0, 2, 0, 0}, "VEC3");
  const auto scales = b.accessor<float>({1, 1, 1, 2, 2, 2}, "VEC3");
  b.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", translations},
                                                                              {"SCALE", scales}};
  const Scene scene = b.scene();
  ASSERT_EQ(scene.instances.size(), 2u);
  expectNear(originOf(scene.instances[1]), {2, 0, 1});
  EXPECT_EQ(scene.instances[1].copy, 1u);
  EXPECT_FLOAT_EQ(scene.instances[1].world_from_local[0][0], 2);
  b.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] =
      b.accessor<float>({1, 1, 1}, "VEC3");
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-value");
}

// Copies of zeros, and nodes times primitives, cost a file next to nothing each.
TEST(Instancing, RefusesMoreThanTheFileJustifies) {
  GltfBuilder b;
  b.triangle();
  const auto zeros = b.push("accessors", {{"componentType", 5126}, {"count", 70000}, {"type", "VEC3"}});
  b.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", zeros}};
  EXPECT_EQ(errorOf([&] { b.scene(); }), "out-of-bounds");
  b.doc["accessors"][zeros]["count"] = 60000;
  EXPECT_EQ(errorOf([&] { b.scene(); }), "no error");

  GltfBuilder product;
  product.triangle();
  Json& primitives = product.doc["meshes"][0]["primitives"];
  for (int i = 0; i < 1000; ++i) primitives.push_back(Json(primitives[0]));
  for (int i = 0; i < 300; ++i) product.node({{"mesh", 0}});
  EXPECT_EQ(errorOf([&] { product.scene(); }), "out-of-bounds");
}

TEST(Lights, AreTurnedAndMovedButNotScaled) {
  GltfBuilder b;
  b.triangle();
  b.doc["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"color", {1, 0.5, 0}},
       {"intensity", 20},
       {"range", 7},
       {"name", "lamp"},
       {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.3}}}},
      {{"type", "directional"}}};
  // A quarter turn about x takes -z to +y; the scale would also mirror.
  b.node({{"translation", {1, 2, 3}},
          {"rotation", {0.70710678, 0, 0, 0.70710678}},
          {"scale", {5, 5, 5}},
          {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  b.node({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}, {"name", "sun"}});
  const Scene scene = b.scene();
  ASSERT_EQ(scene.lights.size(), 2u);
  const Light& spot = scene.lights[0];
  EXPECT_EQ(spot.kind, Light::Kind::kSpot);
  EXPECT_EQ(spot.name, "lamp");
  expectNear(spot.colour, {1, 0.5, 0});
  EXPECT_FLOAT_EQ(spot.intensity, 20);
  EXPECT_FLOAT_EQ(spot.range, 7);
  EXPECT_FLOAT_EQ(spot.inner_cone, 0.1f);
  EXPECT_FLOAT_EQ(spot.outer_cone, 0.3f);
  expectNear(spot.position, {1, 2, 3});
  expectNear(spot.direction, {0, 1, 0});
  EXPECT_EQ(scene.lights[1].name, "sun");
  EXPECT_EQ(scene.lights[1].range, kInfinity);
  expectNear(scene.lights[1].direction, {0, 0, -1});

  b.doc["extensions"]["KHR_lights_punctual"]["lights"][1]["type"] = "tube";
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-value");
}

// A lamp's own word, then that of its kind; lamps without one stand for themselves.
TEST(Lights, BelongToGroups) {
  GltfBuilder b;
  b.triangle();
  b.doc["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"extras", {{"relume", {{"group", "hall"}}}}}},
      {{"type", "point"}, {"intensity", 0}},
      {{"type", "point"}, {"extras", {{"relume", 3}}}}};
  const auto lamp = [](int kind) { return Json{{"KHR_lights_punctual", {{"light", kind}}}}; };
  b.node({{"extensions", lamp(0)}, {"name", "a"}});
  b.node({{"extensions", lamp(0)}, {"name", "b"}, {"extras", {{"relume", {{"group", "stage"}}}}}});
  b.node({{"extensions", lamp(1)}, {"name", "dark"}});
  b.node({{"extensions", lamp(2)}, {"name", "c"}, {"extras", {{"relume", {{"group", 5}}}}}});
  Scene scene = b.scene();
  scene.environment.radiance = Radiance(1.0f);
  EXPECT_EQ(lightGroups(scene), (std::vector<std::string>{"hall", "stage", "c", kEnvironmentGroup}));
}

TEST(Lights, MayBeInBoxesOfTheirAuthor) {
  GltfBuilder b;
  b.triangle();
  const auto box = [](const Json& size) { return Json{{"relume", {{"lightBox", size}}}}; };
  b.node({{"extras", box({2, 1, 4})}, {"translation", {1, 0, 0}}, {"scale", {1, 2, 1}}});
  b.node({{"extras", box({2, 2, 2})}, {"rotation", {0, std::sin(M_PI / 8), 0, std::cos(M_PI / 8)}}});
  const Scene scene = b.scene();
  ASSERT_EQ(scene.light_boxes.size(), 2u);
  expectNear(scene.light_boxes[0].lo, {0, -1, -2});
  expectNear(scene.light_boxes[0].hi, {2, 1, 2});
  const float turned = std::sqrt(2.0f);  // half the diagonal of a square of 2 m
  expectNear(scene.light_boxes[1].hi, {turned, 1, turned});

  b.node({{"extras", box({2, 0, 2})}});
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-value");
}

TEST(Cameras, ArePlaced) {
  GltfBuilder b;
  b.triangle();
  b.doc["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}, {"name", "eye"}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 1}}}}};
  b.node({{"camera", 0}, {"translation", {0, 1, 0}}, {"scale", {2, 2, 2}}});
  b.node({{"camera", 1}, {"name", "plan"}});
  const Scene scene = b.scene();
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name, "eye");
  EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov, 0.5f);
  EXPECT_EQ(scene.cameras[0].world_from_camera, glm::translate(Mat4(1), Vec3(0, 1, 0)));
  EXPECT_TRUE(scene.cameras[1].orthographic);
  EXPECT_FLOAT_EQ(scene.cameras[1].ortho_height, 6);
  EXPECT_EQ(scene.cameras[1].name, "plan");
}

}  // namespace
}  // namespace relume::scene::gltf
