// SPDX-License-Identifier: MIT
// How the light on a patch of surface varies from lamp to lamp: its mean, in the shape that light has on
// average, and modes about that, which are the principal components of what training lamps leave. A patch of
// its mean alone is what radiosity has; where shadows cross it, or a lamp is near, exits beside it need more.
// Patches get modes where they leave most light unsaid, so that few large patches of several modes tell more
// than many small ones. What the modes of a lamp are is estimated from light at few fixed places. Based on:
//   [ES95] Everson, Sirovich. Karhunen-Loeve procedure for gappy data. J. Opt. Soc. Am. A 12 (8), 1995.
// Differs from it: the estimate is a ridge regression over the training lamps, which knows of the noise of
// places, and a mean over places where lamps tell nothing. Measured: docs/light-paths.md.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light_paths/piece_entries.h"
#include "relume/core/progress.h"

namespace relume::transport {

/// Irradiance from training lamps, each of which is so strong that all of them count the same.
struct TrainingLight {
  std::size_t lamps = 0;
  std::vector<float> on_pieces;  ///< shape: [pieces][lamps]
};

/// The entries of patches: of each its mean, then its modes. Light on a piece of a patch is the sum over its
/// shares of their values times the entries.
struct PatchModes {
  std::vector<std::uint32_t> first;  ///< by patch, and one more: its entries
  std::vector<EntryShare> shares;    ///< of pieces
  std::vector<float> of_lamps;       ///< the entries under training lamps; shape: [entries][lamps]
};

/// About `entries` of them, fewer where the light has no more modes; at least one for each patch.
/// patch_of_piece: scene::kNone for those in none. weight: by piece, how much its light matters, not
/// negative. The mean of a patch is weighted so, and modes change nothing about it.
PatchModes modesOf(std::span<const std::uint32_t> patch_of_piece, std::size_t patches,
                   std::span<const float> weight, const TrainingLight& light, std::size_t entries,
                   Progress& progress);

/// By patch [places][entries of the patch]: entry = sum over the patch's places of mix times the irradiance
/// there. on_places: of the training lamps, shape [patches][places][lamps].
std::vector<float> mixOf(const PatchModes& modes, std::span<const float> on_places, std::size_t lamps,
                         std::size_t places, Progress& progress);

}  // namespace relume::transport
