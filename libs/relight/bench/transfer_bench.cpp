// SPDX-License-Identifier: MIT
// Relighting with light path maps beside the rate at which this machine reads memory, measured in turn in the
// same run. Sizes as the bake makes them: tiles of 128 exits that share a third with neighbours, 1,024
// entries in 3 clusters, 12 components to a block.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <vector>

#include "../tests/made_bake.h"
#include "block_product.h"
#include "line_buffer.h"
#include "relume/core/parallel.h"
#include "relume/relight/transfer_relighter.h"

namespace relume::relight {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

MadeMatrix usual(std::uint32_t exits, std::uint32_t bits) {
  return {.rows = exits,
          .columns = 1024,
          .bits = bits,
          .tiles = exits / 128,
          .clusters = 3,
          .rank = 12,
          .overlap = 38,
          .exact_rank = true};
}

std::vector<Irradiance> lit(std::size_t count) {
  std::vector<Irradiance> x(count);
  for (std::size_t i = 0; i < count; ++i)
    x[i] = Irradiance(Vec3(1, 0.5f, 0.25f) * static_cast<float>(i % 97));
  return x;
}

// All threads add up an array larger than any cache, in ordinary pages or in large ones.
class Reader {
 public:
  Reader(std::size_t bytes, bool large_pages) : count_(bytes / sizeof(std::uint64_t)) {
    if (large_pages) {
      lines_ = LineBuffer(bytes / sizeof(Line));
      numbers_ = reinterpret_cast<const std::uint64_t*>(lines_.data());
    } else {
      ordinary_.assign(count_, 1);
      numbers_ = ordinary_.data();
    }
  }
  double bytes() const { return static_cast<double>(count_ * sizeof(std::uint64_t)); }
  std::uint64_t read() const {
    std::atomic<std::uint64_t> total = 0;
    parallelFor(count_, 1 << 17, [&](std::size_t begin, std::size_t end) {
      std::uint64_t sums[32] = {};
      for (; begin < end; begin += 32)
        for (std::size_t i = 0; i < 32; ++i) sums[i] += numbers_[begin + i];
      for (const std::uint64_t s : sums) total += s;
    });
    return total;
  }

 private:
  std::size_t count_;
  std::vector<std::uint64_t> ordinary_;
  LineBuffer lines_;
  const std::uint64_t* numbers_;
};

// The product alone, planes far larger than the caches. The readers pass before each product.
void product(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(2)));
  const auto exits = static_cast<std::uint32_t>(state.range(0));
  const codec::BlockMatrix m = madeMatrix(usual(exits, static_cast<std::uint32_t>(state.range(1))));
  BlockProduct p(m);
  const Reader ordinary(std::size_t{256} << 20, false), large(std::size_t{256} << 20, true);
  const auto x = lit(m.columns);
  std::vector<Irradiance> y(m.rows);
  std::vector<double> read, read_large, multiplied;
  for (auto _ : state) {
    auto start = Clock::now();
    benchmark::DoNotOptimize(ordinary.read());
    read.push_back(secondsSince(start));
    start = Clock::now();
    benchmark::DoNotOptimize(large.read());
    read_large.push_back(secondsSince(start));
    start = Clock::now();
    p.multiply(x, y);
    multiplied.push_back(secondsSince(start));
    benchmark::DoNotOptimize(y.data());
    state.SetIterationTime(multiplied.back());
  }
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  const double memory = ordinary.bytes() / median(read), memory_large = large.bytes() / median(read_large);
  const double rate = static_cast<double>(p.sampleBytes()) / median(multiplied);
  state.counters["megabytes"] = static_cast<double>(p.sampleBytes()) * 1e-6;
  state.counters["bytes_per_exit"] = static_cast<double>(p.sampleBytes()) / exits;
  state.counters["memory_bytes_per_second"] = memory;
  state.counters["bytes_per_second"] = rate;
  state.counters["ratio"] = rate / memory;
  state.counters["large_page_bytes_per_second"] = memory_large;
  state.counters["large_page_ratio"] = rate / memory_large;
}
BENCHMARK(product)
    ->Name("relight.transfer.product")
    ->ArgNames({"exits", "bits", "threads"})
    ->Args({1 << 19, 8, 1})
    ->Args({1 << 19, 8, 0})
    ->Args({1 << 19, 16, 1})
    ->Args({1 << 19, 16, 0})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

// 8,192 exits on one core, from cache: the entries differ in every iteration.
void exitsFromCache(benchmark::State& state) {
  const ThreadLimit one(1);
  BlockProduct p(madeMatrix(usual(8192, static_cast<std::uint32_t>(state.range(0)))));
  auto x = lit(1024);
  std::vector<Irradiance> y(8192);
  for (auto _ : state) {
    x[0].rgb.r += 1;
    p.multiply(x, y);
    benchmark::DoNotOptimize(y.data());
  }
  state.counters["bytes_per_exit"] = static_cast<double>(p.sampleBytes()) / 8192;
}
BENCHMARK(exitsFromCache)
    ->Name("relight.transfer.8192_exits.one_core")
    ->ArgName("bits")
    ->Arg(8)
    ->Arg(16)
    ->Unit(benchmark::kMillisecond);

// A frame of an engine with 8,192 exits (4 x 4 texels each), 1,024 entries of 16 points, one core: one of the
// lights moves. Visibility comes for nothing.
void frame(benchmark::State& state) {
  const ThreadLimit one(1);
  const asset::Asset bake = madeBake(usual(8192, 8), 4, 16);
  TransferRelighter relighter(bake, bake.layers[0]);
  LightSet lights(static_cast<std::size_t>(state.range(0)));
  for (std::size_t i = 0; i < lights.size(); ++i)
    lights[i].position = {0.1f * static_cast<float>(i % 40), 1.5f, 2};
  const VisibilitySource all = [](std::size_t, std::span<float> v) { std::fill(v.begin(), v.end(), 1.0f); };
  for (auto _ : state) {
    lights[0].position.z += 1e-3f;
    benchmark::DoNotOptimize(relighter.evaluate(lights, all).data());
  }
}
BENCHMARK(frame)
    ->Name("relight.transfer.frame.one_core")
    ->ArgName("lights")
    ->Arg(1)
    ->Arg(10)
    ->Arg(100)
    ->Unit(benchmark::kMillisecond);

// What one call costs: the lights that moved, and the interpolation of 131,072 texels.
void entries(benchmark::State& state) {
  const ThreadLimit one(1);
  const asset::Asset bake = madeBake(usual(8192, 8), 1, 16);
  TransferRelighter relighter(bake, bake.layers[0]);
  LightSet lights(1);
  lights[0].position = {1, 1.5f, 2};
  for (auto _ : state) {
    lights[0].position.z += 1e-3f;
    benchmark::DoNotOptimize(relighter.entryIrradiance(lights).data());
  }
}
BENCHMARK(entries)->Name("relight.transfer.entries.one_light.one_core")->Unit(benchmark::kMillisecond);

void texels(benchmark::State& state) {
  const ThreadLimit one(1);
  const asset::Asset bake = madeBake(usual(8192, 8), 4, 1);
  TransferRelighter relighter(bake, bake.layers[0]);
  auto x = lit(1024);
  for (auto _ : state) {
    state.PauseTiming();
    x[0].rgb.r += 1;
    relighter.relight(x);
    state.ResumeTiming();
    benchmark::DoNotOptimize(relighter.texels().data());
  }
}
BENCHMARK(texels)->Name("relight.transfer.texels.131072.one_core")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relume::relight
