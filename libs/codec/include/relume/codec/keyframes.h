// SPDX-License-Identifier: MIT
// Which moments of a sequence must be kept, so that what lies between is seen nowhere when it is
// interpolated. Based on:
//   [BDPTM] Bahnsen, Dewilde, Pedersen, Tranchet, Madsen. Realtime global illumination using compressed
//   pre-computed indirect illumination textures. Section 3.2: halve intervals while a difference is visible.
// What differs: the paper compares the interpolated middle with the ends of its interval, which splits
// straight ramps for nothing and misses a bump between equal ends. Here interpolated frames are compared with
// true ones, at the middle and halfway to it on either side.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace relume::codec {

struct KeyframeOptions {
  double shortest = 1.0;  ///< intervals are not split below twice this, in the unit of the times
  int depth = 2;          ///< 1: the middle alone tells; 2: the quarters too; 3: the eighths...
};

/// Whether a frame at `time`, interpolated between frames at two others, can be told from the true one.
struct Interval {
  double before, after;
};
using Visible = std::function<bool(const Interval& keys, double time)>;

/// Moments to be kept, increasing: `seeds` (increasing, at least one) and what halving adds. Each question is
/// asked once; frames that are asked for again are so with the same time to the last bit. Deterministic.
std::vector<double> chooseKeyframes(std::span<const double> seeds, const Visible& visible,
                                    const KeyframeOptions& options = {});

/// Where a moment lies between keys: frame = (1 - share) frame[key] + share frame[key + 1]. Keys increase and
/// may be uneven; before the first and after the last, the nearest. One key alone: {0, 0}.
struct KeyPlace {
  std::size_t key = 0;
  double share = 0;
};
KeyPlace placeBetween(std::span<const double> keys, double time);

}  // namespace relume::codec
