// SPDX-License-Identifier: MIT
// Based on:
//   [USKP09] Umenhoffer et al. Multi-scale precomputed radiance transfer. Sections 5 to 7.
#include "lightpath_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "forecast.h"
#include "lightpath_errors.h"
#include "relume/asset/transfer.h"
#include "relume/codec/encode_clustered_pca.h"
#include "relume/codec/encode_tiles.h"
#include "relume/core/error.h"
#include "relume/core/kmeans.h"
#include "relume/core/parallel.h"
#include "relume/transport/light_paths.h"

namespace relume::bake {
namespace {

using transport::LightPathOptions;
using transport::LightPaths;

/// What a quality means for transfer: entries for the light sets, rays and elements for the transfer itself,
/// and a bound on what the encoding may add. About equal parts each.
struct Preset {
  std::uint32_t entries, elements, exit_rays;
  double error;
};
constexpr std::array<Preset, 4> kPresets = {
    {{.entries = 512, .elements = 4096, .exit_rays = 256, .error = 0.05},
     {.entries = 1024, .elements = 8192, .exit_rays = 1024, .error = 0.02},
     {.entries = 2048, .elements = 12288, .exit_rays = 2048, .error = 0.01},
     {.entries = 4096, .elements = 16384, .exit_rays = 4096, .error = 0.005}}};

constexpr std::uint32_t kTrainingLights = 768, kHeldOutLights = 64;
constexpr float kNormalTerm = 4.0f;             // entries' sides that a turned normal counts as, in clusters
constexpr std::size_t kColumnsOfCluster = 320;  // about
// Dark exits: errors of them may be so many times those overall. Below that, in halls, the noise of what is
// encoded is larger.
constexpr double kRowErrors = 15, kMostRowError = 0.75;
constexpr double kRowBytes = 0.3;  // that their bound may cost, of what all else takes
constexpr std::size_t kPaperClusters = 32, kPaperComponents = 8;

struct Coding {
  bool clustered_pca = false;
  double error = 0.02, row_error = 0;        ///< overall, and in dark exits
  std::size_t clusters = 0, components = 0;  // 0: chosen here
  std::uint32_t bits = 8;
};

double given(const Parameters& parameters, const char* name, double otherwise) {
  const auto found = parameters.find(name);
  return found == parameters.end() ? otherwise : std::get<double>(found->second);
}

/// A whole number that is a number of something: none of it, or no end of it, is refused.
std::uint32_t count(const Parameters& parameters, const char* name, std::uint32_t otherwise) {
  constexpr double kMost = 65536;
  if (!parameters.contains(name)) return otherwise;
  const double value = given(parameters, name, 0);
  if (!(value >= 1 && value <= kMost))
    throw Error(ErrorCode::kUsage, "--layer lightpath", fmt::format("{}={} is out of range", name, value),
                fmt::format("use 1 to {}", kMost));
  return static_cast<std::uint32_t>(value);
}

const std::string& word(const Parameters& parameters, const char* name) {
  return std::get<std::string>(parameters.at(name));
}

const Preset& presetOf(const QualitySettings& quality) {
  return kPresets[static_cast<std::size_t>(quality.quality)];
}

LightPathOptions optionsOf(const LayerContext& context, const Parameters& parameters) {
  const Preset& preset = presetOf(context.quality);
  LightPathOptions o;
  o.entries = count(parameters, "count", preset.entries);
  if (word(parameters, "entries") == "shot") {
    o.placement = transport::EntryPlacement::kShot;
    if (parameters.contains("samples") || parameters.contains("modes"))
      throw Error(ErrorCode::kUsage, "--layer lightpath", "entries that are shot are points, with one sample",
                  "leave samples= and modes= away, or take entries=patches");
  }
  o.patch_entries = count(parameters, "modes", o.patch_entries);
  o.entry_samples = count(parameters, "samples", o.entry_samples);
  o.transfer = word(parameters, "transfer") == "walks" ? transport::TransferBy::kWalks
                                                       : transport::TransferBy::kGathering;
  o.walks = count(parameters, "walks", o.walks);
  o.walk_seed = context.seed;
  const std::string& receivers = word(parameters, "exits");
  o.receivers = receivers == "vertices" ? transport::Receivers::kVertices
                : receivers == "probes" ? transport::Receivers::kProbes
                                        : transport::Receivers::kTexels;
  o.probe_spacing = static_cast<float>(given(parameters, "spacing", 1));
  if (o.receivers != transport::Receivers::kTexels &&
      (word(parameters, "short") == "obscurance" || o.transfer == transport::TransferBy::kWalks))
    throw Error(ErrorCode::kUsage, "--layer lightpath",
                "short=obscurance and transfer=walks are for exits at texels", "leave exits= away");
  if (word(parameters, "short") == "obscurance") o.near = static_cast<float>(given(parameters, "near", 0));
  o.test_points = count(parameters, "places", o.test_points);
  if (const std::string& aim = word(parameters, "aim"); aim != "all")
    o.aim = Direction(0, aim == "down" ? -1 : 1, 0);
  o.elements = preset.elements;
  o.exit_rays =
      count(parameters, "rays", context.quality.exact() ? context.quality.max_samples : preset.exit_rays);
  const auto across = count(parameters, "size", 256);
  const auto side = static_cast<std::uint32_t>(std::max(context.texels.width, context.texels.height));
  o.exit_side = std::clamp((side + across - 1) / across, 1u, 64u);
  o.materials = word(parameters, "materials") == "lambert" ? transport::Materials::kLambert
                                                           : transport::Materials::kFull;
  o.light_boxes = context.tracer.scene().light_boxes;
  o.seed = context.seed;
  return o;
}

Coding codingOf(const LayerContext& context, const Parameters& parameters) {
  Coding coding;
  coding.clustered_pca = word(parameters, "codec") == "cpca";
  coding.clusters = count(parameters, "clusters", 0);
  coding.components = count(parameters, "components", 0);
  coding.error = given(parameters, "error",
                       coding.components > 0 || coding.clustered_pca ? 0 : presetOf(context.quality).error);
  coding.row_error = given(parameters, "dark", std::min(kRowErrors * coding.error, kMostRowError));
  coding.bits = word(parameters, "bits") == "16" ? 16 : 8;
  return coding;
}

Digest keyOf(const LightPathOptions& o, const Coding& c) {
  Hasher hasher;
  for (const Box3& box : o.light_boxes) hasher.add(box.lo).add(box.hi);
  return hasher
      .add(std::string_view("lightpath 5"))  // raise when results change
      .add(o.entries)
      .add(o.placement)
      .add(o.test_points)
      .add(o.aim.value_or(Direction(0)))
      .add(o.patch_entries)
      .add(o.entry_samples)
      .add(o.transfer)
      .add(o.walks)
      .add(o.near)
      .add(o.receivers)
      .add(o.probe_spacing)
      .add(o.elements)
      .add(o.element_rays)
      .add(o.exit_side)
      .add(o.exit_rays)
      .add(o.materials)
      .add(o.seed)
      .add(c.clustered_pca)
      .add(c.error)
      .add(c.row_error)
      .add(c.clusters)
      .add(c.components)
      .add(c.bits)
      .digest();
}

/// Irradiance of random lights on the entries. Where no light finds room, single entries lit one by one.
std::vector<float> lightSets(const LightPaths& paths, std::uint32_t count, std::uint64_t seed,
                             Progress& progress) {
  const LightSet lights =
      paths.lights(count, {.nearest = 0.25f * paths.spacing(), .spots = 0.25f}, seed, progress);
  const std::size_t entries = paths.entries().size();
  std::vector<float> sets;
  const std::vector<float> all = paths.entryIrradiance(lights, progress);
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(l * entries);
    const auto last = first + static_cast<std::ptrdiff_t>(entries);
    if (std::any_of(first, last, [](float e) { return e > 0; })) sets.insert(sets.end(), first, last);
  }
  for (std::size_t e = 0; sets.size() < entries * std::min<std::size_t>(count, entries) / 8; ++e) {
    sets.resize(sets.size() + entries, 0.0f);
    sets[sets.size() - entries + (e * 7919 + seed) % entries] = 1.0f;
  }
  return sets;
}

/// Entries that lie together and face alike.
codec::ColumnClusters clusterEntries(const transport::Entries& entries, float spacing, std::size_t clusters) {
  std::vector<float> features;
  features.reserve(entries.size() * 6);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const Vec3 n = kNormalTerm * spacing * entries.normal[e];
    for (int c = 0; c < 3; ++c) features.push_back(entries.centre[e][c]);
    for (int c = 0; c < 3; ++c) features.push_back(n[c]);
  }
  const KMeans parts = kMeans(features, 6, entries.area, {.clusters = clusters});
  return codec::clustersFromLabels(parts.label, parts.clusters);
}

