// SPDX-License-Identifier: MIT
// docs/format.md carries a whole small bake; what the page shows is what the reader reads.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "glb.h"
#include "relume/asset/asset.h"
#include "relume/core/file.h"

namespace relume::asset {
namespace {

/// The last block of the page fenced as `language`.
std::string lastBlock(const std::string& page, const std::string& language) {
  const std::string fence = "```" + language + "\n";
  const std::size_t begin = page.rfind(fence) + fence.size();
  return page.substr(begin, page.find("```", begin) - begin);
}

std::vector<std::byte> bytesOf(const std::string& dump) {
  std::vector<std::byte> bytes;
  std::istringstream lines(dump);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;  // the offset
    while (words >> word) bytes.push_back(static_cast<std::byte>(std::stoi(word, nullptr, 16)));
  }
  return bytes;
}

TEST(FormatPage, TheExampleIsABake) {
  const std::string page = readTextFile(RELUME_SOURCE_DIR "/docs/format.md");
  const std::vector<std::byte> bin = bytesOf(lastBlock(page, "hex"));
  ASSERT_EQ(bin.size(), 129u);
  const Asset asset = decode(writeGlb(lastBlock(page, "json"), bin), "format.md");
  EXPECT_EQ(asset.atlas.width, 4);
  EXPECT_EQ(asset.atlas.texel, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(asset.atlas.position, (std::vector<Point>{{0, 0, 0}, {0.5f, 0, 0}}));
  EXPECT_EQ(asset.atlas.normal, (std::vector<Normal>{{0, 1, 0}, {0, 1, 0}}));
  EXPECT_NEAR(asset.atlas.albedo[1].y, 0.25, 0.002);
  ASSERT_EQ(asset.layers.size(), 1u);
  EXPECT_EQ(asset.layers[0].plane("value").values, (std::vector<float>{1, 1, 0.5f, 0.5f}));
  EXPECT_EQ(std::get<double>(asset.layers[0].parameters.at("distance")), HUGE_VAL);
}

}  // namespace
}  // namespace relume::asset
