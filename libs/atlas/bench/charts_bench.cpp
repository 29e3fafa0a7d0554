// SPDX-License-Identifier: MIT
// charts.<case>.<triangles>: whole atlases of 1024 x 1024; items are triangles.
#include <benchmark/benchmark.h>

#include <cmath>

#include "relume/atlas/atlas.h"
#include "relume/core/progress.h"

namespace relume::atlas {
namespace {

/// n x n quads of y = f(x, z).
template <class F>
scene::Mesh heightField(int n, F&& f) {
  scene::Mesh mesh;
  mesh.name = "field";
  for (int z = 0; z <= n; ++z) {
    for (int x = 0; x <= n; ++x) {
      const float u = 4.0f * static_cast<float>(x) / static_cast<float>(n);
      const float v = 4.0f * static_cast<float>(z) / static_cast<float>(n);
      mesh.positions.push_back({u, f(u, v), -v});
      mesh.normals.push_back({0, 1, 0});
    }
  }
  const auto at = [n](int x, int z) { return static_cast<std::uint32_t>(z * (n + 1) + x); };
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) {
      mesh.triangles.push_back({at(x, z), at(x + 1, z), at(x + 1, z + 1)});
      mesh.triangles.push_back({at(x, z), at(x + 1, z + 1), at(x, z + 1)});
    }
  }
  return mesh;
}

void buildOnce(benchmark::State& state, scene::Mesh mesh) {
  scene::Scene scene;
  scene.materials.resize(1);
  scene.instances.push_back({});
  const std::size_t triangles = mesh.triangles.size();
  scene.meshes.push_back(std::move(mesh));
  Atlas atlas;
  for (auto _ : state) {
    Warnings warnings;
    SilentProgress progress;
    atlas = buildAtlas(scene, {}, warnings, progress);
    benchmark::DoNotOptimize(atlas.charts.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * triangles));
  state.counters["charts"] = static_cast<double>(atlas.charts.size());
  state.counters["coverage"] = atlas.statistics.coverage;
  state.counters["stretch"] = atlas.statistics.mean_stretch;
}

void smooth(benchmark::State& state) {
  const auto hills = [](float u, float v) { return 0.4f * std::sin(3 * u) * std::cos(2.5f * v); };
  buildOnce(state, heightField(static_cast<int>(state.range(0)), hills));
}
BENCHMARK(smooth)->Name("charts.smooth")->Arg(32)->Arg(224)->Unit(benchmark::kMillisecond);

/// Steps of a quarter metre: many small flat charts that meet at steep edges.
void terraces(benchmark::State& state) {
  const auto steps = [](float u, float v) {
    return 0.25f * std::floor(4 * std::sin(3 * u) * std::cos(2.5f * v));
  };
  buildOnce(state, heightField(static_cast<int>(state.range(0)), steps));
}
BENCHMARK(terraces)->Name("charts.terraces")->Arg(32)->Arg(224)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relume::atlas