codec::Transfer matrixOf(const LightPaths& paths) {
  const transport::ExitTiles& tiles = paths.tiles();
  const std::uint32_t each = paths.exits().rows_each;
  codec::RowTiles rows;
  for (const std::uint32_t first : tiles.first) rows.first.push_back(first * each);
  for (std::size_t i = 0; i < tiles.row.size(); ++i)
    for (std::uint32_t k = 0; k < each; ++k)
      rows.row.push_back(tiles.row[i] * each + k), rows.blend.push_back(tiles.blend[i]);
  return {.rows = static_cast<std::uint32_t>(paths.exits().size()) * each,
          .columns = static_cast<std::uint32_t>(paths.entries().size()),
          .channels = 3,
          .tiles = std::move(rows),
          .source = [&paths](std::size_t tile, std::span<float> out) { paths.rows(tile, out); }};
}

asset::Entries storedEntries(const transport::Entries& entries) {
  asset::Entries stored{.samples = entries.samples_each,
                        .position = {},
                        .normal = {},
                        .first = entries.first,
                        .mix = entries.mix,
                        .area = entries.area};
  for (const transport::EntrySample& s : entries.samples) {
    stored.position.push_back(s.position);
    stored.normal.push_back(s.normal);
  }
  // Rounded to the grid of the file they must not lie in their own shadow.
  const float step = asset::entryPointStep(stored);
  for (std::size_t i = 0; i < stored.position.size(); ++i) stored.position[i] += step * stored.normal[i];
  return stored;
}

