// SPDX-License-Identifier: MIT
// The numbers of a report against pairs, charts and values made up so that the answer is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "leak_suspects.h"
#include "pages.h"
#include "relume/bake/report.h"
#include "report_numbers.h"

namespace relume::bake {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

TEST(ReportNumbers, HistogramKeepsWhatLiesOutsideInTheEndBins) {
  const std::vector<double> values = {-5, 0, 0.5, 1, 1.5, 2, 3, 99};
  const Histogram h = histogramOf(values, {0, 1, 2, 3});
  EXPECT_THAT(h.counts, ElementsAre(3u, 2u, 3u));  // a bin holds its lower edge
  EXPECT_THAT(h.edges, ElementsAre(0, 1, 2, 3));
}

TEST(ReportNumbers, Quantiles) {
  std::vector<double> values = {5, 1, 4, 2, 3};
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 0.5), 3);
  EXPECT_EQ(quantile(values, 1), 5);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

atlas::SeamSample pair(std::uint32_t a, std::uint32_t b) {
  atlas::SeamSample s{};
  s.texel[0][0] = a, s.weight[0][0] = 1;
  s.texel[1][0] = b, s.weight[1][0] = 1;
  return s;
}

TEST(ReportNumbers, SeamErrorOfAMadeUpPair) {
  // Differences of the channels: 3 and 4 on the first seam, 0 and 0 on the second.
  const std::vector<float> values = {1, 2, 4, 6, 7, 7, 7, 7};
  const std::vector<atlas::SeamSample> seams = {pair(0, 1), pair(2, 3)};
  const SeamError e = seamError(seams, 2, values);
  EXPECT_EQ(e.samples, 2u);
  EXPECT_DOUBLE_EQ(e.max, 4);
  EXPECT_DOUBLE_EQ(e.rms, std::sqrt((9 + 16) / 4.0));
  EXPECT_EQ(seamError({}, 2, values).rms, 0);
}

TEST(ReportNumbers, SeamSidesAreLookedUpBilinearly) {
  atlas::SeamSample s = pair(0, 3);
  s.weight[0][0] = 0.25f;
  s.texel[0][1] = 1, s.weight[0][1] = 0.75f;
  const std::vector<float> values = {0, 4, 0, 1};
  EXPECT_DOUBLE_EQ(seamError(std::vector{s}, 1, values).max, 2);  // 3 against 1
}

TEST(ReportNumbers, DensityOfATexel) {
  atlas::SurfacePoint p;
  p.dp_dx = {0.1f, 0, 0}, p.dp_dy = {0, 0, 0.025f};
  EXPECT_THAT(texelDensity(p), DoubleNear(20, 1e-4));  // 400 texels to the square metre
  p.dp_dy = p.dp_dx;
  EXPECT_EQ(texelDensity(p), 0) << "without an extent it has no density";
}

/// A page of width x height texels, all covered by one chart.
atlas::Texels sheet(int width, int height) {
  atlas::Texels texels{.width = width, .height = height, .pages = 1};
  for (int i = 0; i < width * height; ++i) {
    atlas::SurfacePoint p;
    p.texel = static_cast<std::uint32_t>(i);
    p.position = {static_cast<float>(i % width), 0, static_cast<float>(i / width)};
    texels.points.push_back(p);
  }
  return texels;
}

PointLayer flatLayer(std::size_t points, float value) {
  PointLayer layer;
  layer.planes.push_back({.name = "value", .channels = 1, .values = std::vector<float>(points, value)});
  layer.error.assign(points, 0);
  layer.valid.assign(points, 1);
  return layer;
}

