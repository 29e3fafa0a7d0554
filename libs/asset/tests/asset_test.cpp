// SPDX-License-Identifier: MIT
#include "relume/asset/asset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "example_asset.h"
#include "glb.h"
#include "json_node.h"
#include "relume/core/error.h"
#include "relume/core/file.h"

namespace relume::asset {
namespace {

void expectNear(const AtlasTable& got, const AtlasTable& want) {
  EXPECT_EQ(got.width, want.width);
  EXPECT_EQ(got.height, want.height);
  EXPECT_EQ(got.pages, want.pages);
  ASSERT_EQ(got.texel, want.texel);
  EXPECT_EQ(got.valid, want.valid);
  EXPECT_EQ(got.chart, want.chart);
  Box3 box;
  for (const Point& p : want.position) box.add(p);
  const Vec3 extent = box.extent();
  const float step = std::max({extent.x, extent.y, extent.z}) * 0x1p-23f;
  for (std::size_t i = 0; i < want.texel.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float spacing = std::abs(want.position[i][c]) * 0x1p-23f;  // decoded positions are floats again
      EXPECT_NEAR(got.position[i][c], want.position[i][c], step + spacing) << i;
      EXPECT_NEAR(got.normal[i][c], want.normal[i][c], 1e-4) << i;
      EXPECT_NEAR(got.albedo[i][c], want.albedo[i][c], 0.004) << i;
    }
}

void expectNear(const Plane& got, const Plane& want) {
  EXPECT_EQ(got.name, want.name);
  EXPECT_EQ(got.channels, want.channels);
  EXPECT_EQ(got.storage, want.storage);
  ASSERT_EQ(got.values.size(), want.values.size());
  for (std::size_t i = 0; i < want.values.size(); ++i) {
    const float w = want.values[i];
    double allowed = 0;
    if (want.storage == Storage::kFloat16) allowed = std::max(std::abs(w) * 0x1p-11, 0x1p-25);
    if (want.storage == Storage::kUnorm8) allowed = (want.hi - want.lo) / 509;
    if (want.storage == Storage::kUnorm16) allowed = (want.hi - want.lo) / 131000;
    EXPECT_NEAR(got.values[i], w, allowed) << want.name << ' ' << i;
  }
}

void expectNear(const Asset& got, const Asset& want) {
  EXPECT_EQ(got.generator, want.generator);
  EXPECT_EQ(got.input_hash, want.input_hash);
  expectNear(got.atlas, want.atlas);
  ASSERT_EQ(got.layers.size(), want.layers.size());
  for (std::size_t i = 0; i < want.layers.size(); ++i) {
    const Layer &g = got.layers[i], &w = want.layers[i];
    EXPECT_EQ(g.name, w.name);
    EXPECT_EQ(g.kind, w.kind);
    EXPECT_EQ(g.emitters, w.emitters);
    EXPECT_EQ(g.transport, w.transport);
    EXPECT_EQ(g.receivers, w.receivers);
    EXPECT_EQ(g.codec, w.codec);
    EXPECT_EQ(g.parameters, w.parameters);
    EXPECT_EQ(g.error_estimate, w.error_estimate);
    EXPECT_EQ(g.samples, w.samples);
    ASSERT_EQ(g.planes.size(), w.planes.size());
    for (std::size_t p = 0; p < w.planes.size(); ++p) expectNear(g.planes[p], w.planes[p]);
  }
}

bool sameValues(const Asset& a, const Asset& b) {
  const auto same_layer = [](const Layer& x, const Layer& y) {
    return x.name == y.name && x.kind == y.kind && x.emitters == y.emitters && x.transport == y.transport &&
           x.receivers == y.receivers && x.codec == y.codec && x.parameters == y.parameters &&
           x.error_estimate == y.error_estimate && x.samples == y.samples &&
           std::equal(x.planes.begin(), x.planes.end(), y.planes.begin(), y.planes.end(),
                      [](const Plane& p, const Plane& q) {
                        return p.name == q.name && p.channels == q.channels && p.storage == q.storage &&
                               p.lo == q.lo && p.hi == q.hi && p.values == q.values;
                      });
  };
  return a.generator == b.generator && a.input_hash == b.input_hash && a.atlas.width == b.atlas.width &&
         a.atlas.height == b.atlas.height && a.atlas.pages == b.atlas.pages &&
         a.atlas.texel == b.atlas.texel && a.atlas.position == b.atlas.position &&
         a.atlas.normal == b.atlas.normal && a.atlas.albedo == b.atlas.albedo &&
         a.atlas.valid == b.atlas.valid && a.atlas.chart == b.atlas.chart &&
         std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), b.layers.end(), same_layer);
}