asset::Exits storedExits(const transport::Exits& exits) {
  asset::Exits stored{.side = exits.side, .exit_of_texel = exits.of_texel, .vertices = {}, .probes = {}};
  if (!exits.vertices_of_texel.empty()) {
    stored.kind = asset::Exits::Kind::kVertices;
    for (const transport::Exit& e : exits.all)
      stored.vertices.position.push_back(e.position), stored.vertices.normal.push_back(e.normal);
    for (const transport::TexelVertices& t : exits.vertices_of_texel) {
      const auto first = static_cast<std::uint8_t>(std::lround(255 * t.weight.x)),
                 second =
                     static_cast<std::uint8_t>(std::min<long>(std::lround(255 * t.weight.y), 255L - first));
      for (const std::uint32_t exit : t.exit) stored.vertices.texel_exit.push_back(exit);
      for (const int w : {int{first}, int{second}, 255 - first - second})
        stored.vertices.texel_weight.push_back(static_cast<std::uint8_t>(w));
    }
  }
  if (!exits.grid.exit.empty()) {
    stored.kind = asset::Exits::Kind::kProbes;
    const UVec3 n = exits.grid.count;
    stored.probes = {exits.grid.origin, exits.grid.spacing, {n.x, n.y, n.z}, exits.grid.exit};
  }
  return stored;
}

struct Encoded {
  codec::BlockMatrix matrix;
  codec::EncodeReport report;
};

/// What the encoding cost and lost, for those who inspect the bake.
std::map<std::string, asset::Parameter> costOf(const Encoded& encoded) {
  const auto exits = static_cast<double>(encoded.matrix.rows);
  return {{"exit_bytes", static_cast<double>(encoded.report.bytes) / exits},
          {"dark_bytes", static_cast<double>(encoded.report.row_bytes) / exits},
          {"dark_error", encoded.report.error.row_p95}};
}

