// SPDX-License-Identifier: MIT
// relume bake: light transport into a glTF file.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <thread>

#include "command.h"
#include "day.h"
#include "files.h"
#include "lights.h"
#include "relume/bake/bake.h"
#include "relume/bake/registry.h"
#include "relume/core/file.h"
#include "relume/core/memory.h"
#include "relume/core/parallel.h"
#include "report.h"
#include "report_folder.h"
#include "shell.h"

namespace relume::app {
namespace {

namespace fs = std::filesystem;

struct BakeCommandOptions {
  std::string input, output, lights, day, bounces, quality = "medium", cache, max_memory, isa, stats, report,
                                                   progress = "auto";
  std::vector<std::string> layers;
  int atlas_size = atlas::AtlasOptions{}.page_size;
  int gutter = atlas::AtlasOptions{}.gutter;
  float texel_density = 0;
  std::uint32_t samples = 0;
  int threads = 0;
  std::uint64_t seed = 1;
  bool no_cache = false, dry_run = false, new_uv = false;
};

fs::path cacheFolder(const BakeCommandOptions& options) {
  if (options.no_cache) return {};
  if (!options.cache.empty()) return options.cache;
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg) return fs::path(xdg) / "relume";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "relume";
  return {};
}

bake::BakeOptions toLibrary(const BakeCommandOptions& options) {
  bake::BakeOptions result;
  for (const std::string& layer : options.layers) result.layers.push_back(bake::parseLayerSpec(layer));
  for (bake::LayerSpec& layer : result.layers) {
    if (options.bounces.empty() || !bake::find(layer.kind).has("bounces")) continue;
    layer.values.emplace("bounces", options.bounces);
  }
  if (!options.lights.empty()) {
    result.lights = chooseLights(options.lights, {});
    result.environment = chooseEnvironment(options.lights);
  }
  result.day = readDay(options.day);
  result.quality = bake::parseQuality(options.quality);
  result.samples = options.samples;
  result.atlas.page_size = options.atlas_size;
  result.atlas.gutter = options.gutter;
  result.atlas.texels_per_metre = options.texel_density;
  result.atlas.reuse_uv1 = !options.new_uv;
  result.seed = options.seed;
  result.isa = options.isa;
  result.cache = cacheFolder(options);
  result.report = !options.report.empty();
  if (!options.max_memory.empty()) result.max_memory = parseSize(options.max_memory);
  return result;
}

std::string text(const bake::Parameters& parameters, const char* between) {
  std::string result;
  for (const auto& [key, value] : parameters) {
    const std::string v = std::visit(
        [](const auto& x) {
          if constexpr (std::is_same_v<std::decay_t<decltype(x)>, bool>)
            return std::string(x ? "true" : "false");
          else
            return fmt::format("{}", x);  // the shortest text that reads back to the same bits
        },
        value);
    result += (result.empty() ? "" : between) + key + "=" + v;
  }
  return result;
}

/// A command line that gives the same bits: whatever they depend on is said, with values for what was left to
/// the program; threads, cache and outputs beside the bake are not.
std::string repeating(const BakeCommandOptions& options, const fs::path& output, const asset::Asset& asset) {
  std::vector<std::string> words = {"relume", "bake", fs::absolute(options.input).lexically_normal().string(),
                                    "-o", fs::absolute(output).lexically_normal().string()};
  const auto add = [&](const char* option, std::string value) {
    words.emplace_back(option);
    words.push_back(std::move(value));
  };
  for (const asset::Layer& layer : asset.layers)
    add("--layer", layer.parameters.empty() ? layer.kind : layer.kind + ":" + text(layer.parameters, ","));
  add("--quality", options.quality);
  if (options.samples > 0) add("--samples", std::to_string(options.samples));
  add("--atlas-size", std::to_string(options.atlas_size));
  if (options.texel_density > 0) add("--texel-density", fmt::format("{}", options.texel_density));
  add("--gutter", std::to_string(options.gutter));
  if (options.new_uv) words.emplace_back("--new-uv");
  add("--seed", std::to_string(options.seed));
  if (!options.isa.empty()) add("--isa", options.isa);
  return shellLine(words);
}

void printPreflight(const bake::Preflight& p, const BakeCommandOptions& options) {
  fmt::print("{}: {} static triangles in {} objects, {} dynamic objects, {} lights, {:.3g} m across\n",
             options.input, p.triangles, p.static_instances, p.dynamic_instances, p.lights, p.scene_diagonal);
  fmt::print(
      "atlas: {} x {}, {} page{}, {:.1f} texels per metre, {} charts, {:.1f} % covered, mean stretch {:.3f}, "
      "{} overlapping texels\n",
      p.atlas_width, p.atlas_height, p.atlas_pages, p.atlas_pages == 1 ? "" : "s", p.atlas.texels_per_metre,
      p.atlas.charts, p.atlas.coverage * 100, p.atlas.mean_stretch, p.atlas.overlapping_texels);
  const auto q = bake::settings(bake::parseQuality(options.quality));
  fmt::print("quality {}: {} to {} rays per texel until the standard error is below {}{}\n", options.quality,
             q.min_samples, q.max_samples, q.target_error, q.filter ? ", smoothed in texel space" : "");
  for (const bake::Preflight::Layer& layer : p.layers) {
    fmt::print("layer {} ({})\n  {} of {} texels to compute", layer.name, text(layer.parameters, ", "),
               p.texels - layer.reusable_texels, p.texels);
    if (layer.reusable_texels < p.texels)
      fmt::print(": {}; about {:.1f} s", layer.stale_because, layer.forecast_seconds);
    fmt::print("\n");
  }
  fmt::print("forecast: {:.1f} s, {} of memory\n", p.forecast_seconds, formatSize(p.forecast_bytes));
}

void printSummary(const bake::BakeResult& result, const fs::path& output, double seconds) {
  const bake::Statistics& s = result.statistics;
  for (const bake::LayerStatistics& layer : s.layers) {
    fmt::print("{}: {} texels computed, {} from the cache; estimated error {:.2g} %; {}\n", layer.name,
               layer.computed_texels, layer.reused_texels, layer.error_estimate * 100,
               formatSize(layer.bytes));
  }
  fmt::print("{}: {}; atlas {} x {}{}, {} charts, {:.0f} % covered; {:.1f} s", output.string(),
             formatSize(result.glb.size()), s.atlas_width, s.atlas_height,
             s.atlas_pages > 1 ? fmt::format(" x {} pages", s.atlas_pages) : "", s.atlas.charts,
             s.atlas.coverage * 100, seconds);
  if (s.rays > 0) fmt::print(", {:.1f} million rays a second", s.rays_per_second * 1e-6);
  fmt::print(", {} at peak\n", formatSize(s.peak_rss_bytes));
}

void bakeScene(const BakeCommandOptions& options, const std::string& typed, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const bake::BakeOptions library = toLibrary(options);
  const fs::path output =
      options.output.empty() ? beside(options.input, ".baked.glb") : fs::path(options.output);
  const ThreadLimit threads(options.threads);
  const auto document = scene::gltf::Document::read(options.input);
  if (options.dry_run) {
    const bake::Preflight p = bake::preflight(document, library, progress);
    print(p.warnings);
    printPreflight(p, options);
    return;
  }
  requireWritable(output);
  if (!options.stats.empty()) requireWritable(options.stats);
  std::optional<ReportFolder> report;
  if (!options.report.empty()) report.emplace(options.report);
  const bake::BakeResult result = bake::bake(document, library, progress);
  print(result.warnings);
  writeFileAtomically(output, result.glb);
  if (!options.stats.empty()) writeFileAtomically(options.stats, bake::toJson(result.statistics));
  if (report) {
    const ReportFacts facts{.input = options.input,
                            .output = output.string(),
                            .typed = typed,
                            .command = repeating(options, output, result.asset)};
    writeReport(report->draft(), facts, result, progress);
    report->publish();
  }
  printSummary(result, output,
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (!options.report.empty())
    fmt::print("report: {}\n", (fs::path(options.report) / "report.html").string());
}

std::string layerHelp() {
  std::string help = "NAME[:key=value,...], may be repeated; without it, obscurance. Layers:";
  for (const bake::LayerKind& kind : bake::registry()) {
    help += fmt::format("\n  {}: {}", kind.name, kind.summary);
    for (const bake::ParameterSpec& p : kind.parameters) {
      const std::string choices = p.choices.empty() ? "" : fmt::format(" ({})", fmt::join(p.choices, "|"));
      help += fmt::format("\n    {}={}{}: {}", p.name, p.default_value, choices, p.help);
    }
  }
  return help;
}

}  // namespace

void addBake(CLI::App& app, Program& program) {
  auto options = std::make_shared<BakeCommandOptions>();
  CLI::App* command =
      app.add_subcommand("bake",
                         "Bakes light transport into a glTF file.\nExample: relume bake castle.glb -o "
                         "castle.baked.glb --layer ao:distance=2 --quality high");
  command->add_option("INPUT", options->input, "scene, .gltf or .glb")->required();
  command->add_option("-o,--output", options->output,
                      "baked .glb; without it, INPUT.baked.glb beside the input");
  command->add_option("--layer", options->layers, layerHelp())->allow_extra_args(false);
  command->add_option("--lights", options->lights,
                      "JSON list of lights and an environment; without it, the scene's own lights");
  command->add_option(
      "--day", options->day,
      "DAY.json: place, date and timetable of a layer `day`; without it, the summer solstice at "
      "55.49 N 9.47 E");
  command->add_option("--bounces", options->bounces, "of layers that have bounces; inf: all");
  command->add_option("--quality", options->quality, "draft, medium, high or final: the error to reach")
      ->check(CLI::IsMember({"draft", "medium", "high", "final"}))
      ->capture_default_str();
  command->add_option("--samples", options->samples, "rays per texel, exactly; rounded up to a power of two")
      ->check(CLI::Range(1, 1 << 16));
  command
      ->add_option("--atlas-size", options->atlas_size,
                   "texels along a page of the atlas; the scene is fitted to one page")
      ->check(CLI::Range(16, 16384))
      ->capture_default_str();
  command
      ->add_option("--texel-density", options->texel_density,
                   "texels per metre, on as many pages as it takes")
      ->check(CLI::PositiveNumber);
  command->add_option("--gutter", options->gutter, "texels between charts")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_flag("--new-uv", options->new_uv,
                    "make new charts even where the file has a valid TEXCOORD_1");
  command->add_option("--threads", options->threads, "0: all cores")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the random numbers")->capture_default_str();
  auto* cache =
      command->add_option("--cache", options->cache,
                          "folder for finished and interrupted work; without it, the user's cache folder");
  command->add_flag("--no-cache", options->no_cache, "neither read nor keep earlier work")->excludes(cache);
  command->add_option("--max-memory", options->max_memory, "refuse to use more, e.g. 2G");
  command->add_option("--isa", options->isa, "instruction set of the rays, for equal bits on a mixed farm")
      ->check(CLI::IsMember({"sse2", "sse4.2", "avx", "avx2", "avx512"}));
  command->add_flag("--dry-run", options->dry_run,
                    "say what would be baked and what it would cost; bake nothing");
  command->add_option("--stats", options->stats, "write statistics as JSON");
  command->add_option("--report", options->report,
                      "folder for a report: report.html with pictures, report.json");
  command->add_option("--progress", options->progress, "auto: a line on a terminal; json: lines on stderr")
      ->check(CLI::IsMember({"auto", "json", "none"}))
      ->capture_default_str();
  command->callback([&program, options] {
    program.progress_mode = options->progress;
    program.run = [options, typed = program.command_line](Progress& progress) {
      bakeScene(*options, typed, progress);
    };
  });
}

}  // namespace relume::app
