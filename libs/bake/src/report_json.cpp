// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "relume/bake/report.h"

namespace relume::bake {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const asset::Parameter& parameter) {
  if (const double* v = std::get_if<double>(&parameter)) {
    if (std::isinf(*v)) return "inf";  // JSON has no infinity; the word is what --layer reads
    if (*v == std::floor(*v) && std::abs(*v) < 1e15) return static_cast<std::int64_t>(*v);
  }
  return std::visit([](const auto& v) { return Json(v); }, parameter);
}

Json toJson(const Parameters& parameters) {
  Json out = Json::object();
  for (const auto& [key, value] : parameters) out[key] = toJson(value);
  return out;
}

Json toJson(const Histogram& histogram) { return {{"edges", histogram.edges}, {"counts", histogram.counts}}; }

Json toJson(const SeamError& error) { return {{"rms", error.rms}, {"max", error.max}}; }

Json signsOf(std::uint8_t signs) {
  Json out = Json::array();
  if (signs & kStandsOut) out.push_back("stands out");
  if (signs & kBesideInvalid) out.push_back("beside invalid texels");
  if (signs & kSeesBacks) out.push_back("sees back faces");
  return out;
}

Json toJson(const Suspect& s) {
  return {{"texel", s.texel},
          {"chart", s.chart},
          {"position", {s.position.x, s.position.y, s.position.z}},
          {"value", s.value},
          {"suggested", s.suggested},
          {"severity", s.severity},
          {"signs", signsOf(s.signs)}};
}

Json toJson(const LayerReport& layer) {
  Json out{{"name", layer.name},
           {"kind", layer.kind},
           {"parameters", toJson(layer.parameters)},
           {"mean_value", layer.mean_value},
           {"rms_error", layer.rms_error},
           {"max_error", layer.max_error},
           {"invalid_texels", layer.invalid_texels}};
  out["charts"] = Json::array();
  for (const ChartError& c : layer.charts)
    out["charts"].push_back({{"rms_error", c.rms}, {"max_error", c.max}, {"mean_value", c.mean_value}});
  out["chart_errors"] = toJson(layer.chart_errors);
  out["seams"] = {{"samples", layer.seams_before.samples},
                  {"before", toJson(layer.seams_before)},
                  {"after", toJson(layer.seams_after)}};
  out["suspects"] = {{"stand_out", layer.stand_out},
                     {"beside_invalid", layer.beside_invalid},
                     {"see_back_faces", layer.see_backs},
                     {"worst", Json::array()}};
  for (const Suspect& s : layer.suspects) out["suspects"]["worst"].push_back(toJson(s));
  return out;
}

}  // namespace

std::string toJson(const Report& report) {
  Json out;
  out["settings"] = toJson(report.settings);
  out["objects"] = Json::array();
  for (const ObjectReport& o : report.objects)
    out["objects"].push_back({{"name", o.name},
                              {"charts", o.charts},
                              {"texels", o.texels},
                              {"invalid_texels", o.invalid_texels},
                              {"area", o.area},
                              {"texels_per_metre", o.texels_per_metre}});
  out["charts"] = Json::array();
  for (const ChartReport& c : report.charts)
    out["charts"].push_back({{"object", c.object},
                             {"page", c.page},
                             {"x", c.x},
                             {"y", c.y},
                             {"width", c.width},
                             {"height", c.height},
                             {"texels", c.texels},
                             {"invalid_texels", c.invalid_texels},
                             {"mean_stretch", c.mean_stretch},
                             {"max_stretch", c.max_stretch}});
  out["texel_density"] = {{"unit", "texels per metre"},
                          {"median", report.median_density},
                          {"low", report.low_density},
                          {"high", report.high_density},
                          {"histogram", toJson(report.texel_density)}};
  out["layers"] = Json::array();
  for (const LayerReport& layer : report.layers) out["layers"].push_back(toJson(layer));
  return out.dump(1) + "\n";
}

}  // namespace relume::bake
