// SPDX-License-Identifier: MIT
#include "occlusion_layers.h"

#include <cmath>

#include "relume/core/check.h"
#include "relume/transport/occlusion.h"

namespace relume::bake {
namespace {

using transport::DistanceWeight;
using transport::OcclusionKind;
using transport::OcclusionOptions;

// The row of a texel: value[channels], bent[3] if asked for, error, share of back faces.
struct RowLayout {
  int channels = 1;
  bool bent = false;
  int size() const { return channels + (bent ? 3 : 0) + 2; }
  int errorAt() const { return size() - 2; }
  int backAt() const { return size() - 1; }
};

enum class Correction : std::uint8_t { kNone, kStewartLanger, kJimenez };

Correction correctionOf(const Parameters& parameters) {
  const auto found = parameters.find("correction");
  if (found == parameters.end()) return Correction::kNone;
  const std::string& text = std::get<std::string>(found->second);
  return text == "jimenez"          ? Correction::kJimenez
         : text == "stewart-langer" ? Correction::kStewartLanger
                                    : Correction::kNone;
}

float corrected(Correction correction, float k, float albedo) {
  return correction == Correction::kJimenez ? transport::correctedJimenez(k, albedo)
                                            : transport::correctedStewartLanger(k, albedo);
}

DistanceWeight weightOf(const Parameters& parameters) {
  DistanceWeight weight;
  weight.limit = static_cast<float>(std::get<double>(parameters.at("distance")));
  weight.tau = static_cast<float>(std::get<double>(parameters.at("tau")));
  const std::string& shape = std::get<std::string>(parameters.at("shape"));
  weight.shape = shape == "linear"   ? DistanceWeight::Shape::kLinear
                 : shape == "sqrt"   ? DistanceWeight::Shape::kSqrt
                 : shape == "expcut" ? DistanceWeight::Shape::kExponentialCut
                                     : DistanceWeight::Shape::kExponential;
  return weight;
}

// The mean albedo enters every spectral value. It is rounded so that the rounding errors of a moved object's
// areas do not make every texel of the scene stale.
Albedo roundedMeanAlbedo(const atlas::Texels& texels) {
  return Albedo(glm::round(transport::meanAlbedo(texels).rgb * 1024.0f) / 1024.0f);
}

Digest keyOf(const OcclusionOptions& o, const RowLayout& layout) {
  return Hasher()
      .add("occlusion 5")  // raise when the solver's results change
      .add(o.kind)
      .add(o.weight.shape)
      .add(o.weight.tau)
      .add(o.weight.limit)
      .add(o.bent_normal)
      .add(o.mean_albedo.rgb)
      .add(o.min_samples)
      .add(o.max_samples)
      .add(o.target_error)
      .add(o.smoothed)
      .add(o.seed)
      .add(layout.channels)
      .digest();
}

PointLayer finishRows(const RowLayout& layout, Correction correction, const atlas::Texels& texels,
                      bool filter, std::span<const float> rows) {
  const std::size_t points = texels.points.size(), row = static_cast<std::size_t>(layout.size());
  RELUME_CHECK_EQ(rows.size(), points * row);
  const auto channels = static_cast<std::size_t>(layout.channels);
  PointLayer layer;
  PointPlane value{
      .name = "value", .channels = layout.channels, .unit_interval = layout.channels == 1, .values = {}};
  PointPlane bent{.name = "bent", .channels = 3, .direction = true, .values = {}};
  value.values.resize(points * channels);
  if (layout.bent) bent.values.resize(points * 3);
  layer.error.resize(points), layer.valid.resize(points), layer.back_share.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    const float* r = rows.data() + i * row;
    for (std::size_t c = 0; c < channels; ++c) value.values[i * channels + c] = r[c];
    for (std::size_t c = 0; layout.bent && c < 3; ++c) bent.values[i * 3 + c] = r[channels + c];
    layer.error[i] = r[layout.errorAt()];
    layer.back_share[i] = r[layout.backAt()];
    layer.valid[i] = layer.back_share[i] <= transport::kBuriedShare;
  }
  if (filter) {
    std::vector<float> left(points);
    transport::filterTexels(texels, layer.error, layer.valid, layout.channels, value.values, left);
    if (layout.bent) transport::filterTexels(texels, layer.error, layer.valid, 3, bent.values);
    layer.error = std::move(left);
  }
  if (correction != Correction::kNone) {
    PointPlane rgb{
        .name = "value", .channels = 3, .unit_interval = true, .values = std::vector<float>(points * 3)};
    for (std::size_t i = 0; i < points; ++i)
      for (int c = 0; c < 3; ++c)
        rgb.values[i * 3 + static_cast<std::size_t>(c)] =
            corrected(correction, value.values[i], texels.points[i].albedo.rgb[c]);
    value = std::move(rgb);
  }
  layer.planes.push_back(std::move(value));
  if (layout.bent) layer.planes.push_back(std::move(bent));
  return layer;
}

LayerJob makeJob(const LayerContext& context, const Parameters& parameters, OcclusionKind kind,
                 const DistanceWeight& weight) {
  const RowLayout layout{.channels = kind == OcclusionKind::kSpectral ? 3 : 1,
                         .bent = std::get<bool>(parameters.at("bent"))};
  const OcclusionOptions options{
      .kind = kind,
      .weight = weight,
      .bent_normal = layout.bent,
      .mean_albedo = kind == OcclusionKind::kSpectral ? roundedMeanAlbedo(context.texels) : Albedo(),
      .min_samples = context.quality.min_samples,
      .max_samples = context.quality.max_samples,
      .target_error = context.quality.target_error,
      .smoothed = context.quality.filter,
      .seed = context.seed,
  };
  const trace::Tracer& tracer = context.tracer;
  const atlas::Texels& texels = context.texels;
  LayerJob job;
  job.solver.row = layout.size();
  job.solver.reach = weight.limit;
  job.solver.most_rays = options.max_samples;
  job.solver.key = keyOf(options, layout);
  const auto solver = std::make_shared<transport::OcclusionSolver>(tracer, texels, options);
  job.solver.solve = [=](std::span<const std::uint32_t> which, std::span<float> rows, Progress& progress) {
    if (which.empty()) return std::uint64_t{0};
    const transport::OcclusionResult result = solver->solve(progress, which);
    const auto row = static_cast<std::size_t>(layout.size());
    for (std::size_t i = 0; i < which.size(); ++i) {
      float* r = rows.data() + i * row;
      for (int c = 0; c < layout.channels; ++c) *r++ = result.value[i][c];
      for (int c = 0; layout.bent && c < 3; ++c) *r++ = result.bent[i][c];
      *r++ = result.error[i];
      *r = result.back_share[i];
    }
    return result.rays;
  };
  const Correction correction = correctionOf(parameters);
  const bool filter = context.quality.filter;
  job.finish = [=, &texels](std::span<const float> rows) {
    return finishRows(layout, correction, texels, filter, rows);
  };
  return job;
}

}  // namespace

LayerJob prepareOcclusion(const LayerContext& context, const Parameters& parameters) {
  DistanceWeight weight;
  weight.shape = DistanceWeight::Shape::kStep;
  weight.limit = static_cast<float>(std::get<double>(parameters.at("distance")));
  return makeJob(context, parameters, OcclusionKind::kScalar, weight);
}

LayerJob prepareObscurance(const LayerContext& context, const Parameters& parameters) {
  return makeJob(context, parameters, OcclusionKind::kScalar, weightOf(parameters));
}

LayerJob prepareSpectral(const LayerContext& context, const Parameters& parameters) {
  return makeJob(context, parameters, OcclusionKind::kSpectral, weightOf(parameters));
}

}  // namespace relume::bake
