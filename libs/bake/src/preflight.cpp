// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>

#include "prepared.h"
#include "relume/core/memory.h"
#include "scene_digest.h"
#include "texel_store.h"

namespace relume::bake {
namespace {

constexpr std::size_t kPilotTexels = 512;

// Seconds to compute `pending`, from a few of them spread evenly.
double forecastSeconds(const TexelSolver& solver, const std::vector<std::uint32_t>& pending) {
  if (pending.empty()) return 0;
  const std::size_t count = std::min(kPilotTexels, pending.size());
  std::vector<std::uint32_t> pilot(count);
  for (std::size_t i = 0; i < count; ++i) pilot[i] = pending[i * pending.size() / count];
  std::vector<float> rows(count * static_cast<std::size_t>(solver.row));
  SilentProgress silent;
  const auto start = std::chrono::steady_clock::now();
  solver.solve(pilot, rows, silent);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return seconds * static_cast<double>(pending.size()) / static_cast<double>(count);
}

}  // namespace

Preflight preflight(const scene::gltf::Document& document, const BakeOptions& options, Progress& progress) {
  Preflight result;
  Statistics statistics;
  Stopwatch stopwatch(statistics);
  BakeOptions unlimited = options;  // a preflight tells the memory it would need; it does not refuse
  unlimited.max_memory = 0;
  const auto prepared = prepare(document, unlimited, statistics, stopwatch, result.warnings, progress);
  const Prepared& p = *prepared;
  for (const scene::Instance& instance : p.scene.instances)
    ++(instance.dynamic ? result.dynamic_instances : result.static_instances);
  result.triangles = statistics.triangles, result.texels = statistics.texels,
  result.lights = p.scene.lights.size();
  result.scene_diagonal = p.scene.bounds().diagonal();
  result.atlas_width = p.atlas.width, result.atlas_height = p.atlas.height,
  result.atlas_pages = p.atlas.pages;
  result.atlas = p.atlas.statistics;
  for (const StageTime& stage : statistics.stages) result.forecast_seconds += stage.seconds;
  for (const PreparedLayer& layer : p.layers) {
    const LayerContext context{.tracer = *p.tracer,
                               .atlas = p.atlas,
                               .texels = p.texels,
                               .quality = p.quality,
                               .seed = options.seed};
    const LayerJob job = layer.kind->prepare(context, layer.parameters);
    const TexelStore store(options.cache, p.structure, job.solver, p.texels, placements(p.scene));
    Preflight::Layer plan{
        .name = layer.name, .parameters = layer.parameters, .reusable_texels = store.reused()};
    plan.stale_because = store.staleBecause();
    plan.forecast_seconds = forecastSeconds(job.solver, store.pending());
    result.forecast_seconds += plan.forecast_seconds;
    result.layers.push_back(std::move(plan));
  }
  result.forecast_bytes = peakResidentBytes() + forecastBytes(p);
  return result;
}

}  // namespace relume::bake
