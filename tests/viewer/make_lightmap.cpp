// SPDX-License-Identifier: MIT
// Writes a scene with a lightmap of known irradiance, and the radiance that a viewer has to show:
// make_lightmap OUT.glb EXPECTED.json
//
// Five squares in a row, one unit wide, centred at x = 0, 1, 2...; their lightmap is one strip of a page
// each.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "relume/asset/asset.h"
#include "relume/bake/viewer_textures.h"
#include "relume/core/file.h"
#include "relume/scene/gltf.h"

namespace {

using namespace relume;
using Json = nlohmann::json;

constexpr int kPage = 64;    // texels along a page
constexpr int kSquares = 5;  // on pages 0, 0, 0, 1, 1
constexpr int kStrip = 16;   // texels along a square's part of its page

struct Square {
  std::uint32_t page, slot;  ///< slot: which strip of the page
  std::uint32_t material;
  Vec3 left, right;  ///< irradiance at the ends; linear between
};
const Square kScene[kSquares] = {
    {0, 0, 0, Vec3(2, 1, 0.5f), Vec3(2, 1, 0.5f)},
    {0, 1, 0, Vec3(0.1f), Vec3(2)},
    {0, 2, 1, Vec3(1.5f, 1.7f, 1.9f), Vec3(1.5f, 1.7f, 1.9f)},
    {1, 0, 0, Vec3(300, 200, 100), Vec3(300, 200, 100)},
    {1, 1, 1, Vec3(40), Vec3(40)},
};
const Vec3 kBaseColour[2] = {Vec3(0.8f, 0.5f, 0.25f), Vec3(0.6f)};
constexpr float kMetallic[2] = {0.0f, 0.5f};

void append(std::vector<std::byte>& out, const std::vector<float>& values) {
  const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
  out.insert(out.end(), bytes, bytes + values.size() * sizeof(float));
}

std::string base64(const std::vector<std::byte>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    for (int shift = 18; shift >= 0; shift -= 6) out += kDigits[group >> shift & 63];
  }
  for (std::size_t k = 0; k < (3 - bytes.size() % 3) % 3; ++k) out[out.size() - 1 - k] = '=';
  return out;
}

