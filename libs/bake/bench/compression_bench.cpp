// SPDX-License-Identifier: MIT
// Bytes against error of the codecs of transfer, on the scene that RELUME_COMPRESSION_SCENE names: its light
// paths are solved once, kept whole in memory, and encoded in every way. Nothing is registered without that
// variable. bench/compression.py runs it and writes docs/compression.md.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "relume/codec/encode_clustered_pca.h"
#include "relume/codec/encode_tiles.h"
#include "relume/core/kmeans.h"
#include "relume/core/parallel.h"
#include "relume/scene/gltf.h"
#include "relume/transport/light_paths.h"

namespace relume::bake {
namespace {

using codec::ColumnClusters;
using codec::EncodeReport;

constexpr int kPageSize = 512;
constexpr std::uint32_t kExits = 8192;  // about
constexpr std::uint32_t kTraining = 256, kHeldOut = 32;

// Texels along an exit, so that there are about kExits of them.
std::uint32_t sideFor(std::size_t texels) {
  std::uint32_t side = 1;
  while (texels > std::size_t{kExits} * side * side * 5 / 4) ++side;
  return side;
}

struct Case {
  explicit Case(const char* file) {
    Warnings warnings;
    scene = scene::gltf::import(scene::gltf::Document::read(file), warnings);
    atlas = atlas::buildAtlas(scene, {.page_size = kPageSize}, warnings, silent);
    texels = atlas::rasterize(scene, atlas, silent);
    tracer = std::make_unique<trace::Tracer>(scene);
    transport::LightPathOptions path_options;
    path_options.exit_side = sideFor(texels.points.size());
    paths = std::make_unique<transport::LightPaths>(*tracer, atlas, texels, path_options, silent);

    const auto entries = static_cast<std::uint32_t>(paths->entries().size());
    const transport::ExitTiles& tiles = paths->tiles();
    transfer = {.rows = static_cast<std::uint32_t>(paths->exits().size()),
                .columns = entries,
                .channels = 3,
                .tiles = {tiles.first, tiles.row, tiles.blend}};
    raw.resize(tiles.size());
    parallelFor(tiles.size(), 1, [&](std::size_t t, std::size_t) {
      raw[t].resize(transfer.tiles.rows(t) * 3 * entries);
      paths->rows(t, raw[t]);
    });
    transfer.source = [this](std::size_t t, std::span<float> out) {
      std::copy(raw[t].begin(), raw[t].end(), out.begin());
    };
    const transport::LightPlaces places{.nearest = paths->spacing(), .spots = 0.25f};
    lights.training = paths->entryIrradiance(paths->lights(kTraining, places, 1, silent), silent);
    lights.held_out = paths->entryIrradiance(paths->lights(kHeldOut, places, 2, silent), silent);
  }

  ColumnClusters clusters(std::size_t count) const {
    const transport::Entries& entries = paths->entries();
    std::vector<float> features;
    for (std::size_t e = 0; e < entries.size(); ++e)
      for (const Vec3 v : {entries.centre[e], 4 * paths->spacing() * entries.normal[e]})
        features.insert(features.end(), {v.x, v.y, v.z});
    return codec::clustersFromLabels(kMeans(features, 6, entries.area, {.clusters = count}).label, count);
  }

  SilentProgress silent;
  scene::Scene scene;
  atlas::Atlas atlas;
  atlas::Texels texels;
  std::unique_ptr<trace::Tracer> tracer;
  std::unique_ptr<transport::LightPaths> paths;
  codec::Transfer transfer;
  codec::Lights lights;
  std::vector<std::vector<float>> raw;  // of each tile
};

Case& theCase() {
  static Case instance(std::getenv("RELUME_COMPRESSION_SCENE"));
  return instance;
}

void tell(benchmark::State& state, const EncodeReport& r) {
  const Case& c = theCase();
  const double rows = c.transfer.rows;
  state.counters["exits"] = rows;
  state.counters["entries"] = c.transfer.columns;
  state.counters["bytes"] = static_cast<double>(r.bytes) / rows;
  state.counters["planes"] = static_cast<double>(r.plane_bytes) / rows;
  state.counters["weights"] = static_cast<double>(r.weight_bytes) / rows;
  state.counters["mean"] = r.error.mean;
  state.counters["median"] = r.error.median;
  state.counters["worst"] = r.error.worst;
  state.counters["row_p95"] = r.error.row_p95;
  state.counters["rounding"] = r.rounding_share;
  state.counters["overlap"] = r.overlap;
  state.counters["met"] = r.met;
}

void tiles(benchmark::State& state, std::size_t clusters, codec::TileOptions options) {
  const Case& c = theCase();
  const ColumnClusters parts = c.clusters(clusters);
  EncodeReport report;
  for (auto _ : state) report = codec::encodeTiles(c.transfer, parts, c.lights, options).report;
  tell(state, report);
}

void clusteredPca(benchmark::State& state, std::size_t clusters, double error) {
  const Case& c = theCase();
  const ColumnClusters parts = c.clusters(clusters);
  EncodeReport report;
  const std::size_t most = 2 * c.transfer.columns / clusters;
  for (auto _ : state)
    report = codec::encodeClusteredPca(c.transfer, parts, c.lights, {.rank = most, .error = error}).report;
  tell(state, report);
}

const bool registered = [] {
  if (!std::getenv("RELUME_COMPRESSION_SCENE")) return false;
  const auto once = [](benchmark::internal::Benchmark* b) {
    b->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();
  };
  for (const double error : {0.1, 0.05, 0.02, 0.01}) {
    const std::string percent = fmt::format("{:g}", 100 * error);
    for (const std::size_t n : {1u, 2u, 3u, 4u})
      once(benchmark::RegisterBenchmark(
          fmt::format("compression.tiles.{}.{}", n, percent).c_str(), tiles, n,
          codec::TileOptions{.error = error, .row_error = std::min(15 * error, 0.75), .row_bytes = 0.3}));
    once(benchmark::RegisterBenchmark(fmt::format("compression.tiles-overall.3.{}", percent).c_str(), tiles,
                                      3u, codec::TileOptions{.error = error, .row_error = 0}));
    for (const std::size_t n : {1u, 16u, 32u})
      once(benchmark::RegisterBenchmark(fmt::format("compression.cpca.{}.{}", n, percent).c_str(),
                                        clusteredPca, n, error));
  }
  return true;
}();

}  // namespace
}  // namespace relume::bake
