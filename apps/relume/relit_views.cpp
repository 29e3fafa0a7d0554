// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "lightmap_truth.h"
#include "lightmap_views.h"
#include "relit.h"
#include "relit_comparison.h"

namespace relume::app {
namespace {

constexpr std::size_t kMostCameras = 2;

/// Straight from the lamp, with its shadow.
Vec3 directAt(const trace::Tracer& tracer, const Light& lamp, const transport::Receiver& at) {
  const Point start = trace::offsetOrigin(at.position, at.geometric_normal);
  const Direction way = directionTo(lamp, start);
  if (glm::dot(way, at.geometric_normal) <= 0 || tracer.occluded({start, way, distanceTo(lamp, start)}))
    return Vec3(0.0f);
  return directIrradiance(lamp, at.position, at.shading_normal).rgb;
}

}  // namespace

std::vector<ComparedView> relitViews(scene::Scene scene, asset::Asset asset, const RelitVerification& v,
                                     const ViewOptions& options, std::uint64_t seed, Progress& progress) {
  // Lamps alone, as they were verified.
  scene.environment = {};
  for (scene::Material& m : scene.materials) m.emission = Vec3(0);
  std::vector<const LampAgreement*> order;
  for (const LampAgreement& lamp : v.lamps) order.push_back(&lamp);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->error < b->error; });
  std::vector<std::pair<const char*, const LampAgreement*>> shown = {
      {"median", order[(order.size() - 1) / 2]}};
  if (order.size() > 1) shown.emplace_back("worst", order.back());
  const auto cameras = std::clamp<std::size_t>(scene.cameras.size(), 1, kMostCameras);
  const float aspect = static_cast<float>(options.size.x) / static_cast<float>(options.size.y);
  std::vector<ComparedView> views;
  for (const auto& [which, lamp] : shown) {
    scene.lights = {lamp->lamp};
    const transport::Reference reference(scene);
    asset::Layer& layer = transferLayer(asset, v.layer);
    layer.planes.clear();
    addRelitPlane(asset, v.layer, {scene.lights, &reference.tracer(), {}});
    const picture::BakedValues baked(scene, &asset, picture::View::kIndirect, v.layer);
    transport::ReferenceOptions truth = truthOf(layer, samplesOfPlace(options), seed);
    truth.part = transport::Part::kTotal;
    const ComparedLight light{baked, truth, [&](const transport::Receiver& at) {
                                return directAt(reference.tracer(), lamp->lamp, at);
                              }};
    for (std::size_t camera = 0; camera < cameras; ++camera) {
      const auto viewpoint = picture::defaultViewpoint(reference.tracer(), static_cast<int>(camera), aspect);
      ComparedView view = comparedView(reference, light, viewpoint, options, seed, progress);
      view.name = fmt::format("{}{}", which, camera);
      const Point p = lamp->lamp.position;
      view.caption = fmt::format("The {} lamp, at {:.2f}, {:.2f}, {:.2f} m{}", which, p.x, p.y, p.z,
                                 scene.cameras.empty() ? "" : fmt::format(", camera {} of the file", camera));
      views.push_back(std::move(view));
    }
  }
  return views;
}

}  // namespace relume::app