std::string sceneText() {
  std::vector<std::byte> binary;
  append(binary,
         {-0.5f, -0.5f, 0, 0.5f, -0.5f, 0, 0.5f, 0.5f, 0, -0.5f, -0.5f, 0, 0.5f, 0.5f, 0, -0.5f, 0.5f, 0});
  append(binary, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  append(binary, std::vector<float>(12, 0.0f));  // TEXCOORD_0, of no use to a lightmap
  Json doc{{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"extensionsUsed", {"KHR_materials_specular"}}};
  doc["buffers"] = {
      {{"byteLength", binary.size()}, {"uri", "data:application/octet-stream;base64," + base64(binary)}}};
  doc["bufferViews"] = {{{"buffer", 0}, {"byteLength", 72}, {"byteOffset", 0}},
                        {{"buffer", 0}, {"byteLength", 72}, {"byteOffset", 72}},
                        {{"buffer", 0}, {"byteLength", 48}, {"byteOffset", 144}}};
  doc["accessors"] = {{{"bufferView", 0},
                       {"componentType", 5126},
                       {"count", 6},
                       {"type", "VEC3"},
                       {"min", {-0.5, -0.5, 0}},
                       {"max", {0.5, 0.5, 0}}},
                      {{"bufferView", 1}, {"componentType", 5126}, {"count", 6}, {"type", "VEC3"}},
                      {{"bufferView", 2}, {"componentType", 5126}, {"count", 6}, {"type", "VEC2"}}};
  for (int m = 0; m < 2; ++m) {
    const Vec3 c = kBaseColour[m];
    // three.js takes from the diffuse light what a dielectric's own reflection keeps (1.5 % seen straight
    // on); without that reflection the radiance is exact.
    doc["materials"].push_back({{"pbrMetallicRoughness",
                                 {{"baseColorFactor", {c.x, c.y, c.z, 1}},
                                  {"metallicFactor", kMetallic[m]},
                                  {"roughnessFactor", 1}}},
                                {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
    doc["meshes"].push_back(
        {{"primitives",
          {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"material", m}}}}});
  }
  Json roots = Json::array();
  for (int i = 0; i < kSquares; ++i) {
    doc["nodes"].push_back({{"mesh", kScene[i].material}, {"translation", {i, 0, 0}}});
    roots.push_back(i);
  }
  doc["scenes"] = {{{"nodes", roots}}};
  return doc.dump();
}

asset::Asset lightmap() {
  asset::Asset asset{.generator = "relume tests"};
  asset.atlas = {.width = kPage, .height = kPage, .pages = 2};
  asset::Layer layer{.name = "lightmap", .kind = "lightmap"};
  layer.emitters = "scene", layer.transport = "made by hand", layer.receivers = "texels, RGB";
  layer.codec = "none";
  asset::Plane plane{.name = "value", .channels = 3, .storage = asset::Storage::kFloat32};
  plane.values.resize(asset.atlas.pageTexels() * 3);
  const std::size_t page_texels = std::size_t{kPage} * kPage;
  for (std::uint32_t t = 0; t < asset.atlas.pageTexels(); ++t) {
    for (const Square& s : kScene) {
      const std::uint32_t row = t % page_texels / kPage;
      if (t / page_texels != s.page || row / kStrip != s.slot) continue;
      const float u = (static_cast<float>(t % kPage) + 0.5f) / kPage;
      const Vec3 e = s.left + u * (s.right - s.left);
      for (int c = 0; c < 3; ++c) plane.values[t * std::size_t{3} + static_cast<std::size_t>(c)] = e[c];
      asset.atlas.texel.push_back(t);
      asset.atlas.position.push_back(Vec3(u, 0, 0));
      asset.atlas.normal.push_back(Vec3(0, 0, 1));
      asset.atlas.albedo.push_back(kBaseColour[s.material] * (1 - kMetallic[s.material]));
      asset.atlas.valid.push_back(1);
      asset.atlas.chart.push_back(static_cast<std::uint32_t>(&s - kScene));
    }
  }
  layer.planes.push_back(std::move(plane));
  asset.layers.push_back(std::move(layer));
  return asset;
}

/// TEXCOORD_1 of a square's six vertices: its strip, one texel inside.
std::vector<Vec2> coordinates(const Square& s) {
  const float top = (static_cast<float>(s.slot * kStrip) + 2) / kPage,
              bottom = (static_cast<float>((s.slot + 1) * kStrip) - 2) / kPage;
  return {{0, bottom}, {1, bottom}, {1, top}, {0, bottom}, {1, top}, {0, top}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string text = sceneText();
  const auto document = scene::gltf::Document::parse(std::as_bytes(std::span(text)), "squares.gltf", {});
  Warnings warnings;
  const scene::Scene scene = scene::gltf::import(document, warnings);
  const asset::Asset asset = lightmap();
  scene::gltf::BakeOutput output;
  for (std::uint32_t i = 0; i < kSquares; ++i)
    output.uses.push_back({.instance = i,
                           .page = kScene[i].page,
                           .source_vertex = {0, 1, 2, 3, 4, 5},
                           .triangles = scene.meshes[scene.instances[i].mesh].triangles,
                           .uv = coordinates(kScene[i])});
  bake::addViewerTextures(asset, output);
  asset::Encoded encoded = asset::encode(asset);
  output.transfer = Json::parse(encoded.json);
  output.views = std::move(encoded.views);
  writeFileAtomically(argv[1], scene::gltf::exportGlb(document, scene, output));

  // Radiance of a Lambertian surface: albedo / pi * E. A step: what an 8-bit page cannot tell apart.
  Json expected = Json::array();
  for (int i = 0; i < kSquares; ++i) {
    const Square& s = kScene[i];
    const Vec3 reflected = kBaseColour[s.material] * (1 - kMetallic[s.material]) / kPi;
    for (const float u : {3.5f / 32, 16.5f / 32, 28.5f / 32}) {  // centres of pixels that page.html draws
      const Vec3 radiance = reflected * (s.left + u * (s.right - s.left));
      const Vec3 step = reflected * output.lightmap[s.page].intensity / 255.0f;
      expected.push_back({{"x", static_cast<float>(i) + u - 0.5f},
                          {"radiance", {radiance.x, radiance.y, radiance.z}},
                          {"step", {step.x, step.y, step.z}}});
    }
  }
  writeFileAtomically(argv[2], expected.dump(1));
  return 0;
}
