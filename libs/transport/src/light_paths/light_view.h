// SPDX-License-Identifier: MIT
// Test points where lights may be ([USKP09] 7.1), and what each piece of surface has of them: where entries
// are worth having, and which pieces may share one.
#pragma once
#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

#include "light_paths/pieces.h"
#include "light_paths/places.h"
#include "relume/core/light.h"

namespace relume::transport {

class LightView {
 public:
  static constexpr std::size_t kPlaces = 128;

  /// places: on pieces, the same number on each; a light is looked at from one of them. lights: the first
  /// kPlaces count. Throws Error kInterrupted.
  LightView(const trace::Tracer& tracer, std::size_t pieces, std::span<const Place> places,
            std::span<const Light> lights, Progress& progress);

  /// How finely a piece is worth being divided, in [least, 1]: 1 where it faces a fair share of the places
  /// that the surface that they light faces on average; all 1 without lights. How near they are does not
  /// count: any place might be as near.
  std::vector<float> importance(std::span<const Piece> pieces, float least) const;

  enum class Likeness : std::uint8_t { kUnknown, kAlike, kApart };
  /// Alike: most of the places that one of two pieces sees are seen by the other too, or neither sees any.
  /// Apart: hardly any are, or one sees some and the other none.
  Likeness compare(std::size_t a, std::size_t b) const;
  /// By piece: what falls on it of lights at all the places, how near they are left out.
  std::span<const float> facing() const { return facing_; }
  bool dark(std::size_t piece) const { return seen_[piece].none(); }

 private:
  std::vector<std::bitset<kPlaces>> seen_;  // by piece
  std::vector<float> facing_;               // sum of cosines towards the places that it sees
};

}  // namespace relume::transport
