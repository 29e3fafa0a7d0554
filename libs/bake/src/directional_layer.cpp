// SPDX-License-Identifier: MIT
// Based on:
//   [HP02] Hey, Purgathofer. Real-Time Rendering of Globally Illuminated Soft Glossy Scenes With Directional
//   Light Maps. 2002.
// The solvers are those of lightmaps with the receiver directions:n; what differs is how their light is kept.
#include "directional_layer.h"

#include <fmt/format.h>

#include "lightmap_layer.h"
#include "pack_directions.h"
#include "relume/basis/basis.h"
#include "relume/basis/direction_set.h"
#include "relume/core/check.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::bake {
namespace {

constexpr double kLeast = 6, kMost = 64, kFinest = 4;
constexpr std::size_t kGrain = 256;

struct Settings {
  std::size_t directions = 14;
  float scale = 1;
};

Settings settingsOf(const Parameters& parameters) {
  const double n = std::get<double>(parameters.at("n")), scale = std::get<double>(parameters.at("scale"));
  if (!(n >= kLeast && n <= kMost))
    throw Error(ErrorCode::kUsage, "--layer directional", fmt::format("n={} is out of range", n),
                "use 6 to 64 directions");
  if (!(scale > 0 && scale <= kFinest))
    throw Error(ErrorCode::kUsage, "--layer directional", fmt::format("scale={} is out of range", scale),
                "use for example scale=0.5");
  return {static_cast<std::size_t>(n), static_cast<float>(scale)};
}

}  // namespace

LayerJob prepareDirectional(const LayerContext& context, const Parameters& parameters) {
  const Settings settings = settingsOf(parameters);
  const std::shared_ptr<const basis::Basis> basis =
      basis::makeBasis(fmt::format("directions:{}", settings.directions));
  const atlas::Texels& texels = context.texels;
  LayerJob job = prepareSums(context, parameters, basis);
  job.finish = [finish = job.finish, &texels, basis, settings](std::span<const float> rows) {
    PointLayer layer = finish(rows);
    const std::vector<float>& sums = layer.planes.at(1).values;
    std::vector<float> coefficients(texels.points.size() * basis->coefficients());
    parallelFor(texels.points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        basis->finish(basis::Receiver(texels.points[i].shading_normal),
                      std::span(sums).subspan(i * basis->sums(), basis->sums()),
                      std::span(coefficients).subspan(i * basis->coefficients(), basis->coefficients()));
    });
    const auto set = basis::minimalEnergy(settings.directions);
    layer.tables = asset::tablesOf(packDirections(texels, set, coefficients, layer.valid, settings.scale));
    layer.planes.resize(1);
    return layer;
  };
  return job;
}

}  // namespace relume::bake
