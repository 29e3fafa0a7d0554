// SPDX-License-Identifier: MIT
#include "day_inspection.h"

#include <fmt/format.h>

#include <algorithm>

#include "relume/core/day.h"
#include "relume/core/file.h"
#include "relume/image/plot.h"

namespace relume::app {
namespace {

using Json = nlohmann::ordered_json;

/// Share of the variance that so many components hold, from 1 up.
std::vector<double> heldBy(const asset::DayFrames& frames) {
  std::vector<double> held;
  double sum = 0;
  for (const float v : frames.variance) held.push_back(sum += static_cast<double>(v));
  return held;
}

}  // namespace

Json describeDay(const asset::DayFrames& frames) {
  Json out;
  out["keyframes"] = Json::array();
  for (const double m : frames.minutes) out["keyframes"].push_back({{"minutes", m}, {"time", clockText(m)}});
  out["receivers"] = frames.size();
  out["components"] = frames.series.rank;
  out["variance"] = heldBy(frames);
  return out;
}

void printDay(const asset::DayFrames& frames) {
  const std::vector<double> held = heldBy(frames);
  const std::size_t rank = frames.series.rank;
  fmt::print(
      "  {} keyframes, {} components that hold {:.3f} % of the variance; 10 would hold {:.2f} %, 20 {:.2f} "
      "%\n",
      frames.minutes.size(), rank, rank > 0 && rank <= held.size() ? held[rank - 1] * 100 : 0.0,
      held.empty() ? 0.0 : held[std::min<std::size_t>(10, held.size()) - 1] * 100,
      held.empty() ? 0.0 : held[std::min<std::size_t>(20, held.size()) - 1] * 100);
  for (std::size_t k = 0; k < frames.minutes.size();) {
    const auto hour = static_cast<int>(frames.minutes[k] / 60);
    std::string line;
    for (; k < frames.minutes.size() && static_cast<int>(frames.minutes[k] / 60) == hour; ++k)
      line += " " + clockText(frames.minutes[k]);
    fmt::print("   {}\n", line);
  }
}

void plotDay(const asset::DayFrames& frames, const std::string& name, const std::filesystem::path& folder) {
  image::Plot intervals{.title = "Keyframes through the day",
                        .x = {.label = "time of the day (h)", .range = {{0, 24}}},
                        .y = {.label = "minutes to the next keyframe", .logarithmic = true}};
  image::Series steps{.name = "", .markers = false};
  for (std::size_t k = 0; k + 1 < frames.minutes.size(); ++k) {
    const double width = frames.minutes[k + 1] - frames.minutes[k];
    for (const double m : {frames.minutes[k], frames.minutes[k + 1]})
      steps.x.push_back(m / 60), steps.y.push_back(width);
  }
  intervals.series = {steps};
  writeFileAtomically(folder / (name + "-intervals.svg"), image::svgPlot(intervals));

  image::Plot spectrum{.title = "What components hold",
                       .x = {.label = "component"},
                       .y = {.label = "share of the variance", .logarithmic = true}};
  image::Series shares{.name = "each component", .markers = true},
      left{.name = "what is left after it", .markers = false};
  double rest = 1;
  for (std::size_t c = 0; c < frames.variance.size(); ++c) {
    const auto v = static_cast<double>(frames.variance[c]);
    constexpr double kNoise = 1e-10;
    if (v < kNoise) break;
    rest -= v;
    shares.x.push_back(static_cast<double>(c + 1)), shares.y.push_back(v);
    left.x.push_back(static_cast<double>(c + 1)), left.y.push_back(std::max(rest, 0.0));
  }
  spectrum.series = {shares, left};
  writeFileAtomically(folder / (name + "-spectrum.svg"), image::svgPlot(spectrum));
}

}  // namespace relume::app
