// SPDX-License-Identifier: MIT
// What arrives at the texels of a group, with its directions, as a directional basis wants it.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "group_rays.h"
#include "lightmap/end_radiance.h"
#include "relume/basis/basis.h"

namespace relume::transport {

class DirectionalSums {
 public:
  /// Keeps a reference; null: nothing is kept.
  explicit DirectionalSums(const basis::Basis* basis) : basis_(basis) {}
  explicit operator bool() const { return basis_ != nullptr; }

  void begin(std::span<const std::uint32_t> group, const atlas::Texels& texels) {
    if (!basis_) return;
    receivers_.clear();
    for (const std::uint32_t point : group) receivers_.emplace_back(texels.points[point].shading_normal);
    sums_.assign(group.size() * basis_->sums(), 0.0);
  }

  void add(std::uint32_t texel, const basis::Arrival& light) {
    const std::size_t n = basis_->sums();
    basis_->add(receivers_[texel], light, std::span(sums_).subspan(texel * n, n));
  }

  /// What the rays of a packet brought, each of which stands for pi steradian times cosine; `first`: sample
  /// of the packet.
  void add(const GroupRays& rays, std::uint32_t first, const trace::RayPacket& packet,
           const LightLanes& light) {
    for (std::uint32_t lane = 0; lane < GroupRays::kLanes; ++lane) {
      if (!rays.used(lane) || !(packet.t_max[lane] >= 0.0f) || !(light[lane].w > 0.0f)) continue;
      const Direction d(packet.direction_x[lane], packet.direction_y[lane], packet.direction_z[lane]);
      const float cosine = glm::dot(rays.normals(first, lane).shading, d);
      if (cosine > 0.0f) add(rays.texelOf(lane), {d, Irradiance(kPi * Vec3(light[lane])), cosine});
    }
  }

  /// Adds the means of `count` samples of texel i to `out`.
  void addMeans(std::size_t i, std::uint32_t count, std::span<float> out) const {
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] += static_cast<float>(sums_[i * out.size() + k] / std::max(count, 1u));
  }

 private:
  const basis::Basis* basis_;
  std::vector<basis::Receiver> receivers_;  // by texel
  std::vector<double> sums_;                // [texels][basis->sums()]
};

}  // namespace relume::transport
