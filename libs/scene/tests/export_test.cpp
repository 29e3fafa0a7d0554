// SPDX-License-Identifier: MIT
// Export: the bake is in the file, everything else is still there, and baking a bake does not grow.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fake_bake.h"
#include "glb.h"
#include "gltf_builder.h"
#include "relume/core/parallel.h"

namespace relume::scene::gltf {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

struct Baked {
  std::vector<std::byte> file;
  Document document;
  Scene scene;
};

Baked bakeAgain(const Document& document, const FakeBake& options = {}) {
  Warnings warnings;
  const Scene scene = import(document, warnings);
  std::vector<std::byte> file = exportGlb(document, scene, fakeBake(scene, options));
  Document out = Document::parse(file, "baked.glb", {});
  Scene back = import(out, warnings);
  return {std::move(file), std::move(out), std::move(back)};
}

Baked bake(const GltfBuilder& b, const FakeBake& options = {}) { return bakeAgain(b.document(), options); }

/// Positions of all triangle corners in the world, in order: what a split must not change.
std::vector<Point> corners(const Scene& scene) {
  std::vector<Point> out;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const Vec2 b : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)})
        out.push_back(worldPosition(scene, {i, t, b.x, b.y}));
  }
  return out;
}

/// Two triangles that share an edge, with a material whose occlusion texture is on TEXCOORD_0.
GltfBuilder quad() {
  GltfBuilder b;
  Json primitive;
  primitive["attributes"] = {{"POSITION", b.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3")},
                             {"TEXCOORD_0", b.accessor<float>({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2")}};
  primitive["indices"] = b.accessor<std::uint8_t>({0, 1, 2, 2, 1, 3}, "SCALAR");
  primitive["material"] = 0;
  b.doc["materials"] = {{{"name", "paint"}, {"occlusionTexture", {{"index", 0}, {"strength", 0.5}}}}};
  b.doc["textures"] = {{{"source", 0}}};
  b.doc["images"] = {
      {{"bufferView", b.view(image::encodePngData(image::Image(1, 1, 3, 1.0f)))}, {"mimeType", "image/png"}}};
  b.node({{"mesh", b.mesh(primitive)}, {"name", "quad"}});
  return b;
}

TEST(Export, CarriesTheBake) {
  const Baked out = bake(quad(), {.split = true, .pages = 1});
  const Json& json = out.document.json();
  const Mesh& mesh = out.scene.meshes[0];
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.atlas_page, 0u);
  Warnings warnings;
  const Scene before = import(quad().document(), warnings);
  EXPECT_EQ(corners(out.scene), corners(before));
  EXPECT_EQ(mesh.uv[1], fakeBake(before).uses[0].uv);
  EXPECT_EQ(mesh.uv[0][5], Vec2(1, 1));

  EXPECT_THAT(json["extensionsUsed"], ElementsAre("RELUME_transfer"));
  const Json& layers = json["extensions"]["RELUME_transfer"]["layers"];
  const auto bytesOfView = [&](const Json& index) {
    return json["bufferViews"][index.get<std::size_t>()]["byteLength"];
  };
  EXPECT_EQ(bytesOfView(layers[0]["bufferView"]), 8);
  EXPECT_EQ(bytesOfView(layers[1]["bufferView"]), 5);

  const Json& material = json["materials"][0];
  EXPECT_EQ(json["materials"].size(), 1u);
  EXPECT_EQ(material["occlusionTexture"]["texCoord"], 1);
  EXPECT_FALSE(material["occlusionTexture"].contains("strength"));
  EXPECT_EQ(material["extras"]["relume"]["occlusionTexture"], Json({{"index", 0}, {"strength", 0.5}}));
  const Json& texture = json["textures"][material["occlusionTexture"]["index"].get<std::size_t>()];
  EXPECT_EQ(json["images"][texture["source"].get<std::size_t>()]["mimeType"], "image/png");
}

TEST(Export, KeepsAccessorsOfAnUnsplitMesh) {
  const Baked out = bake(quad(), {.split = false});
  const Json& primitive = out.document.json()["meshes"][0]["primitives"][0];
  EXPECT_EQ(out.document.json()["accessors"].size(), 4u);  // three of the input, and TEXCOORD_1
  EXPECT_EQ(out.document.json()["accessors"][primitive["indices"].get<std::size_t>()]["componentType"], 5121);
}

TEST(Export, DropsWhatNothingRefersToAnyMore) {
  const Baked out = bake(quad(), {.split = true, .occlusion = false, .transfer = false});
  const Json& json = out.document.json();
  EXPECT_EQ(json["accessors"].size(), 4u);
  EXPECT_EQ(json["bufferViews"].size(), 5u);  // and the image
}

TEST(Export, CutsUnusedBytesOutOfSharedViews) {
  GltfBuilder b;
  // One view for the positions of two meshes; one of them moves, so is not baked, and keeps its half.
  const std::vector<float> positions = {9, 9, 9, 9, 9, 9, 9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  const auto view = b.view(toBytes(positions));
  for (const int offset : {0, 36})
    b.push("accessors", {{"bufferView", view},
                         {"byteOffset", offset},
                         {"componentType", 5126},
                         {"count", 3},
                         {"type", "VEC3"}});
  b.node(
      {{"mesh", b.mesh({{"attributes", {{"POSITION", 0}}}})}, {"extras", {{"relume", {{"static", true}}}}}});
  b.node(
      {{"mesh", b.mesh({{"attributes", {{"POSITION", 1}}}})}, {"extras", {{"relume", {{"dynamic", true}}}}}});
  Warnings warnings;
  const Document document = b.document();
  const Scene scene = import(document, warnings);
  BakeOutput nothing = fakeBake(scene, {.split = true, .occlusion = false, .transfer = false});
  std::swap(nothing.uses[0].source_vertex[0], nothing.uses[0].source_vertex[1]);  // not the identity
  const Document out = Document::parse(exportGlb(document, scene, nothing), "out.glb", {});
  const auto& accessors = out.json()["accessors"];
  ASSERT_EQ(accessors.size(), 4u);
  EXPECT_EQ(accessors[0]["byteOffset"], 0);
  EXPECT_EQ(out.json()["bufferViews"][0]["byteLength"], 36);
  EXPECT_EQ(corners(import(out, warnings)), corners(scene));
}

TEST(Export, KeepsEverythingElse) {
  GltfBuilder b = quad();
  const auto joint = b.node({{"name", "joint"}});
  const auto matrices = b.accessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4");
  b.doc["skins"] = {{{"joints", {joint}}, {"inverseBindMatrices", matrices}, {"name", "skin"}}};
  const auto times = b.accessor<float>({0, 1}, "SCALAR");
  const auto values = b.accessor<float>({0, 0, 0, 0, 1, 0}, "VEC3");
  b.doc["animations"] = {
      {{"name", "hop"},
       {"samplers", {{{"input", times}, {"output", values}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", joint}, {"path", "translation"}}}}}}}};
  b.doc["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  b.doc["asset"]["copyright"] = "me";
  b.doc["asset"]["extras"] = {{"tool", 3}};
  b.doc["extras"] = {1, "two", {{"three", nullptr}}};
  b.doc["nodes"][0]["extras"] = {{"door", true}};
  b.doc["meshes"][0]["name"] = "wall";
  b.doc["materials"][0]["extras"] = "text";
  b.doc["extensions"]["VENDOR_fog"] = {{"density", 0.1}, {"accessor", times}, {"bufferView", 2}};
  b.doc["extensionsUsed"] = {"VENDOR_fog"};
  const Json before = b.doc;
  const Baked out = bake(b);
  const Json& after = out.document.json();
  for (const char* key : {"asset", "extras", "nodes", "scenes", "skins", "animations", "cameras"}) {
    Json kept = after[key];
    if (key == std::string("asset")) kept["extras"].erase("relume");
    EXPECT_EQ(kept, before[key]) << key;
  }
  EXPECT_EQ(after["meshes"][0]["name"], "wall");
  EXPECT_EQ(after["materials"][0]["extras"]["value"], "text");
  EXPECT_EQ(after["extensions"]["VENDOR_fog"], before["extensions"]["VENDOR_fog"]);
  EXPECT_THAT(after["extensionsUsed"], ElementsAre("VENDOR_fog", "RELUME_transfer"));
  // What the unknown extension may refer to has kept its number.
  for (const char* list : {"accessors", "bufferViews"})
    for (std::size_t i = 0; i < before[list].size(); ++i)
      EXPECT_EQ(after[list][i].value("type", ""), before[list][i].value("type", "")) << list << i;
}

TEST(Export, MaterialsAreCopiedForEachPageAndForWhoIsNotBaked) {
  GltfBuilder b = quad();
  for (int i = 0; i < 4; ++i) b.node({{"mesh", 0}, {"translation", {i, 0, 0}}});
  b.node({{"mesh", 0}, {"extras", {{"relume", {{"dynamic", true}}}}}});
  const Baked out = bake(b, {.split = true, .pages = 2});
  const Json& json = out.document.json();
  // The original for the dynamic node, one for each page.
  ASSERT_EQ(json["materials"].size(), 3u);
  EXPECT_EQ(json["materials"][0], b.doc["materials"][0]);
  EXPECT_EQ(json["images"].size(), 3u);
  EXPECT_EQ(json["meshes"].size(), 6u);
  std::vector<std::uint32_t> pages;
  for (const Instance& i : out.scene.instances) pages.push_back(out.scene.meshes[i.mesh].atlas_page);
  EXPECT_THAT(pages, ElementsAre(0u, 1u, 0u, 1u, 0u, kNone));
  // All five share the split vertices, and each has its own atlas coordinates.
  EXPECT_EQ(json["accessors"].size(), 3u + 3u + 5u);
}

TEST(Export, PrimitivesWithoutMaterialGetOne) {
  GltfBuilder b;
  b.triangle();
  const Baked out = bake(b);
  const Json& json = out.document.json();
  ASSERT_EQ(json["materials"].size(), 1u);
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["material"], 0);
  EXPECT_FALSE(json["materials"][0].contains("pbrMetallicRoughness"));
  // Read back, it is still the white dielectric that stands for none, not glTF's default of white metal.
  const Material& material = out.scene.materials[out.scene.meshes[0].material];
  EXPECT_EQ(material.metallic, 0.0f);
  EXPECT_EQ(material.base_colour, Vec4(0.8f, 0.8f, 0.8f, 1));
}

TEST(Export, WithoutOcclusionMaterialsStay) {
  const GltfBuilder b = quad();
  const Baked out = bake(b, {.split = true, .occlusion = false});
  EXPECT_EQ(out.document.json()["materials"], b.doc["materials"]);
  EXPECT_EQ(out.document.json()["images"].size(), 1u);
}

TEST(Export, TheSecondSetOfCoordinatesMovesWhereATextureNeedsIt) {
  GltfBuilder b = quad();
  Json& primitive = b.doc["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_1"] =
      b.accessor<std::uint16_t>({0, 0, 65535, 0, 0, 65535, 65535, 65535}, "VEC2", true);
  primitive["attributes"]["TEXCOORD_2"] = b.accessor<float>({5, 5, 5, 5, 5, 5, 5, 5}, "VEC2");
  b.doc["materials"][0]["emissiveTexture"] = {
      {"index", 0}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 1}}}}}};
  b.doc["materials"][0]["emissiveFactor"] = {1, 1, 1};
  b.doc["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatTexture"] = {{"index", 0},
                                                                                        {"texCoord", 1}};
  b.doc["materials"][0]["occlusionTexture"]["texCoord"] = 1;
  b.doc["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_clearcoat"};
  for (const bool split : {false, true}) {
    const Baked out = bake(b, {.split = split});
    const Json& material = out.document.json()["materials"][0];
    EXPECT_EQ(material["emissiveTexture"]["extensions"]["KHR_texture_transform"]["texCoord"], 3);
    EXPECT_EQ(material["extensions"]["KHR_materials_clearcoat"]["clearcoatTexture"]["texCoord"], 3);
    EXPECT_EQ(material["occlusionTexture"]["texCoord"], 1);
    EXPECT_EQ(material["extras"]["relume"]["occlusionTexture"]["texCoord"], 3);
    const Mesh& mesh = out.scene.meshes[0];
    const auto corner = mesh.triangles[1].z;
    EXPECT_EQ(mesh.uv[3][corner], Vec2(1, 1));
    EXPECT_EQ(out.document.json()["meshes"][0]["primitives"][0]["attributes"].size(), 5u);
    // Baked again, nothing has to move any more.
    const Baked twice = bakeAgain(out.document, {.split = false});
    EXPECT_EQ(twice.document.json()["meshes"][0]["primitives"][0]["attributes"].size(), 5u);
    EXPECT_EQ(twice.document.json()["materials"], out.document.json()["materials"]);
  }
}

TEST(Export, AnUnusedSecondSetIsReplaced) {
  GltfBuilder b = quad();
  Json& attributes = b.doc["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"];
  const Baked out = bake(b);
  EXPECT_EQ(out.document.json()["meshes"][0]["primitives"][0]["attributes"].size(), 3u);
}

TEST(Export, GathersJointsMorphTargetsAndCustomAttributesInTheirTypes) {
  GltfBuilder b = quad();
  Json& primitive = b.doc["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] =
      b.accessor<std::uint8_t>({1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0}, "VEC4");
  primitive["attributes"]["WEIGHTS_0"] =
      b.accessor<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, "VEC4", true);
  primitive["attributes"]["_ID"] = b.accessor<std::uint16_t>({10, 11, 12, 13}, "SCALAR");
  const auto delta = b.accessor<float>({0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3");
  b.doc["accessors"][delta]["min"] = {0, 0, 0};
  b.doc["accessors"][delta]["max"] = {0, 0, 3};
  primitive["targets"] = {{{"POSITION", delta}}};
  const Baked out = bake(b);
  const Json& json = out.document.json();
  const Json& p = json["meshes"][0]["primitives"][0];
  const auto accessor = [&](const Json& index) { return json["accessors"][index.get<std::size_t>()]; };
  EXPECT_EQ(accessor(p["attributes"]["JOINTS_0"])["componentType"], 5121);
  EXPECT_EQ(accessor(p["attributes"]["WEIGHTS_0"])["normalized"], true);
  EXPECT_EQ(accessor(p["attributes"]["_ID"])["count"], 6);
  EXPECT_EQ(accessor(p["targets"][0]["POSITION"])["max"], Json({0.0, 0.0, 3.0}));
  EXPECT_EQ(accessor(p["attributes"]["POSITION"])["max"], Json({1.0, 1.0, 0.0}));
  // Elements of two bytes are padded to four.
  const Json ids = accessor(p["attributes"]["_ID"]);
  const Json& view = json["bufferViews"][ids["bufferView"].get<std::size_t>()];
  EXPECT_EQ(view["byteStride"], 4);
  const auto chunks = splitGlb(out.file, "out");
  const std::byte* bytes = chunks.binary->data() + view["byteOffset"].get<std::size_t>();
  std::vector<int> values;
  for (int i = 0; i < 6; ++i) values.push_back(std::to_integer<int>(bytes[4 * i]));
  EXPECT_THAT(values, ElementsAre(10, 11, 12, 12, 11, 13));
}

TEST(Export, StripsBecomeIndexedLists) {
  GltfBuilder b = quad();
  b.doc["meshes"][0]["primitives"][0].erase("indices");
  b.doc["meshes"][0]["primitives"][0]["mode"] = 5;
  Warnings warnings;
  const Scene before = import(b.document(), warnings);
  const Baked out = bake(b, {.split = false});
  EXPECT_FALSE(out.document.json()["meshes"][0]["primitives"][0].contains("mode"));
  EXPECT_EQ(corners(out.scene), corners(before));
}

TEST(Export, VariantsFollowTheBake) {
  GltfBuilder b = quad();
  b.push("materials", {{"name", "second"}});
  b.doc["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", 1}, {"variants", {0}}}};
  b.doc["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "other"}}};
  b.doc["extensionsUsed"] = {"KHR_materials_variants"};
  const Baked out = bake(b);
  EXPECT_TRUE(out.document.json()["materials"][1].contains("occlusionTexture"));
}

TEST(Export, CopiesOfInstancedMeshesBecomeNodes) {
  GltfBuilder b = quad();
  const auto translations = b.accessor<float>({1, 0, 0, 2, 0, 0}, "VEC3");
  b.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", translations}};
  b.doc["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  Warnings warnings;
  const Scene before = import(b.document(), warnings);
  const Baked out = bake(b);
  EXPECT_EQ(corners(out.scene), corners(before));
  EXPECT_EQ(out.document.json()["nodes"][0]["children"].size(), 2u);
  EXPECT_THAT(out.document.json()["extensionsUsed"], ElementsAre("RELUME_transfer"));
  EXPECT_NE(out.scene.meshes[0].uv[1], out.scene.meshes[1].uv[1]);
}

TEST(Export, EmbedsImages) {
  GltfBuilder b = quad();
  const std::string data = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUg==";  // the beginning of a PNG
  b.push("images", {{"uri", data}, {"name", "n"}});
  b.push("images", {{"uri", "missing.png"}});
  const Baked out = bake(b, {.split = true, .occlusion = false});
  const Json& json = out.document.json();
  EXPECT_FALSE(json["images"][1].contains("uri"));
  EXPECT_EQ(json["images"][1]["mimeType"], "image/png");
  EXPECT_EQ(json["images"][1]["name"], "n");
  EXPECT_EQ(json["images"][2]["uri"], "missing.png");
}

TEST(Export, ABakeBakedAgainDoesNotGrow) {
  GltfBuilder b = quad();
  for (int i = 0; i < 4; ++i) b.node({{"mesh", 0}, {"translation", {i, 0, 0}}});
  b.node({{"mesh", b.mesh(b.trianglePrimitive())}});
  const Baked once = bake(b, {.split = true, .pages = 2});
  const Baked twice = bakeAgain(once.document, {.split = false, .pages = 2});
  EXPECT_EQ(twice.file.size(), once.file.size());
  EXPECT_EQ(twice.document.json()["materials"], once.document.json()["materials"]);
  EXPECT_EQ(corners(twice.scene), corners(once.scene));
  // Other pages, fewer pages, more pages: still no growth beyond the pages themselves.
  const Baked fewer = bakeAgain(twice.document, {.split = false, .pages = 1});
  EXPECT_LT(fewer.file.size(), once.file.size());
  EXPECT_EQ(fewer.document.json()["images"].size(), 2u);
  EXPECT_EQ(fewer.document.json()["materials"].size(), 2u);
  const Baked again = bakeAgain(fewer.document, {.split = false, .pages = 2});
  EXPECT_EQ(again.file.size(), once.file.size());
  // Without occlusion the materials are as they were.
  const Baked bare = bakeAgain(once.document, {.split = false, .occlusion = false, .transfer = false});
  EXPECT_EQ(bare.document.json()["materials"], b.doc["materials"]);
  EXPECT_FALSE(bare.document.json()["meshes"][1]["primitives"][0].contains("material"));
  EXPECT_FALSE(bare.document.json().contains("samplers"));
}

// Seams of an earlier atlas are in the vertices; another atlas must not add its own to them.
TEST(Export, AnotherAtlasDoesNotKeepTheSeamsOfTheFirst) {
  const GltfBuilder b = quad();
  const Baked cut = bake(b, {.split = true});
  ASSERT_EQ(cut.scene.meshes[0].positions.size(), 6u);
  // The second atlas is in one piece: coordinates follow the position.
  BakeOutput whole = fakeBake(cut.scene, {.split = true});
  for (std::uint32_t v = 0; v < 6; ++v)
    whole.uses[0].uv[v] = Vec2(cut.scene.meshes[0].positions[whole.uses[0].source_vertex[v]]);
  whole.uses[0].source_vertex = {5, 4, 3, 2, 1, 0};
  std::ranges::reverse(whole.uses[0].uv);
  whole.uses[0].triangles = {{5, 4, 3}, {2, 1, 0}};
  Warnings warnings;
  const Scene back =
      import(Document::parse(exportGlb(cut.document, cut.scene, whole), "back.glb", {}), warnings);
  EXPECT_EQ(back.meshes[0].positions.size(), 4u);
  EXPECT_EQ(corners(back), corners(cut.scene));
}

TEST(Export, AnUnknownExtensionKeepsNumbersButDoesNotMakeItGrow) {
  GltfBuilder b = quad();
  b.doc["extensions"]["VENDOR_fog"] = {{"accessor", 1}};
  b.doc["extensionsUsed"] = {"VENDOR_fog"};
  const Baked once = bake(b);
  const Baked twice = bakeAgain(once.document, {.split = false});
  const Baked thrice = bakeAgain(twice.document, {.split = false});
  EXPECT_EQ(once.document.json()["accessors"][1], b.doc["accessors"][1]);
  EXPECT_EQ(twice.file.size(), once.file.size());
  EXPECT_EQ(thrice.file, twice.file);
}

TEST(Export, BytesDoNotDependOnThreads) {
  const GltfBuilder b = quad();
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return bake(b, {.split = true, .pages = 2}).file;
  };
  EXPECT_EQ(with(1), with(4));
}

TEST(Export, TrianglesLeftOutByImportAreGone) {
  GltfBuilder b = quad();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  b.doc["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      b.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, nan, 1, 0}, "VEC3");
  const Baked out = bake(b, {.split = false});
  EXPECT_EQ(out.scene.triangleCount(), 1u);
  Warnings warnings;
  import(out.document, warnings);
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace relume::scene::gltf
