// SPDX-License-Identifier: MIT
#include "relume/asset/day_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "relume/core/error.h"
#include "table_numbers.h"

namespace relume::asset {
namespace {

constexpr std::size_t kMostPixels = std::size_t{1} << 28;
constexpr std::size_t kMostComponents = 256;
constexpr double kTooLate = 1441;  // minutes

std::string imageName(std::size_t component) { return fmt::format("image{}", component); }

std::size_t rowsOf(const Layer& layer, const char* name) {
  const Table* table = layer.findTable(name);
  if (!table) corrupt(layer, fmt::format("has no table '{}'", name));
  return std::visit([&](const auto& v) { return v.size() / table->channels; }, table->values);
}

std::size_t receiversOf(const DayFrames& frames, const AtlasTable& atlas) {
  switch (frames.receivers) {
    case DayFrames::Receivers::kAtlas:
      return atlas.texel.size();
    case DayFrames::Receivers::kCube:
      return std::size_t{6} * frames.width * frames.width;
    case DayFrames::Receivers::kImage:
      return std::size_t{frames.width} * frames.height;
  }
  return 0;
}

/// Pixel of [-1, 1]^2, y up.
std::size_t pixelAt(Vec2 p, std::uint32_t width, std::uint32_t height) {
  const auto clampTo = [](float v, std::uint32_t n) {
    return static_cast<std::size_t>(std::clamp(v * static_cast<float>(n), 0.0f, static_cast<float>(n) - 1));
  };
  return clampTo(0.5f - 0.5f * p.y, height) * width + clampTo(0.5f + 0.5f * p.x, width);
}

/// Of each face: what it looks along, its right and its up.
struct Face {
  Vec3 forward, right, up;
};
constexpr std::array<Face, 6> kFaces{{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                      {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                      {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                                      {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                      {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                      {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}}};

}  // namespace

std::size_t receiverOf(const DayFrames& frames, Vec3 from_eye) {
  if (frames.receivers == DayFrames::Receivers::kCube) {
    std::size_t face = 0;
    for (std::size_t f = 1; f < kFaces.size(); ++f)
      if (glm::dot(from_eye, kFaces[f].forward) > glm::dot(from_eye, kFaces[face].forward)) face = f;
    const float depth = glm::dot(from_eye, kFaces[face].forward);
    if (!(depth > 0)) return kNowhere;
    const Vec2 p(glm::dot(from_eye, kFaces[face].right) / depth, glm::dot(from_eye, kFaces[face].up) / depth);
    return face * frames.width * frames.width + pixelAt(p, frames.width, frames.width);
  }
  const Vec3 d = glm::transpose(Mat3(frames.camera.world_from_camera)) * from_eye;
  if (!(d.z < 0)) return kNowhere;
  const float half_height = std::tan(0.5f * frames.camera.vertical_fov),
              half_width = half_height * static_cast<float>(frames.width) / static_cast<float>(frames.height);
  const Vec2 p(d.x / -d.z / half_width, d.y / -d.z / half_height);
  constexpr float kRim = 1.02f;  // filters of a picture reach a little beyond it
  if (!(std::max(std::abs(p.x), std::abs(p.y)) <= kRim)) return kNowhere;
  return pixelAt(p, frames.width, frames.height);
}

Direction directionOf(const DayFrames& frames, std::size_t receiver) {
  const std::uint32_t width = frames.width;
  const bool cube = frames.receivers == DayFrames::Receivers::kCube;
  const std::uint32_t height = cube ? width : frames.height;
  const std::size_t pixel = receiver % (std::size_t{width} * height);
  const Vec2 p(2 * (static_cast<float>(pixel % width) + 0.5f) / static_cast<float>(width) - 1,
               1 - 2 * (static_cast<float>(pixel / width) + 0.5f) / static_cast<float>(height));
  if (cube) {
    const Face& face = kFaces[receiver / (std::size_t{width} * width)];
    return glm::normalize(face.forward + p.x * face.right + p.y * face.up);
  }
  const float half_height = std::tan(0.5f * frames.camera.vertical_fov),
              half_width = half_height * static_cast<float>(width) / static_cast<float>(height);
  return glm::normalize(Mat3(frames.camera.world_from_camera) *
                        Vec3(p.x * half_width, p.y * half_height, -1.0f));
}

std::vector<Table> tablesOf(const DayFrames& frames) {
  const codec::TimeSeries& s = frames.series;
  const std::vector<float> keys(frames.minutes.begin(), frames.minutes.end());
  std::vector<float> camera;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) camera.push_back(frames.camera.world_from_camera[c][r]);
  camera.push_back(frames.camera.vertical_fov);
  std::vector<Table> tables = {
      {"shape", 4,
       std::vector<std::uint32_t>{static_cast<std::uint32_t>(frames.receivers), frames.width, frames.height,
                                  static_cast<std::uint32_t>(s.rank)}},
      {"keys", 1, keys},
      {"gains", 1, frames.gain},
      {"variance", 1, frames.variance},
      {"meanScale", 1, std::vector<float>{s.mean_scale}},
      {"mean", 3, s.mean}};
  if (frames.receivers != DayFrames::Receivers::kAtlas) tables.push_back({"camera", 17, std::move(camera)});
  if (s.rank == 0) return tables;
  tables.push_back({"weights", s.rank, s.weights});
  tables.push_back({"steps", 1, s.step});
  for (std::size_t c = 0; c < s.rank; ++c) {
    const auto first = s.images.begin() + static_cast<std::ptrdiff_t>(c * s.values);
    tables.push_back(
        {imageName(c), 3, std::vector<std::int16_t>(first, first + static_cast<std::ptrdiff_t>(s.values))});
  }
  return tables;
}

DayFrames dayFramesOf(const Layer& layer, const AtlasTable& atlas) {
  DayFrames frames;
  const auto& shape = numbers<std::uint32_t>(layer, "shape", 4, 1);
  if (shape[0] > 2) corrupt(layer, fmt::format("has receivers of the unknown kind {}", shape[0]));
  frames.receivers = static_cast<DayFrames::Receivers>(shape[0]);
  frames.width = shape[1], frames.height = shape[2];
  const bool pixels = frames.receivers != DayFrames::Receivers::kAtlas;
  if (pixels && (frames.width == 0 || frames.height == 0 || frames.width > kMostPixels / frames.height / 6))
    corrupt(layer, fmt::format("has pictures of {} x {} pixels", frames.width, frames.height));
  const std::size_t receivers = receiversOf(frames, atlas), rank = shape[3], keys = rowsOf(layer, "keys");
  if (rank > kMostComponents) corrupt(layer, fmt::format("has {} components", rank));
  if (keys == 0) corrupt(layer, "has no keyframe");

  const auto& minutes = numbers<float>(layer, "keys", 1, keys);
  frames.minutes.assign(minutes.begin(), minutes.end());
  for (std::size_t k = 0; k < keys; ++k)
    if (!(frames.minutes[k] >= 0 && frames.minutes[k] < kTooLate) ||
        (k > 0 && !(frames.minutes[k] > frames.minutes[k - 1])))
      corrupt(layer, fmt::format("keyframe {} is at minute {}", k, frames.minutes[k]));
  frames.gain = numbers<float>(layer, "gains", 1, keys);
  if (!std::all_of(frames.gain.begin(), frames.gain.end(), [](float g) { return g >= 0; }))
    corrupt(layer, "a gain is negative");
  frames.variance = numbers<float>(layer, "variance", 1, rowsOf(layer, "variance"));

  codec::TimeSeries& s = frames.series;
  s.frames = keys, s.values = 3 * receivers, s.rank = rank;
  s.mean_scale = numbers<float>(layer, "meanScale", 1, 1)[0];
  s.mean = numbers<std::uint16_t>(layer, "mean", 3, receivers);
  if (pixels) {
    const auto& camera = numbers<float>(layer, "camera", 17, 1);
    for (int i = 0; i < 16; ++i)
      frames.camera.world_from_camera[i / 4][i % 4] = camera[static_cast<std::size_t>(i)];
    frames.camera.vertical_fov = camera[16];
    if (frames.receivers == DayFrames::Receivers::kImage && !(camera[16] > 0 && camera[16] < kPi))
      corrupt(layer, "has a camera that sees nothing");
  }
  if (rank == 0) return frames;
  s.weights = numbers<float>(layer, "weights", rank, keys);
  s.step = numbers<float>(layer, "steps", 1, rank);
  s.images.reserve(rank * s.values);
  for (std::size_t c = 0; c < rank; ++c) {
    const auto& image = numbers<std::int16_t>(layer, imageName(c), 3, receivers);
    s.images.insert(s.images.end(), image.begin(), image.end());
  }
  return frames;
}

}  // namespace relume::asset
