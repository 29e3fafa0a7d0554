// SPDX-License-Identifier: MIT
#include "relit_verification.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lightmap_truth.h"
#include "relit.h"
#include "relume/core/error.h"
#include "relume/core/sampling.h"
#include "relume/picture/baked_values.h"
#include "relume/relight/transfer_relighter.h"
#include "relume/transport/light_search.h"
#include "relume/transport/reference.h"
#include "verification_places.h"

namespace relume::app {
namespace {

constexpr std::uint32_t kProbes = 512;

/// Distance to the nearest surface, from rays all around.
double clearanceAt(const trace::Tracer& tracer, Point p) {
  float nearest = kInfinity;
  for (std::uint32_t i = 0; i < kProbes; ++i)
    nearest = std::min(nearest, tracer.intersect({p, squareToSphere(sobol2(i, 0)), kInfinity}, i).t);
  return static_cast<double>(nearest);
}

/// Where the bake takes lamps to be: in the author's boxes, or in free space.
std::vector<LampAgreement> chooseLamps(const trace::Tracer& tracer, std::uint32_t count,
                                       const transport::LightPlaces& where, std::uint64_t seed,
                                       Progress& progress) {
  std::vector<Box3> boxes = tracer.scene().light_boxes;
  if (boxes.empty()) boxes.push_back(tracer.scene().bounds());
  std::vector<LampAgreement> lamps;
  for (const Light& lamp : transport::findLights(tracer, boxes, count, where, seed, progress))
    lamps.push_back({lamp, clearanceAt(tracer, lamp.position)});
  return lamps;
}

/// Side of a square of the median entry. Entries that no lamp reaches are larger, but few.
double spacingOf(std::span<const float> areas) {
  std::vector<float> sorted(areas.begin(), areas.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  if (sorted.empty()) return 0;
  std::nth_element(sorted.begin(), middle, sorted.end());
  return std::sqrt(static_cast<double>(*middle));
}

/// A plane of irradiance, read at the places as a viewer does.
std::vector<Vec3> readAt(const scene::Scene& scene, const asset::Asset& asset, const std::string& layer,
                         std::span<const VerifiedPlace> places) {
  const picture::BakedValues baked(scene, &asset, picture::View::kIndirect, layer);
  std::vector<Vec3> values;
  for (const VerifiedPlace& place : places) values.push_back(baked.value(*baked.locate(place.hit)));
  return values;
}

void compare(std::span<const Vec3> relit, std::span<const Irradiance> first,
             std::span<const Irradiance> second, LampAgreement& lamp) {
  // As in verification.cpp: two truths, whose noise has no part in the mean of the product.
  double truth2 = 0, sum = 0, truth = 0;
  std::vector<double> error2;
  for (std::size_t i = 0; i < relit.size(); ++i) {
    const glm::dvec3 a(first[i].rgb), b(second[i].rgb), r(relit[i]);
    error2.push_back(glm::dot(r - a, r - b)), truth2 += glm::dot(a, b);
    sum += r.x + r.y + r.z, truth += 0.5 * (a.x + a.y + a.z + b.x + b.y + b.z);
  }
  std::sort(error2.begin(), error2.end());
  const auto without = [&](std::size_t places) {
    const double left =
        std::accumulate(error2.begin(), error2.end() - static_cast<std::ptrdiff_t>(places), 0.0);
    return truth2 > 0 ? std::sqrt(std::max(left, 0.0) / truth2) : 0;
  };
  lamp.error = without(0), lamp.rest = without(error2.size() / 100);
  lamp.bias = truth > 0 ? sum / truth - 1 : 0;
}

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

}  // namespace

RelitVerification verifyRelit(scene::Scene scene, asset::Asset asset, const VerifyOptions& options,
                              std::uint32_t count, bool near, Progress& progress) {
  // Lamps alone: what else shines is not in the transfer.
  scene.environment = {};
  for (scene::Material& m : scene.materials) m.emission = Vec3(0);
  scene.lights.clear();
  RelitVerification result;
  const asset::Layer& layer = transferLayer(asset, options.layer);
  result.layer = layer.name, result.error_estimate = layer.error_estimate;
  const bool lambert = layer.parameters.contains("materials") &&
                       layer.parameters.at("materials") == asset::Parameter(std::string("lambert"));
  {
    const relight::TransferRelighter relighter(asset, layer);
    result.spacing = spacingOf(relighter.entryAreas());
  }
  addRelitPlane(asset, result.layer, {});  // for the places, which a layer without values has not
  const trace::Tracer tracer(scene);
  std::size_t skipped = 0;
  const auto places = choosePlaces(
      tracer, picture::BakedValues(scene, &asset, picture::View::kIndirect, result.layer), options, skipped);
  result.points = places.size();
  const auto spacing = static_cast<float>(result.spacing);
  result.lamps = chooseLamps(
      tracer, count, {.nearest = near ? 0.25f * spacing : spacing, .farthest = near ? spacing : kInfinity},
      options.seed, progress);
  if (result.lamps.empty() || places.empty())
    throw Error(ErrorCode::kEmptyScene, scene.name,
                "no lamp finds room as far from all surfaces as entries are wide",
                "bake with more entries (count=)");

  std::vector<transport::Receiver> receivers;
  for (const VerifiedPlace& place : places)
    receivers.push_back({scene::worldPosition(scene, place.hit),
                         scene::geometricNormal(scene, place.hit.instance, place.hit.triangle),
                         scene::shadingNormal(scene, place.hit)});
  Stage stage(progress, "truth", result.lamps.size());
  for (LampAgreement& lamp : result.lamps) {
    scene.lights = {lamp.lamp};
    asset::Layer& relit_layer = transferLayer(asset, result.layer);
    relit_layer.planes.clear();
    addRelitPlane(asset, result.layer, {scene.lights, &tracer, {}});
    const transport::Reference reference(scene);
    transport::ReferenceOptions truth;
    truth.part = transport::Part::kIndirect;
    truth.materials = lambert ? transport::Materials::kLambert : transport::Materials::kFull;
    truth.samples = std::max(options.samples / 2, 16u), truth.seed = options.seed;
    const auto first = reference.irradiance(receivers, truth, progress);
    truth.seed = independentSeed(options.seed);
    const auto second = reference.irradiance(receivers, truth, progress);
    result.paths += first.samples + second.samples;
    compare(readAt(scene, asset, result.layer, places), first.value, second.value, lamp);
    stage.advance(1);
  }
  std::vector<double> errors, rests;
  for (const LampAgreement& lamp : result.lamps) errors.push_back(lamp.error), rests.push_back(lamp.rest);
  result.median = medianOf(errors), result.median_rest = medianOf(rests);
  result.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
  result.worst = *std::max_element(errors.begin(), errors.end());
  return result;
}

}  // namespace relume::app
