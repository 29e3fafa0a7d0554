// SPDX-License-Identifier: MIT
#include "baked_layer.h"
#include "forecast.h"
#include "prepared.h"
#include "relume/core/memory.h"
#include "scene_digest.h"
#include "texel_store.h"

namespace relume::bake {
namespace {

Preflight::Layer planTexels(const PreparedLayer& layer, const LayerContext& context, const Prepared& p,
                            const BakeOptions& options, Progress& progress) {
  Preflight::Layer plan{.name = layer.name, .parameters = layer.parameters};
  const LayerJob job = layer.kind->prepare(context, layer.parameters);
  const TexelStore store(options.cache, p.structure, job.solver, p.texels, placements(p.scene));
  plan.reusable_texels = store.reused(), plan.stale_because = store.staleBecause();
  const std::vector<std::uint32_t> pending = store.pending();
  const Stage stage(progress, "pilot of " + layer.name, pending.size());
  plan.forecast_seconds = forecastSeconds(job.solver, p.texels, pending, progress);
  return plan;
}

Preflight::Layer planWhole(const PreparedLayer& layer, const LayerContext& context, const Prepared& p,
                           const BakeOptions& options, Progress& progress) {
  Preflight::Layer plan{.name = layer.name, .parameters = layer.parameters};
  const WholeJob job = layer.kind->prepare_whole(context, layer.parameters);
  if (isKept(options, p, job.key)) {
    plan.reusable_texels = p.texels.points.size();
    return plan;
  }
  plan.stale_because = "nothing baked with this geometry and these settings is in the cache";
  const Stage stage(progress, "pilot of " + layer.name, 1);
  plan.forecast_seconds = job.forecast(progress);
  return plan;
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
  const asset::AtlasTable table = tableOf(p);
  for (const PreparedLayer& layer : p.layers) {
    const LayerContext context{.tracer = *p.tracer,
                               .atlas = p.atlas,
                               .texels = p.texels,
                               .table = table,
                               .quality = p.quality,
                               .seed = options.seed,
                               .day = options.day};
    Preflight::Layer plan = layer.kind->prepare ? planTexels(layer, context, p, options, progress)
                                                : planWhole(layer, context, p, options, progress);
    result.forecast_seconds += plan.forecast_seconds;
    result.layers.push_back(std::move(plan));
  }
  result.forecast_bytes = peakResidentBytes() + forecastBytes(p);
  return result;
}

}  // namespace relume::bake
