// SPDX-License-Identifier: MIT
#include "relit_verification.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lightmap_truth.h"
#include "relit.h"
#include "relume/core/error.h"
#include "relume/core/frame.h"
#include "relume/core/sampling.h"
#include "relume/picture/baked_values.h"
#include "relume/relight/transfer_relighter.h"
#include "relume/transport/reference.h"
#include "verification_places.h"

namespace relume::app {
namespace {

constexpr std::uint32_t kTriesPerLamp = 400, kProbes = 128;

/// Distance to the nearest surface, from rays all around; 0 inside bodies.
float clearanceAt(const trace::Tracer& tracer, Point p, std::uint32_t stream) {
  float nearest = kInfinity;
  std::uint32_t backs = 0;
  for (std::uint32_t i = 0; i < kProbes; ++i) {
    const trace::RayHit hit = tracer.intersect({p, squareToSphere(sobol2(i, stream))});
    if (!hit) continue;
    nearest = std::min(nearest, hit.t);
    backs += hit.back_face;
  }
  return backs > kProbes / 4 ? 0.0f : nearest;
}

/// Lamps between a place on a surface and what lies opposite: in the air, whatever the shape of the scene.
std::vector<LampAgreement> chooseLamps(const trace::Tracer& tracer, const SurfaceSampler& surface,
                                       std::uint32_t count, float least, float most, std::uint64_t seed) {
  std::vector<LampAgreement> lamps;
  const std::uint32_t stream = streamOf(seed, 1, 0);
  for (std::uint32_t i = 0; i < count * kTriesPerLamp && lamps.size() < count; ++i) {
    const Vec2 u = sobol2(i, stream), v = sobol2(i, stream + 1), w = sobol2(i, stream + 2);
    const scene::Hit from = surface.at(u.x, v);
    const Normal n = scene::geometricNormal(tracer.scene(), from.instance, from.triangle);
    const Point p = trace::offsetOrigin(scene::worldPosition(tracer.scene(), from), n);
    const Direction d = Frame::about(n).toWorld(squareToCosineHemisphere(w));
    const trace::RayHit opposite = tracer.intersect({p, d});
    if (!opposite || opposite.back_face) continue;
    const Point at = p + u.y * opposite.t * d;
    const float clearance = clearanceAt(tracer, at, stream + 3 + i);
    if (clearance < least || clearance > most) continue;
    Light lamp;
    lamp.position = at;
    lamps.push_back({lamp, static_cast<double>(clearance)});
  }
  return lamps;
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
  double error2 = 0, truth2 = 0, sum = 0, truth = 0;
  for (std::size_t i = 0; i < relit.size(); ++i) {
    const glm::dvec3 a(first[i].rgb), b(second[i].rgb), r(relit[i]);
    error2 += glm::dot(r - a, r - b), truth2 += glm::dot(a, b);
    sum += r.x + r.y + r.z, truth += 0.5 * (a.x + a.y + a.z + b.x + b.y + b.z);
  }
  lamp.error = truth2 > 0 ? std::sqrt(std::max(error2, 0.0) / truth2) : 0;
  lamp.bias = truth > 0 ? sum / truth - 1 : 0;
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
    const auto areas = relighter.entryAreas();
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
    result.spacing = std::sqrt(area / static_cast<double>(std::max<std::size_t>(areas.size(), 1)));
  }
  addRelitPlane(asset, result.layer, {});  // for the places, which a layer without values has not
  const trace::Tracer tracer(scene);
  std::size_t skipped = 0;
  const auto places = choosePlaces(
      tracer, picture::BakedValues(scene, &asset, picture::View::kIndirect, result.layer), options, skipped);
  result.points = places.size();
  const auto spacing = static_cast<float>(result.spacing);
  result.lamps = chooseLamps(tracer, SurfaceSampler(scene), count, near ? 0.25f * spacing : spacing,
                             near ? spacing : kInfinity, options.seed);
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
  std::vector<double> errors;
  for (const LampAgreement& lamp : result.lamps) errors.push_back(lamp.error);
  std::sort(errors.begin(), errors.end());
  const std::size_t n = errors.size();
  result.median = 0.5 * (errors[(n - 1) / 2] + errors[n / 2]);
  result.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(n);
  result.worst = errors.back();
  return result;
}

}  // namespace relume::app
