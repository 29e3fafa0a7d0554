// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "baked_layer.h"
#include "pages.h"
#include "texel_store.h"

namespace relume::bake {
namespace {

// RMS of the standard errors over valid texels, relative to the RMS of the first plane.
double relativeError(const PointLayer& layer) {
  const PointPlane& value = layer.planes.front();
  const auto channels = static_cast<std::size_t>(value.channels);
  double error2 = 0, value2 = 0;
  for (std::size_t i = 0; i < layer.error.size(); ++i) {
    if (!layer.valid[i]) continue;
    error2 += static_cast<double>(layer.error[i]) * layer.error[i];
    double mean = 0;
    for (std::size_t c = 0; c < channels; ++c)
      mean += value.values[i * channels + c] / static_cast<double>(channels);
    value2 += mean * mean;
  }
  return value2 > 0 ? std::sqrt(error2 / value2) : 0;
}

}  // namespace

asset::Layer describe(const PreparedLayer& prepared) {
  asset::Layer layer;
  layer.name = prepared.name;
  layer.kind = prepared.kind->name;
  layer.emitters = prepared.kind->emitters, layer.transport = prepared.kind->transport;
  layer.receivers = prepared.kind->receivers, layer.codec = prepared.kind->codec;
  layer.parameters = prepared.parameters;
  return layer;
}

BakedLayer bakeTexels(const LayerTask& task, std::span<const atlas::SeamSample> seams, Progress& progress) {
  const Prepared& p = task.prepared;
  const PreparedLayer& prepared = task.layer;
  const LayerJob job = prepared.kind->prepare(task.context, prepared.parameters);
  TexelStore store(task.options.cache, p.structure, job.solver, p.texels, placements(p.scene));
  BakedLayer baked{.layer = describe(prepared), .numbers = {.name = prepared.name}, .key = job.solver.key};
  LayerStatistics& numbers = baked.numbers;
  numbers.reused_texels = store.reused();
  numbers.computed_texels = p.texels.points.size() - store.reused();
  {
    Stage stage(progress, prepared.name, numbers.computed_texels);
    numbers.samples = store.complete(job.solver, progress);
  }
  numbers.seconds = task.stopwatch.lap(prepared.name);
  obeyMemoryLimit(task.options.max_memory);

  PointLayer points = job.finish(store.rows());
  // Per texel at most; what was really spent depends on the cache.
  baked.layer.samples = p.quality.max_samples;
  baked.layer.error_estimate = numbers.error_estimate = relativeError(points);
  LayerReport* report = task.report ? &task.report->add(prepared, points) : nullptr;
  for (PointPlane& plane : points.planes) {
    baked.layer.planes.push_back(finishPlane(p.texels, seams, points.valid, std::move(plane), report));
    report = nullptr;  // seams are told of the layer's first plane
    numbers.raw_bytes += baked.layer.planes.back().values.size() * sizeof(float);
  }
  baked.layer.tables = std::move(points.tables);
  baked.valid = std::move(points.valid);
  task.stopwatch.lap(prepared.name + " finish");
  return baked;
}

}  // namespace relume::bake
