// SPDX-License-Identifier: MIT
#include "lightmap_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lightmap_truth.h"
#include "lightmap_views.h"
#include "report_charts.h"
#include "report_parts.h"

namespace relume::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSmallBias = 0.01, kSmallError = 0.1;  // shares from which a figure is no longer green
constexpr double kLargeBias = 0.05;
constexpr double kSure = 3;  // standard errors from which a bias is believed

std::string signedPercent(double share) { return fmt::format("{:+.2f} %", 100 * share); }
std::string withError(double share, double error) {
  return fmt::format("{:+.2f} ± {:.2f} %", 100 * share, 100 * error);
}

Json toJson(const Agreement& a) {
  return {{"points", a.points},
          {"mean_baked", a.mean_baked},
          {"mean_true", a.mean_true},
          {"relative_bias", a.bias},
          {"relative_bias_error", a.bias_error},
          {"relative_rmse", a.rmse},
          {"relative_rmse_error", a.rmse_error},
          {"truth_noise", a.truth_noise}};
}

std::string summaryOf(const Verification& v, const asset::Layer& layer) {
  std::string parameters;
  for (const char* key : {"part", "materials", "solver"})
    if (const auto found = layer.parameters.find(key); found != layer.parameters.end())
      parameters += fmt::format("{}{} {}", parameters.empty() ? "" : ", ", key,
                                escapeHtml(std::get<std::string>(found->second)));
  return fmt::format(
      "Irradiance of the layer {} ({}), read as a viewer does, beside path tracing at {} places that are "
      "spread evenly over the baked surfaces: {:.1f} million paths. Places inside other geometry, cut out by "
      "alpha or on coinciding surfaces have no single truth and were left out ({}). The noise of the truth "
      "is "
      "taken off the errors.",
      escapeHtml(layer.name), parameters, v.points, 1e-6 * static_cast<double>(v.paths), v.skipped);
}

std::vector<Comparison::Figure> figuresOf(const Verification& v) {
  const double bias = std::abs(v.bias) - kSure * v.bias_error;
  std::vector<double> sizes;
  for (const double d : v.differences) sizes.push_back(std::abs(d));
  std::sort(sizes.begin(), sizes.end());
  const auto within = [&](double share) {
    return sizes[static_cast<std::size_t>(share * static_cast<double>(sizes.size() - 1))];
  };
  return {
      {signedPercent(v.bias),
       fmt::format("bias: mean of the bake against the mean of the truth, known to ± {:.2f} %",
                   100 * v.bias_error),
       bias > kLargeBias   ? "bad"
       : bias > kSmallBias ? "watch"
                           : "good"},
      {fmt::format("{:.1f} %", 100 * v.rmse),
       fmt::format("error at a place (RMS, share of the mean), ± {:.1f} %; what the texels' size costs "
                   "is in it",
                   100 * v.rmse_error),
       v.rmse > kSmallError ? "watch" : "good"},
      {fmt::format("{:.1f} %", 100 * within(0.5)),
       fmt::format("of the mean: half of the places are nearer to the truth, 19 of 20 nearer than {:.1f} % "
                   "(noise of the truth included)",
                   100 * within(0.95)),
       ""},
      {fmt::format("{:.1f} %", 100 * v.error_estimate), "noise, by the bake's own estimate", ""},
      {shortNumber(v.mean_true),
       fmt::format("mean true irradiance; the bake has {}", shortNumber(v.mean_baked)), ""}};
}

std::vector<Comparison::Finding> findingsOf(const Verification& v) {
  std::vector<Comparison::Finding> findings;
  if (std::abs(v.bias) > kSmallBias + kSure * v.bias_error)
    findings.push_back(
        {fmt::format(
             "The bake is too {} on the whole, by {:.1f} %. Is <code>--lights</code> the file that it "
             "was baked with?",
             v.bias > 0 ? "bright" : "dark", 100 * std::abs(v.bias)),
         std::abs(v.bias) > kLargeBias ? "bad" : "watch"});
  if (!v.worst.empty()) {
    const Verification::Place& p = v.worst.front();
    findings.push_back(
        {fmt::format("The place that is most wrong lies on <b>{}</b> at ({:.2f}, {:.2f}, {:.2f}): "
                     "{} where {} is true.",
                     escapeHtml(p.object), p.position.x, p.position.y, p.position.z, shortNumber(p.baked),
                     shortNumber(p.truth)),
         "watch"});
  }
  if (findings.empty()) findings.push_back({"Nothing needs a second look.", "good"});
  return findings;
}

