// SPDX-License-Identifier: MIT
// The cache keeps such a layer as a .glb of its own that carries nothing else: whole, checksummed, and read
// by the same code as any bake.
#include <system_error>

#include "baked_layer.h"
#include "relume/core/error.h"
#include "relume/core/file.h"
#include "relume/core/version.h"
#include "scene_digest.h"

namespace relume::bake {
namespace fs = std::filesystem;

namespace {

/// Where the layer lies in the cache; empty without one.
fs::path fileOf(const BakeOptions& options, const Prepared& prepared, const Digest& key) {
  if (options.cache.empty()) return {};
  Hasher hasher;
  hasher.add(std::string_view(version())).add(key).add(prepared.structure);
  for (const Placement& placement : placements(prepared.scene)) hasher.add(placement.world_from_local);
  return options.cache / (hasher.digest().hex() + ".layer");
}

bool load(const fs::path& file, asset::Layer& layer) {
  std::error_code ec;
  if (file.empty() || !fs::exists(file, ec)) return false;
  try {
    asset::Asset kept = asset::readAsset(file);
    if (kept.layers.size() != 1) return false;
    layer = std::move(kept.layers[0]);
  } catch (const Error&) {
    return false;  // a damaged entry is as good as none
  }
  fs::last_write_time(file, fs::file_time_type::clock::now(), ec);  // used: trimmed last
  return true;
}

void keep(const fs::path& file, const asset::Layer& layer) {
  if (file.empty()) return;
  asset::Asset asset;
  asset.atlas.width = asset.atlas.height = 1, asset.atlas.pages = 1;
  asset.layers.push_back(layer);
  std::error_code ec;
  fs::create_directories(file.parent_path(), ec);
  try {
    writeFileAtomically(file, asset::encodeGlb(asset));
  } catch (const Error&) {
    // A cache that cannot be written costs time later, not the bake now.
  }
}

}  // namespace

bool isKept(const BakeOptions& options, const Prepared& prepared, const Digest& key) {
  asset::Layer layer;
  return load(fileOf(options, prepared, key), layer);
}

BakedLayer bakeWhole(const LayerTask& task, Progress& progress) {
  const PreparedLayer& prepared = task.layer;
  const WholeJob job = prepared.kind->prepare_whole(task.context, prepared.parameters);
  BakedLayer baked{.layer = {}, .numbers = {.name = prepared.name}, .key = job.key, .valid = {}};
  const fs::path file = fileOf(task.options, task.prepared, job.key);
  const std::size_t texels = task.prepared.texels.points.size();
  asset::Layer found;
  if (load(file, found)) {
    baked.numbers.reused_texels = texels;
  } else {
    WholeLayer solved = job.solve(progress);
    found = std::move(solved.layer);
    baked.numbers.samples = solved.rays, baked.numbers.computed_texels = texels;
    keep(file, found);
  }
  baked.layer = describe(prepared);
  for (const auto& [name, value] : found.parameters) {
    baked.layer.parameters[name] = value;
    if (const double* number = std::get_if<double>(&value)) baked.numbers.measured[name] = *number;
  }
  baked.layer.planes = std::move(found.planes);
  baked.layer.tables = std::move(found.tables);
  baked.layer.samples = found.samples;
  baked.layer.error_estimate = baked.numbers.error_estimate = found.error_estimate;
  baked.numbers.raw_bytes = job.raw_bytes(baked.layer);
  if (job.warnings) baked.warnings = job.warnings(baked.layer);
  baked.numbers.seconds = task.stopwatch.lap(prepared.name);
  obeyMemoryLimit(task.options.max_memory);
  return baked;
}

}  // namespace relume::bake
