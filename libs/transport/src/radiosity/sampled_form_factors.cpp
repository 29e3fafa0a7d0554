// SPDX-License-Identifier: MIT
// Cosine-weighted rays from texels of the patch, through the rays of texel groups, whose 16 sequences make
// one net (sample_table.h). A direction below the true surface brings nothing, as in irradiance.
#include <algorithm>
#include <bit>

#include "group_rays.h"
#include "radiosity/form_factors.h"
#include "radiosity/row_builder.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kFewest = 16, kMost = 256;  // rays from a texel
constexpr std::size_t kGrain = 16;                  // patches

class Sampler {
 public:
  Sampler(const FormFactorScene& scene, const SampleTable& table, std::uint64_t seed)
      : scene_(scene),
        rays_(scene.tracer.scene(), scene.texels, table, seed, kInfinity, Alignment::kTurnedByBlock),
        row_(scene.patches.size()) {}

  void solve(std::size_t patch, std::uint32_t wanted, FormFactors& result) {
    const std::uint32_t texels = scene_.patches.all[patch].count;
    const std::uint32_t each = std::clamp(std::bit_ceil(std::max(wanted / texels, 1u)), kFewest, kMost);
    const double area = static_cast<double>(scene_.patches.all[patch].area);
    scene_.patches.forEachGroup(scene_.texels, patch, [&](std::span<const std::uint32_t> group) {
      rays_.begin(group);
      active_.resize(group.size());
      for (std::uint32_t i = 0; i < group.size(); ++i) {
        active_[i] = i;
        const double share =
            area > 0 ? static_cast<double>(scene_.texels.points[group[i]].area) / area : 1.0 / texels;
        share_[i] = share / each;
      }
      rays_.select(active_, each);
      for (std::uint32_t s = 0; s < each; s += rays_.samplesPerPacket()) trace(s);
    });
    result.set(patch, row_.take(), each * texels);
  }

 private:
  void trace(std::uint32_t first) {
    rays_.packet(first, packet_);
    scene_.tracer.intersectPacket(packet_, hits_);
    for (std::uint32_t lane = 0; lane < GroupRays::kLanes; ++lane) {
      if (!rays_.used(lane) || packet_.t_max[lane] < 0.0f || ((hits_.hit >> lane) & 1u) == 0 ||
          ((hits_.behind >> lane) & 1u) != 0)
        continue;
      const std::uint32_t point = scene_.lookup.point(hits_.where(lane));
      if (point != scene::kNone) row_.add(scene_.patches.patch_of[point], share_[rays_.texelOf(lane)]);
    }
  }

  const FormFactorScene& scene_;
  GroupRays rays_;
  RowBuilder row_;
  trace::RayPacket packet_;
  trace::HitPacket hits_;
  std::vector<std::uint32_t> active_;
  std::array<double, kGroupTexels> share_{};
};

}  // namespace

FormFactors sampledFormFactors(const FormFactorScene& scene, std::uint32_t rays, std::uint64_t seed,
                               Progress& progress) {
  const Stage stage(progress, "form factors", scene.patches.size());
  const SampleTable table(kFewest, kMost, seed, BlockSamples::kShared);
  FormFactors result(scene.patches.size());
  parallelFor(
      scene.patches.size(), kGrain,
      [&](std::size_t begin, std::size_t end) {
        Sampler sampler(scene, table, seed);
        for (std::size_t i = begin; i < end; ++i) sampler.solve(i, rays, result);
      },
      &progress);
  return result;
}

}  // namespace relume::transport