Comparison::Table objectTable(const Verification& v) {
  Comparison::Table table{
      .title = "Objects",
      .text =
          "Errors in shares of each object's own mean irradiance; those that make most of the "
          "scene's error come first. A bias in grey is within its own error.",
      .head = {"Object", "Places", "Irradiance, true", "baked", "Bias", "Error"}};
  std::vector<const ObjectAgreement*> objects;
  for (const ObjectAgreement& o : v.objects) objects.push_back(&o);
  const auto squares = [](const ObjectAgreement* o) {
    return static_cast<double>(o->points) * o->rmse * o->rmse * o->mean_true * o->mean_true;
  };
  std::stable_sort(objects.begin(), objects.end(),
                   [&](const auto* a, const auto* b) { return squares(a) > squares(b); });
  for (const ObjectAgreement* o : objects) {
    const bool sure = std::abs(o->bias) > kSure * o->bias_error;
    table.rows.push_back(
        {escapeHtml(o->object), fmt::format("{}", o->points), shortNumber(o->mean_true),
         shortNumber(o->mean_baked),
         fmt::format("<span class={}>{}</span>", sure ? "sure" : "soft", withError(o->bias, o->bias_error)),
         fmt::format("{:.1f} %", 100 * o->rmse)});
  }
  return table;
}

Comparison::Table worstTable(const Verification& v) {
  Comparison::Table table{.title = "The places that are most wrong",
                          .text = "Of those that the noise of the truth does not explain.",
                          .head = {"Object", "Place in the world, m", "Baked", "True", "Noise of the truth"},
                          .first_number = 2};
  for (const Verification::Place& p : v.worst)
    table.rows.push_back({escapeHtml(p.object),
                          fmt::format("{:.2f}, {:.2f}, {:.2f}", p.position.x, p.position.y, p.position.z),
                          shortNumber(p.baked), shortNumber(p.truth), "± " + shortNumber(p.truth_error)});
  return table;
}

std::string plotOf(const Verification& v) {
  constexpr int kBins = 40;
  bake::Histogram histogram;
  for (int i = 0; i <= kBins; ++i) histogram.edges.push_back(-0.5 + static_cast<double>(i) / kBins);
  histogram.counts.assign(kBins, 0);
  for (const double d : v.differences)
    ++histogram.counts[static_cast<std::size_t>(std::clamp((d + 0.5) * kBins, 0.0, kBins - 1.0))];
  return "<h3>How far off places are</h3>\n" +
         svgHistogram({.histogram = histogram,
                       .axis =
                           "baked − true, in shares of the mean irradiance; what is beyond is in the last "
                           "bars",
                       .items = "places",
                       .marker = 0.0,
                       .marker_label = "right"}) +
         fmt::format("<p class=soft>The truth's own noise is in this picture: {:.1f} % RMS at a place.</p>\n",
                     100 * v.truth_noise);
}

}  // namespace

Json toJson(const Verification& v) {
  Json out{{"layer", v.layer}};
  out.update(toJson(static_cast<const Agreement&>(v)));
  out["skipped"] = v.skipped, out["paths"] = v.paths, out["error_estimate"] = v.error_estimate;
  out["worst"] = Json::array();
  for (const Verification::Place& p : v.worst)
    out["worst"].push_back({{"object", p.object},
                            {"position", {p.position.x, p.position.y, p.position.z}},
                            {"baked", p.baked},
                            {"true", p.truth},
                            {"true_error", p.truth_error}});
  out["objects"] = Json::array();
  for (const ObjectAgreement& o : v.objects) {
    Json object{{"name", o.object}};
    object.update(toJson(static_cast<const Agreement&>(o)));
    out["objects"].push_back(std::move(object));
  }
  return out;
}

Comparison compareLightmap(const scene::Scene& scene, const asset::Asset& asset,
                           const Verification& verification, const VerifyOptions& options,
                           const ViewOptions& views, Progress& progress) {
  const asset::Layer& layer = lightmapOf(asset, verification.layer);
  Comparison comparison{.id = layer.name,
                        .title = layer.name == layer.kind ? "Lightmap" : "Lightmap " + layer.name};
  comparison.summary = summaryOf(verification, layer);
  comparison.figures = figuresOf(verification);
  comparison.findings = findingsOf(verification);
  comparison.plots = plotOf(verification);
  comparison.tables.push_back(objectTable(verification));
  if (!verification.worst.empty()) comparison.tables.push_back(worstTable(verification));
  comparison.numbers = toJson(verification);

  const transport::Reference reference(scene);
  const auto cameras = std::clamp<std::size_t>(scene.cameras.size(), 1, views.most);
  const float aspect = static_cast<float>(views.size.x) / static_cast<float>(views.size.y);
  for (std::size_t camera = 0; camera < cameras; ++camera) {
    const auto viewpoint = picture::defaultViewpoint(reference.tracer(), static_cast<int>(camera), aspect);
    ComparedView view = lightmapView(reference, asset, layer, viewpoint, views, options.seed, progress);
    view.name = fmt::format("view{}", camera);
    view.caption =
        scene.cameras.empty() ? "The scene as a whole" : fmt::format("Camera {} of the file", camera);
    comparison.views.push_back(std::move(view));
  }
  return comparison;
}

}  // namespace relume::app