Encoded encode(const codec::Transfer& matrix, const codec::ColumnClusters& columns,
               const codec::Lights& lights, const Coding& coding, Progress& progress) {
  if (coding.clustered_pca) {
    auto encoded = codec::encodeClusteredPca(matrix, columns, lights,
                                             {.rank = coding.components > 0 ? coding.components
                                                      : coding.error > 0    ? columns.column.size()
                                                                            : kPaperComponents,
                                              .error = coding.error,
                                              .bits = coding.bits},
                                             &progress);
    return {std::move(encoded.matrix), std::move(encoded.report)};
  }
  auto encoded = codec::encodeTiles(matrix, columns, lights,
                                    {.error = coding.error,
                                     .row_error = coding.row_error,
                                     .row_bytes = kRowBytes,
                                     .rank = coding.components,
                                     .bits = coding.bits},
                                    &progress);
  return {std::move(encoded.matrix), std::move(encoded.report)};
}

WholeLayer solveLightPaths(const LayerContext& context, const LightPathOptions& options, const Coding& coding,
                           Progress& progress) {
  const LightPaths paths(context.tracer, context.atlas, context.texels, options, progress);
  const codec::Lights lights{.training = lightSets(paths, kTrainingLights, options.seed * 2, progress),
                             .held_out = lightSets(paths, kHeldOutLights, options.seed * 2 + 1, progress)};
  const std::size_t entries = paths.entries().size();
  const std::size_t clusters = coding.clusters > 0    ? coding.clusters
                               : coding.clustered_pca ? kPaperClusters
                                                      : (entries + kColumnsOfCluster - 1) / kColumnsOfCluster;
  const codec::ColumnClusters columns = clusterEntries(paths.entries(), paths.spacing(), clusters);
  const codec::Transfer matrix = matrixOf(paths);
  Encoded encoded = encode(matrix, columns, lights, coding, progress);
  WholeLayer solved;
  solved.layer.parameters = costOf(encoded);
  solved.layer.error_estimate = encoded.report.error.mean;
  asset::Transfer transfer{.matrix = std::move(encoded.matrix),
                           .entries = storedEntries(paths.entries()),
                           .exits = storedExits(paths.exits()),
                           .near_share = options.near > 0 ? paths.nearShares(progress) : std::vector<Vec3>(),
                           .errors = std::nullopt};
  transfer.errors = measureErrors(paths, options, transfer.matrix, progress);
  solved.layer.tables = asset::transferTables(transfer, context.table);
  solved.layer.samples = options.exit_rays;
  solved.rays = paths.rays();
  return solved;
}

/// From a bake with a quarter of the entries and elements, and one tile of it. Rays grow with either, the
/// rows of the transfer and of what elements send out with both.
double forecastLightPaths(const LayerContext& context, LightPathOptions options, Progress& progress) {
  constexpr std::uint32_t kLess = 4;
  options.entries = std::max(options.entries / kLess, 16u),
  options.elements = std::max(options.elements / kLess, 64u);
  const double begin = steadySeconds();
  const LightPaths paths(context.tracer, context.atlas, context.texels, options, progress);
  const double solved = steadySeconds();
  const std::size_t tiles = paths.tiles().size();
  if (tiles == 0) return 0;
  const std::size_t tile = tiles / 2, rows = paths.tiles().first[tile + 1] - paths.tiles().first[tile];
  std::vector<float> out(rows * paths.exits().rows_each * 3 * paths.entries().size());
  paths.rows(tile, out);
  const double one_tile = steadySeconds() - solved;
  constexpr double kGrowth = 1.5 * kLess;  // between the rays' and the rows'
  return kGrowth * (solved - begin) +
         2.0 * one_tile * static_cast<double>(tiles) * kLess / static_cast<double>(threadCount());
}

}  // namespace

WholeJob prepareLightPaths(const LayerContext& context, const Parameters& parameters) {
  const LightPathOptions options = optionsOf(context, parameters);
  const Coding coding = codingOf(context, parameters);
  const asset::AtlasTable& table = context.table;
  return {.key = keyOf(options, coding),
          .solve = [context, options, coding](
                       Progress& progress) { return solveLightPaths(context, options, coding, progress); },
          .forecast = [context, options](
                          Progress& progress) { return forecastLightPaths(context, options, progress); },
          .raw_bytes =
              [&table](const asset::Layer& layer) {
                const codec::BlockMatrix matrix = asset::readTransfer(layer, table).matrix;
                return std::uint64_t{4} * matrix.rows * matrix.columns * matrix.channels;
              }};
}

}  // namespace relume::bake
