// SPDX-License-Identifier: MIT
// Rate of the rays that gather indirect light, everything included (sequences, tracing, look-ups of the
// cache, error estimate), beside bare Embree on rays of the same texels in the same process. One thread. The
// cache is filled before the clock starts.
#include <benchmark/benchmark.h>

#include <numeric>
#include <string>

#include "bare_embree.h"
#include "relume/atlas/atlas.h"
#include "relume/core/parallel.h"
#include "relume/core/progress.h"
#include "relume/transport/lightmap.h"

namespace relume::transport {
namespace {

using bench::Bare;
using bench::cpuSeconds;

constexpr std::size_t kTexels = 4096;

struct Lit {
  explicit Lit(const std::string& where) {
    setting.scene = where == "room" ? made::room() : made::temple(100000);
    Light& light = setting.scene.lights.emplace_back();
    light.position = {0.2f, 0.1f, 2.2f}, light.intensity = 10;
    Warnings warnings;
    SilentProgress silent;
    atlas = atlas::buildAtlas(setting.scene, {.page_size = 512}, warnings, silent);
    setting.texels = atlas::rasterize(setting.scene, atlas, silent);
  }
  bench::Setting setting;
  atlas::Atlas atlas;
};

void gather(benchmark::State& state, const std::string& where) {
  const ThreadLimit one(1);
  Lit lit(where);
  const auto samples = static_cast<std::uint32_t>(state.range(0));
  const trace::Tracer tracer(lit.setting.scene);
  LightmapSolver solver(tracer, lit.atlas, lit.setting.texels,
                        {.part = Part::kIndirect, .min_samples = samples, .max_samples = samples});
  std::vector<std::uint32_t> which(std::min(kTexels, lit.setting.texels.points.size()));
  std::iota(which.begin(), which.end(), static_cast<std::uint32_t>(lit.setting.texels.points.size() / 2));
  SilentProgress silent;
  solver.solve(silent, which);
  double rays = 0, start = cpuSeconds();
  for (auto _ : state) rays += static_cast<double>(solver.solve(silent, which).rays);
  const double rate = rays / (cpuSeconds() - start);

  bench::Setting few;
  few.scene = lit.setting.scene, few.texels = lit.setting.texels;
  few.texels.points.clear();
  for (const std::uint32_t i : which) few.texels.points.push_back(lit.setting.texels.points[i]);
  const Bare bare(few, kInfinity, std::min(samples, 64u));
  bare.intersect();
  rays = 0, start = cpuSeconds();
  for (int i = 0; i < 5; ++i)
    benchmark::DoNotOptimize(bare.intersect()), rays += static_cast<double>(bare.rays());
  const double bare_rate = rays / (cpuSeconds() - start);
  state.counters["rays_per_second"] = rate;
  state.counters["bare_rays_per_second"] = bare_rate;
  state.counters["ratio"] = rate / bare_rate;
}

const bool kRegistered = [] {
  for (const std::string where : {"room", "temple"})
    benchmark::RegisterBenchmark(("transport.gather." + where).c_str(),
                                 [=](benchmark::State& s) { gather(s, where); })
        ->Arg(16)
        ->Arg(64)
        ->Arg(256);
  return true;
}();

}  // namespace
}  // namespace relume::transport
