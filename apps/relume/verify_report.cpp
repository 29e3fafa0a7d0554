// SPDX-License-Identifier: MIT
#include "verify_report.h"

#include <fmt/format.h>

#include <cmath>

#include "exposure.h"
#include "relume/core/file.h"
#include "relume/image/colour.h"
#include "relume/image/io.h"
#include "relume/image/metrics.h"

namespace relume::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

image::Image meanOf(const image::Image& a, const image::Image& b) {
  image::Image mean = a;
  for (std::size_t i = 0; i < mean.data.size(); ++i) mean.data[i] = 0.5f * (a.data[i] + b.data[i]);
  return mean;
}

ShownView show(const fs::path& folder, const std::string& prefix, const ComparedView& view) {
  const image::Image truth = meanOf(view.truth, view.other_truth);
  ShownView shown;
  shown.caption = view.caption;
  shown.exposure = chooseExposure(truth, view.background, true);
  const auto onScreen = [&](const image::Image& linear) {
    return image::toneMap(linear, image::ToneCurve::kFilmic, shown.exposure);
  };
  const image::Image baked_shown = onScreen(view.baked), truth_shown = onScreen(truth);
  const image::Difference flip = image::flip(baked_shown, truth_shown);
  shown.mean_flip = flip.mean;
  // The mean of two truths is half as far from what is true as they are from each other.
  shown.noise_flip = 0.5 * image::flip(onScreen(view.truth), onScreen(view.other_truth)).mean;
  const image::Rmse rmse = image::rmse(view.baked, truth), noise = image::rmse(view.truth, view.other_truth);
  shown.bias = rmse.bias, shown.rmse = rmse.relative, shown.noise = 0.5 * noise.relative;
  const auto write = [&](const char* what, const image::Image& picture, const char* caption) {
    const std::string file = fmt::format("{}-{}-{}.png", prefix, view.name, what);
    image::writeImage(folder / file, picture);
    return ReportPicture{file, caption, picture.width, picture.height};
  };
  shown.baked = write("baked", baked_shown, "Baked");
  shown.truth = write("truth", truth_shown, "Path-traced");
  shown.difference =
      write("flip", image::falseColour(flip.map, 0.0f, 1.0f), "FLIP: where an eye sees them differ");
  return shown;
}

Json jsonOf(const ShownView& view) {
  return {{"caption", view.caption},       {"baked", view.baked.file},        {"truth", view.truth.file},
          {"flip", view.difference.file},  {"exposure_stops", view.exposure}, {"mean_flip", view.mean_flip},
          {"noise_flip", view.noise_flip}, {"relative_bias", view.bias},      {"relative_rmse", view.rmse},
          {"relative_noise", view.noise}};
}

}  // namespace

void writeVerifyReport(const fs::path& folder, const VerifyFacts& facts,
                       const std::vector<Comparison>& comparisons, Progress& progress) {
  Json out{{"asset", facts.asset},
           {"generator", facts.generator},
           {"lights", facts.lights},
           {"typed", facts.typed}};
  out["comparisons"] = Json::array();
  std::vector<std::vector<ShownView>> shown;
  for (const Comparison& c : comparisons) {
    Json numbers{{"id", c.id}, {"title", c.title}};
    numbers.update(c.numbers);
    numbers["views"] = Json::array();
    shown.emplace_back();
    for (const ComparedView& view : c.views) {
      progress.throwIfCancelled();
      shown.back().push_back(show(folder, c.id, view));
      numbers["views"].push_back(jsonOf(shown.back().back()));
    }
    out["comparisons"].push_back(std::move(numbers));
  }
  writeFileAtomically(folder / "report.html", verifyPage(facts, comparisons, shown));
  writeFileAtomically(folder / "report.json", out.dump(1) + "\n");
}

}  // namespace relume::app
