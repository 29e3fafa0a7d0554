// SPDX-License-Identifier: MIT
#include "relit_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report_charts.h"
#include "report_parts.h"

namespace relume::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kGood = 0.05, kBad = 0.15;  // mean error

std::string share(double x) { return fmt::format("{:.2f} %", 100 * x); }

const char* colourOf(double error) { return error < kGood ? "good" : error < kBad ? "watch" : "bad"; }

}  // namespace

double unexplained(const RelitVerification& v, const asset::TransferErrors& e) {
  const auto square = [](double x) { return x * x; };
  const double explained = square(static_cast<double>(e.entries)) + square(static_cast<double>(e.transfer)) +
                           square(static_cast<double>(e.encoding));
  return std::sqrt(std::max(square(v.median) - explained, 0.0));
}

namespace {

/// The parameter that lessens the largest part.
std::string remedyOf(const RelitVerification& v, const asset::TransferErrors& e) {
  const std::array<std::pair<double, const char*>, 4> parts = {
      {{static_cast<double>(e.entries), "irradiance is taken at too few entries: raise <code>count=</code>"},
       {static_cast<double>(e.transfer),
        "the transfer is noisy: raise <code>rays=</code> (of random walks <code>walks=</code>)"},
       {static_cast<double>(e.encoding), "the encoding takes most: lower <code>error=</code>"},
       {unexplained(v, e),
        "what is left comes from interpolation between exits, and from small elements: raise "
        "<code>size=</code> (of probes lower <code>spacing=</code>), or take a higher quality"}}};
  return std::string("Largest part of the error: ") +
         std::max_element(parts.begin(), parts.end(),
                          [](const auto& a, const auto& b) { return a.first < b.first; })
             ->second +
         ".";
}

}  // namespace

Json toJson(const RelitVerification& v, const std::optional<asset::TransferErrors>& errors) {
  Json out{{"layer", v.layer},
           {"points", v.points},
           {"paths", v.paths},
           {"spacing", v.spacing},
           {"median_error", v.median},
           {"mean_error", v.mean},
           {"worst_error", v.worst},
           {"encoding_error", v.error_estimate},
           {"median_error_of_99_percent", v.median_rest}};
  if (errors)
    out["causes"] = {{"entries", errors->entries},
                     {"transfer_noise", errors->transfer},
                     {"encoding", errors->encoding},
                     {"rest_of_median", unexplained(v, *errors)}};
  out["lamps"] = Json::array();
  for (const LampAgreement& lamp : v.lamps) {
    const Point p = lamp.lamp.position;
    out["lamps"].push_back({{"position", {p.x, p.y, p.z}},
                            {"clearance", lamp.clearance},
                            {"error", lamp.error},
                            {"error_of_99_percent", lamp.rest},
                            {"bias", lamp.bias}});
  }
  return out;
}

Comparison compareRelit(const RelitVerification& v, const std::optional<asset::TransferErrors>& errors) {
  Comparison c;
  c.id = "relit", c.title = fmt::format("Layer {}: lamps that were not there", escapeHtml(v.layer));
  c.summary = fmt::format(
      "Indirect irradiance that the run time makes of {} random point lamps, each alone, beside path tracing "
      "at {} "
      "places all over the baked surfaces: {:.1f} million paths. An error is the root of the summed squares "
      "of what "
      "is wrong over that of what is true, the truth's noise taken off. An entry of light is {:.2f} m wide.",
      v.lamps.size(), v.points, 1e-6 * static_cast<double>(v.paths), v.spacing);
  c.figures = {
      {share(v.median), "error under the median lamp", colourOf(v.median)},
      {share(v.mean), "error in the mean over lamps", colourOf(v.mean)},
      {share(v.worst), "error under the worst lamp", ""},
      {share(v.median_rest), "under the median lamp without the hundredth of places most wrong", ""}};
  if (errors) {
    const auto part = [&](double x, const char* what) { c.figures.push_back({share(x), what, ""}); };
    part(static_cast<double>(errors->entries),
         "of it from taking irradiance at entries, as the bake measured");
    part(static_cast<double>(errors->transfer), "of it noise of the transfer, as the bake measured");
    part(static_cast<double>(errors->encoding), "of it from encoding, as the bake measured");
    part(unexplained(v, *errors), "left of the median: interpolation between exits, and elements");
  } else {
    c.figures.push_back({share(v.error_estimate), "of it from encoding, as the bake measured", ""});
  }
  if (v.mean > kGood && errors)
    c.findings.push_back({remedyOf(v, *errors), colourOf(v.mean)});
  else if (v.mean > kGood)
    c.findings.push_back(
        {"More entries (<code>count=</code>) help lamps near walls; a smaller "
         "<code>error=</code> helps where encoding is a large part.",
         colourOf(v.mean)});
  else
    c.findings.push_back({"Nothing needs a second look.", "good"});
  Comparison::Table table{
      .title = "Lamps",
      .text = "The worst first. Lamps nearer to a surface than an entry is wide are hard.",
      .head = {"Lamp at, m", "Nearest surface, m", "Error", "Of 99 % of places", "Bias"}};
  std::vector<const LampAgreement*> order;
  for (const LampAgreement& lamp : v.lamps) order.push_back(&lamp);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->error > b->error; });
  for (const LampAgreement* lamp : order) {
    const Point p = lamp->lamp.position;
    table.rows.push_back({fmt::format("{:.2f}, {:.2f}, {:.2f}", p.x, p.y, p.z),
                          fmt::format("{:.2f}", lamp->clearance), share(lamp->error), share(lamp->rest),
                          fmt::format("{:+.2f} %", 100 * lamp->bias)});
  }
  c.tables.push_back(std::move(table));
  c.numbers = toJson(v, errors);
  return c;
}

}  // namespace relume::app
