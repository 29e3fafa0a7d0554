// SPDX-License-Identifier: MIT
#include "relit_comparison.h"

#include <fmt/format.h>

#include <algorithm>

#include "report_charts.h"
#include "report_parts.h"

namespace relume::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kGood = 0.05, kBad = 0.15;  // mean error

std::string share(double x) { return fmt::format("{:.2f} %", 100 * x); }

const char* colourOf(double error) { return error < kGood ? "good" : error < kBad ? "watch" : "bad"; }

}  // namespace

Json toJson(const RelitVerification& v) {
  Json out{{"layer", v.layer},         {"points", v.points},
           {"paths", v.paths},         {"spacing", v.spacing},
           {"median_error", v.median}, {"mean_error", v.mean},
           {"worst_error", v.worst},   {"encoding_error", v.error_estimate}};
  out["lamps"] = Json::array();
  for (const LampAgreement& lamp : v.lamps) {
    const Point p = lamp.lamp.position;
    out["lamps"].push_back({{"position", {p.x, p.y, p.z}},
                            {"clearance", lamp.clearance},
                            {"error", lamp.error},
                            {"bias", lamp.bias}});
  }
  return out;
}

Comparison compareRelit(const RelitVerification& v) {
  Comparison c;
  c.id = "relit", c.title = fmt::format("Layer {}: lamps that were not there", escapeHtml(v.layer));
  c.summary = fmt::format(
      "Indirect irradiance that the run time makes of {} random point lamps, each alone, beside path tracing "
      "at {} "
      "places all over the baked surfaces: {:.1f} million paths. An error is the root of the summed squares "
      "of what "
      "is wrong over that of what is true, the truth's noise taken off. An entry of light is {:.2f} m wide.",
      v.lamps.size(), v.points, 1e-6 * static_cast<double>(v.paths), v.spacing);
  c.figures = {{share(v.median), "error under the median lamp", colourOf(v.median)},
               {share(v.mean), "error in the mean over lamps", colourOf(v.mean)},
               {share(v.worst), "error under the worst lamp", ""},
               {share(v.error_estimate), "of it from encoding, as the bake measured", ""}};
  if (v.mean > kGood)
    c.findings.push_back(
        {"More entries (<code>count=</code>) help lamps near walls; a smaller "
         "<code>error=</code> helps where encoding is a large part.",
         colourOf(v.mean)});
  else
    c.findings.push_back({"Nothing needs a second look.", "good"});
  Comparison::Table table{
      .title = "Lamps",
      .text = "The worst first. Lamps nearer to a surface than an entry is wide are hard.",
      .head = {"Lamp at, m", "Nearest surface, m", "Error", "Bias"}};
  std::vector<const LampAgreement*> order;
  for (const LampAgreement& lamp : v.lamps) order.push_back(&lamp);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->error > b->error; });
  for (const LampAgreement* lamp : order) {
    const Point p = lamp->lamp.position;
    table.rows.push_back({fmt::format("{:.2f}, {:.2f}, {:.2f}", p.x, p.y, p.z),
                          fmt::format("{:.2f}", lamp->clearance), share(lamp->error),
                          fmt::format("{:+.2f} %", 100 * lamp->bias)});
  }
  c.tables.push_back(std::move(table));
  c.numbers = toJson(v);
  return c;
}

}  // namespace relume::app
