// SPDX-License-Identifier: MIT
// Who receives the light of a day: all texels, or what a camera sees of them. Only this tells the three
// look-ups of the layer apart.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "relume/asset/day_frames.h"
#include "relume/bake/registry.h"
#include "relume/image/image.h"

namespace relume::bake {

class DayReceivers {
 public:
  /// `shape`: kind, size and camera. What lies in texels that are not `valid` is not looked at.
  DayReceivers(const LayerContext& context, const asset::DayFrames& shape,
               std::span<const std::uint8_t> valid);

  std::size_t size() const { return albedo_.size(); }
  /// What receivers get, by what texels get (in the order of Texels::points). out: [size()]
  void gather(std::span<const Vec3> texels, std::span<Vec3> out) const;
  /// Light that they send out, times `exposure`, as a picture to be looked at: the atlas, the faces of the
  /// cube below one another, or what the camera sees.
  image::Image picture(std::span<const Vec3> irradiance, float exposure) const;
  /// Mean of the logarithm of the luminance that they send out, as a luminance; what is black counts for
  /// nothing.
  float typical(std::span<const Vec3> irradiance) const;

 private:
  /// A bilinear look-up among the texels of one chart.
  struct Taps {
    std::array<std::uint32_t, 4> point{};
    std::array<float, 4> weight{};
  };
  void takePixels(const LayerContext& context, const asset::DayFrames& shape,
                  std::span<const std::uint8_t> valid);

  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> pixel_;  // by receiver, in the picture
  std::vector<Vec3> albedo_;
  std::vector<Taps> taps_;  // empty: receivers are texels
};

}  // namespace relume::bake
