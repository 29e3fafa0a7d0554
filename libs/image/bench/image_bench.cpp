// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cmath>

#include "relume/image/io.h"
#include "relume/image/metrics.h"

namespace relume::image {
namespace {

// Waves with fine noise: no metric may skip it, and files do not shrink to nothing.
Image picture(int side, std::uint32_t seed) {
  Image out(side, side, 3);
  std::uint32_t state = seed;
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    state = state * 1664525u + 1013904223u;
    const float wave = 0.5f + 0.4f * std::sin(0.0001f * static_cast<float>(i));
    out.data[i] = wave + 0.1f * (static_cast<float>(state >> 8) * 0x1p-24f - 0.5f);
  }
  return out;
}

template <class F>
void perPixel(benchmark::State& state, F&& work) {
  const int side = static_cast<int>(state.range(0));
  const Image a = picture(side, 1), b = picture(side, 2);
  for (auto _ : state) benchmark::DoNotOptimize(work(a, b));
  state.SetItemsProcessed(state.iterations() * side * side);
}

void rmseBench(benchmark::State& state) {
  perPixel(state, [](const Image& a, const Image& b) { return rmse(a, b).rmse; });
}
void flipBench(benchmark::State& state) {
  perPixel(state, [](const Image& a, const Image& b) { return flip(a, b).mean; });
}
void yeeBench(benchmark::State& state) {
  perPixel(state, [](const Image& a, const Image& b) { return yee(a, b).visible_pixels; });
}
void encodePngBench(benchmark::State& state) {
  perPixel(state, [](const Image& a, const Image&) { return encodePngSrgb(a).size(); });
}
void decodePngBench(benchmark::State& state) {
  const std::vector<std::byte> file = encodePngSrgb(picture(static_cast<int>(state.range(0)), 1));
  perPixel(state, [&](const Image&, const Image&) { return decodeTexture(file, "picture").width; });
}

BENCHMARK(rmseBench)->Name("image.rmse")->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(flipBench)->Name("image.flip")->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(yeeBench)->Name("image.yee")->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(encodePngBench)->Name("image.png.encode")->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(decodePngBench)->Name("image.png.decode")->Arg(1024)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relume::image
