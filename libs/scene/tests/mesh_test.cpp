// SPDX-License-Identifier: MIT
// Primitives become indexed triangles: modes, indices, attributes of every type, and data that cannot be
// used.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gltf_builder.h"

namespace relume::scene::gltf {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Six vertices in a zigzag: (0,0), (0,1), (1,0), (1,1), (2,0), (2,1).
GltfBuilder zigzag(int mode) {
  GltfBuilder b;
  const auto positions = b.accessor<float>({0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0}, "VEC3");
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}, {"mode", mode}})}});
  return b;
}

TEST(Primitive, ListsStripsAndFans) {
  EXPECT_THAT(zigzag(4).scene().meshes[0].triangles, ElementsAre(UVec3(0, 1, 2), UVec3(3, 4, 5)));
  // glTF 2.0, section 3.7.2.1.
  EXPECT_THAT(zigzag(5).scene().meshes[0].triangles,
              ElementsAre(UVec3(0, 1, 2), UVec3(1, 3, 2), UVec3(2, 3, 4), UVec3(3, 5, 4)));
  EXPECT_THAT(zigzag(6).scene().meshes[0].triangles,
              ElementsAre(UVec3(1, 2, 0), UVec3(2, 3, 0), UVec3(3, 4, 0), UVec3(4, 5, 0)));
  // All triangles of a strip face the same way.
  const Scene strip = zigzag(5).scene();
  for (std::uint32_t t = 0; t < 4; ++t) EXPECT_EQ(geometricNormal(strip, 0, t), Normal(0, 0, -1)) << t;
}

TEST(Primitive, PointsAndLinesAreSkippedWithAWarning) {
  for (const int mode : {0, 1, 2, 3}) {
    GltfBuilder b = zigzag(mode);
    b.triangle();
    EXPECT_EQ(b.scene().triangleCount(), 1u);
    EXPECT_EQ(b.warnings.size(), 1u);
  }
  GltfBuilder lines = zigzag(1);
  EXPECT_EQ(errorOf([&] { lines.scene(); }), "empty-scene");
  GltfBuilder unknown = zigzag(7);
  EXPECT_EQ(errorOf([&] { unknown.scene(); }), "invalid-value");
}

template <class T>
std::vector<UVec3> withIndices(const std::vector<T>& indices) {
  GltfBuilder b = zigzag(4);
  b.doc["meshes"][0]["primitives"][0]["indices"] = b.accessor<T>(indices, "SCALAR");
  return b.scene().meshes[0].triangles;
}

TEST(Primitive, ReadsAllIndexTypes) {
  EXPECT_THAT(withIndices<std::uint8_t>({2, 1, 0}), ElementsAre(UVec3(2, 1, 0)));
  EXPECT_THAT(withIndices<std::uint16_t>({2, 1, 0, 5, 4, 3}), ElementsAre(UVec3(2, 1, 0), UVec3(5, 4, 3)));
  EXPECT_THAT(withIndices<std::uint32_t>({2, 1, 0, 5}), ElementsAre(UVec3(2, 1, 0)));  // one left over
  EXPECT_EQ(errorOf([] { withIndices<std::uint16_t>({0, 1, 6}); }), "out-of-bounds");
  EXPECT_EQ(errorOf([] { withIndices<std::uint32_t>({0, 1, 0xffffffff}); }), "out-of-bounds");
  EXPECT_EQ(errorOf([] { withIndices<float>({0, 1, 2}); }), "invalid-value");
  EXPECT_EQ(errorOf([] { withIndices<std::int16_t>({0, 1, 2}); }), "invalid-value");
}

TEST(Primitive, AnErrorNamesTheMeshAndThePrimitive) {
  GltfBuilder b = zigzag(4);
  b.doc["meshes"][0]["name"] = "Curtain";
  b.doc["meshes"][0]["primitives"][0]["indices"] = b.accessor<std::uint16_t>({0, 1, 9}, "SCALAR");
  try {
    b.scene();
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "test.glb: meshes[0] \"Curtain\".primitives[0].indices (accessors[1]): names vertex 9, but "
                 "POSITION has 6");
  }
}

