// SPDX-License-Identifier: MIT
// Compressed geometry, made with the encoders of the libraries: it must come out as it went in, and lies must
// be refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>

#include "compression.h"
#include "sample_files.h"

namespace relume::scene::gltf {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

TEST(Meshopt, VerticesTrianglesAndSequences) {
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    for (const bool sequence : {false, true}) {
      const Scene scene = meshoptFile(extension, sequence).scene();
      EXPECT_THAT(scene.meshes[0].triangles, ElementsAre(UVec3(0, 1, 2), UVec3(2, 1, 3)));
      EXPECT_EQ(scene.meshes[0].positions[3], Point(1, 1, 0));
    }
}

TEST(Meshopt, RefusesLies) {
  const auto with = [](std::size_t view, const char* key, Json value) {
    GltfBuilder b = meshoptFile("EXT_meshopt_compression", false);
    b.doc["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = std::move(value);
    return errorOf([&] { b.scene(); });
  };
  EXPECT_EQ(with(1, "mode", "ATTRIBUTES"), "no error");
  EXPECT_EQ(with(1, "mode", "TRIANGLES"), "invalid-value");
  EXPECT_EQ(with(1, "mode", "NONSENSE"), "invalid-value");
  EXPECT_EQ(with(1, "count", 1000000000), "out-of-bounds");
  EXPECT_EQ(with(1, "count", 60000), "invalid-value");  // plausible in size, yet not what was packed
  EXPECT_EQ(with(1, "count", 3), "out-of-bounds");      // less than the view says it holds
  EXPECT_EQ(with(1, "byteStride", 0), "invalid-value");
  EXPECT_EQ(with(1, "byteStride", 13), "invalid-value");
  EXPECT_EQ(with(1, "byteStride", 1024), "invalid-value");
  EXPECT_EQ(with(1, "byteLength", 5), "invalid-value");
  EXPECT_EQ(with(1, "byteLength", 5000), "out-of-bounds");
  EXPECT_EQ(with(1, "filter", "OCTAHEDRAL"), "invalid-value");  // stride 12
  EXPECT_EQ(with(1, "filter", "QUATERNION"), "invalid-value");
  EXPECT_EQ(with(1, "filter", "BLUR"), "invalid-value");
  EXPECT_EQ(with(3, "filter", "EXPONENTIAL"), "invalid-value");  // of indices
  EXPECT_EQ(with(3, "count", 5), "invalid-value");
  EXPECT_EQ(with(3, "byteStride", 1), "invalid-value");
}

TEST(Meshopt, Filters) {
  // Octahedral: unit vectors come back to within the quantization of 8 bits.
  const std::vector<float> normals = {0, 0, 1, 0, 0.6f, 0, 0.8f, 0, 0, -1, 0, 0, -0.48f, 0.6f, -0.64f, 0};
  std::vector<std::int8_t> oct(16);
  meshopt_encodeFilterOct(oct.data(), 4, 4, 8, normals.data());
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(4, 4));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), oct.data(), 4, 4));
  const auto unpacked =
      decompressView({std::as_bytes(std::span(packed)), "ATTRIBUTES", "OCTAHEDRAL", "test", 4, 4});
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(static_cast<float>(static_cast<std::int8_t>(unpacked[4 * i + k])) / 127.0f,
                  normals[4 * i + k], 0.015f);

  // Exponential: floats come back to 2^-15 of their size.
  const std::vector<float> lengths = {1.5f, -300.25f, 0.001f, 0};
  std::vector<std::uint32_t> exponential(4);
  meshopt_encodeFilterExp(exponential.data(), 4, 4, 16, lengths.data());
  packed.resize(meshopt_encodeVertexBufferBound(4, 4));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), exponential.data(), 4, 4));
  const auto floats =
      decompressView({std::as_bytes(std::span(packed)), "ATTRIBUTES", "EXPONENTIAL", "test", 4, 4});
  for (std::size_t i = 0; i < 4; ++i) {
    float f;
    std::memcpy(&f, floats.data() + 4 * i, 4);
    EXPECT_NEAR(f, lengths[i], std::abs(lengths[i]) / 16384);
  }

  // Quaternions: 16-bit components.
  const std::vector<float> rotation = {0.5f, -0.5f, 0.5f, 0.5f};
  std::vector<std::int16_t> quaternion(4);
  meshopt_encodeFilterQuat(quaternion.data(), 1, 8, 16, rotation.data());
  packed.resize(meshopt_encodeVertexBufferBound(1, 8));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), quaternion.data(), 1, 8));
  const auto turned =
      decompressView({std::as_bytes(std::span(packed)), "ATTRIBUTES", "QUATERNION", "test", 8, 1});
  for (std::size_t k = 0; k < 4; ++k) {
    std::int16_t q;
    std::memcpy(&q, turned.data() + 2 * k, 2);
    EXPECT_NEAR(std::abs(static_cast<float>(q)) / 32767.0f, 0.5f, 1e-3f);
  }
}

