// SPDX-License-Identifier: MIT
// relume verify: a bake against path-traced truth.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "command.h"
#include "files.h"
#include "reference_picture.h"
#include "relume/core/error.h"
#include "relume/core/file.h"
#include "verification.h"

namespace relume::app {
namespace {

struct VerifyCommandOptions {
  std::string asset, lights, json;
  VerifyOptions verify;
};

std::string toJson(const Verification& v) {
  nlohmann::ordered_json out{{"layer", v.layer},
                             {"points", v.points},
                             {"skipped", v.skipped},
                             {"paths", v.paths},
                             {"mean_baked", v.mean_baked},
                             {"mean_true", v.mean_true},
                             {"relative_bias", v.bias},
                             {"relative_bias_error", v.bias_error},
                             {"relative_rmse", v.rmse},
                             {"relative_rmse_error", v.rmse_error},
                             {"truth_noise", v.truth_noise},
                             {"error_estimate", v.error_estimate}};
  out["worst"] = nlohmann::ordered_json::array();
  for (const Verification::Place& p : v.worst)
    out["worst"].push_back({{"object", p.object},
                            {"position", {p.position.x, p.position.y, p.position.z}},
                            {"baked", p.baked},
                            {"true", p.truth},
                            {"true_error", p.truth_error}});
  return out.dump(2) + "\n";
}

void verify(const VerifyCommandOptions& options, Progress& progress) {
  const auto opened = open(options.asset, {.normal_maps = true});
  if (!opened->asset)
    throw Error(ErrorCode::kNoSuchLayer, options.asset, "carries no bake", "bake --layer lightmap first");
  if (!options.json.empty()) requireWritable(options.json);
  lightScene(opened->scene, options.lights, "");
  const Verification v = verifyLightmap(opened->scene, *opened->asset, options.verify, progress);
  fmt::print("{}: {} places, {} paths; shares of the mean true irradiance, {:.4g}\n", v.layer, v.points,
             v.paths, v.mean_true);
  fmt::print("bias  {:+.2f} % +- {:.2f} %\n", v.bias * 100, v.bias_error * 100);
  fmt::print(
      "error {:.2f} % +- {:.2f} % RMS, texel size included; the bake's own estimate of its noise: {:.2f} %\n",
      v.rmse * 100, v.rmse_error * 100, v.error_estimate * 100);
  for (const Verification::Place& p : v.worst)
    fmt::print("  {:>8.4g} where {:.4g} +- {:.2g} is true: {} at {:.3f}, {:.3f}, {:.3f}\n", p.baked, p.truth,
               p.truth_error, p.object, p.position.x, p.position.y, p.position.z);
  if (!options.json.empty()) writeFileAtomically(options.json, toJson(v));
}

}  // namespace

void addVerify(CLI::App& app, Program& program) {
  auto options = std::make_shared<VerifyCommandOptions>();
  CLI::App* command = app.add_subcommand("verify",
                                         "Compares a baked lightmap with path-traced truth.\nExample: relume "
                                         "verify room.baked.glb --points 4000");
  command->add_option("ASSET", options->asset, "baked .glb with a lightmap")->required();
  command->add_option("--lights", options->lights, "the light file that it was baked with");
  command->add_option("--layer", options->verify.layer, "without it, the first lightmap");
  command->add_option("--points", options->verify.points, "places on the surfaces")
      ->check(CLI::Range(1u, 10'000'000u))
      ->capture_default_str();
  command->add_option("--spp", options->verify.samples, "paths for each place")
      ->check(CLI::Range(32u, 1u << 24))
      ->capture_default_str();
  command->add_option("--seed", options->verify.seed, "of the random numbers")->capture_default_str();
  command->add_option("--json", options->json, "write what was measured to a file");
  onCommand(command, program, options, verify);
}

}  // namespace relume::app