TEST(Primitive, QuantizedPositionsAndNormals) {
  GltfBuilder b;
  const auto positions = b.accessor<std::int16_t>({0, 0, 0, 0, 200, 0, 0, 0, 0, 200, 0, 0}, "VEC4");
  b.doc["accessors"][positions] = {
      {"bufferView", 0}, {"componentType", 5122}, {"count", 3}, {"type", "VEC3"}};
  b.doc["bufferViews"][0]["byteStride"] = 8;
  const auto normals = b.accessor<std::int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, "VEC4", true);
  b.doc["accessors"][normals]["type"] = "VEC3";
  b.doc["bufferViews"][1]["byteStride"] = 4;
  const auto uv = b.accessor<std::uint16_t>({0, 0, 65535, 0, 0, 65535}, "VEC2", true);
  b.node({{"mesh",
           b.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uv}}}})}});
  b.doc["extensionsRequired"] = {"KHR_mesh_quantization"};
  const Scene scene = b.scene();
  EXPECT_THAT(scene.meshes[0].positions, ElementsAre(Point(0), Point(200, 0, 0), Point(0, 200, 0)));
  EXPECT_THAT(scene.meshes[0].normals, testing::Each(Normal(0, 0, 1)));
  EXPECT_THAT(scene.meshes[0].uv[0], ElementsAre(Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)));
}

TEST(Primitive, MissingNormalsAreFlatAndStillThere) {
  const Scene scene = zigzag(5).scene();
  EXPECT_TRUE(scene.meshes[0].flat_normals);
  EXPECT_THAT(scene.meshes[0].normals, testing::SizeIs(6));
  EXPECT_THAT(scene.meshes[0].normals, testing::Each(Normal(0, 0, -1)));
}

TEST(Primitive, UnusableNormalsAreMadeFromTheFaces) {
  GltfBuilder b;
  Json primitive = b.trianglePrimitive();
  primitive["attributes"]["NORMAL"] = b.accessor<float>({kNan, 0, 0, 0, 0, 0, 0, 3, 0}, "VEC3");
  b.node({{"mesh", b.mesh(primitive)}});
  EXPECT_THAT(b.scene().meshes[0].normals, ElementsAre(Normal(0, 0, 1), Normal(0, 0, 1), Normal(0, 1, 0)));
}

TEST(Primitive, ColoursOfBothShapesAreClamped) {
  GltfBuilder b;
  Json primitive = b.trianglePrimitive();
  primitive["attributes"]["COLOR_0"] =
      b.accessor<std::uint8_t>({255, 0, 51, 0, 0, 0, 255, 255, 255}, "VEC3", true);
  b.node({{"mesh", b.mesh(primitive)}});
  primitive["attributes"]["COLOR_0"] =
      b.accessor<float>({2, -1, 0.5, 0.25, 0, 0, 0, 0, kNan, 1, 1, 1}, "VEC4");
  b.node({{"mesh", b.mesh(primitive)}});
  const Scene scene = b.scene();
  EXPECT_EQ(scene.meshes[0].colours[0], Vec4(1, 0, 0.2f, 1));
  EXPECT_EQ(scene.meshes[1].colours[0], Vec4(1, 0, 0.5f, 0.25f));
  EXPECT_EQ(scene.meshes[1].colours[2], Vec4(1));
}

TEST(Primitive, TrianglesWithUnusablePositionsAreLeftOut) {
  GltfBuilder b;
  const auto positions =
      b.accessor<float>({kNan, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, INFINITY, 0, 0, 1e30f, 0, 0}, "VEC3");
  const auto uv = b.accessor<float>({9, 9, 1, 1, 2, 2, 3, 3, 9, 9, 9, 9}, "VEC2");
  const auto indices = b.accessor<std::uint16_t>({0, 1, 2, 3, 2, 1, 1, 2, 4, 1, 2, 5}, "SCALAR");
  b.node({{"mesh",
           b.mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv}}}, {"indices", indices}})}});
  const Scene scene = b.scene();
  const Mesh& mesh = scene.meshes[0];
  EXPECT_THAT(mesh.triangles, ElementsAre(UVec3(2, 1, 0)));
  EXPECT_THAT(mesh.positions, ElementsAre(Point(0), Point(1, 0, 0), Point(0, 1, 0)));
  EXPECT_THAT(mesh.uv[0], ElementsAre(Vec2(1), Vec2(2), Vec2(3)));
  EXPECT_THAT(mesh.gltf_vertex, ElementsAre(1u, 2u, 3u));
  ASSERT_EQ(b.warnings.size(), 1u);
  EXPECT_NE(b.warnings[0].text().find("3 of 4 triangles"), std::string::npos);
}

