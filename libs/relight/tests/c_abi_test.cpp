// SPDX-License-Identifier: MIT
// Bakes for the checks that are written in C (c_abi_check.c).
#include <gtest/gtest.h>

#include <vector>

#include "c_abi_check.h"
#include "made_bake.h"
#include "relume/asset/asset.h"
#include "relume/relight/relume.h"
#include "relume/relight/transfer_relighter.h"

namespace relume::relight {
namespace {

asset::Asset twoTexels() {
  asset::Asset bake;
  bake.atlas.width = 2, bake.atlas.height = 1, bake.atlas.pages = 1;
  bake.atlas.texel = {0, 1};
  bake.atlas.position = {{0, 0, 0}, {1, 0, 0}};
  bake.atlas.normal = {{0, 1, 0}, {0, 1, 0}};
  bake.atlas.valid.assign(2, 1);
  bake.atlas.chart.assign(2, 0);
  return bake;
}

TEST(CAbi, RelightsObscurance) {
  asset::Asset bake = twoTexels();
  bake.layers = {
      {.name = "obscurance", .kind = "obscurance", .planes = {{.name = "value", .values = {0.5f, 0.25f}}}}};
  const auto glb = asset::encodeGlb(bake);
  EXPECT_EQ(checkObscuranceFromC(glb.data(), glb.size()), 0) << "line of c_abi_check.c";
}

TEST(CAbi, RelightsTransfer) {
  const auto glb = asset::encodeGlb(madeBake({}));
  const asset::Asset bake = asset::decode(glb, "made");
  TransferRelighter relighter(bake, bake.layers[0]);
  LightSet lights(1);
  lights[0].intensity = 10, lights[0].position = {2, 1.5f, 2.5f};
  std::vector<float> expected;
  for (const Irradiance& e : relighter.evaluate(lights, [](std::size_t, std::span<float> v) {
         for (std::size_t i = 0; i < v.size(); ++i) v[i] = i % 2 == 0 ? 1.0f : 0.0f;
       }))
    for (int c = 0; c < 3; ++c) expected.push_back(e.rgb[c]);
  EXPECT_EQ(checkTransferFromC(glb.data(), glb.size(), expected.data()), 0) << "line of c_abi_check.c";
}

TEST(CAbi, DimsGroups) {
  asset::Asset bake = twoTexels();
  bake.layers = {{.name = "lightgroups",
                  .kind = "lightgroups",
                  .planes = {{.name = "a", .channels = 3, .values = {1, 2, 3, 1, 2, 3}},
                             {.name = "b", .channels = 3, .values = {10, 20, 30, 10, 20, 30}}}}};
  const auto glb = asset::encodeGlb(bake);
  EXPECT_EQ(checkGroupsFromC(glb.data(), glb.size()), 0) << "line of c_abi_check.c";
}

// Null pointers everywhere.
TEST(CAbi, NullIsRefused) {
  EXPECT_EQ(relume_point_count(nullptr), 0u);
  EXPECT_EQ(relume_points(nullptr), nullptr);
  EXPECT_EQ(relume_point_normals(nullptr), nullptr);
  EXPECT_EQ(relume_group_count(nullptr), 0u);
  EXPECT_EQ(relume_group_name(nullptr, 0), nullptr);
  EXPECT_EQ(relume_forget_visibility(nullptr), RELUME_BAD_ARGUMENT);
  EXPECT_EQ(relume_set_visibility(nullptr, nullptr, nullptr), RELUME_BAD_ARGUMENT);
  EXPECT_EQ(relume_evaluate(nullptr, nullptr, nullptr, 0), RELUME_BAD_ARGUMENT);
}

}  // namespace
}  // namespace relume::relight
