// SPDX-License-Identifier: MIT
// Interactive light editing: 100,000 texels under 100 lights. Counter: texel-lights a second.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "relume/relight/obscurance.h"

namespace relume::relight {
namespace {

constexpr int kWidth = 400, kHeight = 250;  // 100,000 texels, all covered

asset::Asset room() {
  asset::Asset a;
  a.atlas.width = kWidth;
  a.atlas.height = kHeight;
  a.atlas.pages = 1;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit;
  asset::Layer layer;
  layer.name = "obscurance";
  layer.planes = {{.name = "value", .values = {}}};
  for (std::uint32_t t = 0; t < kWidth * kHeight; ++t) {
    a.atlas.texel.push_back(t);
    a.atlas.position.push_back({20 * unit(random), 3 * unit(random), 20 * unit(random)});
    a.atlas.normal.push_back(
        glm::normalize(Vec3(unit(random) - 0.5f, unit(random) + 0.1f, unit(random) - 0.5f)));
    layer.planes[0].values.push_back(unit(random));
  }
  a.layers = {layer};
  return a;
}

LightSet lamps(std::size_t count, Light::Kind kind) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit;
  LightSet lights(count);
  for (Light& l : lights) {
    l.kind = kind;
    l.position = {20 * unit(random), 3.0f, 20 * unit(random)};
    l.direction = {0, -1, 0};
    l.range = 15;
    l.area = 0.5f;
    l.intensity = 40;
  }
  return lights;
}

void fullEvaluation(benchmark::State& state, Light::Kind kind) {
  const asset::Asset a = room();
  ObscuranceRelighter relighter(a, a.layers[0]);
  LightSet lights = lamps(static_cast<std::size_t>(state.range(0)), kind);
  for (auto _ : state) {
    lights[0].intensity += 1;  // as an editor does
    benchmark::DoNotOptimize(relighter.evaluate(lights, {}).data());
  }
  state.counters["texel-lights/s"] = benchmark::Counter(
      static_cast<double>(state.range(0)) * kWidth * kHeight, benchmark::Counter::kIsIterationInvariantRate);
}

void withVisibility(benchmark::State& state) {
  const asset::Asset a = room();
  ObscuranceRelighter relighter(a, a.layers[0]);
  const LightSet lights = lamps(static_cast<std::size_t>(state.range(0)), Light::Kind::kPoint);
  const VisibilitySource all = [](std::size_t, std::span<float> v) { std::fill(v.begin(), v.end(), 1.0f); };
  for (auto _ : state) benchmark::DoNotOptimize(relighter.evaluate(lights, {}, all).data());
  state.counters["texel-lights/s"] = benchmark::Counter(
      static_cast<double>(state.range(0)) * kWidth * kHeight, benchmark::Counter::kIsIterationInvariantRate);
}

#define RELUME_RELIGHT_BENCH(f) \
  f->Arg(1)->Arg(100)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime()
RELUME_RELIGHT_BENCH(BENCHMARK_CAPTURE(fullEvaluation, point, Light::Kind::kPoint));
RELUME_RELIGHT_BENCH(BENCHMARK_CAPTURE(fullEvaluation, spot, Light::Kind::kSpot));
RELUME_RELIGHT_BENCH(BENCHMARK_CAPTURE(fullEvaluation, directional, Light::Kind::kDirectional));
RELUME_RELIGHT_BENCH(BENCHMARK_CAPTURE(fullEvaluation, area, Light::Kind::kArea));
RELUME_RELIGHT_BENCH(BENCHMARK(withVisibility));

}  // namespace
}  // namespace relume::relight