TEST(ReportNumbers, ErrorsOfCharts) {
  atlas::Texels texels = sheet(4, 1);
  texels.points[2].chart = 1, texels.points[3].chart = 2;
  PointLayer layer = flatLayer(4, 2);
  layer.error = {3, 4, 9, 5};
  layer.valid = {1, 1, 0, 1};
  layer.planes[0].values = {1, 2, 100, 7};
  const auto charts = chartErrors(texels, layer, 3);
  EXPECT_DOUBLE_EQ(charts[0].rms, std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(charts[0].max, 4);
  EXPECT_DOUBLE_EQ(charts[0].mean_value, 1.5);
  EXPECT_DOUBLE_EQ(charts[1].rms, 0) << "an invalid texel has no error of its own";
  EXPECT_DOUBLE_EQ(charts[2].rms, 5);
}

class Suspects : public testing::Test {
 protected:
  static constexpr int kWidth = 9, kHeight = 8;
  Suspects() : texels_(sheet(kWidth, kHeight)), layer_(flatLayer(texels_.points.size(), 0.5f)) {}
  float& at(int x, int y) { return layer_.planes[0].values[static_cast<std::size_t>(y * kWidth + x)]; }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * kWidth + x); }
  LayerReport find() {
    LayerReport report;
    report.mean_value = 0.5;
    findSuspects(texels_, pointsByTexel(texels_), layer_, report);
    return report;
  }
  atlas::Texels texels_;
  PointLayer layer_;
};

TEST_F(Suspects, EvenAndSloping) {
  EXPECT_EQ(find().stand_out, 0u);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) at(x, y) = 0.1f * static_cast<float>(x) + 0.05f * static_cast<float>(y);
  EXPECT_EQ(find().stand_out, 0u) << "a slope is no leak, also at the borders";
}

TEST_F(Suspects, AnEdgeOfAShadowIsNoLeak) {
  for (int y = 0; y < kHeight; ++y)
    for (int x = 4; x < kWidth; ++x) at(x, y) = 0.02f;
  EXPECT_EQ(find().stand_out, 0u);
}

TEST_F(Suspects, ABrightTexelStandsOutAndIsToldWhere) {
  at(3, 4) = 0.9f;
  const LayerReport report = find();
  ASSERT_GE(report.stand_out, 1u);
  const Suspect& worst = report.suspects.front();
  EXPECT_EQ(worst.texel, index(3, 4));
  EXPECT_EQ(worst.position, Point(3, 0, 4));
  EXPECT_FLOAT_EQ(worst.value, 0.9f);
  EXPECT_FLOAT_EQ(worst.suggested, 0.5f);
  EXPECT_FLOAT_EQ(worst.severity, 0.4f / (0.2f * 0.9f + 0.02f * 0.5f));
  EXPECT_EQ(worst.signs, kStandsOut);
  EXPECT_EQ(report.marks[index(3, 4)], kStandsOut);
}

TEST_F(Suspects, ALeakAlongABorderStandsOut) {
  for (int x = 0; x < kWidth; ++x) at(x, 0) = 0.9f;
  const LayerReport report = find();
  EXPECT_EQ(report.stand_out, static_cast<std::size_t>(kWidth));
  for (int x = 0; x < kWidth; ++x) EXPECT_TRUE(report.marks[index(x, 0)] & kStandsOut) << x;
}

TEST_F(Suspects, NoiseIsTolerated) {
  at(3, 4) = 0.9f;
  layer_.error[index(3, 4)] = 0.1f;
  EXPECT_EQ(find().stand_out, 0u);
}

TEST_F(Suspects, AnotherChartHasNoSay) {
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 5; x < kWidth; ++x) {
      texels_.points[index(x, y)].chart = 1;
      at(x, y) = 0.9f;
    }
  }
  EXPECT_EQ(find().stand_out, 0u);
  for (int y = 0; y < kHeight; ++y) at(4, y) = 0.9f;  // a leak, though the chart beside it is as bright
  EXPECT_EQ(find().stand_out, static_cast<std::size_t>(kHeight));
}

TEST_F(Suspects, AHemFoldedIntoTheChartIsNoLeak) {
  for (int x = 0; x < kWidth; ++x) at(x, 0) = 0.1f;
  EXPECT_EQ(find().stand_out, static_cast<std::size_t>(kWidth)) << "a dark row of the same surface is one";
  for (int x = 0; x < kWidth; ++x) texels_.points[index(x, 0)].shading_normal = {0, 1, 0};
  EXPECT_EQ(find().stand_out, 0u);
  at(4, 0) = 0.9f;
  EXPECT_EQ(find().stand_out, 0u) << "two texels beside it are too few to tell";
}