TEST(Draco, BothMethods) {
  for (const bool edgebreaker : {false, true}) {
    const Scene scene = dracoFile(edgebreaker).scene();
    const Mesh& mesh = scene.meshes[0];
    ASSERT_EQ(mesh.triangles.size(), 2u);
    ASSERT_EQ(mesh.positions.size(), 4u);
    // The order of vertices is Draco's; colour tells which is which.
    const std::map<std::array<float, 3>, Point> expected = {
        {{1, 0, 0}, {0, 0, 0}}, {{0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}}, {{1, 1, 1}, {1, 1, 0}}};
    for (std::size_t v = 0; v < 4; ++v) {
      const Vec4 c = mesh.colours[v];
      EXPECT_LT(glm::length(mesh.positions[v] - expected.at({c.x, c.y, c.z})), 1e-3f);
    }
    for (std::uint32_t t = 0; t < 2; ++t) EXPECT_EQ(geometricNormal(scene, 0, t), Normal(0, 0, 1));
  }
}

TEST(Draco, RefusesLies) {
  const auto with = [](auto change) {
    GltfBuilder b = dracoFile(true);
    change(b, b.doc["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]);
    return errorOf([&] { b.scene(); });
  };
  EXPECT_EQ(with([](auto&, Json& e) { e["bufferView"] = 7; }), "invalid-reference");
  EXPECT_EQ(with([](auto&, Json& e) { e.erase("attributes"); }), "invalid-value");
  EXPECT_EQ(with([](auto&, Json& e) { e["attributes"]["POSITION"] = 9; }), "invalid-reference");
  EXPECT_EQ(with([](auto&, Json& e) { e["attributes"]["NORMAL"] = 1; }), "invalid-reference");
  EXPECT_EQ(with([](auto& b, Json&) { b.doc["bufferViews"][0]["byteLength"] = 20; }), "invalid-value");
  EXPECT_EQ(with([](auto& b, Json&) { b.bin[0] = std::byte{0}; }), "invalid-value");
  EXPECT_EQ(with([](auto& b, Json&) { b.bin[5] = std::byte{1}; }), "unsupported");  // version 1
  // Five bytes that say four thousand million vertices.
  EXPECT_EQ(with([](auto& b, Json&) {
              std::fill_n(b.bin.begin() + 12, 4, std::byte{0xff});
              b.bin[16] = std::byte{0x0f};
            }),
            "out-of-bounds");
}

// Every byte of a stream, changed in every bit: an Error or a mesh, never a crash.
TEST(Draco, SurvivesEveryFlippedBit) {
  for (const bool edgebreaker : {false, true}) {
    const GltfBuilder b = dracoFile(edgebreaker);
    for (std::size_t at = 0; at < b.bin.size(); ++at)
      for (int bit = 0; bit < 8; ++bit) {
        GltfBuilder broken = b;
        broken.bin[at] ^= static_cast<std::byte>(1 << bit);
        errorOf([&] { broken.scene(); });
      }
  }
}

}  // namespace
}  // namespace relume::scene::gltf
