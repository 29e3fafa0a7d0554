// SPDX-License-Identifier: MIT
// Writing and reading a bake of one page of 1024^2, 80 % covered by flat charts of 32 x 32 texels, with noise
// as solvers leave it. Counters: bytes of the file for each covered texel, seconds by the texel.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "relume/asset/asset.h"

namespace relume::asset {
namespace {

constexpr int kSide = 1024, kChart = 32;

Asset page(bool table, int channels) {
  Asset a;
  a.atlas.width = a.atlas.height = kSide;
  a.atlas.pages = 1;
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  Plane value{.name = "value", .channels = channels, .values = {}};
  struct Chart {
    Point origin;
    Vec3 u, v;
    Normal n;
    Vec3 albedo;
  };
  std::vector<Chart> charts(kSide / kChart * kSide / kChart);
  for (Chart& c : charts) {
    c.n = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    c.u = 0.02f * glm::normalize(glm::cross(c.n, Vec3(0.3f, 0.5f, 0.1f)));
    c.v = glm::cross(c.n, c.u);
    c.origin = 10.0f * Vec3(normal(random), normal(random), normal(random));
    c.albedo = 0.5f + 0.2f * glm::sin(Vec3(normal(random), normal(random), normal(random)));
  }
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const std::size_t chart = static_cast<std::size_t>(y / kChart * (kSide / kChart) + x / kChart);
      const float w = 0.6f + 0.3f * std::sin(0.05f * static_cast<float>(x) + static_cast<float>(chart)) *
                                 std::cos(0.03f * static_cast<float>(y));
      for (int c = 0; c < channels; ++c) value.values.push_back(w + 0.01f * normal(random));
      if (!table || x % kChart >= 29 || y % kChart >= 29) continue;
      const Chart& c = charts[chart];
      a.atlas.texel.push_back(static_cast<std::uint32_t>(y * kSide + x));
      a.atlas.position.push_back(c.origin + static_cast<float>(x % kChart) * c.u +
                                 static_cast<float>(y % kChart) * c.v);
      a.atlas.normal.push_back(c.n);
      a.atlas.albedo.push_back(c.albedo + 0.02f * normal(random));
      a.atlas.valid.push_back(1);
      a.atlas.chart.push_back(static_cast<std::uint32_t>(chart));
    }
  if (channels > 0) {
    a.layers.resize(1);
    a.layers[0].planes = {value};
  }
  return a;
}

void count(benchmark::State& state, std::size_t bytes, std::size_t texels) {
  state.counters["bytes/texel"] = static_cast<double>(bytes) / static_cast<double>(texels);
  state.counters["texels/s"] =
      benchmark::Counter(static_cast<double>(texels), benchmark::Counter::kIsIterationInvariantRate);
}

void encodePage(benchmark::State& state, bool table, int channels) {
  const Asset a = page(table, channels);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = encodeGlb(a).size();
  count(state, bytes, table ? a.atlas.texel.size() : a.atlas.pageTexels());
}

void decodePage(benchmark::State& state, bool table, int channels) {
  const Asset a = page(table, channels);
  const auto file = encodeGlb(a);
  for (auto _ : state) benchmark::DoNotOptimize(decode(file, "bench").layers.size());
  count(state, file.size(), table ? a.atlas.texel.size() : a.atlas.pageTexels());
}

BENCHMARK_CAPTURE(encodePage, table, true, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encodePage, scalarLayer, false, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encodePage, rgbLayer, false, 3)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decodePage, table, true, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decodePage, scalarLayer, false, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decodePage, rgbLayer, false, 3)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relume::asset
