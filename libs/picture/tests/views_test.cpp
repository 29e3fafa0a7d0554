// SPDX-License-Identifier: MIT
// Views of a bake's data, and its look-ups.
#include <gtest/gtest.h>

#include <limits>

#include "hand_made.h"
#include "relume/image/colour.h"
#include "relume/picture/baked_values.h"

namespace relume::picture {
namespace {

constexpr Vec3 kRed{1, 0, 0}, kGrey{0.5f}, kMagenta{1, 0, 1};

/// Values 0, 1, 2... of a page of 3 x 2 texels, and 100 more on the next page.
asset::Asset numberedBake() {
  asset::Asset bake = emptyBake(3, 2, 2);
  addLayer(bake, "obscurance", "value", {0, 1, 2, 3, 4, 5, 100, 101, 102, 103, 104, 105});
  return bake;
}

TEST(BakedValues, AreBilinearBetweenTexelCentresAndStayInTheirPage) {
  const scene::Scene scene = sceneOf({{}});
  const asset::Asset bake = numberedBake();
  const BakedValues values(scene, &bake, View::kObscurance, "");
  const auto at = [&](std::uint32_t page, float x, float y) { return values.value({page, {x, y}}).r; };
  EXPECT_FLOAT_EQ(at(0, 0.5f, 0.5f), 0);
  EXPECT_FLOAT_EQ(at(0, 1.5f, 1.5f), 4);
  EXPECT_FLOAT_EQ(at(0, 1.0f, 0.5f), 0.5f);
  EXPECT_FLOAT_EQ(at(0, 0.5f, 1.0f), 1.5f);
  EXPECT_FLOAT_EQ(at(0, 1.25f, 1.25f), 0.75f + 3 * 0.75f);
  EXPECT_FLOAT_EQ(at(0, 0, 0), 0);
  EXPECT_FLOAT_EQ(at(0, 3, 2), 5);
  EXPECT_FLOAT_EQ(at(1, 0, 0), 100);
  EXPECT_FLOAT_EQ(at(1, 3, 2), 105);
}

TEST(BakedValues, WildCoordinatesStayInTheirPage) {
  const scene::Scene scene = sceneOf({{}});
  const asset::Asset bake = numberedBake();
  const BakedValues values(scene, &bake, View::kObscurance, "");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FLOAT_EQ(values.value({0, {nan, nan}}).r, 0);
  EXPECT_FLOAT_EQ(values.value({0, {kInfinity, kInfinity}}).r, 5);
  EXPECT_FLOAT_EQ(values.value({1, {-1e30f, 1e30f}}).r, 103);
  EXPECT_EQ(values.tableIndex({0, {nan, -kInfinity}}), 0u);
  EXPECT_EQ(values.tableIndex({1, {kInfinity, 1e30f}}), 11u);
}

TEST(BakedValues, FindTheTableEntryOfATexel) {
  const scene::Scene scene = sceneOf({{}});
  asset::Asset bake = emptyBake(4, 4);
  bake.atlas.texel = {2, 5, 15};
  bake.atlas.chart = {7, 8, 9};
  bake.atlas.valid = {1, 0, 1};
  const BakedValues values(scene, &bake, View::kCharts, "");
  EXPECT_EQ(values.tableIndex({0, {2.5f, 0.5f}}), 0u);
  EXPECT_EQ(values.tableIndex({0, {1.99f, 1.01f}}), 1u);
  EXPECT_EQ(values.tableIndex({0, {4, 4}}), 2u);
  EXPECT_FALSE(values.tableIndex({0, {0.5f, 0.5f}}).has_value());
}

// 4 x 4 texels in 4 x 4 pixels of 1 sample each, which lies less than a pixel from the centre: a picture of
// 12 x 12 has a pixel in the middle of each texel. Row 0 of the atlas is v = 0, which `Quad` puts at the
// bottom of the picture.
template <class F>
void forTexelCentres(const image::Image& picture, const F& f) {
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) f(x, y, picture.rgb(3 * x + 1, 11 - (3 * y + 1)));
}

TEST(Charts, HaveTheirColours) {
  asset::Asset bake = emptyBake(4, 4);
  bake.atlas.texel.pop_back();  // the texel (3, 3) is not covered
  bake.atlas.chart.resize(15);
  bake.atlas.valid.resize(15);
  for (std::uint32_t i = 0; i < 15; ++i) bake.atlas.chart[i] = i % 4 < 2 ? 3 : 4;
  const scene::Scene scene = sceneOf({{}});
  const image::Image picture = rendered(scene, &bake, squareOn(1.0f), optionsOf(View::kCharts, 12));
  forTexelCentres(picture, [](int x, int y, Vec3 colour) {
    SCOPED_TRACE(testing::Message() << x << ", " << y);
    const Vec3 expected = x == 3 && y == 3 ? Vec3(0.2f) : image::labelColour(x < 2 ? 3 : 4);
    expectNear(colour, expected, 1e-6f);
  });
}

TEST(Validity, IsRedGreyAndMagenta) {
  asset::Asset bake = emptyBake(4, 4);
  bake.atlas.texel.pop_back();
  bake.atlas.chart.resize(15);
  bake.atlas.valid.resize(15);
  bake.atlas.valid[6] = 0;  // (2, 1)
  const scene::Scene scene = sceneOf({{}});
  const image::Image picture = rendered(scene, &bake, squareOn(1.0f), optionsOf(View::kValidity, 12));
  forTexelCentres(picture, [](int x, int y, Vec3 colour) {
    SCOPED_TRACE(testing::Message() << x << ", " << y);
    expectNear(colour, x == 3 && y == 3 ? kMagenta : x == 2 && y == 1 ? kRed : kGrey, 1e-6f);
  });
}

TEST(Validity, ShowsSurfacesWithoutABakeInMagenta) {
  const scene::Scene scene = sceneOf({{}, {.corner = {0, 0, 1}, .page = scene::kNone}});
  const asset::Asset bake = constantBake(1.0f);
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kValidity, 1)), kMagenta, 1e-6f);
}

