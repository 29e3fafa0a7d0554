// SPDX-License-Identifier: MIT
// Speed of the codecs on data like that of a bake: 1024^2 float16 values, smooth with 1 % of noise; a
// transfer of 64 emitters.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "relume/codec/compress.h"
#include "relume/codec/pca.h"
#include "relume/codec/quantize.h"

namespace relume::codec {
namespace {

constexpr std::size_t kTexels = 1024 * 1024;

std::vector<float> values(std::size_t count) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<float> v(count);
  for (std::size_t i = 0; i < count; ++i)
    v[i] = 0.6f + 0.3f * std::sin(0.05f * static_cast<float>(i)) + 0.01f * normal(random);
  return v;
}

std::vector<std::byte> halves() {
  std::vector<std::byte> bytes;
  for (const float v : values(kTexels)) {
    const std::uint16_t h = halfFromFloat(v);
    bytes.push_back(static_cast<std::byte>(h & 0xff));
    bytes.push_back(static_cast<std::byte>(h >> 8));
  }
  return bytes;
}

void halfFromFloats(benchmark::State& state) {
  const auto in = values(kTexels);
  std::vector<std::uint16_t> out(kTexels);
  for (auto _ : state) {
    for (std::size_t i = 0; i < kTexels; ++i) out[i] = halfFromFloat(in[i]);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kTexels));
}

void compressHalves(benchmark::State& state) {
  const auto data = halves();
  const auto filter = static_cast<Filter>(state.range(0));
  std::size_t size = 0;
  for (auto _ : state) size = compress(data, filter, {2, 1}).size();
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(data.size()));
  state.counters["ratio"] = static_cast<double>(data.size()) / static_cast<double>(size);
}

void decompressHalves(benchmark::State& state) {
  const auto data = halves();
  const auto filter = static_cast<Filter>(state.range(0));
  const auto stored = compress(data, filter, {2, 1});
  for (auto _ : state) benchmark::DoNotOptimize(decompress(stored, data.size(), filter, {2, 1}).data());
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(data.size()));
}

void pcaOfTransfer(benchmark::State& state) {
  constexpr std::size_t kEmitters = 64, kReceivers = 16384;
  const auto data = values(kEmitters * kReceivers);
  for (auto _ : state) benchmark::DoNotOptimize(pca(data, kEmitters, kReceivers).rank);
}

BENCHMARK(halfFromFloats);
BENCHMARK(compressHalves)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(decompressHalves)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(pcaOfTransfer)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relume::codec
