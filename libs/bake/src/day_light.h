// SPDX-License-Identifier: MIT
// Frames of a day: what texels get at a time, without what comes straight from the sun and from lamps.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "relume/core/day.h"
#include "relume/transport/light_sequence.h"

namespace relume::bake {

class DayLight {
 public:
  /// Keeps references. Lamps that stand still are traced once, by group; only the sun and lamps that move are
  /// traced at every time.
  DayLight(const transport::LightSequence& sequence, const scene::Scene& scene, const Day& day);

  using Light = transport::LightSequence::Light;
  /// Reflected light and skylight; of emissive surfaces, which nothing adds live, their direct light too.
  Light at(double minutes);
  std::size_t frames() const { return frames_; }  ///< asked for so far

 private:
  using Direct = transport::LightSequence::Direct;
  struct Column {
    std::string group;            ///< its gain
    std::size_t keyed = kNoLamp;  ///< or that lamp's
    bool surface = false;
    Direct direct;
  };
  static constexpr std::size_t kNoLamp = ~std::size_t{0};

  Direct trace(const LightSet& lights);
  void addScene(const LightSet& lamps);
  void addKeyed(const std::vector<KeyedLight>& lamps);
  void addSurfaces();
  Vec3 gainOf(const Column& column, double minutes) const;

  const transport::LightSequence& sequence_;
  const Day& day_;
  scene::Scene lit_;       // the scene without light; lamps are put in to be traced
  scene::Scene surfaces_;  // the scene with its emissive surfaces alone
  std::vector<Column> columns_;
  std::vector<std::size_t> moving_;  // of the day's own lamps
  std::size_t frames_ = 0;
};

}  // namespace relume::bake
