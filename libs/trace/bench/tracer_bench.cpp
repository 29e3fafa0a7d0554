// SPDX-License-Identifier: MIT
// Rates of the tracer's queries on prepared rays: from texels of a temple's floor, single, in packets of one
// texel's directions (unsorted, sorted) and in packets of one direction cell of 16 neighbouring texels; and
// how fast it builds, with its size.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <vector>

#include "../tests/made_scenes.h"
#include "relume/core/frame.h"
#include "relume/core/sampling.h"
#include "relume/trace/tracer.h"

namespace relume::trace {
namespace {

enum Order : int { kUnsorted, kSorted, kNeighbours };
constexpr std::uint32_t kDirections = 256, kTexels = 1024;

std::uint32_t mortonCell(Vec2 u) {  // of 16 x 16
  const auto x = static_cast<std::uint32_t>(16 * u.x), y = static_cast<std::uint32_t>(16 * u.y);
  std::uint32_t code = 0;
  for (std::uint32_t b = 0; b < 4; ++b) code |= ((x >> b & 1u) << (2 * b + 1)) | ((y >> b & 1u) << (2 * b));
  return code;
}

std::vector<RayPacket> packets(Order order, float limit) {
  struct Keyed {
    std::uint64_t key;
    Point origin;
    Direction direction;
  };
  std::vector<Keyed> rays;
  for (std::uint32_t t = 0; t < kTexels; ++t) {
    const std::uint32_t block = t / 16, in = t % 16;
    const Point origin(-1.7f + 0.4f * static_cast<float>(block % 8) + 0.05f * static_cast<float>(in % 4),
                       -1.7f + 0.4f * static_cast<float>(block / 8) + 0.05f * static_cast<float>(in / 4),
                       1e-3f);
    for (std::uint32_t i = 0; i < kDirections; ++i) {
      const Vec2 u = sobol2(i, t);
      const std::uint64_t cell = mortonCell(u);
      const std::uint64_t key = order == kUnsorted ? (std::uint64_t{t} << 32) + i
                                : order == kSorted ? (std::uint64_t{t} << 32) + cell
                                                   : (std::uint64_t{block} << 32) + (cell << 8) + in;
      rays.push_back({key, origin, squareToCosineHemisphere(u)});
    }
  }
  std::sort(rays.begin(), rays.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
  std::vector<RayPacket> result(rays.size() / RayPacket::kSize);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RayPacket& p = result[i / RayPacket::kSize];
    const std::size_t lane = i % RayPacket::kSize;
    p.origin_x[lane] = rays[i].origin.x, p.origin_y[lane] = rays[i].origin.y,
    p.origin_z[lane] = rays[i].origin.z;
    p.direction_x[lane] = rays[i].direction.x, p.direction_y[lane] = rays[i].direction.y;
    p.direction_z[lane] = rays[i].direction.z;
    p.t_max[lane] = limit, p.alpha_seed[lane] = 0;
  }
  return result;
}

Ray rayOf(const RayPacket& p, std::size_t lane) {
  return {{p.origin_x[lane], p.origin_y[lane], p.origin_z[lane]},
          {p.direction_x[lane], p.direction_y[lane], p.direction_z[lane]},
          p.t_max[lane]};
}

void queries(benchmark::State& state, Order order, bool any_hit, bool single) {
  const scene::Scene scene = made::temple(100000);
  const Tracer tracer(scene);
  const std::vector<RayPacket> all = packets(order, kInfinity);
  HitPacket hits;
  for (auto _ : state) {
    std::uint32_t sum = 0;
    for (const RayPacket& packet : all) {
      if (single) {
        for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
          sum += any_hit ? tracer.occluded(rayOf(packet, i))
                         : static_cast<bool>(tracer.intersect(rayOf(packet, i)));
        }
      } else if (any_hit) {
        sum += tracer.occludedPacket(packet);
      } else {
        tracer.intersectPacket(packet, hits);
        sum += hits.hit;
      }
    }
    benchmark::DoNotOptimize(sum);
  }
  state.counters["rays_per_second"] = benchmark::Counter(
      static_cast<double>(state.iterations() * all.size() * RayPacket::kSize), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(queries, trace.occluded.single, kUnsorted, true, true);
BENCHMARK_CAPTURE(queries, trace.occluded.packet.unsorted, kUnsorted, true, false);
BENCHMARK_CAPTURE(queries, trace.occluded.packet.sorted, kSorted, true, false);
BENCHMARK_CAPTURE(queries, trace.occluded.packet.neighbours, kNeighbours, true, false);
BENCHMARK_CAPTURE(queries, trace.intersect.single, kUnsorted, false, true);
BENCHMARK_CAPTURE(queries, trace.intersect.packet.unsorted, kUnsorted, false, false);
BENCHMARK_CAPTURE(queries, trace.intersect.packet.sorted, kSorted, false, false);
BENCHMARK_CAPTURE(queries, trace.intersect.packet.neighbours, kNeighbours, false, false);

void build(benchmark::State& state) {
  const scene::Scene scene = made::temple(static_cast<std::size_t>(state.range(0)));
  const auto triangles = static_cast<double>(scene.triangleCount());
  double bytes = 0;
  for (auto _ : state) bytes = static_cast<double>(Tracer(scene).bytes());
  state.counters["bytes_per_triangle"] = bytes / triangles;
  state.counters["triangles_per_second"] =
      benchmark::Counter(triangles * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(build)->Name("trace.build")->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relume::trace
