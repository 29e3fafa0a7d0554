// SPDX-License-Identifier: MIT
#include "prepared.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

#include "relume/core/memory.h"
#include "relume/core/parallel.h"
#include "relume/transport/emitters.h"
#include "scene_digest.h"

namespace relume::bake {
namespace {

QualitySettings qualityOf(const BakeOptions& options) {
  QualitySettings quality = settings(options.quality);
  if (options.samples > 0) {
    // Exactly so many rays: a measured curve needs a known count, so nothing stops early and nothing is
    // smoothed but by the preset.
    quality.max_samples = std::bit_ceil(options.samples);
    quality.min_samples = quality.max_samples;
    quality.target_error = 0;
  }
  return quality;
}

/// The atlas that was asked for, with a bound on its texels: beyond it the bake would end in the system's
/// hands.
atlas::AtlasOptions withinMemory(const BakeOptions& options) {
  constexpr std::uint64_t kBytesPerTexel = 250;  // about: surface point, row, planes
  atlas::AtlasOptions result = options.atlas;
  const std::uint64_t bytes = options.max_memory ? options.max_memory : machineBytes();
  if (bytes) result.most_texels = std::min(result.most_texels, bytes / kBytesPerTexel);
  return result;
}

/// Normal maps are read only for those who use them.
bool seesNormalMaps(const LayerSpec& spec) {
  const auto materials = spec.values.find("materials");
  return find(spec.kind).has("materials") && (materials == spec.values.end() || materials->second == "full");
}

/// Albedo and emission are read from the textures only for those who use them: they take as long as all else
/// that is known of a texel.
bool seesMaterials(const PreparedLayer& layer) {
  const auto correction = layer.parameters.find("correction");
  const bool corrected =
      correction != layer.parameters.end() && correction->second != asset::Parameter(std::string("none"));
  return !layer.kind->visibility_alone || corrected;
}

/// A scene in which nothing shines gets a white sky: a black bake helps nobody.
void requireLight(scene::Scene& scene, const std::vector<PreparedLayer>& layers, Warnings& warnings) {
  const auto needs = [](const PreparedLayer& layer) { return layer.kind->needs_light; };
  if (std::none_of(layers.begin(), layers.end(), needs) || !transport::Emitters(scene).empty()) return;
  warnings.push_back({scene.name, "nothing static in it shines", "it is lit by a white sky; give --lights"});
  scene.environment.radiance = Radiance(1.0f);
}

void warnOfScale(const scene::Scene& scene, float diagonal, Warnings& warnings) {
  if (diagonal >= 2.0f && diagonal <= 400.0f) return;
  warnings.push_back(
      {scene.name,
       fmt::format(
           "the scene is {:.3g} metres across; if that is not its true size, its unit is not the metre",
           diagonal),
       "distances left to themselves follow the scene's size; give distance= to choose"});
}

std::vector<PreparedLayer> resolveLayers(const BakeOptions& options, float diagonal) {
  std::vector<LayerSpec> specs = options.layers;
  if (specs.empty()) specs = {{.kind = "obscurance", .values = {}}, {.kind = "lightpath", .values = {}}};
  std::vector<PreparedLayer> layers;
  std::map<std::string, int> count;
  for (const LayerSpec& spec : specs) {
    PreparedLayer layer;
    layer.kind = &find(spec.kind);
    layer.parameters = resolve(*layer.kind, spec, diagonal);
    const int number = ++count[spec.kind];
    layer.name = number == 1 ? spec.kind : fmt::format("{}.{}", spec.kind, number);
    layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace

std::unique_ptr<Prepared> prepare(const scene::gltf::Document& document, const BakeOptions& options,
                                  Statistics& statistics, Stopwatch& stopwatch, Warnings& warnings,
                                  Progress& progress) {
  auto p = std::make_unique<Prepared>();
  p->quality = qualityOf(options);
  for (const LayerSpec& spec : options.layers) find(spec.kind);  // wrong names fail before any work
  {
    Stage stage(progress, "import", 1);
    const bool normal_maps = std::any_of(options.layers.begin(), options.layers.end(), seesNormalMaps);
    p->scene = scene::gltf::import(document, warnings, {.normal_maps = normal_maps});
    if (options.lights) p->scene.lights = *options.lights;
    if (options.environment) p->scene.environment = *options.environment;
  }
  if (p->scene.triangleCount() == 0)
    throw Error(
        ErrorCode::kEmptyScene, p->scene.name, "there is no static triangle to bake",
        "animated, skinned and marked nodes are left alone; extras.relume.static on a node includes it");
  const float diagonal = p->scene.bounds().diagonal();
  p->layers = resolveLayers(options, diagonal);
  warnOfScale(p->scene, diagonal, warnings);
  requireLight(p->scene, p->layers, warnings);
  stopwatch.lap("import");

  p->atlas = atlas::buildAtlas(p->scene, withinMemory(options), warnings, progress);
  stopwatch.lap("atlas");
  obeyMemoryLimit(options.max_memory);

  p->materials = std::any_of(p->layers.begin(), p->layers.end(), seesMaterials);
  p->texels = atlas::rasterize(p->scene, p->atlas, progress, {.materials = p->materials});
  if (p->texels.points.empty())
    throw Error(ErrorCode::kEmptyScene, p->scene.name, "no triangle has an area",
                "check the scale of the nodes and the positions");
  stopwatch.lap("texels");
  obeyMemoryLimit(options.max_memory);

  {
    Stage stage(progress, "ray tracing structure", 1);
    p->tracer = std::make_unique<trace::Tracer>(p->scene, trace::TracerOptions{.isa = options.isa});
  }
  p->structure = structureDigest(p->scene, p->atlas);
  stopwatch.lap("bvh");

  statistics.triangles = p->scene.triangleCount();
  statistics.texels = p->texels.points.size();
  statistics.atlas_width = p->atlas.width, statistics.atlas_height = p->atlas.height,
  statistics.atlas_pages = p->atlas.pages;
  statistics.atlas = p->atlas.statistics;

  const std::uint64_t needed = currentResidentBytes() + forecastBytes(*p);
  if (options.max_memory && needed > options.max_memory)
    throw Error(ErrorCode::kOutOfMemory, p->scene.name,
                fmt::format("the bake needs about {} and --max-memory allows {}", formatSize(needed),
                            formatSize(options.max_memory)),
                "use a smaller --atlas-size or a lower --texel-density");
  return p;
}

asset::AtlasTable tableOf(const Prepared& prepared) {
  const atlas::Texels& texels = prepared.texels;
  const bool materials = prepared.materials;
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

std::uint64_t forecastBytes(const Prepared& p) {
  std::uint64_t most = 0;
  for (const PreparedLayer& layer : p.layers) {
    const bool rgb = layer.kind->name == "spectral" || layer.kind->name == "lightmap";
    const auto bent = layer.parameters.find("bent");
    const bool has_bent = bent != layer.parameters.end() && std::get<bool>(bent->second);
    const std::uint64_t channels = (rgb ? 3 : 1) + (has_bent ? 3 : 0);
    // Rows of the solver and of the finished layer, then a page-sized plane with its copy for the encoder.
    most =
        std::max(most, p.texels.points.size() * (channels + 2) * 4 * 3 + p.atlas.texels() * channels * 4 * 2);
  }
  const std::uint64_t atlas_table = p.texels.points.size() * 48;
  return most + atlas_table;
}

void obeyMemoryLimit(std::uint64_t limit) {
  if (!limit) return;
  const std::uint64_t used = currentResidentBytes();
  if (used > limit)
    throw Error(ErrorCode::kOutOfMemory, "",
                fmt::format("{} are in use and --max-memory allows {}", formatSize(used), formatSize(limit)),
                "use a smaller --atlas-size, a lower --texel-density or smaller textures");
}

}  // namespace relume::bake
