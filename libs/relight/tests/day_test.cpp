// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "relume/core/error.h"
#include "relume/relight/day_file.h"
#include "relume/relight/day_relighter.h"

namespace relume::relight {
namespace {

ErrorCode codeOf(const std::string& json) {
  try {
    parseDay(json, "day.json");
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << json << " was read";
  return ErrorCode::kInterrupted;
}

TEST(DayFile, ReadsEveryMember) {
  const Day day = parseDay(R"({"latitude": -33.9, "longitude": 151.2, "date": "2024-02-29", "utcOffset": 10.5,
    "heading": 90, "turbidity": 4, "scale": 0.01, "sun": false, "sky": "constant", "begin": "4:30", "end": "22:00",
    "groups": {"posts": [["05:00", 1], ["05:10", [0, 0.5, 1]]]},
    "lights": [{"type": "point", "name": "lantern", "position": [1, 2, 3], "intensity": 5,
      "keys": [{"time": "10:00", "intensity": 2, "color": [1, 0, 0]}, {"time": "11:00", "position": [4, 5, 6]}]}]})",
                           "day.json");
  EXPECT_EQ(day.place.latitude_deg, -33.9);
  EXPECT_EQ(day.date, (Date{2024, 2, 29}));
  EXPECT_EQ(day.utc_offset, 10.5);
  EXPECT_EQ(day.heading_deg, 90);
  EXPECT_EQ(day.sky, Day::Sky::kConstant);
  EXPECT_FALSE(day.sun);
  EXPECT_EQ(day.begin, 270);
  EXPECT_EQ(day.groups.at("posts")[1].gain, Vec3(0, 0.5f, 1));
  ASSERT_EQ(day.lights->size(), 1u);
  EXPECT_EQ((*day.lights)[0].keys[1].position, Point(4, 5, 6));
  EXPECT_EQ(*(*day.lights)[0].keys[0].intensity, 2);
  EXPECT_EQ(parseDay("{}", "day.json").date, (Date{2011, 6, 21})) << "every member may be missing";
}

TEST(DayFile, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(codeOf("{"), ErrorCode::kInvalidJson);
  for (const char* wrong :
       {"[]", R"({"latitud": 5})", R"({"latitude": 91})", R"({"latitude": "north"})",
        R"({"date": "2011-02-29"})", R"({"date": "21.6.2011"})", R"({"sky": "cloudy"})", R"({"sun": 1})",
        R"({"begin": "25:00"})", R"({"begin": "12:00", "end": "11:00"})", R"({"groups": {"a": []}})",
        R"({"groups": {"a": [["12:00"]]}})", R"({"groups": {"a": [["12:00", 1], ["11:00", 1]]}})",
        R"({"groups": {"a": [["12:00", -1]]}})", R"({"lights": [{"type": "point", "keys": 3}]})",
        R"({"lights": [{"type": "point", "keys": [{"intensity": 3}]}]})",
        R"({"lights": [{"type": "point", "keys": [{"time": "1:00", "colour": [1, 1, 1]}]}]})",
        R"({"lights": [{"type": "lamp"}]})", R"({"turbidity": 1})"})
    EXPECT_EQ(codeOf(wrong), ErrorCode::kInvalidValue) << wrong;
}

/// Three keyframes of four texels: 1 at 60 minutes, 3 at 120, and 11 at 200.
asset::Asset bakeOfADay() {
  asset::Asset bake;
  bake.atlas.width = bake.atlas.height = 2, bake.atlas.pages = 1;
  for (std::uint32_t t = 0; t < 4; ++t) bake.atlas.texel.push_back(t), bake.atlas.chart.push_back(0);
  asset::DayFrames frames;
  frames.width = frames.height = 2;
  frames.minutes = {60, 120, 200};
  frames.gain = {1, 2, 4};  // frames hold 1, 1.5 and 2.75
  codec::TimeSeries& s = frames.series;
  s.frames = 3, s.values = 12, s.rank = 1;
  s.mean.assign(12, 0x3c00);  // 1
  s.images.assign(12, 7), s.step = {0.25f};
  s.weights = {0, 2.0f / 7, 1};
  asset::Layer layer;
  layer.name = layer.kind = "day";
  layer.parameters["day"] = std::string(R"({"latitude": 10})");
  layer.tables = asset::tablesOf(frames);
  bake.layers = {layer};
  return bake;
}

TEST(DayRelighter, InterpolatesBetweenUnevenKeyframes) {
  const asset::Asset bake = bakeOfADay();
  DayRelighter relighter(bake, bake.layers[0]);
  EXPECT_EQ(relighter.day().place.latitude_deg, 10);
  const double known[][2] = {{0, 1}, {60, 1}, {75, 1.5}, {120, 3}, {140, 5}, {160, 7}, {200, 11}, {1440, 11}};
  for (const auto& [minutes, light] : known) {
    const auto texels = relighter.evaluate(minutes);
    ASSERT_EQ(texels.size(), 4u);
    for (const Irradiance& e : texels)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(e.rgb[c], static_cast<float>(light), 1e-5f) << minutes;
  }
}

TEST(DayRelighter, RefusesOtherLayers) {
  asset::Asset bake = bakeOfADay();
  bake.layers[0].parameters.clear();
  EXPECT_THROW(DayRelighter(bake, bake.layers[0]), Error);
  bake = bakeOfADay();
  bake.layers[0].kind = "lightmap";
  EXPECT_THROW(DayRelighter(bake, bake.layers[0]), Error);
}

}  // namespace
}  // namespace relume::relight
