// SPDX-License-Identifier: MIT
// Rates of the occlusion solver, everything included (sequences, sorting, tracing, error estimate), beside
// bare Embree in the same process: one rtcOccluded1 or rtcIntersect1 after the other on the very rays of the
// same texels, unsorted, prepared beforehand, with Embree's default flags. One thread. Counter
// `rays_per_second` is the one to compare, `ratio` does it.
#include <benchmark/benchmark.h>
#include <algorithm>
#include <map>
#include <string>

#include "bare_embree.h"
#include "relume/core/parallel.h"
#include "relume/core/progress.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

using Shape = DistanceWeight::Shape;

constexpr std::uint32_t kSamples = 256;

using bench::Bare;
using bench::cpuSeconds;
using bench::Setting;

/// 64 x 64 texels of 5 cm on the floor, under the columns or between the boxes.
Setting settingOf(const std::string& name) {
  if (name == "room")
    return {made::room(), made::texelGrid(64, 64, {-1.95f, -1.95f, 0}, {0.06f, 0, 0}, {0, 0.06f, 0})};
  return {made::temple(100000), made::texelGrid(64, 64, {-1.7f, -1.7f, 0}, {0.05f, 0, 0}, {0, 0.05f, 0})};
}

/// Rate of the bare variant of a case, for the ratio of the other.
std::map<std::string, double>& bareRates() {
  static std::map<std::string, double> rates;
  return rates;
}

void bare(benchmark::State& state, const std::string& where, bool any_hit, float limit) {
  const Bare scene(settingOf(where), limit, kSamples);
  const double start = cpuSeconds();
  double rays = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(any_hit ? scene.occluded() : scene.intersect());
    rays += static_cast<double>(scene.rays());
  }
  bareRates()[where + (any_hit ? "a" : "f") + std::to_string(limit)] = rays / (cpuSeconds() - start);
  state.counters["rays_per_second"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}

void solver(benchmark::State& state, const std::string& where, bool any_hit, float limit,
            std::uint32_t samples) {
  const ThreadLimit one(1);
  const Setting setting = settingOf(where);
  const trace::Tracer tracer(setting.scene);
  OcclusionOptions options;
  options.weight = {any_hit ? Shape::kStep : Shape::kExponential, 1.0f, limit};
  options.min_samples = options.max_samples = samples;
  SilentProgress silent;
  const double start = cpuSeconds();
  double rays = 0;
  for (auto _ : state) {
    rays += static_cast<double>(solveOcclusion(tracer, setting.texels, options, silent).rays);
  }
  const double rate = rays / (cpuSeconds() - start);
  state.counters["rays_per_second"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
  const auto found = bareRates().find(where + (any_hit ? "a" : "f") + std::to_string(limit));
  if (found != bareRates().end()) state.counters["ratio"] = rate / found->second;
}

void limits(benchmark::State& state) {  // cost must fall with the distance limit
  const ThreadLimit one(1);
  const Setting setting = settingOf("temple");
  const trace::Tracer tracer(setting.scene);
  OcclusionOptions options;
  options.weight.limit = static_cast<float>(state.range(0)) / 100.0f;
  SilentProgress silent;
  double rays = 0;
  for (auto _ : state) {
    rays += static_cast<double>(solveOcclusion(tracer, setting.texels, options, silent).rays);
  }
  state.counters["rays_per_second"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}

const bool kRegistered = [] {
  for (const std::string where : {"room", "temple"}) {
    for (const bool any_hit : {true, false}) {
      for (const float limit : {kInfinity, 2.0f}) {
        const std::string name =
            where + (any_hit ? ".occluded." : ".intersect.") + (limit < kInfinity ? "2m" : "endless");
        benchmark::RegisterBenchmark(("transport.bare." + name).c_str(),
                                     [=](benchmark::State& s) { bare(s, where, any_hit, limit); });
        for (const std::uint32_t samples : {16u, 64u, 256u}) {
          benchmark::RegisterBenchmark(
              ("transport.solver." + name + "." + std::to_string(samples)).c_str(),
              [=](benchmark::State& s) { solver(s, where, any_hit, limit, samples); });
        }
      }
    }
  }
  benchmark::RegisterBenchmark("transport.limit_cm", limits)
      ->Arg(25)
      ->Arg(50)
      ->Arg(100)
      ->Arg(200)
      ->Arg(400)
      ->Arg(1000);
  return true;
}();

}  // namespace
}  // namespace relume::transport
