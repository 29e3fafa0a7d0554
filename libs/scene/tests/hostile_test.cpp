// SPDX-License-Identifier: MIT
// No input may crash: every truncation of a file, and every change of one byte of its JSON, is refused with
// an Error or loads, and what loads can be baked and exported. Meant to be run with sanitizers too.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>

#include "fake_bake.h"
#include "relume/core/file.h"
#include "sample_files.h"

namespace relume::scene::gltf {
namespace {

using Json = nlohmann::json;

/// Import, and export where import agrees. True when both did.
bool survives(std::span<const std::byte> file) {
  try {
    const Document document = Document::parse(file, "hostile.glb", {});
    Warnings warnings;
    const Scene scene = import(document, warnings);
    exportGlb(document, scene, fakeBake(scene));
    return true;
  } catch (const Error&) {
    return false;
  }
}

// The seeds of tests/fuzz are these files: RELUME_WRITE_SEEDS=FOLDER relume_scene_tests
// --gtest_filter='Seeds.*'
TEST(Seeds, Write) {
  const char* folder = std::getenv("RELUME_WRITE_SEEDS");
  if (!folder) GTEST_SKIP() << "RELUME_WRITE_SEEDS is not set";
  const std::filesystem::path to(folder);
  GltfBuilder strip = everything(), uv = everything(), embedded;
  strip.doc["meshes"][0]["primitives"][0].erase("indices");
  strip.doc["meshes"][0]["primitives"][0]["mode"] = 5;
  uv.doc["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = 2;
  uv.doc["materials"][0]["occlusionTexture"] = {{"index", 0}, {"texCoord", 1}};
  embedded.triangle();
  embedded.doc["buffers"] = {{{"byteLength", 6}, {"uri", "data:;base64,AAABAAIA"}}};
  writeFileAtomically(to / "everything.glb", everything().glb());
  writeFileAtomically(to / "strip.glb", strip.glb());
  writeFileAtomically(to / "uv.glb", uv.glb());
  writeFileAtomically(to / "embedded.gltf", embedded.doc.dump());
  writeFileAtomically(to / "draco-edgebreaker.glb", dracoFile(true).glb());
  writeFileAtomically(to / "draco-sequential.glb", dracoFile(false).glb());
  writeFileAtomically(to / "meshopt.glb", meshoptFile("EXT_meshopt_compression", false).glb());
  writeFileAtomically(to / "meshopt-sequence.glb", meshoptFile("KHR_meshopt_compression", true).glb());
  const Document document = uv.document();
  Warnings warnings;
  const Scene scene = import(document, warnings);
  writeFileAtomically(to / "baked.glb",
                      exportGlb(document, scene, fakeBake(scene, {.split = true, .pages = 2})));
}

TEST(Hostile, TheFileItselfLoads) { EXPECT_TRUE(survives(everything().glb())); }

TEST(Hostile, EveryTruncation) {
  const std::vector<std::byte> file = everything().glb();
  for (std::size_t size = 0; size < file.size(); ++size) {
    EXPECT_FALSE(survives(std::span(file).first(size))) << size;
    // With the lengths put right for what is left.
    std::vector<std::byte> cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
    if (size < 20) continue;
    const auto length = static_cast<std::uint32_t>(size);
    std::memcpy(cut.data() + 8, &length, 4);
    survives(cut);
  }
}

TEST(Hostile, EveryByteOfTheJson) {
  const std::vector<std::byte> file = everything().glb();
  std::uint32_t json_size;
  std::memcpy(&json_size, file.data() + 12, 4);
  int loaded = 0;
  for (std::size_t at = 20; at < 20 + json_size; ++at)
    for (const char value : {'0', '9', '-', '"', '{', ']', ',', ' ', 'e', '.', '\x00', '\xff'}) {
      std::vector<std::byte> changed = file;
      changed[at] = static_cast<std::byte>(value);
      loaded += survives(changed);
    }
  EXPECT_GT(loaded, 100);  // or the test tests nothing
}

TEST(Hostile, EveryByteOfTheBinary) {
  const GltfBuilder good = everything();
  for (std::size_t at = 0; at < good.bin.size(); ++at)
    for (const int value : {0x00, 0x7f, 0x80, 0xff}) {
      GltfBuilder b = good;
      b.bin[at] = static_cast<std::byte>(value);
      survives(b.glb());
    }
}

// Every field of every object replaced by values of other types and of absurd size.
void replaceEach(const Json& whole, Json& place, const std::vector<Json>& values,
                 const std::function<void(const Json&)>& test) {
  if (!place.is_structured()) return;
  for (auto& [key, child] : place.items()) {
    const Json kept = child;
    for (const Json& value : values) {
      child = value;
      test(whole);
    }
    child = kept;
    replaceEach(whole, child, values, test);
  }
}

TEST(Hostile, EveryFieldOfAnotherType) {
  const GltfBuilder good = everything();
  Json doc = good.doc;
  const std::vector<Json> values = {nullptr,
                                    true,
                                    -1,
                                    0,
                                    1,
                                    3,
                                    1.5,
                                    1e300,
                                    4294967295u,
                                    9007199254740992,
                                    "x",
                                    Json::array(),
                                    Json::object(),
                                    Json::array({0}),
                                    Json::array({"x"})};
  int loaded = 0;
  replaceEach(doc, doc, values, [&](const Json& changed) {
    GltfBuilder b;
    b.doc = changed;
    b.bin = good.bin;
    loaded += survives(b.glb());
  });
  EXPECT_GT(loaded, 100);
}

}  // namespace
}  // namespace relume::scene::gltf
