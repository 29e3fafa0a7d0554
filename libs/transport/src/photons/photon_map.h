// SPDX-License-Identifier: MIT
// What paths deposit, by texel, in whole units: sums that any order of threads makes the same.
#pragma once
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "relume/transport/photons.h"

namespace relume::transport {

using Flux = PhotonBalance::Flux;

inline Flux& operator+=(Flux& a, const Flux& b) {
  for (std::size_t c = 0; c < 3; ++c) a[c] += b[c];
  return a;
}
inline Flux operator-(const Flux& a, const Flux& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
/// Rounded to whole units.
inline Flux scaled(const Flux& f, Vec3 by) {
  const auto part = [&](std::size_t c, float s) {
    return static_cast<std::int64_t>(std::llround(static_cast<double>(f[c]) * static_cast<double>(s)));
  };
  return {part(0, by.x), part(1, by.y), part(2, by.z)};
}

class PhotonMap {
 public:
  /// `sums`: numbers that a receiver adds to, 0 without one.
  PhotonMap(std::size_t points, std::size_t sums)
      : sums_(sums), texels_(points), directional_(points * sums) {}

  void add(std::uint32_t point, const Flux& flux) {
    Texel& texel = texels_[point];
    for (std::size_t c = 0; c < 3; ++c) bump(texel.flux[c], flux[c]);
    // Of luminance, in units of 2^10: a path's 2^20 squared a few thousand million times still fits.
    const std::int64_t grey = (13933 * flux[0] + 46871 * flux[1] + 4732 * flux[2]) >> 26;
    bump(texel.squares, grey * grey);
    bump(texel.paths, 1);
  }
  /// What a basis makes of the arrival of a flux, in units.
  void addDirectional(std::uint32_t point, std::span<const double> sums) {
    for (std::size_t k = 0; k < sums.size(); ++k)
      if (sums[k] != 0) bump(directional_[point * sums_ + k], std::llround(sums[k]));
  }

  std::size_t sums() const { return sums_; }
  const Flux& flux(std::size_t point) const { return texels_[point].flux; }
  std::int64_t paths(std::size_t point) const { return texels_[point].paths; }
  /// Variance of the luminance of a texel's flux, square units.
  double variance(std::size_t point) const { return static_cast<double>(texels_[point].squares) * 1048576.0; }
  double directional(std::size_t point, std::size_t k) const {
    return static_cast<double>(directional_[point * sums_ + k]);
  }

 private:
  static void bump(std::int64_t& slot, std::int64_t by) {
    if (by != 0) std::atomic_ref(slot).fetch_add(by, std::memory_order_relaxed);
  }

  struct alignas(64) Texel {  // one cache line: paths land anywhere
    Flux flux{};
    std::int64_t squares = 0, paths = 0;
  };

  std::size_t sums_;
  std::vector<Texel> texels_;
  std::vector<std::int64_t> directional_;
};

}  // namespace relume::transport
