// SPDX-License-Identifier: MIT
#include "relume/bake/bake.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>

#include "baked_layer.h"
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

/// What a layer takes in the file.
std::uint64_t bytesOf(const nlohmann::json& layer, const scene::gltf::BakeOutput& output) {
  std::uint64_t bytes = 0;
  for (const char* arrays : {"planes", "tables"}) {
    if (!layer.contains(arrays)) continue;
    for (const auto& array : layer.at(arrays))
      bytes += output.views.at(array.at("bufferView").get<std::size_t>()).size();
  }
  return bytes;
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
  asset.atlas = tableOf(p);
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
                               .table = asset.atlas,
                               .quality = p.quality,
                               .seed = options.seed,
                               .day = options.day};
    const LayerTask task{.prepared = p,
                         .layer = prepared_layer,
                         .context = context,
                         .options = options,
                         .report = gatherer ? &*gatherer : nullptr,
                         .stopwatch = stopwatch};
    BakedLayer baked =
        prepared_layer.kind->prepare ? bakeTexels(task, seams, progress) : bakeWhole(task, progress);
    input.add(baked.key);
    statistics.rays += baked.numbers.samples, tracing_seconds += baked.numbers.seconds;
    for (std::size_t i = 0; i < baked.valid.size(); ++i) asset.atlas.valid[i] &= baked.valid[i];
    result.warnings.insert(result.warnings.end(), baked.warnings.begin(), baked.warnings.end());
    asset.layers.push_back(std::move(baked.layer));
    statistics.layers.push_back(std::move(baked.numbers));
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
      statistics.layers[i].bytes = bytesOf(output.transfer.at("layers").at(i), output);
    result.glb = scene::gltf::exportGlb(document, p.scene, output);
  }
  stopwatch.lap("export");
  obeyMemoryLimit(options.max_memory);
  statistics.peak_rss_bytes = peakResidentBytes();
  return result;
}

}  // namespace relume::bake
