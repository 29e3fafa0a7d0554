// SPDX-License-Identifier: MIT
// With two independent truths T1, T2 at every place the mean of (B - T1)(B - T2) is the squared error of B:
// their noise has no part in it. Standard errors are those of means over places.
#include "verification.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lightmap_truth.h"
#include "relume/core/error.h"
#include "relume/core/frame.h"
#include "relume/core/quantity.h"
#include "relume/core/sampling.h"
#include "relume/picture/baked_values.h"
#include "relume/transport/reference.h"
#include "verification_places.h"

namespace relume::app {
namespace {

constexpr std::size_t kWorst = 10;
constexpr double kBeyondNoise = 4;  // standard errors

/// What is known of one place: luminance of the irradiance.
struct Sample {
  double baked = 0, first = 0, second = 0;  ///< two independent truths
  double truth() const { return 0.5 * (first + second); }
  double noise() const { return 0.5 * std::abs(first - second); }
};

Agreement agreementOf(std::span<const Sample> samples) {
  Agreement a;
  a.points = samples.size();
  const auto n = static_cast<double>(samples.size());
  double noise2 = 0, product_sum = 0;
  const auto product = [](const Sample& s) { return (s.baked - s.first) * (s.baked - s.second); };
  for (const Sample& s : samples) {
    a.mean_baked += s.baked / n, a.mean_true += s.truth() / n;
    noise2 += s.noise() * s.noise() / n, product_sum += product(s) / n;
  }
  if (!(a.mean_true > 0)) return a;
  double spread = 0, difference2 = 0;
  for (const Sample& s : samples) {
    spread += (product(s) - product_sum) * (product(s) - product_sum) / (n * n);
    const double d = s.baked - s.truth() - (a.mean_baked - a.mean_true);
    difference2 += d * d / (n * n);
  }
  a.bias = a.mean_baked / a.mean_true - 1;
  a.truth_noise = std::sqrt(noise2) / a.mean_true;
  a.bias_error = std::sqrt(difference2) / a.mean_true;
  a.rmse = std::sqrt(std::max(product_sum, 0.0)) / a.mean_true;
  a.rmse_error = std::sqrt(spread) / (2 * std::max(a.rmse, 1e-9) * a.mean_true * a.mean_true);
  return a;
}

std::vector<ObjectAgreement> byObject(const scene::Scene& scene, std::span<const VerifiedPlace> places,
                                      std::span<const Sample> samples) {
  std::map<std::uint32_t, std::vector<Sample>> of_instance;
  for (std::size_t i = 0; i < places.size(); ++i) of_instance[places[i].hit.instance].push_back(samples[i]);
  std::vector<ObjectAgreement> objects;
  for (const auto& [instance, own] : of_instance)
    objects.push_back({agreementOf(own), scene.instances[instance].name});
  return objects;
}

}  // namespace

Verification verifyLightmap(const scene::Scene& scene, const asset::Asset& asset,
                            const VerifyOptions& options, Progress& progress) {
  const asset::Layer& layer = lightmapOf(asset, options.layer);
  const picture::BakedValues baked(scene, &asset, picture::View::kLightmap, layer.name);
  Verification result;
  result.layer = layer.name, result.error_estimate = layer.error_estimate;
  const transport::Reference reference(scene);
  const std::vector<VerifiedPlace> places = choosePlaces(reference.tracer(), baked, options, result.skipped);
  if (places.empty()) throw Error(ErrorCode::kEmptyScene, scene.name, "no baked surface was found to verify");
  result.points = places.size();

  std::vector<transport::Receiver> receivers;
  for (const VerifiedPlace& place : places)
    receivers.push_back({scene::worldPosition(scene, place.hit),
                         scene::geometricNormal(scene, place.hit.instance, place.hit.triangle),
                         scene::shadingNormal(scene, place.hit)});
  transport::ReferenceOptions truth = truthOf(layer, std::max(options.samples / 2, 16u), options.seed);
  const auto first = reference.irradiance(receivers, truth, progress);
  truth.seed = independentSeed(options.seed);
  const auto second = reference.irradiance(receivers, truth, progress);
  result.paths = first.samples + second.samples;

  std::vector<Sample> samples(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    samples[i] = {places[i].baked, static_cast<double>(luminance(first.value[i].rgb)),
                  static_cast<double>(luminance(second.value[i].rgb))};
  static_cast<Agreement&>(result) = agreementOf(samples);
  if (!(result.mean_true > 0))
    throw Error(ErrorCode::kEmptyScene, scene.name, "no light reaches the baked surfaces",
                "give the --lights that it was baked with");
  result.objects = byObject(scene, places, samples);
  for (const Sample& s : samples) result.differences.push_back((s.baked - s.truth()) / result.mean_true);

  std::vector<std::size_t> order;
  const double typical = result.truth_noise * result.mean_true;
  const auto off = [&](std::size_t i) { return std::abs(samples[i].baked - samples[i].truth()); };
  for (std::size_t i = 0; i < places.size(); ++i)
    if (off(i) > kBeyondNoise * std::max(samples[i].noise(), typical)) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return off(a) > off(b); });
  if (order.size() > kWorst) order.resize(kWorst);
  for (const std::size_t i : order)
    result.worst.push_back({scene.instances[places[i].hit.instance].name, receivers[i].position,
                            samples[i].baked, samples[i].truth(), samples[i].noise()});
  return result;
}

}  // namespace relume::app
