// SPDX-License-Identifier: MIT
// Containers, URIs, versions and extensions: what the door lets in.
#include <gtest/gtest.h>

#include <filesystem>

#include "gltf_builder.h"
#include "relume/core/file.h"
#include "uri.h"

namespace relume::scene::gltf {
namespace {

namespace fs = std::filesystem;

std::string parseError(const std::string& text) {
  return errorOf([&] { Document::parse(toBytes(text), "test.gltf", {}); });
}

class DocumentFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("relume-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_ / "sub");
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;

  /// A .gltf in folder/sub whose one buffer has this URI and whose triangle uses it.
  std::string writeWithBuffer(const std::string& uri, std::size_t length) {
    GltfBuilder b;
    b.triangle();
    b.doc["buffers"] = {{{"uri", uri}, {"byteLength", length}}};
    return b.doc.dump();
  }
  std::vector<std::byte> triangleBuffer() {
    GltfBuilder b;
    b.triangle();
    return b.bin;
  }
};

TEST(Document, ReadsGlbAndGltfAlike) {
  GltfBuilder b;
  b.triangle();
  EXPECT_EQ(b.document().json()["asset"]["version"], "2.0");
  EXPECT_EQ(b.scene().triangleCount(), 1u);
}

TEST(Document, SaysWhatIsWrongWithAContainer) {
  EXPECT_EQ(parseError(""), "truncated");
  EXPECT_EQ(parseError("solid"), "not-gltf");
  EXPECT_EQ(parseError("[1]"), "not-gltf");
  EXPECT_EQ(parseError("{]"), "invalid-json");
  EXPECT_EQ(parseError("{\"asset\":{\"version\":\"2.0\"}"), "invalid-json");
  EXPECT_EQ(parseError("{\"a\":\"\xff\"}"), "invalid-json");
  EXPECT_EQ(parseError("{\"a\":1e999}"), "invalid-json");
  EXPECT_EQ(parseError("{}"), "not-gltf");
  EXPECT_EQ(parseError("{\"asset\":{\"version\":\"1.0\"}}"), "unsupported");
  EXPECT_EQ(parseError("{\"asset\":{\"version\":\"\"}}"), "invalid-value");
  EXPECT_EQ(parseError("{\"asset\":{\"version\":2}}"), "invalid-value");
  EXPECT_EQ(parseError("{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"2.1\"}}"), "unsupported");
  EXPECT_EQ(parseError("{\"asset\":{\"version\":\"2.1\"}}"), "no error");
  EXPECT_EQ(parseError("\xEF\xBB\xBF{\"asset\":{\"version\":\"2.0\"}}"), "no error");
}

TEST(Document, SaysWhatIsWrongWithAGlb) {
  GltfBuilder b;
  b.triangle();
  const std::vector<std::byte> good = b.glb();
  const auto with = [&](std::size_t at, unsigned value) {
    std::vector<std::byte> file = good;
    file[at] = static_cast<std::byte>(value);
    return errorOf([&] { Document::parse(file, "test.glb", {}); });
  };
  EXPECT_EQ(with(4, 1), "unsupported");  // version 1
  EXPECT_EQ(with(11, 1), "truncated");   // length + 2^24
  EXPECT_EQ(with(15, 1), "truncated");   // chunk length + 2^24
  EXPECT_EQ(with(16, 'X'), "not-gltf");  // first chunk not JSON
}

// JSON nested a million deep would overflow the stack wherever it is copied or written.
TEST(Document, RefusesDeepNesting) {
  EXPECT_EQ(parseError("{\"a\":" + std::string(1000000, '[') + std::string(1000000, ']') + "}"),
            "invalid-json");
  EXPECT_EQ(parseError("{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(200, '[') +
                       std::string(200, ']') + "}"),
            "no error");
  EXPECT_EQ(parseError("{\"asset\":{\"version\":\"2.0\"},\"extras\":\"" + std::string(1000, '[') + "\\\"\"}"),
            "no error");
}

TEST(Document, NamesAnUnknownRequiredExtension) {
  GltfBuilder b;
  b.triangle();
  b.doc["extensionsUsed"] = {"VENDOR_magic"};
  EXPECT_EQ(errorOf([&] { b.document(); }), "no error");
  b.doc["extensionsRequired"] = {"VENDOR_magic"};
  try {
    b.document();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
    EXPECT_NE(std::string(error.what()).find("VENDOR_magic"), std::string::npos);
  }
}

TEST(Uri, DecodesDataUris) {
  const auto text = [](const std::string& uri) {
    const auto bytes = decodeDataUri(uri, "test");
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  EXPECT_EQ(text("data:application/octet-stream;base64,SGVsbG8="), "Hello");
  EXPECT_EQ(text("data:;base64,SGVsbG8"), "Hello");
  EXPECT_EQ(text("data:;base64,SGVsbG8%3D"), "Hello");
  EXPECT_EQ(text("data:text/plain,Hel%6Co%"), "Hello%");
  EXPECT_EQ(text("data:;base64,"), "");
  EXPECT_EQ(errorOf([&] { text("data:;base64,SG!sbG8="); }), "invalid-value");
  EXPECT_EQ(errorOf([&] { text("data:;base64"); }), "invalid-value");
}

TEST(Uri, AllowsRelativePathsOnly) {
  EXPECT_EQ(relativePath("a%20b/../c.bin", "test"), fs::path("a b/../c.bin"));
  EXPECT_EQ(relativePath("100%.bin", "test"), fs::path("100%.bin"));
  for (const char* uri : {"/etc/passwd", "%2Fetc/passwd", "file:///etc/passwd", "https://example.org/a.bin",
                          "C:/a.bin", "", "a%00b"})
    EXPECT_EQ(errorOf([&] { relativePath(uri, "test"); }), "invalid-reference") << uri;
}

TEST_F(DocumentFolder, ReadsExternalBuffers) {
  writeFileAtomically(folder_ / "my buffer.bin", triangleBuffer());
  writeFileAtomically(folder_ / "sub" / "a.gltf",
                      writeWithBuffer("../my%20buffer.bin", triangleBuffer().size()));
  Warnings warnings;
  EXPECT_EQ(import(Document::read(folder_ / "sub" / "a.gltf"), warnings).triangleCount(), 1u);
}

TEST_F(DocumentFolder, SaysWhichBufferIsMissing) {
  const auto error = [&](const std::string& uri, std::size_t length) {
    writeFileAtomically(folder_ / "a.gltf", writeWithBuffer(uri, length));
    return errorOf([&] { Document::read(folder_ / "a.gltf"); });
  };
  writeFileAtomically(folder_ / "short.bin", "abc");
  EXPECT_EQ(error("none.bin", 10), "file-not-found");
  EXPECT_EQ(error("short.bin", 10), "truncated");
  EXPECT_EQ(error("sub", 10), "file-unreadable");
  EXPECT_EQ(error("../../../../../../../../../dev/zero", 10), "file-unreadable");
  EXPECT_EQ(error("http://example.org/a.bin", 10), "invalid-reference");
  EXPECT_EQ(error(std::string(5000, 'x'), 10), "file-not-found");
  EXPECT_EQ(errorOf([&] { Document::read(folder_ / "nothing.glb"); }), "file-not-found");
  // Without a folder no files may be read.
  EXPECT_EQ(errorOf([&] { Document::parse(toBytes(writeWithBuffer("short.bin", 3)), "a.gltf", {}); }),
            "invalid-reference");
}

TEST(Document, ABufferWithoutDataIsAnErrorOnlyWhereItIsUsed) {
  GltfBuilder b;
  b.triangle();
  const std::string text = [&] {
    auto json = b.doc;
    json["buffers"] = {{{"byteLength", b.bin.size()}}};
    return json.dump();
  }();
  const Document document = Document::parse(toBytes(text), "test.gltf", {});
  Warnings warnings;
  EXPECT_EQ(errorOf([&] { import(document, warnings); }), "invalid-reference");
}

}  // namespace
}  // namespace relume::scene::gltf