ErrorCode codeOf(std::span<const std::byte> glb, const DecodeLimits& limits = {}) {
  try {
    decode(glb, "test.glb", limits);
  } catch (const Error& e) {
    EXPECT_EQ(e.subject(), "test.glb");
    return e.code();
  }
  ADD_FAILURE() << "was accepted";
  return {};
}

// The file with its JSON changed and its checksums left as they were.
std::vector<std::byte> withJson(std::span<const std::byte> file,
                                const std::function<void(nlohmann::json&)>& change) {
  const Glb parts = parseGlb(file, "");
  auto json = nlohmann::json::parse(parts.json);
  change(json);
  return writeGlb(json.dump(), parts.bin);
}

TEST(Asset, RoundTrip) {
  const Asset asset = exampleAsset();
  expectNear(decode(encodeGlb(asset), "test.glb"), asset);
}

TEST(Asset, EncodingIsDeterministicAndStable) {
  const Asset asset = exampleAsset();
  const auto file = encodeGlb(asset);
  EXPECT_EQ(encodeGlb(asset), file);
  // Decoded values are representable, so a second generation loses nothing.
  const Asset once = decode(file, "test.glb");
  EXPECT_TRUE(sameValues(decode(encodeGlb(once), "test.glb"), once));
}

TEST(Asset, TablesKeepEveryBit) {
  Asset asset = exampleAsset();
  asset.layers[1].tables = {{"i8", 1, std::vector<std::int8_t>{-128, 0, 127, 5, 5, 5}},
                            {"u8", 3, std::vector<std::uint8_t>{0, 255, 7}},
                            {"i16", 2, std::vector<std::int16_t>{-32768, 32767}},
                            {"u16", 1, std::vector<std::uint16_t>{65535}},
                            {"u32", 1, std::vector<std::uint32_t>{0, ~0u, 3}},
                            {"f32", 1, std::vector<float>{-0.0f, 1e-40f, 3e38f}},
                            {"empty", 4, std::vector<float>{}}};
  const Asset got = decode(encodeGlb(asset), "test.glb");
  expectNear(got, asset);
  ASSERT_EQ(got.layers[1].tables.size(), asset.layers[1].tables.size());
  for (const Table& want : asset.layers[1].tables) {
    const Table* table = got.layers[1].findTable(want.name);
    ASSERT_NE(table, nullptr) << want.name;
    EXPECT_EQ(table->channels, want.channels);
    EXPECT_EQ(table->values, want.values) << want.name;
  }
  EXPECT_EQ(got.layers[1].findTable("none"), nullptr);
  asset.layers[1].tables[5].values = std::vector<float>{1, std::nanf("")};
  EXPECT_THROW(encode(asset), Error);
}

TEST(Asset, EmptyBake) {
  Asset asset;
  asset.atlas.width = asset.atlas.height = 1;
  asset.atlas.pages = 1;
  const Asset got = decode(encodeGlb(asset), "test.glb");
  EXPECT_TRUE(got.atlas.texel.empty());
  EXPECT_TRUE(got.layers.empty());
}