TEST_F(Suspects, TexelsBesideInvalidOnesAndThoseThatSeeBacks) {
  layer_.valid[index(4, 4)] = 0;
  at(4, 4) = 100;  // whatever is there has no say
  layer_.back_share.assign(texels_.points.size(), 0);
  layer_.back_share[index(0, 0)] = 0.1f;
  const LayerReport report = find();
  EXPECT_EQ(report.invalid_texels, 1u);
  EXPECT_EQ(report.marks[index(4, 4)], kInvalidMark);
  EXPECT_EQ(report.beside_invalid, 8u);
  EXPECT_EQ(report.marks[index(3, 3)], kBesideInvalid);
  EXPECT_EQ(report.see_backs, 1u);
  EXPECT_EQ(report.marks[index(0, 0)], kSeesBacks);
  EXPECT_EQ(report.stand_out, 0u);
}

TEST_F(Suspects, HdrValuesAreJudgedRelatively) {
  for (float& v : layer_.planes[0].values) v = 5000;
  at(3, 4) = 5500;
  EXPECT_EQ(find().stand_out, 0u);
  at(3, 4) = 9000;
  EXPECT_GE(find().stand_out, 1u);
}

TEST(FinishedPlane, TellsSeamErrorsBeforeAndAfterStitching) {
  atlas::Texels texels = sheet(4, 1);
  const std::vector<std::uint8_t> valid(4, 1);
  PointPlane plane{.name = "value", .channels = 1, .values = {0, 0.2f, 0.6f, 1}};
  LayerReport report;
  const asset::Plane out = finishPlane(texels, std::vector{pair(1, 2)}, valid, plane, &report);
  EXPECT_NEAR(report.seams_before.rms, 0.4, 1e-6);
  EXPECT_NEAR(report.seams_after.max, std::abs(out.values[1] - out.values[2]), 1e-6);
  EXPECT_LT(report.seams_after.max, 0.1);
}

TEST(ReportJson, HasEveryFieldAndNoInfinity) {
  Report report;
  report.settings = {
      {"max_memory", std::numeric_limits<double>::infinity()}, {"seed", 7.0}, {"smoothing", true}};
  report.objects.push_back({.name = "wall \"a\"", .charts = 1, .texels = 3, .invalid_texels = 1});
  report.charts.push_back({.object = 0, .page = 2, .x = 4, .texels = 3});
  report.texel_density = {.edges = {1, 2}, .counts = {3}};
  LayerReport layer{.name = "ao.2", .kind = "ao"};
  layer.charts.push_back({.rms = 0.5, .max = 1, .mean_value = 0.25});
  layer.seams_before = {.samples = 5, .rms = 0.1, .max = 0.2};
  layer.suspects.push_back({.texel = 9, .severity = 2, .signs = kStandsOut | kSeesBacks});
  report.layers.push_back(layer);
  const auto json = nlohmann::json::parse(toJson(report));
  EXPECT_EQ(json["settings"]["max_memory"], "inf");
  EXPECT_EQ(json["settings"]["seed"], 7);
  EXPECT_TRUE(json["settings"]["seed"].is_number_integer());
  EXPECT_EQ(json["objects"][0]["name"], "wall \"a\"");
  EXPECT_EQ(json["charts"][0]["page"], 2);
  EXPECT_EQ(json["texel_density"]["histogram"]["counts"][0], 3);
  const auto& l = json["layers"][0];
  EXPECT_EQ(l["charts"][0]["rms_error"], 0.5);
  EXPECT_EQ(l["seams"]["samples"], 5);
  EXPECT_EQ(l["seams"]["before"]["max"], 0.2);
  EXPECT_EQ(l["suspects"]["worst"][0]["signs"].size(), 2u);
}

}  // namespace
}  // namespace relume::bake