TEST(Texels, AlternateOverTheValue) {
  asset::Asset bake = emptyBake(4, 4);
  addLayer(bake, "ao", "value", std::vector<float>(16, 0.5f));
  const scene::Scene scene = sceneOf({{}});
  const image::Image picture = rendered(scene, &bake, squareOn(1.0f), optionsOf(View::kTexels, 12));
  Vec3 colours[2] = {picture.rgb(1, 10), picture.rgb(4, 10)};
  EXPECT_GT(glm::length(colours[0] - colours[1]), 0.2f);
  forTexelCentres(picture,
                  [&](int x, int y, Vec3 colour) { expectNear(colour, colours[(x + y) % 2], 1e-6f); });

  asset::Asset dark = emptyBake(4, 4);
  addLayer(dark, "ao", "value", std::vector<float>(16, 0.0f));
  const image::Image darker = rendered(scene, &dark, squareOn(1.0f), optionsOf(View::kTexels, 12));
  forTexelCentres(darker, [&](int x, int y, Vec3 colour) {
    expectNear(colour, colours[(x + y) % 2] / 3.0f, 1e-6f);  // (0.2 + 0.8 * 0) / (0.2 + 0.8 * 0.5)
  });
}

TEST(Normals, AreShownAsColours) {
  const scene::Scene scene = sceneOf({{}});
  asset::Asset bake = emptyBake(1, 1);
  addLayer(bake, "ao", "bent", {0.6f, 0, 0.8f});
  expectNear(onePixel(scene, nullptr, middle(), optionsOf(View::kNormal, 1)), {0.5f, 0.5f, 1.0f}, 1e-6f);
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kBentNormal, 1)), {0.8f, 0.5f, 0.9f}, 1e-6f);
  bake.layers[0].planes[0].values = {0, 0, 0};
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kBentNormal, 1)), {0.5f, 0.5f, 1.0f}, 1e-6f);
}

TEST(Layers, ObscuranceIsPreferredWhereTheViewIsItsOwn) {
  asset::Asset bake = emptyBake(1, 1);
  addLayer(bake, "ao", "value", {0.25f});
  const scene::Scene scene = sceneOf({{}});
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kObscurance, 1)), Vec3(0.25f), 1e-6f);
  addLayer(bake, "obscurance", "value", {0.75f});
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kObscurance, 1)), Vec3(0.75f), 1e-6f);
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kOcclusion, 1)), Vec3(0.25f), 1e-6f);
}

}  // namespace
}  // namespace relume::picture