TEST(Asset, AxisNormalsAreExactAndAllOthersNear) {
  Asset asset;
  asset.atlas.width = 1000;
  asset.atlas.height = 4;
  asset.atlas.pages = 1;
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    Vec3 n(normal(random), normal(random), normal(random));
    if (i < 6) n = Vec3(0), n[static_cast<int>(i / 2)] = i % 2 ? -1.0f : 1.0f;
    asset.atlas.texel.push_back(i);
    asset.atlas.position.push_back(1000.0f * n);
    asset.atlas.normal.push_back(glm::normalize(n));
    asset.atlas.albedo.push_back(Vec3(static_cast<float>(i) / 4000));
    asset.atlas.valid.push_back(1);
    asset.atlas.chart.push_back(0);
  }
  const Asset got = decode(encodeGlb(asset), "test.glb");
  expectNear(got.atlas, asset.atlas);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(got.atlas.normal[i], asset.atlas.normal[i]) << i;
}

TEST(Asset, ABakeOfVisibilityHasNoAlbedo) {
  Asset asset = exampleAsset();
  asset.atlas.albedo.clear();
  const Asset got = decode(encodeGlb(asset), "test.glb");
  EXPECT_EQ(got.atlas.texel, asset.atlas.texel);
  EXPECT_TRUE(got.atlas.albedo.empty());
}

TEST(Asset, FindsLayersAndPlanes) {
  const Asset asset = exampleAsset();
  EXPECT_EQ(asset.layer("").name, "obscurance");
  EXPECT_EQ(asset.layer("every").plane("c").channels, 2);
  EXPECT_EQ(asset.find("none"), nullptr);
  try {
    asset.layer("ao");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kNoSuchLayer);
    EXPECT_NE(std::string(e.what()).find("obscurance, every"), std::string::npos);
  }
  EXPECT_THROW(asset.layer("every").plane("value"), Error);
}

TEST(Asset, RefusesWhatAStorageCannotHold) {
  const auto refused = [](Storage storage, float value) {
    Asset asset = exampleAsset();
    asset.layers[0].planes[0].storage = storage;
    for (float& v : asset.layers[0].planes[0].values) v = 0.0f;
    asset.layers[0].planes[0].values[5] = value;
    try {
      encode(asset);
      return false;
    } catch (const Error& e) {
      return e.code() == ErrorCode::kInvalidValue;
    }
  };
  EXPECT_TRUE(refused(Storage::kFloat16, 65505));
  EXPECT_FALSE(refused(Storage::kFloat16, 65504));
  EXPECT_TRUE(refused(Storage::kFloat16, std::nanf("")));
  EXPECT_TRUE(refused(Storage::kFloat32, kInfinity));
  EXPECT_TRUE(refused(Storage::kUnorm8, 1.5f));
  EXPECT_TRUE(refused(Storage::kUnorm16, -0.1f));
  EXPECT_TRUE(refused(Storage::kUint32, 1.5f));
  EXPECT_TRUE(refused(Storage::kUint32, 16777218.0f));
}

TEST(Asset, RefusesTexelsThatNoSurfaceHas) {
  const auto refused = [](const std::function<void(AtlasTable&)>& change) {
    Asset asset = exampleAsset();
    change(asset.atlas);
    try {
      encode(asset);
      return false;
    } catch (const Error& e) {
      return e.code() == ErrorCode::kInvalidValue;
    }
  };
  EXPECT_TRUE(refused([](AtlasTable& a) { a.position[1].y = kInfinity; }));
  EXPECT_TRUE(refused([](AtlasTable& a) { a.position[0].x = -3e38f, a.position[1].x = 3e38f; }));
  EXPECT_TRUE(refused([](AtlasTable& a) { a.normal[1] = Vec3(0); }));
  EXPECT_TRUE(refused([](AtlasTable& a) { a.normal[1].x = std::nanf(""); }));
  EXPECT_TRUE(refused([](AtlasTable& a) { a.albedo[1].x = -1; }));
  EXPECT_FALSE(refused([](AtlasTable&) {}));
}

