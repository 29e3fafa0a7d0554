// SPDX-License-Identifier: MIT
// relume verify: a bake against path-traced truth.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "command.h"
#include "day_verification.h"
#include "files.h"
#include "lightmap_comparison.h"
#include "reference_picture.h"
#include "relit_comparison.h"
#include "relume/core/error.h"
#include "relume/core/file.h"
#include "report_folder.h"
#include "verification.h"
#include "verify_report.h"

namespace relume::app {
namespace {

struct VerifyCommandOptions {
  std::string asset, lights, json, report, size = "480x270";
  VerifyOptions verify;
  std::uint32_t lamps = 20, times = 20;
  bool near = false;
  ViewOptions views;
};

void print(const Verification& v) {
  fmt::print("{}: {} places, {} paths; shares of the mean true irradiance, {:.4g}\n", v.layer, v.points,
             v.paths, v.mean_true);
  fmt::print("bias  {:+.2f} % +- {:.2f} %\n", v.bias * 100, v.bias_error * 100);
  fmt::print(
      "error {:.2f} % +- {:.2f} % RMS, texel size included; the bake's own estimate of its noise: {:.2f} %\n",
      v.rmse * 100, v.rmse_error * 100, v.error_estimate * 100);
  for (const Verification::Place& p : v.worst)
    fmt::print("  {:>8.4g} where {:.4g} +- {:.2g} is true: {} at {:.3f}, {:.3f}, {:.3f}\n", p.baked, p.truth,
               p.truth_error, p.object, p.position.x, p.position.y, p.position.z);
}

void print(const RelitVerification& v, const std::optional<asset::TransferErrors>& causes) {
  fmt::print("{}: {} lamps, {} places, {} paths; entries {:.2f} m wide\n", v.layer, v.lamps.size(), v.points,
             v.paths, v.spacing);
  fmt::print(
      "error of indirect irradiance: median {:.2f} %, mean {:.2f} %, worst {:.2f} %; encoding {:.2f} %\n"
      "median without the hundredth of places that are most wrong: {:.2f} %\n",
      v.median * 100, v.mean * 100, v.worst * 100, v.error_estimate * 100, v.median_rest * 100);
  if (causes)
    fmt::print(
        "by cause, as the bake measured: entries {:.2f} % (count=), noise of the transfer {:.2f} % (rays=), "
        "encoding {:.2f} % (error=); left of the median {:.2f} %, from interpolation between exits and from "
        "elements (size=)\n",
        causes->entries * 100, causes->transfer * 100, causes->encoding * 100, unexplained(v, *causes) * 100);
}

/// Transfer is compared where it is asked for, and where there is nothing else.
bool comparesTransfer(const asset::Asset& asset, const std::string& layer) {
  if (!layer.empty()) return asset.layer(layer).kind == "lightpath";
  const auto is = [&](const char* kind) {
    return std::any_of(asset.layers.begin(), asset.layers.end(),
                       [&](const asset::Layer& l) { return l.kind == kind; });
  };
  return is("lightpath") && !is("lightmap");
}

/// Likewise a day.
bool comparesDay(const asset::Asset& asset, const std::string& layer) {
  if (!layer.empty()) return asset.layer(layer).kind == "day";
  return std::all_of(asset.layers.begin(), asset.layers.end(),
                     [](const asset::Layer& l) { return l.kind != "lightmap" && l.kind != "lightpath"; }) &&
         std::any_of(asset.layers.begin(), asset.layers.end(),
                     [](const asset::Layer& l) { return l.kind == "day"; });
}

/// Numbers printed, and what a report shows.
Comparison verified(const VerifyCommandOptions& options, Opened& opened, const ViewOptions& views,
                    bool pictures, Progress& progress) {
  const asset::Asset& asset = *opened.asset;
  if (comparesDay(asset, options.verify.layer)) {
    if (pictures)
      throw Error(ErrorCode::kUsage, "--output", "shows no day yet", "leave it out, or give --json");
    const DayVerification v = verifyDay(opened.scene, asset, options.verify, options.times, progress);
    print(v);
    Comparison numbers;
    numbers.numbers = toJson(v);
    return numbers;
  }
  if (comparesTransfer(asset, options.verify.layer)) {
    const RelitVerification v =
        verifyRelit(opened.scene, asset, options.verify, options.lamps, options.near, progress);
    const auto causes = asset::readTransfer(asset.layer(v.layer), asset.atlas).errors;
    print(v, causes);
    std::fflush(stdout);  // pictures take longer
    Comparison comparison = compareRelit(v, causes);
    if (pictures) comparison.views = relitViews(opened.scene, asset, v, views, options.verify.seed, progress);
    return comparison;
  }
  lightScene(opened.scene, options.lights, "");
  const Verification v = verifyLightmap(opened.scene, asset, options.verify, progress);
  print(v);
  std::fflush(stdout);  // pictures take longer
  if (pictures) return compareLightmap(opened.scene, asset, v, options.verify, views, progress);
  Comparison numbers;
  numbers.numbers = toJson(v);
  return numbers;
}

void verify(const VerifyCommandOptions& options, const std::string& typed, Progress& progress) {
  const auto opened = open(options.asset, {.normal_maps = true});
  if (!opened->asset)
    throw Error(ErrorCode::kNoSuchLayer, options.asset, "carries no bake", "bake --layer lightmap first");
  if (!options.json.empty()) requireWritable(options.json);
  ViewOptions views = options.views;
  views.size = parseExtent(options.size, "--size");
  std::optional<ReportFolder> report;
  if (!options.report.empty()) report.emplace(options.report);
  const Comparison comparison = verified(options, *opened, views, report.has_value(), progress);
  if (!options.json.empty()) writeFileAtomically(options.json, comparison.numbers.dump(2) + "\n");
  if (!report) return;
  const VerifyFacts facts{options.asset, options.lights, opened->asset->generator, typed};
  writeVerifyReport(report->draft(), facts, {comparison}, progress);
  report->publish();
  fmt::print("report: {}\n", (std::filesystem::path(options.report) / "report.html").string());
}

}  // namespace

void addVerify(CLI::App& app, Program& program) {
  auto options = std::make_shared<VerifyCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "verify",
      "Compares a baked lightmap with path-traced truth, or the light that a lightpath\nmakes of "
      "random lamps.\nExample: relume "
      "verify room.baked.glb -o verified");
  command->add_option("ASSET", options->asset, "baked .glb with a lightmap or a lightpath")->required();
  command->add_option("--lights", options->lights, "the light file that it was baked with");
  command->add_option("--layer", options->verify.layer,
                      "without it, the first lightmap, or the lightpath where there is none");
  command->add_option("--points", options->verify.points, "places on the surfaces")
      ->check(CLI::Range(1u, 10'000'000u))
      ->capture_default_str();
  command->add_option("--spp", options->verify.samples, "paths for each place")
      ->check(CLI::Range(32u, 1u << 24))
      ->capture_default_str();
  command->add_option("--lamps", options->lamps, "random lamps to judge a lightpath by")
      ->check(CLI::Range(1u, 10'000u))
      ->capture_default_str();
  command->add_option("--times", options->times, "random times to judge a day at")
      ->check(CLI::Range(1u, 10'000u))
      ->capture_default_str();
  command->add_flag("--near", options->near, "lamps nearer to a surface than an entry is wide");
  command->add_option("--seed", options->verify.seed, "of the random numbers")->capture_default_str();
  command->add_option("--json", options->json, "write what was measured to a file");
  command->add_option("-o,--output", options->report,
                      "folder for a report: report.html with pictures beside path-traced ones, report.json");
  command->add_option("--size", options->size, "width x height of the report's pictures")
      ->capture_default_str();
  command->add_option("--picture-spp", options->views.samples, "paths per pixel of the report's pictures")
      ->check(CLI::Range(8u, 1u << 20))
      ->capture_default_str();
  command->callback([&program, options] {
    program.run = [options, typed = program.command_line](Progress& progress) {
      verify(*options, typed, progress);
    };
  });
}

}  // namespace relume::app
