// SPDX-License-Identifier: MIT
// Materials, textures and what of them is decoded.
#include <gtest/gtest.h>
#include <webp/encode.h>

#include "gltf_builder.h"
#include "relume/image/io.h"

namespace relume::scene::gltf {
namespace {

using Json = nlohmann::json;

/// A file with one triangle of one material.
GltfBuilder withMaterial(Json material) {
  GltfBuilder b;
  Json primitive = b.trianglePrimitive();
  primitive["material"] = 0;
  b.doc["materials"] = Json::array({std::move(material)});
  b.node({{"mesh", b.mesh(primitive)}});
  return b;
}

std::vector<std::byte> png(Vec3 srgb) {
  image::Image one(1, 1, 3);
  one.setRgb(0, 0, srgb);
  return image::encodePngData(one);
}

std::size_t addTexture(GltfBuilder& b, const std::vector<std::byte>& file, const char* mime = "image/png") {
  const auto image = b.push("images", {{"bufferView", b.view(file)}, {"mimeType", mime}});
  return b.push("textures", {{"source", image}});
}

TEST(Material, NamesItsHeightMap) {
  GltfBuilder b = withMaterial({{"extras", {{"relume", {{"height", {{"index", 0}, {"scale", 0.125}}}}}}}});
  addTexture(b, png(Vec3(0.5f)));
  const Scene read = b.scene({.normal_maps = true});
  const Material& m = read.materials[0];
  ASSERT_TRUE(m.height_texture);
  EXPECT_EQ(m.height_scale, 0.125f);
  EXPECT_FALSE(read.textures[m.height_texture.texture].srgb);
  EXPECT_TRUE(read.textures[m.height_texture.texture].image);
  EXPECT_FALSE(b.scene().textures[m.height_texture.texture].image);  // nobody needs it
  b.doc["materials"][0]["extras"]["relume"]["height"]["scale"] = -1;
  EXPECT_THROW(b.scene(), Error);
}

TEST(Material, ReadsTheFactors) {
  GltfBuilder b = withMaterial(
      {{"name", "m"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.25}}},
       {"emissiveFactor", {0.5, 1, 0}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.75},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
         {"KHR_materials_unlit", Json::object()}}}});
  const Material m = b.scene().materials[0];
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.base_colour, Vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(m.emission, Vec3(5, 10, 0));
  EXPECT_EQ(m.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(m.alpha_cutoff, 0.75f);
  EXPECT_TRUE(m.double_sided);
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(m.transmission, 0.9f);
}

TEST(Material, DefaultsAreThoseOfGltfButWithoutMaterialItIsWhiteDielectric) {
  const Scene scene = withMaterial(Json::object()).scene();
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].base_colour, Vec4(1));
  EXPECT_EQ(scene.materials[0].metallic, 1.0f);
  EXPECT_EQ(scene.materials[0].emission, Vec3(0));
  EXPECT_EQ(scene.materials[1].base_colour, Vec4(0.8f, 0.8f, 0.8f, 1));
  EXPECT_EQ(scene.materials[1].metallic, 0.0f);
}

TEST(Material, SpecularGlossinessIsReadAsItsDiffusePart) {
  GltfBuilder b = withMaterial({{"extensions",
                                 {{"KHR_materials_pbrSpecularGlossiness",
                                   {{"diffuseFactor", {0.5, 0.25, 1, 1}}, {"glossinessFactor", 0.75}}}}}});
  const Material m = b.scene().materials[0];
  EXPECT_EQ(m.base_colour, Vec4(0.5f, 0.25f, 1, 1));
  EXPECT_EQ(m.metallic, 0.0f);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(b.warnings.size(), 1u);
}

TEST(Material, RefusesReferencesThatLeadNowhere) {
  GltfBuilder b = withMaterial({{"normalTexture", {{"index", 0}}}});
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-reference");
  b.doc["textures"] = {{{"source", 0}}};
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-reference");
  b.doc["textures"] = {{{"sampler", 0}}};
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-reference");
  b.doc["textures"] = Json::array({Json::object()});
  EXPECT_EQ(errorOf([&] { b.scene(); }), "no error");
  b.doc["materials"][0]["emissiveFactor"] = {1, 1};
  EXPECT_EQ(errorOf([&] { b.scene(); }), "invalid-value");
}

TEST(Textures, DecodeWhatLightNeedsOnce) {
  GltfBuilder b = withMaterial({});
  const auto colour = addTexture(b, png({1, 0, 0}));
  const auto rough = addTexture(b, png({0, 1, 0}));
  const auto glow = addTexture(b, png({0, 0, 1}));
  const auto bumps = addTexture(b, png({0.5, 0.5, 1}));
  const auto unused = addTexture(b, png({1, 1, 1}));
  b.doc["materials"][0] = {
      {"pbrMetallicRoughness",
       {{"baseColorTexture", {{"index", colour}}}, {"metallicRoughnessTexture", {{"index", rough}}}}},
      {"emissiveTexture", {{"index", glow}}},
      {"emissiveFactor", {1, 1, 1}},
      {"normalTexture", {{"index", bumps}}}};
  b.push("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", unused}}}}}});
  b.push("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", colour}}}}}});

  const auto decoded = [&](const ImportOptions& options) {
    const Scene scene = b.scene(options);
    const Material& m = scene.materials[0];
    std::string out;
    const auto put = [&](char name, const TextureRef& ref) {
      if (scene.textures.at(ref.texture).image) out += name;
    };
    put('c', m.base_colour_texture);
    put('r', m.metallic_roughness_texture);
    put('e', m.emission_texture);
    put('n', m.normal_texture);
    put('u', scene.materials[1].base_colour_texture);
    EXPECT_EQ(scene.materials[2].base_colour_texture.texture, m.base_colour_texture.texture);
    return out;
  };
  EXPECT_EQ(decoded({}), "cre");
  EXPECT_EQ(decoded({TextureUse::kLight, true}), "cren");
  EXPECT_EQ(decoded({TextureUse::kOpacity, false}), "");
  EXPECT_EQ(decoded({TextureUse::kNone, false}), "");
  b.doc["materials"][0]["alphaMode"] = "BLEND";
  EXPECT_EQ(decoded({TextureUse::kOpacity, false}), "c");
  // An emissive texture under a factor of zero sends no light.
  b.doc["materials"][0]["emissiveFactor"] = {0, 0, 0};
  EXPECT_EQ(decoded({}), "cr");
  EXPECT_TRUE(b.warnings.empty());
}

