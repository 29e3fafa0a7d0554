// SPDX-License-Identifier: MIT
#include "report_gather.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "leak_suspects.h"
#include "report_numbers.h"

namespace relume::bake {
namespace {

Parameters settingsOf(const BakeOptions& options, const QualitySettings& quality, const atlas::Atlas& atlas) {
  const atlas::AtlasOptions& a = options.atlas;
  return {
      {"quality", std::string(name(options.quality))},
      {"samples_min", static_cast<double>(quality.min_samples)},
      {"samples_max", static_cast<double>(quality.max_samples)},
      {"target_error", static_cast<double>(quality.target_error)},
      {"smoothing", quality.filter},
      {"atlas_size", static_cast<double>(a.page_size)},
      {"texel_density", a.texels_per_metre > 0 ? static_cast<double>(a.texels_per_metre)
                                               : static_cast<double>(atlas.statistics.texels_per_metre)},
      {"texel_density_chosen_by", std::string(a.texels_per_metre > 0 ? "user" : "atlas size")},
      {"gutter", static_cast<double>(a.gutter)},
      {"keep_valid_uv1", a.reuse_uv1},
      {"chart_discontinuity_angle", static_cast<double>(a.discontinuity_angle)},
      {"chart_cone_angle", static_cast<double>(a.cone_angle)},
      {"seed", static_cast<double>(options.seed)},
      {"isa", options.isa.empty() ? std::string("best of the machine") : options.isa},
      {"cache", !options.cache.empty()},
      {"max_memory",
       options.max_memory ? static_cast<double>(options.max_memory) : static_cast<double>(kInfinity)},
  };
}

// What a scene calls an instance: the node, and the primitive where its mesh has several.
std::string nameOf(const scene::Scene& scene, const scene::Instance& instance) {
  const std::string& mesh = scene.meshes[instance.mesh].name;
  const std::size_t bracket = mesh.ends_with(']') ? mesh.rfind('[') : std::string::npos;
  return bracket == std::string::npos ? instance.name : instance.name + mesh.substr(bracket);
}

// Quarters of octaves, three octaves to each side; the middle is in the middle of a bin.
std::vector<double> densityEdges(double middle) {
  std::vector<double> edges;
  for (int i = -12; i <= 13; ++i) edges.push_back(middle * std::exp2((i - 0.5) / 4));
  return edges;
}

std::vector<double> evenEdges(double last, int bins) {
  std::vector<double> edges;
  for (int i = 0; i <= bins; ++i) edges.push_back(last * i / bins);
  return edges;
}

}  // namespace

ReportGatherer::ReportGatherer(const Prepared& prepared, const BakeOptions& options)
    : prepared_(prepared), point_of_texel_(pointsByTexel(prepared.texels)) {
  report_.settings = settingsOf(options, prepared.quality, prepared.atlas);
  std::map<std::uint32_t, std::uint32_t> object_of_instance;
  for (const atlas::InstanceUv& uv : prepared.atlas.instances) {
    object_of_instance[uv.instance] = static_cast<std::uint32_t>(report_.objects.size());
    report_.objects.push_back({.name = nameOf(prepared.scene, prepared.scene.instances[uv.instance])});
  }
  for (const atlas::Chart& chart : prepared.atlas.charts) {
    const std::uint32_t object = object_of_instance.at(chart.instance);
    ++report_.objects[object].charts;
    report_.charts.push_back({.object = object,
                              .page = chart.page,
                              .x = chart.first_texel_x,
                              .y = chart.first_texel_y,
                              .width = chart.width,
                              .height = chart.height,
                              .mean_stretch = chart.mean_stretch,
                              .max_stretch = chart.max_stretch});
  }
  std::vector<double> densities;
  std::vector<std::vector<double>> of_object(report_.objects.size());
  for (const atlas::SurfacePoint& p : prepared.texels.points) {
    ChartReport& chart = report_.charts[p.chart];
    ObjectReport& object = report_.objects[chart.object];
    ++chart.texels, ++object.texels;
    object.area += p.area;
    if (const double density = texelDensity(p); density > 0)
      densities.push_back(density), of_object[chart.object].push_back(density);
  }
  report_.median_density = quantile(densities, 0.5);
  report_.low_density = quantile(densities, 0.05);
  report_.high_density = quantile(densities, 0.95);
  report_.texel_density =
      histogramOf(densities, densityEdges(report_.median_density > 0 ? report_.median_density : 1));
  for (std::size_t i = 0; i < of_object.size(); ++i)
    report_.objects[i].texels_per_metre = quantile(of_object[i], 0.5);
}

LayerReport& ReportGatherer::add(const PreparedLayer& prepared, const PointLayer& layer) {
  LayerReport& out = report_.layers.emplace_back();
  out.name = prepared.name, out.kind = prepared.kind->name, out.parameters = prepared.parameters;
  out.charts = chartErrors(prepared_.texels, layer, report_.charts.size());
  const PointPlane& plane = layer.planes.front();
  const auto channels = static_cast<std::size_t>(plane.channels);
  double values = 0, squares = 0;
  std::size_t valid = 0;
  std::vector<std::size_t> valid_texels(report_.charts.size());
  for (std::size_t i = 0; i < layer.valid.size(); ++i) {
    if (!layer.valid[i]) continue;
    for (std::size_t c = 0; c < channels; ++c) values += plane.values[i * channels + c];
    squares += static_cast<double>(layer.error[i]) * layer.error[i];
    ++valid, ++valid_texels[prepared_.texels.points[i].chart];
  }
  if (valid > 0) {
    out.mean_value = values / static_cast<double>(valid * channels);
    out.rms_error = std::sqrt(squares / static_cast<double>(valid));
  }
  std::vector<double> errors;
  for (std::size_t c = 0; c < out.charts.size(); ++c) {
    if (valid_texels[c] == 0) continue;
    errors.push_back(out.charts[c].rms);
    out.max_error = std::max(out.max_error, out.charts[c].max);
  }
  const double most = errors.empty() ? 0 : *std::max_element(errors.begin(), errors.end());
  out.chart_errors = histogramOf(errors, evenEdges(most > 0 ? most : 1, 24));
  findSuspects(prepared_.texels, point_of_texel_, layer, out);
  out.errors = layer.error;
  return out;
}

Report ReportGatherer::take(std::span<const std::uint8_t> valid) {
  for (std::size_t i = 0; i < valid.size(); ++i) {
    if (valid[i]) continue;
    ChartReport& chart = report_.charts[prepared_.texels.points[i].chart];
    ++chart.invalid_texels, ++report_.objects[chart.object].invalid_texels;
  }
  return std::move(report_);
}

}  // namespace relume::bake
