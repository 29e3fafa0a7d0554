// SPDX-License-Identifier: MIT
// Accessors: every component type, sparse and zero accessors, and what lies about its size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "access.h"
#include "gltf_builder.h"

namespace relume::scene::gltf {
namespace {

using testing::ElementsAre;

/// Reads accessor 0 of the file as VEC2.
std::vector<Vec2> readFirst(const GltfBuilder& b) {
  GltfBuilder with_reference = b;
  with_reference.doc["extras"] = {{"ref", 0}};
  const Document document = with_reference.document();
  Access access(document);
  return readVectors<2>(access.accessor(access.root()["extras"]["ref"]));
}

template <class T>
Vec2 converted(T a, T b, bool normalized) {
  GltfBuilder builder;
  builder.accessor<T>({a, b}, "VEC2", normalized);
  return readFirst(builder)[0];
}

// glTF 2.0, section 3.11: normalized integers c mean c / max, and the lowest signed one is clamped to -1.
TEST(Accessor, ConvertsEveryComponentType) {
  EXPECT_EQ(converted<float>(0.5f, -3.0f, false), Vec2(0.5f, -3.0f));
  EXPECT_EQ(converted<std::uint8_t>(255, 51, true), Vec2(1.0f, 0.2f));
  EXPECT_EQ(converted<std::int8_t>(127, -128, true), Vec2(1.0f, -1.0f));
  EXPECT_EQ(converted<std::uint16_t>(65535, 13107, true), Vec2(1.0f, 0.2f));
  EXPECT_EQ(converted<std::int16_t>(32767, -32768, true), Vec2(1.0f, -1.0f));
  EXPECT_EQ(converted<std::uint8_t>(255, 3, false), Vec2(255, 3));
  EXPECT_EQ(converted<std::int8_t>(-128, 3, false), Vec2(-128, 3));
  EXPECT_EQ(converted<std::int16_t>(-32768, 3, false), Vec2(-32768, 3));
  EXPECT_EQ(converted<std::uint16_t>(65535, 3, false), Vec2(65535, 3));
}

TEST(Accessor, FollowsStrideAndOffset) {
  GltfBuilder b;
  b.view(toBytes(std::vector<float>{9, 1, 2, 9, 3, 4}), 12);
  b.push("accessors",
         {{"bufferView", 0}, {"byteOffset", 4}, {"componentType", 5126}, {"count", 2}, {"type", "VEC2"}});
  EXPECT_THAT(readFirst(b), ElementsAre(Vec2(1, 2), Vec2(3, 4)));
}

TEST(Accessor, SubstitutesSparseElements) {
  GltfBuilder b;
  b.accessor<float>({1, 1, 2, 2, 3, 3}, "VEC2");
  const auto indices = b.view(toBytes(std::vector<std::uint8_t>{0, 2}));
  const auto values = b.view(toBytes(std::vector<float>{7, 7, 8, 8}));
  b.doc["accessors"][0]["sparse"] = {{"count", 2},
                                     {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                     {"values", {{"bufferView", values}}}};
  EXPECT_THAT(readFirst(b), ElementsAre(Vec2(7), Vec2(2), Vec2(8)));
  b.doc["accessors"][0].erase("bufferView");  // then what is not substituted is zero
  EXPECT_THAT(readFirst(b), ElementsAre(Vec2(7), Vec2(0), Vec2(8)));

  b.doc["accessors"][0]["count"] = 2;  // now index 2 is outside
  EXPECT_EQ(errorOf([&] { readFirst(b); }), "out-of-bounds");
  b.doc["accessors"][0]["count"] = 1;  // and more are substituted than there are
  EXPECT_EQ(errorOf([&] { readFirst(b); }), "out-of-bounds");
}

TEST(Accessor, RefusesWhatLeavesItsView) {
  const auto with = [](const char* key, nlohmann::json value) {
    GltfBuilder b;
    b.accessor<float>({1, 2, 3, 4}, "VEC2");
    b.doc["accessors"][0][key] = std::move(value);
    return errorOf([&] { readFirst(b); });
  };
  EXPECT_EQ(with("count", 2), "no error");
  EXPECT_EQ(with("count", 2.0), "no error");
  EXPECT_EQ(with("count", 3), "out-of-bounds");
  EXPECT_EQ(with("count", 1000000000), "out-of-bounds");
  EXPECT_EQ(with("count", 5000000000), "out-of-bounds");
  EXPECT_EQ(with("count", 9007199254740992), "out-of-bounds");
  EXPECT_EQ(with("count", -1), "invalid-value");
  EXPECT_EQ(with("count", 1.5), "invalid-value");
  EXPECT_EQ(with("count", "2"), "invalid-value");
  EXPECT_EQ(with("byteOffset", 4), "out-of-bounds");
  EXPECT_EQ(with("byteOffset", 9007199254740992), "out-of-bounds");
  EXPECT_EQ(with("bufferView", 1), "invalid-reference");
  EXPECT_EQ(with("bufferView", -1), "invalid-value");
  EXPECT_EQ(with("type", "VEC5"), "invalid-value");
  EXPECT_EQ(with("type", "SCALAR"), "invalid-value");  // fewer components than asked for
  EXPECT_EQ(with("componentType", 5124), "invalid-value");
}

TEST(Accessor, RefusesViewsThatLeaveTheirBuffer) {
  const auto with = [](const char* key, nlohmann::json value) {
    GltfBuilder b;
    b.accessor<float>({1, 2, 3, 4}, "VEC2");
    b.doc["bufferViews"][0][key] = std::move(value);
    return errorOf([&] { readFirst(b); });
  };
  EXPECT_EQ(with("byteLength", 16), "no error");
  EXPECT_EQ(with("byteLength", 17), "out-of-bounds");
  EXPECT_EQ(with("byteOffset", 1), "out-of-bounds");
  EXPECT_EQ(with("byteOffset", 9007199254740992), "out-of-bounds");
  EXPECT_EQ(with("buffer", 1), "invalid-reference");
  EXPECT_EQ(with("byteStride", 12), "out-of-bounds");
  EXPECT_EQ(with("byteStride", 1e9), "invalid-value");
}

// No view means zeros, which cost a file nothing: their number must fit the file.
TEST(Accessor, RefusesABillionZeros) {
  GltfBuilder b;
  b.push("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
  EXPECT_THAT(readFirst(b), ElementsAre(Vec2(0), Vec2(0), Vec2(0)));
  b.doc["accessors"][0]["count"] = 1000000000;
  EXPECT_EQ(errorOf([&] { readFirst(b); }), "out-of-bounds");
}

TEST(Accessor, RefusesTheFileWithAShortBuffer) {
  GltfBuilder b;
  b.accessor<float>({1, 2, 3, 4}, "VEC2");
  b.doc["buffers"] = {{{"byteLength", 17}}};
  EXPECT_EQ(errorOf([&] { b.document(); }), "truncated");
  b.doc["buffers"] = {{{"byteLength", 8}}};  // shorter than the chunk: the rest is not the buffer's
  EXPECT_EQ(errorOf([&] { readFirst(b); }), "out-of-bounds");
}

}  // namespace
}  // namespace relume::scene::gltf
