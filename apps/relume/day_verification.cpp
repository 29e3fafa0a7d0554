// SPDX-License-Identifier: MIT
#include "day_verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "day.h"
#include "lightmap_truth.h"
#include "relit.h"
#include "relume/core/error.h"
#include "relume/core/sampling.h"
#include "relume/picture/baked_values.h"
#include "relume/relight/day_relighter.h"
#include "relume/scene/day_sky.h"
#include "relume/transport/reference.h"
#include "verification_places.h"

namespace relume::app {
namespace {

/// What the layer holds: all that is reflected, and the direct light of the sky and of emissive surfaces.
class DayTruth {
 public:
  DayTruth(scene::Scene lit, bool lambert) : all_(std::move(lit)), unlit_(all_), lambert_(lambert) {
    unlit_.lights.clear();
  }
  transport::ReferenceIrradiance at(std::span<const transport::Receiver> places, std::uint32_t samples,
                                    std::uint64_t seed, Progress& progress) const {
    transport::ReferenceOptions how;
    how.samples = samples, how.seed = seed;
    how.materials = lambert_ ? transport::Materials::kLambert : transport::Materials::kFull;
    how.part = transport::Part::kIndirect;
    auto sum = transport::Reference(all_).irradiance(places, how, progress);
    how.part = transport::Part::kDirect;
    const auto straight = transport::Reference(unlit_).irradiance(places, how, progress);
    for (std::size_t i = 0; i < sum.value.size(); ++i) sum.value[i] += straight.value[i];
    sum.samples += straight.samples;
    return sum;
  }

 private:
  const scene::Scene all_;
  scene::Scene unlit_;
  const bool lambert_;
};

std::vector<transport::Receiver> receiversAt(const scene::Scene& scene,
                                             std::span<const VerifiedPlace> places) {
  std::vector<transport::Receiver> receivers;
  for (const VerifiedPlace& place : places)
    receivers.push_back({scene::worldPosition(scene, place.hit),
                         scene::geometricNormal(scene, place.hit.instance, place.hit.triangle),
                         scene::shadingNormal(scene, place.hit)});
  return receivers;
}

void compare(std::span<const Vec3> baked, std::span<const Irradiance> first,
             std::span<const Irradiance> second, TimeAgreement& time) {
  // Two truths, whose noise has no part in the mean of the product.
  double error2 = 0, truth2 = 0, sum = 0, truth = 0, light = 0;
  for (std::size_t i = 0; i < baked.size(); ++i) {
    const glm::dvec3 a(first[i].rgb), b(second[i].rgb), r(baked[i]);
    error2 += glm::dot(r - a, r - b), truth2 += glm::dot(a, b);
    sum += r.x + r.y + r.z, truth += 0.5 * (a.x + a.y + a.z + b.x + b.y + b.z);
    light += 0.5 * static_cast<double>(luminance(first[i].rgb) + luminance(second[i].rgb));
  }
  time.mean_true = light / static_cast<double>(std::max<std::size_t>(baked.size(), 1));
  time.error = truth2 > 0 ? std::sqrt(std::max(error2, 0.0) / truth2) : 0;
  time.bias = truth > 0 ? sum / truth - 1 : 0;
}

}  // namespace

DayVerification verifyDay(scene::Scene scene, asset::Asset asset, const VerifyOptions& options,
                          std::uint32_t count, Progress& progress) {
  asset::Layer* layer = dayLayer(asset, options.layer);
  if (!layer) throw Error(ErrorCode::kNoSuchLayer, scene.name, "holds no day", "bake --layer day");
  relight::DayRelighter relighter(asset, *layer);
  const Day day = relighter.day();
  const std::string name = layer->name;
  const bool lambert = layer->parameters.at("materials") == asset::Parameter(std::string("lambert"));
  addRelitPlane(asset, name, {});  // for the places, which a layer without values has not
  DayVerification result{.layer = name};
  const trace::Tracer tracer(scene);
  std::size_t skipped = 0;
  const auto places = choosePlaces(
      tracer, picture::BakedValues(scene, &asset, picture::View::kIndirect, name), options, skipped);
  if (places.empty()) throw Error(ErrorCode::kEmptyScene, scene.name, "has no place to compare");
  const std::vector<transport::Receiver> receivers = receiversAt(scene, places);
  result.points = places.size();
  for (std::uint32_t i = 0; i < count; ++i) {
    const double u = static_cast<double>(sobol2(i, streamOf(options.seed, 0, 77)).x);
    result.times.push_back({.minutes = day.begin + u * (day.end - day.begin)});
  }
  std::sort(result.times.begin(), result.times.end(),
            [](const TimeAgreement& a, const TimeAgreement& b) { return a.minutes < b.minutes; });
  Stage stage(progress, "truth", result.times.size());
  for (TimeAgreement& time : result.times) {
    dayLayer(asset, name)->planes.clear();
    addRelitPlane(asset, name, {.lights = {}, .minutes = time.minutes});
    const picture::BakedValues baked(scene, &asset, picture::View::kIndirect, name);
    std::vector<Vec3> values;
    for (const VerifiedPlace& place : places) values.push_back(baked.value(*baked.locate(place.hit)));
    scene::Scene lit = scene;
    scene::lightAt(lit, day, time.minutes);
    const DayTruth truth(std::move(lit), lambert);
    const std::uint32_t half = std::max(options.samples / 2, 16u);
    const auto first = truth.at(receivers, half, options.seed, progress),
               second = truth.at(receivers, half, independentSeed(options.seed), progress);
    result.paths += first.samples + second.samples;
    compare(values, first.value, second.value, time);
    stage.advance(1);
  }
  std::vector<double> errors;
  for (const TimeAgreement& time : result.times) errors.push_back(time.error);
  std::sort(errors.begin(), errors.end());
  const std::size_t n = errors.size();
  result.median = 0.5 * (errors[(n - 1) / 2] + errors[n / 2]);
  result.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(n);
  result.worst = errors.back();
  return result;
}

nlohmann::ordered_json toJson(const DayVerification& v) {
  nlohmann::ordered_json out{{"layer", v.layer},   {"points", v.points}, {"paths", v.paths},
                             {"median", v.median}, {"mean", v.mean},     {"worst", v.worst}};
  out["times"] = nlohmann::ordered_json::array();
  for (const TimeAgreement& t : v.times)
    out["times"].push_back({{"minutes", t.minutes},
                            {"time", clockText(std::round(t.minutes * 60) / 60)},
                            {"mean_true", t.mean_true},
                            {"error", t.error},
                            {"bias", t.bias}});
  return out;
}

void print(const DayVerification& v) {
  fmt::print("{}: {} random times, {} places, {} paths\n", v.layer, v.times.size(), v.points, v.paths);
  fmt::print("error of reflected and sky light: median {:.2f} %, mean {:.2f} %, worst {:.2f} %\n",
             v.median * 100, v.mean * 100, v.worst * 100);
  for (const TimeAgreement& t : v.times)
    fmt::print("  {}  error {:>6.2f} %  bias {:>+6.2f} %  mean irradiance {:.4g}\n",
               clockText(std::round(t.minutes * 60) / 60), t.error * 100, t.bias * 100, t.mean_true);
}

}  // namespace relume::app