TEST(Primitive, AMeshOfNothingUsableIsAnEmptyScene) {
  GltfBuilder b;
  const auto positions = b.accessor<float>(std::vector<float>(9, kNan), "VEC3");
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}})}});
  EXPECT_EQ(errorOf([&] { b.scene(); }), "empty-scene");
}

TEST(Primitive, DegenerateTrianglesStayAndAreToldOfWhenAllAreSo) {
  GltfBuilder b = zigzag(4);
  b.doc["meshes"][0]["primitives"][0]["indices"] = b.accessor<std::uint8_t>({0, 0, 1, 0, 1, 2}, "SCALAR");
  EXPECT_EQ(b.scene().triangleCount(), 2u);
  EXPECT_TRUE(b.warnings.empty());
  b.doc["meshes"][0]["primitives"][0]["indices"] = b.accessor<std::uint8_t>({0, 0, 1, 2, 2, 2}, "SCALAR");
  EXPECT_EQ(b.scene().triangleCount(), 2u);
  EXPECT_EQ(b.warnings.size(), 1u);
}

// Primitives of one mesh often share one large set of vertices.
TEST(Primitive, VerticesThatNoTriangleUsesAreLeftOut) {
  GltfBuilder b;
  std::vector<float> positions;
  for (int i = 0; i < 1000; ++i)
    positions.insert(positions.end(), {static_cast<float>(i), static_cast<float>(i * i % 7), 0});
  const auto accessor = b.accessor<float>(positions, "VEC3");
  const auto indices = b.accessor<std::uint16_t>({900, 500, 700}, "SCALAR");
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", accessor}}}, {"indices", indices}})}});
  const Scene scene = b.scene();
  const Mesh& mesh = scene.meshes[0];
  EXPECT_THAT(mesh.gltf_vertex, ElementsAre(500u, 700u, 900u));
  EXPECT_THAT(mesh.triangles, ElementsAre(UVec3(2, 0, 1)));
  EXPECT_EQ(mesh.positions[2].x, 900.0f);
}

TEST(Primitive, AttributesMustReachAllVertices) {
  GltfBuilder b;
  Json primitive = b.trianglePrimitive();
  primitive["attributes"]["TEXCOORD_0"] = b.accessor<float>({0, 0, 1, 0}, "VEC2");
  b.node({{"mesh", b.mesh(primitive)}});
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-value");
}

// The same indices used thousands of times would fill any memory.
TEST(Primitive, RefusesWhatUnfoldsOutOfProportion) {
  GltfBuilder b;
  const Json primitive = {
      {"attributes", b.triangleAttributes()},
      {"indices", b.accessor<std::uint8_t>(std::vector<std::uint8_t>(30000, 1), "SCALAR")}};
  Json primitives = Json::array();
  for (int i = 0; i < 3000; ++i) primitives.push_back(primitive);
  b.push("meshes", {{"primitives", primitives}});
  b.node({{"mesh", 0}});
  EXPECT_EQ(errorOf([&] { b.scene(); }), "out-of-bounds");
}

TEST(Primitive, NamesAndMaterials) {
  GltfBuilder b;
  const Json primitive = b.trianglePrimitive();
  Json with_material = primitive;
  with_material["material"] = 0;
  b.doc["materials"] = {{{"name", "paint"}}};
  b.push("meshes", {{"name", "table"}, {"primitives", {primitive, with_material}}});
  b.node({{"mesh", 0}});
  const Scene scene = b.scene();
  EXPECT_EQ(scene.meshes[0].name, "table[0]");
  EXPECT_EQ(scene.meshes[1].name, "table[1]");
  EXPECT_EQ(scene.meshes[0].material, 1u);  // the default one, last
  EXPECT_EQ(scene.meshes[1].material, 0u);
  EXPECT_EQ(scene.meshes[1].gltf_primitive, 1u);
  b.doc["meshes"][0]["primitives"][0]["material"] = 1;
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-reference");
}

}  // namespace
}  // namespace relume::scene::gltf
