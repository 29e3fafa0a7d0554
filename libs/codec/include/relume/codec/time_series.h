// SPDX-License-Identifier: MIT
// A sequence of frames as few eigen-images: frame[k] ~ mean + sum_c weight[k][c] image[c], in bytes. Based
// on:
//   [BDPTM] Bahnsen et al. Realtime global illumination using compressed pre-computed indirect illumination
//   textures. Section 3.2: PCA of the frames.
// Images are kept in whole steps, all of the same size, so that those that hardly matter hold small numbers,
// which compress well; the mean in half floats. Weights are at most 1, so that an image is off by half a step
// at most in any frame.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relume/codec/pca.h"

namespace relume::codec {

struct TimeSeries {
  std::size_t frames = 0, values = 0, rank = 0;
  float mean_scale = 1;
  std::vector<std::uint16_t> mean;   ///< shape [values]: half floats, to be multiplied by mean_scale
  std::vector<float> step;           ///< shape [rank]
  std::vector<std::int16_t> images;  ///< shape [rank][values]: step * q
  std::vector<float> weights;        ///< shape [frames][rank], in [-1, 1]

  /// out: [values]; sum over frames of gain times frame. gains: [frames]
  void blend(std::span<const float> gains, std::span<float> out) const;
  /// The same of one frame.
  void frame(std::size_t index, std::span<float> out) const;
};

/// The first `rank` components of a PCA of frames (rows). `step`: of the images; larger where 16 bits do not
/// hold them.
TimeSeries encodeTimeSeries(const Pca& pca, std::size_t rank, float step);

}  // namespace relume::codec