TEST(Textures, ColourIsSrgbAndDataIsLinear) {
  GltfBuilder b = withMaterial({});
  const auto grey = addTexture(b, png(Vec3(0.5f)));
  b.doc["materials"][0] = {
      {"pbrMetallicRoughness",
       {{"baseColorTexture", {{"index", grey}}}, {"metallicRoughnessTexture", {{"index", grey}}}}}};
  const Scene scene = b.scene();
  const Surface s = surfaceAt(scene, {0, 0, 0, 0});
  EXPECT_NEAR(s.base_colour.r, 0.2159f, 1e-3f);  // sRGB 128
  EXPECT_NEAR(s.metallic, 128 / 255.0f, 1e-6f);
  EXPECT_NEAR(s.roughness, 128 / 255.0f, 1e-6f);
  ASSERT_EQ(scene.textures.size(), 2u);
  EXPECT_EQ(scene.textures[0].image, scene.textures[1].image);  // decoded once
}

TEST(Textures, WebpAndItsFallback) {
  const std::uint8_t pixel[] = {255, 0, 0};
  std::uint8_t* packed = nullptr;
  const std::size_t size = WebPEncodeLosslessRGB(pixel, 1, 1, 3, &packed);
  GltfBuilder b =
      withMaterial({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}});
  const auto webp =
      b.push("images", {{"bufferView", b.view(toBytes(packed, size))}, {"mimeType", "image/webp"}});
  WebPFree(packed);
  b.doc["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", webp}}}}}}};
  b.doc["extensionsRequired"] = {"EXT_texture_webp"};
  EXPECT_EQ(surfaceAt(b.scene(), {0, 0, 0, 0}).base_colour, Vec4(1, 0, 0, 1));
}

TEST(Textures, WhatCannotBeReadIsWhiteWithAWarning) {
  GltfBuilder b =
      withMaterial({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}});
  b.doc["textures"] = {{{"source", 0}}};
  const std::vector<Json> broken = {
      {{"uri", "missing.png"}},
      {{"uri", "https://example.org/a.png"}},
      {{"uri", "data:image/png;base64,AAAA"}},
      {{"uri", "%!QAAAQAAA5"}},
      {{"bufferView", 0}},
      {{"bufferView", 99}},
      {{"mimeType", "image/png"}},
  };
  for (const Json& image : broken) {
    b.doc["images"] = Json::array({image});
    const Scene scene = b.scene();
    EXPECT_EQ(b.warnings.size(), 1u) << image;
    EXPECT_EQ(surfaceAt(scene, {0, 0, 0, 0}).base_colour, Vec4(1)) << image;
  }
  b.doc["textures"] = Json::array({Json::object()});  // an image only an unknown extension knows
  b.scene();
  EXPECT_EQ(b.warnings.size(), 1u);
}

TEST(Textures, TransformAndItsTexCoord) {
  GltfBuilder b = withMaterial({});
  const auto grey = addTexture(b, png(Vec3(0.5f)));
  b.doc["materials"][0] = {
      {"pbrMetallicRoughness",
       {{"baseColorTexture",
         {{"index", grey},
          {"texCoord", 0},
          {"extensions",
           {{"KHR_texture_transform",
             {{"offset", {0.5, 0.25}}, {"rotation", 1.5}, {"scale", {2, 3}}, {"texCoord", 1}}}}}}}}}};
  const Scene scene = b.scene();
  const TextureRef& ref = scene.materials[0].base_colour_texture;
  EXPECT_EQ(ref.uv_set, 1u);
  EXPECT_EQ(ref.offset, Vec2(0.5f, 0.25f));
  EXPECT_EQ(ref.scale, Vec2(2, 3));
  EXPECT_EQ(ref.rotation, 1.5f);
}

TEST(Textures, FurtherSetsAreReadWhereTheyAreUsed) {
  GltfBuilder b = withMaterial({});
  const auto grey = addTexture(b, png(Vec3(0.5f)));
  b.doc["materials"][0] = {{"emissiveTexture", {{"index", grey}, {"texCoord", 2}}}};
  Json& attributes = b.doc["meshes"][0]["primitives"][0]["attributes"];
  for (const char* name : {"TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"})
    attributes[name] = attributes["TEXCOORD_0"];
  const Scene scene = b.scene();
  EXPECT_FALSE(scene.meshes[0].uv[2].empty());
  EXPECT_TRUE(scene.meshes[0].uv[3].empty());
  b.doc["materials"][0]["emissiveTexture"]["texCoord"] = 4;
  EXPECT_EQ(b.scene().materials[0].emission_texture.uv_set, 0u);
  EXPECT_EQ(b.warnings.size(), 1u);
}

}  // namespace
}  // namespace relume::scene::gltf
