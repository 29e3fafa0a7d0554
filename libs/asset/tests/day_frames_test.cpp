// SPDX-License-Identifier: MIT
#include "relume/asset/day_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "relume/core/error.h"

namespace relume::asset {
namespace {

using Kind = DayFrames::Receivers;

AtlasTable atlasOf(std::uint32_t texels) {
  AtlasTable atlas;
  atlas.width = atlas.height = 8, atlas.pages = 1;
  for (std::uint32_t t = 0; t < texels; ++t) atlas.texel.push_back(t), atlas.chart.push_back(0);
  return atlas;
}

DayFrames example(Kind kind = Kind::kAtlas) {
  DayFrames frames;
  frames.receivers = kind;
  frames.width = kind == Kind::kAtlas ? 8 : 4, frames.height = kind == Kind::kImage ? 3 : frames.width;
  frames.camera = {Mat4(1.0f), 0.9f};
  frames.minutes = {0, 100, 1440};
  frames.gain = {1, 0.5f, 2};
  const std::size_t receivers = kind == Kind::kAtlas ? 5 : kind == Kind::kCube ? 96 : 12;
  codec::TimeSeries& s = frames.series;
  s.frames = 3, s.values = 3 * receivers, s.rank = 2;
  s.mean.assign(s.values, 0x3c00), s.images.assign(2 * s.values, -300);
  s.step = {0.5f, 0.25f}, s.weights = {1, 0, 0, -1, 0.5f, 0.5f};
  frames.variance = {0.9f, 0.1f};
  return frames;
}

Layer layerOf(const DayFrames& frames) {
  Layer layer;
  layer.name = layer.kind = "day";
  layer.tables = tablesOf(frames);
  return layer;
}

TEST(DayFrames, ComeBackFromTheirTables) {
  for (const Kind kind : {Kind::kAtlas, Kind::kCube, Kind::kImage}) {
    const DayFrames frames = example(kind), back = dayFramesOf(layerOf(frames), atlasOf(5));
    EXPECT_EQ(back.receivers, kind);
    EXPECT_EQ(back.minutes, frames.minutes);
    EXPECT_EQ(back.gain, frames.gain);
    EXPECT_EQ(back.variance, frames.variance);
    EXPECT_EQ(back.series.values, frames.series.values);
    EXPECT_EQ(back.series.images, frames.series.images);
    EXPECT_EQ(back.series.weights, frames.series.weights);
    EXPECT_EQ(back.series.mean, frames.series.mean);
    if (kind != Kind::kAtlas) {
      EXPECT_EQ(back.camera, frames.camera);
    }
  }
  DayFrames mean_alone = example();
  mean_alone.series.rank = 0, mean_alone.series.images.clear(), mean_alone.series.weights.clear();
  EXPECT_EQ(dayFramesOf(layerOf(mean_alone), atlasOf(5)).series.rank, 0u);
}

TEST(DayFrames, WhatMakesNoSenseIsRefused) {
  const std::vector<std::function<void(DayFrames&)>> damages = {
      [](DayFrames& f) { f.minutes[1] = 0; },
      [](DayFrames& f) { f.minutes[2] = 5000; },
      [](DayFrames& f) { f.minutes.clear(); },
      [](DayFrames& f) { f.gain[0] = -1; },
      [](DayFrames& f) { f.gain.pop_back(); },
      [](DayFrames& f) { f.series.mean.resize(f.series.mean.size() - 3); },
      [](DayFrames& f) { f.series.step.pop_back(); },
      [](DayFrames& f) { f.series.weights.resize(4); },
      [](DayFrames& f) { f.receivers = static_cast<Kind>(7); },
      [](DayFrames& f) { f.receivers = Kind::kImage, f.width = 0; },
      [](DayFrames& f) { f.receivers = Kind::kImage, f.height = 0xffffffffu; },
  };
  for (std::size_t i = 0; i < damages.size(); ++i) {
    DayFrames frames = example();
    damages[i](frames);
    EXPECT_THROW(dayFramesOf(layerOf(frames), atlasOf(5)), Error) << i;
  }
  for (std::size_t t = 0; t < tablesOf(example()).size(); ++t) {
    Layer layer = layerOf(example());
    layer.tables.erase(layer.tables.begin() + static_cast<std::ptrdiff_t>(t));
    EXPECT_THROW(dayFramesOf(layer, atlasOf(5)), Error) << t;
  }
  EXPECT_THROW(dayFramesOf(layerOf(example()), atlasOf(6)), Error) << "another atlas";
}

TEST(DayFrames, DirectionsAndPixelsAreInverse) {
  DayFrames frames = example(Kind::kImage);
  frames.camera.world_from_camera[3] = Vec4(1, 2, 3, 1);
  const float a = 0.7f;
  frames.camera.world_from_camera[0] = Vec4(std::cos(a), 0, -std::sin(a), 0);
  frames.camera.world_from_camera[2] = Vec4(std::sin(a), 0, std::cos(a), 0);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(receiverOf(frames, 3.0f * directionOf(frames, i)), i);
  EXPECT_EQ(receiverOf(frames, -directionOf(frames, 5)), kNowhere) << "behind";
  EXPECT_EQ(receiverOf(frames, {0, 1, 0}), kNowhere) << "above";
  // The upper left pixel is to the left and above.
  const Vec3 d = glm::transpose(Mat3(frames.camera.world_from_camera)) * directionOf(frames, 0);
  EXPECT_LT(d.x, 0);
  EXPECT_GT(d.y, 0);
  const DayFrames cube = example(Kind::kCube);
  for (std::size_t i = 0; i < 96; ++i) EXPECT_EQ(receiverOf(cube, 0.1f * directionOf(cube, i)), i);
}

}  // namespace
}  // namespace relume::asset
