// SPDX-License-Identifier: MIT
#include "lightmap_layer.h"

#include <cmath>

#include "directional_planes.h"
#include "light_digest.h"
#include "photon_rows.h"
#include "relume/core/check.h"
#include "relume/core/error.h"
#include "relume/scene/light_groups.h"
#include "relume/transport/lightmap.h"
#include "relume/transport/occlusion.h"
#include "scene_digest.h"

namespace relume::bake {
namespace {

using transport::LightmapOptions;

// The row of a texel; behind it what a directional receiver sums up.
constexpr std::size_t kErrorAt = 3, kBackAt = 4, kRow = 5;

transport::RadiosityOptions radiosityOf(const Parameters& parameters) {
  using transport::RadiosityOptions;
  RadiosityOptions options;
  options.patch = static_cast<std::uint32_t>(std::get<double>(parameters.at("patch")));
  options.form_factors = std::get<std::string>(parameters.at("formfactors")) == "hemicube"
                             ? RadiosityOptions::FormFactors::kHemicube
                             : RadiosityOptions::FormFactors::kSampled;
  options.solution = std::get<std::string>(parameters.at("solution")) == "progressive"
                         ? RadiosityOptions::Solution::kProgressive
                         : RadiosityOptions::Solution::kGathering;
  return options;
}

LightmapOptions optionsOf(const LayerContext& context, const Parameters& parameters) {
  const std::string& part = std::get<std::string>(parameters.at("part"));
  const double bounces = std::get<double>(parameters.at("bounces"));
  LightmapOptions options;
  const std::string& solver = std::get<std::string>(parameters.at("solver"));
  options.method = solver == "path"        ? transport::LightmapMethod::kPath
                   : solver == "radiosity" ? transport::LightmapMethod::kRadiosity
                                           : transport::LightmapMethod::kGather;
  if (parameters.contains("patch")) options.radiosity = radiosityOf(parameters);
  options.part = part == "direct"     ? transport::Part::kDirect
                 : part == "indirect" ? transport::Part::kIndirect
                                      : transport::Part::kTotal;
  options.materials = std::get<std::string>(parameters.at("materials")) == "lambert"
                          ? transport::Materials::kLambert
                          : transport::Materials::kFull;
  options.max_bounces = bounces < 1e6 ? static_cast<int>(bounces) : transport::ReferenceOptions::kUnlimited;
  options.min_samples = context.quality.min_samples, options.max_samples = context.quality.max_samples;
  options.target_error = context.quality.target_error;
  options.smoothed = context.quality.filter;
  options.cache_samples = context.quality.cache_samples;
  options.seed = context.seed;
  return options;
}

Digest keyOf(const LightmapOptions& o, const scene::Scene& scene) {
  Hasher hasher;
  hasher
      .add("lightmap 3")  // raise when the solver's results change
      .add(o.method)
      .add(o.part)
      .add(o.materials)
      .add(o.max_bounces)
      .add(o.min_samples)
      .add(o.max_samples)
      .add(o.target_error)
      .add(o.smoothed)
      .add(o.cache_samples)
      .add(o.seed)
      .add(std::string_view(o.group));
  if (o.method == transport::LightmapMethod::kRadiosity)
    hasher
        .add("radiosity 1")  // as above
        .add(o.radiosity.patch)
        .add(o.radiosity.form_factors)
        .add(o.radiosity.solution)
        .add(o.radiosity.emission)
        .add(o.radiosity.rays)
        .add(o.radiosity.cube_resolution)
        .add(o.radiosity.residual);
  if (o.receiver) hasher.add("receiver 1").add(std::string_view(o.receiver->name()));  // raise likewise
  addLightsAndNormals(hasher, scene);
  return hasher.digest();
}

/// Fills what lies at `at` in rows of `row` floats.
std::uint64_t solveRows(transport::LightmapSolver& solver, std::span<const std::uint32_t> which,
                        std::span<float> rows, std::size_t row, std::size_t at, Progress& progress) {
  if (which.empty()) return 0;
  const transport::LightmapResult result = solver.solve(progress, which);
  for (std::size_t i = 0; i < which.size(); ++i) {
    float* out = rows.data() + i * row + at;
    for (int c = 0; c < 3; ++c) out[c] = result.value[i].rgb[c];
    out[kErrorAt] = result.error[i];
    out[kBackAt] = result.back_share[i];
    const std::size_t sums = result.sums.size() / which.size();
    std::copy_n(result.sums.data() + i * sums, sums, out + kRow);
  }
  return result.rays;
}

/// Rows as planes: irradiance, and where there are sums one of them.
PointLayer finishRows(const atlas::Texels& texels, bool filter, std::span<const float> rows,
                      std::size_t stride, std::size_t at, const std::string& name, std::size_t sums = 0) {
  const std::size_t points = texels.points.size(), channels = 3 + sums;
  RELUME_CHECK_EQ(rows.size(), points * stride);
  PointLayer layer;
  std::vector<float> values(points * channels);
  layer.error.resize(points), layer.valid.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    const float* row = rows.data() + i * stride + at;
    std::copy_n(row, 3, &values[i * channels]);
    std::copy_n(row + kRow, sums, &values[i * channels] + 3);
    layer.error[i] = row[kErrorAt];
    layer.valid[i] = row[kBackAt] <= transport::kBuriedShare;
  }
  if (filter) {
    // Sums are as linear in the light as irradiance is: what may be mixed of one may be mixed of the other.
    std::vector<float> left(points);
    transport::filterTexels(texels, layer.error, layer.valid, static_cast<int>(channels), values, left,
                            {.guides = 3});
    layer.error = std::move(left);
  }
  if (sums == 0) {
    layer.planes.push_back({.name = name, .channels = 3, .values = std::move(values)});
    return layer;
  }
  PointPlane value{.name = name, .channels = 3, .values = std::vector<float>(points * 3)};
  PointPlane rest{
      .name = "sums", .channels = static_cast<int>(sums), .values = std::vector<float>(points * sums)};
  for (std::size_t i = 0; i < points; ++i) {
    std::copy_n(&values[i * channels], 3, &value.values[i * 3]);
    std::copy_n(&values[i * channels] + 3, sums, &rest.values[i * sums]);
  }
  layer.planes.push_back(std::move(value)), layer.planes.push_back(std::move(rest));
  return layer;
}

TexelSolver gatherSolver(const LayerContext& context, const LightmapOptions& options, std::size_t row) {
  TexelSolver solver;
  solver.row = static_cast<int>(row);
  solver.key = keyOf(options, context.tracer.scene());
  const auto texels =
      std::make_shared<transport::LightmapSolver>(context.tracer, context.atlas, context.texels, options);
  solver.solve = [texels, row](std::span<const std::uint32_t> which, std::span<float> rows,
                               Progress& progress) {
    return solveRows(*texels, which, rows, row, 0, progress);
  };
  return solver;
}

}  // namespace

