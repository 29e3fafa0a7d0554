// SPDX-License-Identifier: MIT
// Light on pieces of surface, as the entries tell it: irradiance of a piece = sum over its shares of value
// times irradiance of the entry. A piece of a patch has the patch's irradiance in its shape; one that entry
// points were shot at has 1 / (d A) of each, d the density of entries and A its own area.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "relume/scene/scene.h"

namespace relume::transport {

struct EntryShare {
  std::uint32_t piece, entry;
  float value;
};

class PieceEntries {
 public:
  PieceEntries() = default;
  PieceEntries(std::size_t pieces, std::vector<EntryShare> shares) : first_(pieces + 1, 0) {
    std::stable_sort(shares.begin(), shares.end(),
                     [](const EntryShare& a, const EntryShare& b) { return a.piece < b.piece; });
    shares_ = std::move(shares);
    for (const EntryShare& s : shares_) ++first_[s.piece + 1];
    for (std::size_t p = 0; p < pieces; ++p) first_[p + 1] += first_[p];
  }
  /// entry_of_piece: scene::kNone for pieces in no entry. shape: by piece (typical_light.h).
  static PieceEntries ofPatches(std::span<const std::uint32_t> entry_of_piece, std::span<const float> shape) {
    std::vector<EntryShare> shares;
    for (std::uint32_t p = 0; p < entry_of_piece.size(); ++p)
      if (entry_of_piece[p] != scene::kNone) shares.push_back({p, entry_of_piece[p], shape[p]});
    return {entry_of_piece.size(), std::move(shares)};
  }

  std::span<const EntryShare> of(std::size_t piece) const {
    return std::span(shares_).subspan(first_[piece], first_[piece + 1] - first_[piece]);
  }

 private:
  std::vector<std::size_t> first_;  // by piece, and one more
  std::vector<EntryShare> shares_;
};

}  // namespace relume::transport
