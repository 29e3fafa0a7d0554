// SPDX-License-Identifier: MIT
#include "relume/transport/occlusion_volume.h"

#include <algorithm>
#include <cmath>

#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

/// Evenly over the sphere (spherical Fibonacci points).
Direction fibonacci(std::uint32_t i, std::uint32_t count) {
  const float z = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(count);
  const float sine = std::sqrt(std::max(0.0f, 1 - z * z));
  const double turn = 0.6180339887498949 * i;
  const auto phi = static_cast<float>(2 * 3.14159265358979323846 * (turn - std::floor(turn)));
  return {sine * std::cos(phi), sine * std::sin(phi), z};
}

}  // namespace

float hiddenByCap(float share, float cosine) {
  // What a large cap leaves open is a small one on the other side.
  if (share > 0.5f) return 1 - hiddenByCap(1 - share, -cosine);
  const float q = 4 * share * (1 - share);  // sin^2 of the cap's half angle
  if (q <= 0) return 0;
  if (cosine * cosine >= q) return std::max(cosine, 0.0f) * q;  // the horizon does not cut it
  const float h2 = 1 / q, sine2 = 1 - cosine * cosine;
  const float rim = std::sqrt(std::max(1 - h2 * cosine * cosine, 0.0f)), beyond = std::max(h2 - 1, 1e-6f);
  const float part = cosine * std::acos(std::clamp(-cosine * std::sqrt(beyond / sine2), -1.0f, 1.0f)) -
                     rim * std::sqrt(beyond);
  return std::max(0.0f, (part * q + std::atan(rim / std::sqrt(beyond))) * kInvPi);
}

OcclusionVolume occlusionVolume(const trace::Tracer& tracer, const Box3& object,
                                const OcclusionVolumeOptions& options) {
  OcclusionVolume out;
  const Vec3 extent = object.hi - object.lo;
  const float reach = options.reach * std::max({extent.x, extent.y, extent.z});
  out.box = {object.lo - Vec3(reach), object.hi + Vec3(reach)};
  out.side = options.side;
  const auto side = static_cast<std::size_t>(options.side);
  out.cells.resize(side * side * side);
  const Vec3 cell = (out.box.hi - out.box.lo) / static_cast<float>(options.side);
  parallelFor(out.cells.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Point p = out.box.lo + (Vec3(i % side, i / side % side, i / side / side) + 0.5f) * cell;
      Vec3 sum(0.0f);
      std::uint32_t hidden = 0;
      for (std::uint32_t r = 0; r < options.rays; ++r) {
        const Direction d = fibonacci(r, options.rays);
        if (!tracer.occluded({p, d})) continue;
        sum += d;
        ++hidden;
      }
      const float length = glm::length(sum);
      out.cells[i] = Vec4(length > 0 ? sum / length : Vec3(0),
                          static_cast<float>(hidden) / static_cast<float>(options.rays));
    }
  });
  return out;
}

}  // namespace relume::transport