LayerJob prepareSums(const LayerContext& context, const Parameters& parameters,
                     std::shared_ptr<const basis::Basis> basis) {
  LightmapOptions options = optionsOf(context, parameters);
  options.receiver = basis;
  if (basis && options.method == transport::LightmapMethod::kPath)
    throw Error(ErrorCode::kUsage, "--layer lightmap", "solver=path knows irradiance alone",
                "leave receiver= away, or take solver=gather");
  const std::size_t sums = basis ? basis->sums() : 0, row = kRow + sums;
  LayerJob job;
  if (std::get<std::string>(parameters.at("solver")) == "photon")
    job.solver = photonSolver(context, photonOptionsOf(context, parameters, std::move(basis)));
  else
    job.solver = gatherSolver(context, options, row);
  job.finish = [&texels = context.texels, filter = context.quality.filter, row,
                sums](std::span<const float> rows) {
    return finishRows(texels, filter, rows, row, 0, "value", sums);
  };
  return job;
}

LayerJob prepareLightmap(const LayerContext& context, const Parameters& parameters) {
  const Receiver receiver = receiverOf(parameters);
  LayerJob job = prepareSums(context, parameters, receiver.basis);
  if (!receiver.basis) return job;
  job.finish = [finish = job.finish, &texels = context.texels, receiver](std::span<const float> rows) {
    PointLayer layer = finish(rows);
    const PointPlane sums = std::move(layer.planes.back());
    layer.planes.pop_back();
    for (PointPlane& plane : directionalPlanes(receiver, texels, sums.values))
      layer.planes.push_back(std::move(plane));
    return layer;
  };
  return job;
}

LayerJob prepareLightGroups(const LayerContext& context, const Parameters& parameters) {
  const std::vector<std::string> groups = scene::lightGroups(context.tracer.scene());
  struct Group {
    std::string name;
    transport::LightmapSolver solver;
  };
  // Solvers are heavy only while they hold a cache, which they fill at their first texel.
  auto solvers = std::make_shared<std::vector<Group>>();
  LightmapOptions options = optionsOf(context, parameters);
  Hasher key;
  for (const std::string& group : groups) {
    options.group = group;
    key.add(keyOf(options, context.tracer.scene()));
    solvers->push_back({group, {context.tracer, context.atlas, context.texels, options}});
  }
  const std::size_t row = kRow * groups.size();
  LayerJob job;
  job.solver.row = static_cast<int>(row);
  job.solver.key = key.digest();
  job.solver.solve = [solvers, row](std::span<const std::uint32_t> which, std::span<float> rows,
                                    Progress& progress) {
    std::uint64_t rays = 0;
    for (std::size_t g = 0; g < solvers->size(); ++g)
      rays += solveRows((*solvers)[g].solver, which, rows, row, g * kRow, progress);
    return rays;
  };
  const atlas::Texels& texels = context.texels;
  const bool filter = context.quality.filter;
  job.finish = [&texels, filter, groups, row](std::span<const float> rows) {
    PointLayer layer;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      PointLayer own = finishRows(texels, filter, rows, row, g * kRow, groups[g]);
      if (g == 0) {
        layer = std::move(own);
        continue;
      }
      layer.planes.push_back(std::move(own.planes[0]));
      // Groups are independent: the error of their sum.
      for (std::size_t i = 0; i < layer.error.size(); ++i) {
        layer.error[i] = std::hypot(layer.error[i], own.error[i]);
        layer.valid[i] = layer.valid[i] && own.valid[i];
      }
    }
    return layer;
  };
  return job;
}

}  // namespace relume::bake
