// SPDX-License-Identifier: MIT
// Paths that light tracing shoots a second, by core: from a lamp until they end, deposits included, with
// diffuse and with full materials, on one thread and on all. The paths of a second before the clock starts
// warm the caches. Seconds are those of the wall.
#include <benchmark/benchmark.h>

#include <chrono>
#include <string>

#include "bare_embree.h"
#include "relume/core/parallel.h"
#include "relume/transport/photons.h"

namespace relume::transport {
namespace {

void shoot(benchmark::State& state, const std::string& where, Materials materials, int threads) {
  const ThreadLimit limit(threads);
  scene::Scene scene = where == "room" ? made::room() : made::temple(100000);
  Light& light = scene.lights.emplace_back();
  light.position = {0.2f, 0.1f, 2.2f}, light.intensity = 10;
  Warnings warnings;
  SilentProgress silent;
  const atlas::Atlas atlas = atlas::buildAtlas(scene, {.page_size = 512}, warnings, silent);
  const atlas::Texels texels = atlas::rasterize(scene, atlas, silent);
  const trace::Tracer tracer(scene);
  PhotonOptions options{
      .paths = 1 << 21, .materials = materials, .kernel = {.shape = PhotonKernel::Shape::kBox}};
  tracePhotons(tracer, atlas, texels, options, silent);
  double paths = 0, rays = 0;
  const auto start = std::chrono::steady_clock::now();
  for (auto _ : state) {
    rays += static_cast<double>(tracePhotons(tracer, atlas, texels, options, silent).rays);
    paths += static_cast<double>(options.paths);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  state.counters["paths_per_second_per_core"] = paths / seconds.count() / threadCount();
  state.counters["rays_per_path"] = rays / paths;
  state.counters["threads"] = threadCount();
}

const bool kRegistered = [] {
  for (const std::string where : {"room", "temple"})
    for (const Materials materials : {Materials::kLambert, Materials::kFull})
      for (const int threads : {1, 0})
        benchmark::RegisterBenchmark(
            ("transport.photons." + where + (materials == Materials::kFull ? ".full" : ".lambert") +
             (threads == 1 ? ".one_thread" : ".all_threads"))
                .c_str(),
            [=](benchmark::State& s) { shoot(s, where, materials, threads); })
            ->Iterations(2)
            ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace relume::transport
