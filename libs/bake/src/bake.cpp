// SPDX-License-Identifier: MIT
#include "relume/bake/bake.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>

#include "pages.h"
#include "prepared.h"
#include "relume/bake/viewer_textures.h"
#include "relume/core/file.h"
#include "relume/core/memory.h"
#include "relume/core/parallel.h"
#include "relume/core/version.h"
#include "report_gather.h"
#include "scene_digest.h"
#include "texel_store.h"

namespace relume::bake {
namespace {

constexpr std::uint64_t kStoreLimit = std::uint64_t{2} << 30;  // bytes kept in the cache folder

asset::AtlasTable tableOf(const atlas::Texels& texels, bool materials) {
  asset::AtlasTable table{.width = texels.width, .height = texels.height, .pages = texels.pages};
  const std::size_t n = texels.points.size();
  table.texel.resize(n), table.position.resize(n), table.normal.resize(n), table.chart.resize(n);
  if (materials) table.albedo.resize(n);
  table.valid.assign(n, 1);
  parallelFor(n, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const atlas::SurfacePoint& p = texels.points[i];
      table.texel[i] = p.texel, table.chart[i] = p.chart;
      table.position[i] = p.position, table.normal[i] = p.shading_normal;
      if (materials) table.albedo[i] = p.albedo.rgb;
    }
  });
  return table;
}

// A cache that cannot be written costs time later, not the bake now.
void warnOfCache(const std::filesystem::path& folder, Warnings& warnings) {
  if (folder.empty()) return;
  std::error_code ec;
  std::filesystem::create_directories(folder, ec);
  try {
    requireWritable(folder / "any");
  } catch (const Error& error) {
    warnings.push_back({folder.string(), "nothing can be kept there for later bakes: " + error.problem(),
                        "choose another --cache, or --no-cache"});
  }
}

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

scene::gltf::BakeOutput outputOf(atlas::Atlas& atlas, const asset::Asset& asset) {
  scene::gltf::BakeOutput output;
  const Vec2 size(static_cast<float>(atlas.width), static_cast<float>(atlas.height));
  for (atlas::InstanceUv& uv : atlas.instances) {
    scene::gltf::AtlasUse use{.instance = uv.instance,
                              .page = uv.page,
                              .source_vertex = std::move(uv.source_vertex),
                              .triangles = std::move(uv.triangles),
                              .uv = std::move(uv.uv)};
    for (Vec2& t : use.uv) t = glm::clamp(t / size, Vec2(0), Vec2(1));
    output.uses.push_back(std::move(use));
  }
  addViewerTextures(asset, output);
  asset::Encoded encoded = asset::encode(asset);
  output.transfer = nlohmann::json::parse(encoded.json);
  output.views = std::move(encoded.views);
  return output;
}

asset::Layer describe(const PreparedLayer& prepared) {
  asset::Layer layer;
  layer.name = prepared.name;
  layer.kind = prepared.kind->name;
  layer.emitters = prepared.kind->emitters, layer.transport = prepared.kind->transport;
  layer.receivers = prepared.kind->receivers, layer.codec = prepared.kind->codec;
  layer.parameters = prepared.parameters;
  return layer;
}

}  // namespace

BakeResult bake(const scene::gltf::Document& document, const BakeOptions& options, Progress& progress) {
  BakeResult result;
  Statistics& statistics = result.statistics;
  Stopwatch stopwatch(statistics);
  warnOfCache(options.cache, result.warnings);
  const auto prepared = prepare(document, options, statistics, stopwatch, result.warnings, progress);
  Prepared& p = *prepared;

  std::vector<atlas::SeamSample> seams = atlas::findSeams(p.scene, p.atlas, progress);
  stopwatch.lap("seams");

  asset::Asset& asset = result.asset;
  asset.generator = std::string("relume ") + version();
  asset.atlas = tableOf(p.texels, p.materials);
  Hasher input;
  input.add(p.structure);
  for (const Placement& placement : placements(p.scene)) input.add(placement.world_from_local);

  std::optional<ReportGatherer> gatherer;
  if (options.report) gatherer.emplace(p, options);
  double tracing_seconds = 0;
  for (const PreparedLayer& prepared_layer : p.layers) {
    const LayerContext context{.tracer = *p.tracer,
                               .atlas = p.atlas,
                               .texels = p.texels,
                               .quality = p.quality,
                               .seed = options.seed};
    const LayerJob job = prepared_layer.kind->prepare(context, prepared_layer.parameters);
    input.add(job.solver.key);
    TexelStore store(options.cache, p.structure, job.solver, p.texels, placements(p.scene));
    LayerStatistics numbers{.name = prepared_layer.name};
    numbers.reused_texels = store.reused();
    numbers.computed_texels = p.texels.points.size() - store.reused();
    {
      Stage stage(progress, prepared_layer.name, numbers.computed_texels);
      numbers.samples = store.complete(job.solver, progress);
    }
    numbers.seconds = stopwatch.lap(prepared_layer.name);
    statistics.rays += numbers.samples, tracing_seconds += numbers.seconds;
    obeyMemoryLimit(options.max_memory);

    PointLayer points = job.finish(store.rows());
    asset::Layer layer = describe(prepared_layer);
    layer.samples = p.quality.max_samples;  // per texel at most; what was really spent depends on the cache
    layer.error_estimate = numbers.error_estimate = relativeError(points);
    for (std::size_t i = 0; i < points.valid.size(); ++i) asset.atlas.valid[i] &= points.valid[i];
    LayerReport* report = gatherer ? &gatherer->add(prepared_layer, points) : nullptr;
    for (PointPlane& plane : points.planes) {
      layer.planes.push_back(finishPlane(p.texels, seams, points.valid, std::move(plane), report));
      report = nullptr;  // seams are told of the layer's first plane
      numbers.raw_bytes += layer.planes.back().values.size() * sizeof(float);
    }
    asset.layers.push_back(std::move(layer));
    statistics.layers.push_back(std::move(numbers));
    stopwatch.lap(prepared_layer.name + " finish");
  }
  asset.input_hash = input.digest().hex();
  if (!options.cache.empty()) trimStore(options.cache, kStoreLimit);
  statistics.invalid_texels =
      static_cast<std::size_t>(std::count(asset.atlas.valid.begin(), asset.atlas.valid.end(), 0));
  statistics.rays_per_second =
      tracing_seconds > 0 ? static_cast<double>(statistics.rays) / tracing_seconds : 0;

  if (gatherer) result.report = gatherer->take(asset.atlas.valid);
  gatherer.reset();
  p.tracer.reset();
  p.texels = {};
  seams = {};
  {
    Stage stage(progress, "write", 1);
    scene::gltf::BakeOutput output = outputOf(p.atlas, asset);
    for (std::size_t i = 0; i < asset.layers.size(); ++i)
      for (const auto& plane : output.transfer.at("layers").at(i).at("planes"))
        statistics.layers[i].bytes += output.views.at(plane.at("bufferView").get<std::size_t>()).size();
    result.glb = scene::gltf::exportGlb(document, p.scene, output);
  }
  stopwatch.lap("export");
  obeyMemoryLimit(options.max_memory);
  statistics.peak_rss_bytes = peakResidentBytes();
  return result;
}

}  // namespace relume::bake
