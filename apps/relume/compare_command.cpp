// SPDX-License-Identifier: MIT
// relume compare: how different two images or lightmaps are.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "command.h"
#include "relume/core/error.h"
#include "relume/core/file.h"
#include "relume/image/colour.h"
#include "relume/image/io.h"
#include "relume/image/metrics.h"

namespace relume::app {
namespace {

struct CompareOptions {
  std::string test, reference, metric = "rmse", diff, mask;
  bool json = false;
  double pixels_per_degree = 67.0;
};

struct Outcome {
  nlohmann::ordered_json numbers;
  std::string text;
  image::Image map;  // one channel
  float map_scale = 1;
};

Outcome compareRmse(const image::Image& a, const image::Image& b, const image::Image* mask) {
  image::Rmse r = image::rmse(a, b, mask);
  return {{{"rmse", r.rmse}, {"relative", r.relative}, {"bias", r.bias}, {"p99", r.p99}, {"max", r.max}},
          fmt::format("RMSE {:.6g} ({:.4g} % of the reference), bias {:+.4g} %, 99 % of the pixels within "
                      "{:.4g}, largest error {:.4g}",
                      r.rmse, r.relative * 100, r.bias * 100, r.p99, r.max),
          std::move(r.map),
          static_cast<float>(r.p99 > 0 ? r.p99 : 1)};
}

Outcome compareFlip(const image::Image& a, const image::Image& b, double pixels_per_degree) {
  image::Difference d = image::flip(a, b, pixels_per_degree);
  return {{{"mean", d.mean}, {"p95", d.p95}, {"p99", d.p99}, {"max", d.max}},
          fmt::format("mean FLIP {:.4f}, 95 % of the pixels below {:.4f}, 99 % below {:.4f}, largest {:.4f}",
                      d.mean, d.p95, d.p99, d.max),
          std::move(d.map),
          1.0f};
}

Outcome compareYee(const image::Image& a, const image::Image& b) {
  image::Yee y = image::yee(a, b);
  const double share = static_cast<double>(y.visible_pixels) / static_cast<double>(a.pixels());
  return {{{"visible_pixels", y.visible_pixels}, {"visible_share", share}},
          fmt::format("{} pixels ({:.3g} %) differ visibly", y.visible_pixels, share * 100),
          std::move(y.map),
          1.0f};
}

void compare(const CompareOptions& options, Progress&) {
  if (!options.diff.empty()) requireWritable(options.diff);
  for (const std::string& file : {options.test, options.reference})
    if (file.ends_with(".glb"))
      throw Error(ErrorCode::kUnsupported, file, "is a bake, not an image",
                  "`relume export` writes the planes of its layers as images");
  const image::Image test = image::readImage(options.test), reference = image::readImage(options.reference);
  image::Image mask;
  if (!options.mask.empty()) mask = image::readImage(options.mask);
  const Outcome outcome = options.metric == "rmse"
                              ? compareRmse(test, reference, mask.empty() ? nullptr : &mask)
                          : options.metric == "flip" ? compareFlip(test, reference, options.pixels_per_degree)
                                                     : compareYee(test, reference);
  if (!options.diff.empty())
    image::writeImage(options.diff, image::falseColour(outcome.map, 0.0f, outcome.map_scale));
  fmt::print("{}\n", options.json ? outcome.numbers.dump(2) : outcome.text);
}

}  // namespace

void addCompare(CLI::App& app, Program& program) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare",
                                         "How different two images or lightmaps are.\nExample: relume "
                                         "compare a.exr b.exr --metric flip --diff difference.png");
  command->add_option("A", options->test, "image to judge: exr, hdr, png, jpg or webp")->required();
  command->add_option("B", options->reference, "reference image of the same size")->required();
  command
      ->add_option("--metric", options->metric,
                   "rmse: numbers; flip: as an observer flips between them; yee: pixels that differ visibly")
      ->check(CLI::IsMember({"rmse", "flip", "yee"}))
      ->capture_default_str();
  command->add_option("--diff", options->diff, "write the error in false colour");
  command->add_option("--mask", options->mask, "only where this image is above one half (rmse)");
  command->add_option("--pixels-per-degree", options->pixels_per_degree, "viewing distance for flip")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print JSON");
  onCommand(command, program, options, compare);
}

}  // namespace relume::app
