// SPDX-License-Identifier: MIT
// Irradiance as MOZ_lightmap: where it stands, what it leaves alone, and that it can be undone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fake_bake.h"
#include "gltf_builder.h"

namespace relume::scene::gltf {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

Document bake(const Document& document, const FakeBake& options) {
  Warnings warnings;
  const Scene scene = import(document, warnings);
  return Document::parse(exportGlb(document, scene, fakeBake(scene, options)), "baked.glb", {});
}

constexpr FakeBake kLightmap{.split = true, .pages = 1, .occlusion = false, .lightmap = true};

/// One triangle with a material.
GltfBuilder painted() {
  GltfBuilder b;
  Json primitive = b.trianglePrimitive();
  primitive["material"] = 0;
  b.doc["materials"] = {{{"name", "paint"}}};
  b.node({{"mesh", b.mesh(primitive)}});
  return b;
}

TEST(ExportLightmap, StandsOnTheMaterialWithItsPagesIntensity) {
  const Document out = bake(painted().document(), kLightmap);
  const Json& json = out.json();
  const Json& extension = json["materials"][0]["extensions"]["MOZ_lightmap"];
  EXPECT_EQ(extension["texCoord"], 1);
  EXPECT_EQ(extension["intensity"], 2.5);
  const Json& texture = json["textures"][extension["index"].get<std::size_t>()];
  EXPECT_EQ(json["images"][texture["source"].get<std::size_t>()]["mimeType"], "image/png");
  EXPECT_FALSE(json["materials"][0].contains("occlusionTexture"));
  EXPECT_THAT(json["extensionsUsed"], ElementsAre("MOZ_lightmap", "RELUME_transfer"));
  EXPECT_FALSE(json.contains("extensionsRequired"));
}

TEST(ExportLightmap, AMaterialOnTwoPagesIsCopied) {
  GltfBuilder b = painted();
  for (int i = 0; i < 2; ++i) b.node({{"mesh", 0}, {"translation", {i, 0, 0}}});
  b.node({{"mesh", 0}, {"extras", {{"relume", {{"dynamic", true}}}}}});
  FakeBake options = kLightmap;
  options.pages = 2;
  const Document out = bake(b.document(), options);
  const Json& materials = out.json()["materials"];
  ASSERT_EQ(materials.size(), 3u);
  EXPECT_EQ(materials[0], b.doc["materials"][0]) << "the one of the object that moves";
  EXPECT_EQ(materials[1]["extensions"]["MOZ_lightmap"]["intensity"], 2.5);
  EXPECT_EQ(materials[2]["extensions"]["MOZ_lightmap"]["intensity"], 3.5);
  EXPECT_NE(materials[1]["extensions"]["MOZ_lightmap"]["index"],
            materials[2]["extensions"]["MOZ_lightmap"]["index"]);
}

TEST(ExportLightmap, LeavesOtherExtensionsAndUnlitSurfacesAlone) {
  GltfBuilder b = painted();
  b.doc["materials"][0]["extensions"]["KHR_materials_ior"] = {{"ior", 1.4}};
  b.doc["materials"][0]["occlusionTexture"] = {{"index", 0}};
  b.push("materials", {{"name", "sign"}, {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  b.doc["textures"] = {{{"source", 0}}};
  b.doc["images"] = {
      {{"bufferView", b.view(image::encodePngData(image::Image(1, 1, 3, 1.0f)))}, {"mimeType", "image/png"}}};
  Json sign = b.trianglePrimitive();
  sign["material"] = 1;
  b.node({{"mesh", b.mesh(sign)}});
  b.doc["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_unlit"};
  const Document out = bake(b.document(), kLightmap);
  const Json& materials = out.json()["materials"];
  EXPECT_EQ(materials[0]["extensions"]["KHR_materials_ior"]["ior"], 1.4);
  EXPECT_TRUE(materials[0]["extensions"].contains("MOZ_lightmap"));
  EXPECT_EQ(materials[0]["occlusionTexture"], b.doc["materials"][0]["occlusionTexture"]);
  EXPECT_EQ(materials[1], b.doc["materials"][1]);
}

TEST(ExportLightmap, IsReplacedAndUndoneByTheNextBake) {
  GltfBuilder b = painted();
  b.doc["materials"][0]["extensions"]["MOZ_lightmap"] = {{"index", 0}, {"texCoord", 0}, {"intensity", 9}};
  b.doc["textures"] = {{{"source", 0}}};
  b.doc["images"] = {
      {{"bufferView", b.view(image::encodePngData(image::Image(1, 1, 3, 1.0f)))}, {"mimeType", "image/png"}}};
  b.doc["extensionsUsed"] = {"MOZ_lightmap"};
  const Document once = bake(b.document(), kLightmap);
  EXPECT_EQ(once.json()["materials"][0]["extensions"]["MOZ_lightmap"]["intensity"], 2.5);
  FakeBake again = kLightmap;
  again.split = false;
  const Document twice = bake(once, again);
  EXPECT_EQ(twice.json()["materials"], once.json()["materials"]);
  EXPECT_EQ(twice.json()["images"].size(), once.json()["images"].size());
  const Document bare =
      bake(twice, {.split = false, .pages = 1, .occlusion = false, .lightmap = false, .transfer = false});
  EXPECT_EQ(bare.json()["materials"], b.doc["materials"]);
  EXPECT_EQ(bare.json()["images"].size(), 1u);
  EXPECT_FALSE(bare.json().contains("samplers"));
  EXPECT_THAT(bare.json()["extensionsUsed"], ElementsAre("MOZ_lightmap", "RELUME_transfer"));
}

TEST(ExportLightmap, TexturesOfAnotherKindAreTakenOver) {
  const Document lit =
      bake(painted().document(), {.split = true, .pages = 1, .occlusion = true, .lightmap = true});
  EXPECT_EQ(lit.json()["images"].size(), 2u);
  EXPECT_EQ(lit.json()["samplers"].size(), 1u);
  for (const bool lightmap : {true, false}) {
    const Document one =
        bake(lit, {.split = false, .pages = 1, .occlusion = !lightmap, .lightmap = lightmap});
    EXPECT_EQ(one.json()["images"].size(), 1u);
    EXPECT_EQ(one.json()["textures"].size(), 1u);
    EXPECT_EQ(one.json()["materials"][0].contains("occlusionTexture"), !lightmap);
    EXPECT_EQ(one.json()["materials"][0].contains("extensions"), lightmap);
    EXPECT_EQ(one.json()["extensionsUsed"].size(), lightmap ? 2u : 1u);
  }
}

}  // namespace
}  // namespace relume::scene::gltf
