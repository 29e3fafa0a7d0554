// SPDX-License-Identifier: MIT
#include "radiosity/texel_light.h"

#include "group_solving.h"
#include "lightmap/light_rays.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kGatherSamples = 16, kLightSamples = 8;

class Worker {
 public:
  Worker(const RadiosityScene& scene, const Emitters& emitters, const SampleTable& directions,
         const LightTable& lights, std::uint64_t seed)
      : rays_(scene.tracer.scene(), scene.texels, directions, seed, kInfinity, Alignment::kTurned),
        gatherer_(scene.tracer, scene.lookup, emitters),
        light_rays_(scene.tracer, emitters, lights, false) {}

  std::uint64_t rays() const { return gatherer_.rays() + light_rays_.rays(); }

  void solve(std::span<const std::uint32_t> group, TexelLight& result) {
    rays_.begin(group);
    active_.resize(group.size());
    for (std::uint32_t i = 0; i < group.size(); ++i) active_[i] = i;
    light_rays_.trace(rays_, active_, 0, kLightSamples,
                      [&](std::uint32_t texel, std::uint32_t, Vec3 irradiance, float, Direction) {
                        result.irradiance[group[texel]] += irradiance * (1.0f / kLightSamples);
                      });
    rays_.select(active_, kGatherSamples);
    BackCounts backs;
    gatherer_.trace(rays_, 0, kGatherSamples, backs,
                    [&](std::uint32_t texel, std::uint32_t, const Arrival& arrival) {
                      result.irradiance[group[texel]] += arrival.emitted * (kPi / kGatherSamples);
                    });
    for (std::size_t i = 0; i < group.size(); ++i)
      result.back_share[group[i]] = static_cast<float>(backs.behind(i)) / kGatherSamples;
  }

 private:
  GroupRays rays_;
  Gatherer gatherer_;
  LightRays light_rays_;
  std::vector<std::uint32_t> active_;
};

}  // namespace

TexelLight texelLight(const RadiosityScene& scene, const Emitters& emitters, std::uint64_t seed,
                      Progress& progress) {
  const Stage stage(progress, "direct light", scene.texels.points.size());
  const SampleTable directions(kGatherSamples, kGatherSamples, seed, BlockSamples::kShared);
  const LightTable lights(kLightSamples, kLightSamples, seed, BlockSamples::kShared);
  TexelLight result;
  result.irradiance.assign(scene.texels.points.size(), Vec3(0.0f));
  result.back_share.assign(scene.texels.points.size(), 0.0f);
  SolverPool<Worker> pool;
  result.rays = solveGroups(
      scene.groups, scene.texels, {}, progress, pool,
      [&] { return std::make_unique<Worker>(scene, emitters, directions, lights, seed); },
      [&](Worker& worker, auto group, auto) { worker.solve(group, result); });
  return result;
}

}  // namespace relume::transport
