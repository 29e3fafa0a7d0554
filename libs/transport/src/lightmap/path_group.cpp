// SPDX-License-Identifier: MIT
#include "lightmap/path_group.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "path_sampler.h"

namespace relume::transport {
namespace {

ReferenceOptions walkOf(const LightmapOptions& options) {
  ReferenceOptions walk;
  walk.max_bounces = options.max_bounces;
  walk.materials = options.materials;
  walk.part = options.part;
  return walk;
}

}  // namespace

Vec3 PathGroup::Sums::mean() const {
  const glm::dvec3 sum = std::accumulate(run.begin(), run.end(), glm::dvec3(0));
  return count > 0 ? Vec3(sum / static_cast<double>(count)) : Vec3(0.0f);
}

float PathGroup::Sums::error() const {
  if (count < 2 * kRuns) return luminance(mean());
  const double per_run = static_cast<double>(count) / kRuns, all = luminance(mean());
  double squares = 0;
  for (const glm::dvec3& r : run) squares += std::pow(luminance(Vec3(r / per_run)) - all, 2);
  return static_cast<float>(std::sqrt(squares / (kRuns * (kRuns - 1))));
}

PathGroup::PathGroup(const trace::Tracer& tracer, const atlas::Texels& texels, const TexelLookup& lookup,
                     const Emitters& emitters, const SampleTable& directions, const Exposure& exposure,
                     std::uint32_t back_rays, const LightmapOptions& options)
    : texels_(texels),
      options_(options),
      walk_(walkOf(options)),
      exposure_(exposure),
      back_rays_(back_rays),
      rays_(tracer.scene(), texels, directions, options.seed, kInfinity, Alignment::kSame, &exposure),
      gatherer_(tracer, lookup, emitters, &exposure),
      tracer_(tracer, emitters, walk_) {}

void PathGroup::sample(std::uint32_t texel, std::uint32_t place, std::uint32_t until) {
  Sums& sums = sums_[place];
  for (; sums.count < until; ++sums.count) {
    PathSampler sampler(options_.seed, texel, sums.count % kRuns, sums.count / kRuns);
    const GroupRays::Spot spot = rays_.spot(place, sampler.pair());
    sums.run[sums.count % kRuns] +=
        glm::dvec3(tracer_.irradiance({spot.origin, spot.geometric_normal, spot.shading_normal}, sampler));
    ++paths_;
  }
}

bool PathGroup::converged(std::size_t texels) const {
  double errors = 0, mean = 0;
  for (std::size_t i = 0; i < texels; ++i)
    errors += std::pow(sums_[i].error(), 2), mean += luminance(sums_[i].mean());
  const double n = static_cast<double>(texels),
               allowed = static_cast<double>(options_.target_error) * mean / n;
  return errors / n <= allowed * allowed;
}

void PathGroup::solve(std::span<const std::uint32_t> group, std::span<const std::uint32_t> slots,
                      LightmapResult& result) {
  rays_.begin(group);
  sums_.fill(Sums());
  const bool adaptive = options_.target_error > 0.0f;
  for (std::uint32_t until = adaptive ? options_.min_samples : options_.max_samples;
       until <= options_.max_samples; until *= 2) {
    for (std::uint32_t i = 0; i < group.size(); ++i) sample(texels_.points[group[i]].texel, i, until);
    if (adaptive && converged(group.size())) break;
  }
  std::vector<std::uint32_t> all(group.size());
  std::iota(all.begin(), all.end(), 0u);
  BackCounts backs;
  rays_.select(all, back_rays_);
  gatherer_.tracePackets(rays_, 0, back_rays_,
                         [&](std::uint32_t, const trace::RayPacket& packet, const trace::HitPacket& hits) {
                           backs.add(rays_, packet, hits);
                         });
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (slots[i] == scene::kNone) continue;
    result.value[slots[i]] = Irradiance(sums_[i].mean());
    result.error[slots[i]] = sums_[i].error();
    const bool dark = sums_[i].mean() == Vec3(0.0f);
    result.back_share[slots[i]] = exposure_.hidden(group[i]) ? 1.0f : backs.share(i, dark);
  }
}

}  // namespace relume::transport