TEST(Untrusted, EveryTruncationIsRefused) {
  const auto file = encodeGlb(exampleAsset());
  for (std::size_t size = 0; size < file.size(); ++size) {
    const std::vector<std::byte> cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
    const ErrorCode code = codeOf(cut);
    ASSERT_EQ(code, size < 4 ? ErrorCode::kNotGltf : ErrorCode::kTruncated) << size;
  }
}

// One bit of every byte: an Error, or a part of the file that carries nothing of the bake.
TEST(Untrusted, EveryDamagedByteIsNoticedOrHarmless) {
  const auto file = encodeGlb(exampleAsset());
  const Asset truth = decode(file, "test.glb");
  std::size_t harmless = 0;
  for (std::size_t i = 0; i < file.size(); ++i) {
    auto flipped = file;
    flipped[i] ^= static_cast<std::byte>(1u << (i % 8));
    try {
      ASSERT_TRUE(sameValues(decode(flipped, "test.glb"), truth)) << "byte " << i;
      ++harmless;
    } catch (const Error&) {
    }
  }
  EXPECT_LT(harmless, file.size() / 4) << "most of the file must matter";
}

// Several random bytes at once, and random cuts and doublings: nothing but Error may come of it.
TEST(Untrusted, MangledFilesNeverCrash) {
  const auto file = encodeGlb(exampleAsset());
  std::mt19937 random(11);
  for (int run = 0; run < 1500; ++run) {
    auto mangled = file;
    for (unsigned k = random() % 6 + 1; k > 0; --k)
      mangled[random() % mangled.size()] = static_cast<std::byte>(random());
    const auto at = static_cast<std::ptrdiff_t>(random() % mangled.size());
    if (run % 3 == 0)
      mangled.erase(mangled.begin() + at,
                    mangled.begin() + std::min<std::ptrdiff_t>(at + 7, std::ssize(mangled)));
    if (run % 3 == 1) mangled.insert(mangled.begin() + at, file.begin(), file.begin() + at);
    try {
      decode(mangled, "test.glb", {.max_bytes = 1 << 20});
    } catch (const Error&) {
    }
  }
}

TEST(Untrusted, SaysWhatIsWrong) {
  const auto file = encodeGlb(exampleAsset());
  const auto code = [&](const std::function<void(nlohmann::json&)>& change) {
    return codeOf(withJson(file, change));
  };
  EXPECT_EQ(code([](auto& j) { j.erase("extensions"); }), ErrorCode::kNoSuchLayer);
  EXPECT_EQ(code([](auto& j) { j["extensions"]["RELUME_transfer"]["version"] = 2; }),
            ErrorCode::kUnsupported);
  EXPECT_EQ(code([](auto& j) { j["extensions"]["RELUME_transfer"]["version"] = -1; }),
            ErrorCode::kCorruptAsset);
  EXPECT_EQ(code([](auto& j) { j["extensions"]["RELUME_transfer"] = 1; }), ErrorCode::kCorruptAsset);
  EXPECT_EQ(code([](auto& j) { j["extensions"]["RELUME_transfer"]["generator"] = "other"; }),
            ErrorCode::kCorruptAsset);
  EXPECT_EQ(code([](auto& j) { j["bufferViews"] = nlohmann::json::array(); }), ErrorCode::kCorruptAsset);
  EXPECT_EQ(code([](auto& j) { j["bufferViews"][0]["byteOffset"] = 1u << 31; }), ErrorCode::kCorruptAsset);
  EXPECT_EQ(code([](auto& j) { j["bufferViews"][0]["byteLength"] = ~0ull; }), ErrorCode::kCorruptAsset);
  EXPECT_EQ(code([](auto& j) { j["bufferViews"][0]["buffer"] = 1; }), ErrorCode::kCorruptAsset);
  EXPECT_EQ(codeOf(std::as_bytes(std::span("{\"asset\":{}}"))), ErrorCode::kNotGltf);
  EXPECT_EQ(codeOf(writeGlb("{", {})), ErrorCode::kInvalidJson);
  EXPECT_EQ(codeOf(writeGlb("[]", {})), ErrorCode::kNoSuchLayer);
  EXPECT_EQ(codeOf(file, {.max_bytes = 2000}), ErrorCode::kOutOfMemory);
  auto other_version = file;
  other_version[4] = std::byte{1};
  EXPECT_EQ(codeOf(other_version), ErrorCode::kUnsupported);
  // A chunk that says it is longer than the file.
  const Glb parts = parseGlb(file, "");
  for (const std::size_t chunk : {std::size_t{12}, 20 + parts.json.size()}) {
    auto long_chunk = file;
    long_chunk[chunk + 3] = std::byte{0x7f};
    EXPECT_EQ(codeOf(long_chunk), ErrorCode::kTruncated);
  }
  EXPECT_THROW(readAsset("/no/such/file.glb"), Error);
}

