// SPDX-License-Identifier: MIT
#include "relume/relight/group_relighter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

float valueOf(std::size_t group, std::size_t texel, std::size_t channel) {
  return static_cast<float>((texel * 13 + channel * 7 + group * 5) % 23);
}

// 3,000 of 6,000 texels are covered; a plane of one channel stands among the groups.
asset::Asset bakeOfGroups() {
  asset::Asset bake;
  bake.atlas.width = 100, bake.atlas.height = 60, bake.atlas.pages = 1;
  for (std::uint32_t t = 0; t < 6000; t += 2) bake.atlas.texel.push_back(t);
  asset::Layer layer;
  layer.name = layer.kind = "lightgroups";
  for (std::size_t g = 0; g < 3; ++g) {
    asset::Plane plane{.name = std::string(1, static_cast<char>('a' + g)), .channels = 3, .values = {}};
    for (std::size_t i = 0; i < 18000; ++i) plane.values.push_back(valueOf(g, i / 3, i % 3));
    layer.planes.push_back(plane);
  }
  layer.planes.insert(layer.planes.begin() + 1,
                      asset::Plane{.name = "other", .values = std::vector<float>(6000, 9.0f)});
  bake.layers = {layer};
  return bake;
}

TEST(GroupRelighter, IsTheSumOfGroupsTimesGains) {
  const asset::Asset bake = bakeOfGroups();
  GroupRelighter relighter(bake, bake.layers[0]);
  EXPECT_EQ(relighter.groupNames(), (std::vector<std::string>{"a", "b", "c"}));
  const std::vector<Vec3> gains{{1, 0.5f, 0}, {0, 0, 0}, {2, 3, 4}};
  const auto got = relighter.evaluate(gains);
  ASSERT_EQ(got.size(), 3000u);
  for (std::size_t i = 0; i < got.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      float expected = 0;
      for (std::size_t g = 0; g < 3; ++g) expected += gains[g][static_cast<int>(c)] * valueOf(g, 2 * i, c);
      EXPECT_FLOAT_EQ(got[i].rgb[static_cast<int>(c)], expected) << i;
    }
}

TEST(GroupRelighter, SameBitsForAnyNumberOfThreads) {
  const asset::Asset bake = bakeOfGroups();
  GroupRelighter relighter(bake, bake.layers[0]);
  const std::vector<Vec3> gains{{0.1f, 0.2f, 0.3f}, {1.1f, 0, 0.7f}, {0.9f, 0.4f, 0.6f}};
  const auto all = relighter.evaluate(gains);
  const std::vector<Irradiance> expected(all.begin(), all.end());
  const ThreadLimit one(1);
  const auto got = relighter.evaluate(gains);
  EXPECT_EQ(std::vector<Irradiance>(got.begin(), got.end()), expected);
}

TEST(GroupRelighter, RefusesGainsAndLayersThatMakeNoSense) {
  asset::Asset bake = bakeOfGroups();
  GroupRelighter relighter(bake, bake.layers[0]);
  for (const float bad : {-1.0f, std::nanf(""), kInfinity}) {
    const std::vector<Vec3> gains{{1, 1, 1}, {1, bad, 1}, {1, 1, 1}};
    try {
      relighter.evaluate(gains);
      FAIL();
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::kInvalidValue);
      EXPECT_EQ(e.subject(), "group b");
    }
  }
  bake.layers[0].kind = "lightmap";
  EXPECT_THROW(GroupRelighter(bake, bake.layers[0]), Error);
}

}  // namespace
}  // namespace relume::relight
