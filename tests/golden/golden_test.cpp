// SPDX-License-Identifier: MIT
// The comparison with golden images, itself.
#include "golden.h"

#include <gtest/gtest.h>

namespace relume::golden {
namespace {

/// Sets an environment variable while it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old, was_set_ = true;
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { was_set_ ? setenv(name_, old_.c_str(), 1) : unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::string old_;
  bool was_set_ = false;
};

class Golden : public testing::Test {
 protected:
  Golden()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("golden-") + testing::UnitTest::GetInstance()->current_test_info()->name())),
        out_("RELUME_TEST_OUT", (folder_ / "out").string()),
        update_("RELUME_UPDATE_GOLDEN", "0") {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Golden() override { std::filesystem::remove_all(folder_); }

  static image::Image ramp(int width = 32, int height = 16) {
    image::Image picture(width, height, 3);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const float t = static_cast<float>(x) / static_cast<float>(width);
        picture.setRgb(x, y, {t, 0.5f, 1 - t});
      }
    return picture;
  }
  bool written(const char* file) const { return std::filesystem::exists(folder_ / "out" / "ramp" / file); }

  std::filesystem::path folder_;

 private:
  Environment out_, update_;
};

TEST_F(Golden, AnEqualPictureMatchesPngAndExr) {
  for (const char* file : {"ramp.png", "ramp.exr"}) {
    image::writeImage(folder_ / file, ramp());
    EXPECT_TRUE(matches(ramp(), folder_ / file, {.mean = 1e-4, .p99 = 1e-4}));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(Golden, AChangedPictureFailsAndIsShown) {
  image::writeImage(folder_ / "ramp.png", ramp());
  image::Image changed = ramp();
  for (int y = 0; y < 16; ++y) changed.setRgb(5, y, Vec3(1.0f));
  EXPECT_FALSE(matches(changed, folder_ / "ramp.png", {.mean = 1.0, .p99 = 0.1})) << "a small place";
  EXPECT_FALSE(matches(changed, folder_ / "ramp.png", {.mean = 0.01, .p99 = 1.0})) << "the whole";
  for (const char* file : {"picture.png", "picture.exr", "reference.png", "flip.png"})
    EXPECT_TRUE(written(file)) << file;
  const std::string page = readTextFile(folder_ / "out" / "ramp" / "index.html");
  for (const char* word : {"picture.png", "reference.png", "flip.png", "FLIP mean"})
    EXPECT_NE(page.find(word), std::string::npos) << word;
}

TEST_F(Golden, AnotherSizeFails) {
  image::writeImage(folder_ / "ramp.png", ramp(16, 16));
  EXPECT_FALSE(matches(ramp(), folder_ / "ramp.png", {.mean = 1.0, .p99 = 1.0}));
  EXPECT_TRUE(written("index.html"));
}

TEST_F(Golden, AMissingReferenceFails) {
  const testing::AssertionResult result = matches(ramp(), folder_ / "ramp.png", {});
  EXPECT_FALSE(result);
  EXPECT_TRUE(written("picture.png"));
  EXPECT_NE(std::string(result.message()).find("RELUME_UPDATE_GOLDEN=1"), std::string::npos);
}

TEST_F(Golden, UpdatingStoresThePicture) {
  {
    const Environment update("RELUME_UPDATE_GOLDEN", "1");
    EXPECT_TRUE(matches(ramp(), folder_ / "new" / "ramp.png", {}));
  }
  EXPECT_TRUE(matches(ramp(), folder_ / "new" / "ramp.png", {.mean = 1e-4, .p99 = 1e-4}));
}

}  // namespace
}  // namespace relume::golden