// A table in a storage of later files, with the checksum that its description then has.
TEST(Untrusted, UnknownStorageOfATableIsRefused) {
  Asset asset = exampleAsset();
  asset.layers[0].tables = {{"t", 1, std::vector<std::int8_t>{1, 2, 3}}};
  auto bake = nlohmann::json::parse(encode(asset).json);
  bake["layers"][0]["tables"][0]["storage"] = "float64";
  bake["crc32"] = descriptionCrc(JsonNode(bake, "test.glb", ""));
  EXPECT_EQ(codeOf(withJson(encodeGlb(asset), [&](auto& j) { j["extensions"]["RELUME_transfer"] = bake; })),
            ErrorCode::kCorruptAsset);
}

TEST(Untrusted, DeepNestingIsRefused) {
  std::string deep = R"({"extensions":{"RELUME_transfer":{"version":1,"crc32":0,"x":)";
  deep += std::string(200000, '[') + std::string(200000, ']') + "}}}";
  EXPECT_EQ(codeOf(writeGlb(deep, {})), ErrorCode::kCorruptAsset);
}

// Other tools renumber buffer views, write 1 as 1.0, sort members and add extras; the bake stays readable.
TEST(Asset, SurvivesOtherTools) {
  const Asset asset = exampleAsset();
  const auto changed = withJson(encodeGlb(asset), [](nlohmann::json& j) {
    auto& bake = j["extensions"]["RELUME_transfer"];
    bake["extras"] = {{"note", "optimised"}};
    bake["version"] = 1.0;
    bake["layers"][0]["samples"] = 256.0;
    auto& views = j["bufferViews"];
    std::reverse(views.begin(), views.end());
    const auto renumber = [&](nlohmann::json& planes) {
      for (auto& plane : planes)
        plane["bufferView"] = views.size() - 1 - plane["bufferView"].template get<std::size_t>();
    };
    renumber(bake["atlas"]["planes"]);
    for (auto& layer : bake["layers"]) renumber(layer["planes"]);
  });
  expectNear(decode(changed, "test.glb"), asset);
}

// Written once by an early Relume and never again; docs/format.md promises that version 1 is read for ever.
// To write the file of a new version: RELUME_WRITE_GOLDEN=FILE relume_asset_tests --gtest_filter=Golden.*
TEST(Golden, Version1IsReadForEver) {
  if (const char* path = std::getenv("RELUME_WRITE_GOLDEN")) {
    writeFileAtomically(path, encodeGlb(exampleAsset()));
    GTEST_SKIP() << "wrote " << path;
  }
  expectNear(readAsset(RELUME_SOURCE_DIR "/libs/asset/tests/data/v1.glb"), exampleAsset());
}

}  // namespace
}  // namespace relume::asset
