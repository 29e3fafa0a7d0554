// SPDX-License-Identifier: MIT
// Golden pictures of a bake from end to end: the stage as glTF, baked, written, read again and shown. They
// change when the atlas, a solver, the file or the renderer changes what one sees. A bake repeats its bits,
// so that the tolerance is for other instruction sets, whose few different hits move single texels.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "golden.h"
#include "hand_made.h"
#include "relume/bake/bake.h"
#include "relume/scene/gltf.h"
#include "stage.h"

namespace relume {
namespace {

constexpr golden::Tolerance kTolerance{.mean = 0.01, .p99 = 0.08};

std::string base64(const std::vector<std::byte>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// glTF text of a scene's meshes: positions, triangles, base colours. The opaque ones only.
std::string gltfOf(const scene::Scene& scene) {
  nlohmann::json gltf = {
      {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
  std::vector<std::byte> buffer;
  const auto view = [&](const auto& values) {
    const std::size_t bytes = values.size() * sizeof values[0];
    gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes}});
    buffer.resize(buffer.size() + bytes);
    std::memcpy(buffer.data() + buffer.size() - bytes, values.data(), bytes);
    return gltf["bufferViews"].size() - 1;
  };
  for (const scene::Mesh& mesh : scene.meshes) {
    const scene::Material& material = scene.materials[mesh.material];
    if (material.alpha_mode != scene::AlphaMode::kOpaque) continue;
    Box3 box;
    for (const Point& p : mesh.positions) box.add(p);
    const std::size_t index = gltf.contains("meshes") ? gltf["meshes"].size() : 0;
    gltf["accessors"].push_back({{"bufferView", view(mesh.positions)},
                                 {"componentType", 5126},
                                 {"count", mesh.positions.size()},
                                 {"type", "VEC3"},
                                 {"min", {box.lo.x, box.lo.y, box.lo.z}},
                                 {"max", {box.hi.x, box.hi.y, box.hi.z}}});
    gltf["accessors"].push_back({{"bufferView", view(mesh.triangles)},
                                 {"componentType", 5125},
                                 {"count", 3 * mesh.triangles.size()},
                                 {"type", "SCALAR"}});
    gltf["meshes"].push_back(
        {{"primitives",
          {{{"attributes", {{"POSITION", 2 * index}}}, {"indices", 2 * index + 1}, {"material", index}}}}});
    const Vec4 c = material.base_colour;
    gltf["materials"].push_back(
        {{"pbrMetallicRoughness", {{"baseColorFactor", {c.r, c.g, c.b, c.a}}, {"metallicFactor", 0.0}}}});
    gltf["nodes"].push_back({{"mesh", index}});
    gltf["scenes"][0]["nodes"].push_back(index);
  }
  gltf["buffers"] = {
      {{"byteLength", buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer)}}};
  return gltf.dump();
}

scene::gltf::Document parse(const void* data, std::size_t size) {
  return scene::gltf::Document::parse({static_cast<const std::byte*>(data), size}, "stage", {});
}

class GoldenBake : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::string gltf = gltfOf(picture::stage());
    bake::BakeOptions options;
    for (const char* layer : {"ao", "obscurance", "spectral"})
      options.layers.push_back(bake::parseLayerSpec(layer));
    options.samples = 256;
    options.atlas.page_size = 256;
    SilentProgress silent;
    glb_ = bake::bake(parse(gltf.data(), gltf.size()), options, silent).glb;
  }
  static void expectGolden(picture::View view, const std::string& layer) {
    Warnings warnings;
    const scene::Scene scene = scene::gltf::import(parse(glb_.data(), glb_.size()), warnings);
    const asset::Asset asset = asset::decode(glb_, "stage.glb");
    const trace::Tracer tracer(scene);
    picture::PictureOptions options{.width = 192, .height = 144};
    options.view = view;
    options.layer = layer;
    SilentProgress silent;
    const image::Image shown =
        picture::render(tracer, &asset, picture::frameScene(tracer, 4.0f / 3.0f), options, silent);
    EXPECT_TRUE(golden::matches(shown, std::filesystem::path(RELUME_GOLDEN_DIR) / ("baked-" + layer + ".png"),
                                kTolerance));
  }

 private:
  static inline std::vector<std::byte> glb_;
};

TEST_F(GoldenBake, Ao) { expectGolden(picture::View::kOcclusion, "ao"); }
TEST_F(GoldenBake, Obscurance) { expectGolden(picture::View::kObscurance, "obscurance"); }
TEST_F(GoldenBake, Spectral) { expectGolden(picture::View::kObscurance, "spectral"); }

}  // namespace
}  // namespace relume
