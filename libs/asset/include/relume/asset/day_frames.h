// SPDX-License-Identifier: MIT
// Light at points in time, as a layer of kind `day` keeps it (docs/format.md): keyframes at uneven times as
// mean, eigen-images and weights. Based on:
//   [BDPTM] Bahnsen, Dewilde, Pedersen, Tranchet, Madsen. Realtime global illumination using compressed
//   pre-computed indirect illumination textures. Sections 3.1 and 3.2.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/codec/time_series.h"

namespace relume::asset {

struct DayFrames {
  /// Who receives light. The paper's three look-ups, for a camera that is free, one that only turns, and one
  /// that stands still.
  enum class Receivers : std::uint32_t {
    kAtlas,  ///< covered texels, in the order of AtlasTable
    kCube,   ///< six faces of `width` x `width` pixels about the camera's eye: +X, -X, +Y, -Y, +Z, -Z
    kImage,  ///< `width` x `height` pixels of the camera, row 0 on top
  };
  struct Camera {
    Mat4 world_from_camera{1.0f};  ///< looks along -z, +y up
    float vertical_fov = 0;        ///< radians
    bool operator==(const Camera&) const = default;
  };

  Receivers receivers = Receivers::kAtlas;
  std::uint32_t width = 0, height = 0;
  Camera camera;
  std::vector<double> minutes;  ///< of the keyframes, by the clock; increasing
  std::vector<float> gain;      ///< by keyframe: irradiance = gain * frame
  codec::TimeSeries series;     ///< frames; values are RGB of receivers
  std::vector<float> variance;  ///< of the components there were, as shares of all; falling

  std::size_t size() const { return series.values / 3; }  ///< receivers
};

/// Which value of a cube or an image answers for what lies in that direction from the eye; kNowhere outside
/// the picture. Directions in world space, of any length.
inline constexpr std::size_t kNowhere = ~std::size_t{0};
std::size_t receiverOf(const DayFrames& frames, Vec3 from_eye);
/// The direction from the eye through a pixel's middle.
Direction directionOf(const DayFrames& frames, std::size_t receiver);

std::vector<Table> tablesOf(const DayFrames& frames);

/// Throws Error kCorruptAsset for tables that are missing, of the wrong shape, or hold what makes no sense.
DayFrames dayFramesOf(const Layer& layer, const AtlasTable& atlas);

}  // namespace relume::asset
