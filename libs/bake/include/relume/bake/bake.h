// SPDX-License-Identifier: MIT
// A bake from end to end: glTF document in, the same document with its light transport out.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/atlas/atlas.h"
#include "relume/bake/layer_spec.h"
#include "relume/bake/quality.h"
#include "relume/bake/registry.h"
#include "relume/bake/report.h"
#include "relume/bake/statistics.h"
#include "relume/core/error.h"
#include "relume/core/light.h"
#include "relume/core/progress.h"
#include "relume/scene/environment.h"
#include "relume/scene/gltf.h"

namespace relume::bake {

struct BakeOptions {
  std::vector<LayerSpec> layers;  ///< empty: obscurance and lightpath
  Quality quality = Quality::kMedium;
  std::uint32_t samples =
      0;  ///< rays per texel, exactly (rounded up to a power of two); 0: as the quality says
  atlas::AtlasOptions atlas;
  std::optional<LightSet> lights;  ///< instead of the document's
  std::optional<scene::Environment> environment;
  DayPlan day;  ///< of layers of kind day
  std::uint64_t seed = 1;
  std::string isa;               ///< see trace::TracerOptions
  std::filesystem::path cache;   ///< folder for finished and interrupted work; empty: none
  std::uint64_t max_memory = 0;  ///< bytes; 0: no limit
  bool report = false;           ///< also gather BakeResult::report
};

struct BakeResult {
  std::vector<std::byte> glb;  ///< the baked file
  asset::Asset asset;          ///< what it carries
  Statistics statistics;
  Report report;  ///< empty unless asked for
  Warnings warnings;
};

/// Bakes. The bits of the result are a function of the document and the options but for cache and max_memory:
/// not of the number of threads, of interruptions, or of what the cache held. Throws Error: kEmptyScene,
/// kUsage, kOutOfMemory (forecast or use above max_memory), kInterrupted (finished texels are in the cache).
BakeResult bake(const scene::gltf::Document& document, const BakeOptions& options, Progress& progress);

/// What a bake would do.
struct Preflight {
  struct Layer {
    std::string name;
    Parameters parameters;
    std::size_t reusable_texels = 0;  ///< from the cache
    std::string stale_because;        ///< why the others must be computed
    double forecast_seconds = 0;      ///< of tracing, from a pilot of a few texels
  };
  std::size_t static_instances = 0, dynamic_instances = 0, triangles = 0, texels = 0, lights = 0;
  float scene_diagonal = 0;  ///< metres
  int atlas_width = 0, atlas_height = 0;
  std::uint32_t atlas_pages = 0;
  atlas::AtlasStatistics atlas;
  std::vector<Layer> layers;
  double forecast_seconds = 0;
  std::uint64_t forecast_bytes = 0;  ///< peak memory
  Warnings warnings;
};
Preflight preflight(const scene::gltf::Document& document, const BakeOptions& options, Progress& progress);

}  // namespace relume::bake
