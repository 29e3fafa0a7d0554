// SPDX-License-Identifier: MIT
#include "direct_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/core/check.h"
#include "relume/core/sampling.h"

namespace relume::picture {
namespace {

constexpr std::uint32_t kAreaSamples = 4;
// Shadow rays end short of the light, so that the surface of a lamp that carries it does not hide it.
constexpr float kShortOfLight = 1.0f - 1e-4f;
constexpr std::uint32_t kFirstLightDimension = 1;  // of a pixel's random numbers

trace::Ray shadowRay(const Receiver& receiver, const Light& light, Point target) {
  const Point origin = trace::offsetOrigin(receiver.shadow_origin, receiver.geometric);
  if (light.kind == Light::Kind::kDirectional) return {origin, -light.direction, kInfinity};
  const Vec3 way = target - origin;
  const float distance = glm::length(way);
  if (!(distance > 0)) return {origin, light.direction, -1.0f};
  return {origin, way / distance, distance * kShortOfLight};
}

}  // namespace

Point shadowOrigin(const scene::Scene& scene, const scene::Hit& hit, Point p, Normal lit_side) {
  const scene::Instance& instance = scene.instances[hit.instance];
  const scene::Mesh& mesh = scene.meshes[instance.mesh];
  if (mesh.flat_normals || mesh.normals.empty()) return p;
  const float weights[3] = {1.0f - hit.b1 - hit.b2, hit.b1, hit.b2};
  const scene::Hit corners[3] = {{hit.instance, hit.triangle, 0, 0},
                                 {hit.instance, hit.triangle, 1, 0},
                                 {hit.instance, hit.triangle, 0, 1}};
  Vec3 raise(0.0f);
  for (int k = 0; k < 3; ++k) {
    Normal n = scene::shadingNormal(scene, corners[k]);
    if (glm::dot(n, lit_side) < 0) n = -n;
    // How far p lies under the tangent plane of the corner; nothing where the surface is hollow.
    const float below = std::min(glm::dot(p - scene::worldPosition(scene, corners[k]), n), 0.0f);
    raise -= weights[k] * below * n;
  }
  // What rounding alone raises is a flat triangle.
  const Vec3 size = scene::worldPosition(scene, corners[1]) - scene::worldPosition(scene, corners[0]);
  return glm::dot(raise, raise) > 1e-10f * glm::dot(size, size) ? p + raise : p;
}

void directIrradiance(const LayeredTracer& tracer, const LightSet& lights,
                      std::span<const Receiver> receivers, std::span<Irradiance> result) {
  constexpr std::size_t kPacket = trace::Tracer::kPacket;
  const std::size_t count = receivers.size();
  RELUME_CHECK_EQ(count, result.size());
  RELUME_CHECK_LE(count, kPacket);
  std::array<trace::Ray, kPacket> rays;
  std::array<std::uint32_t, kPacket> seeds{};
  std::array<float, kPacket> visible{};
  std::array<Irradiance, kPacket> unshadowed;
  for (std::size_t i = 0; i < count; ++i) result[i] = Irradiance(0.0f);

  for (std::size_t l = 0; l < lights.size(); ++l) {
    const Light& light = lights[l];
    bool any = false;
    for (std::size_t i = 0; i < count; ++i) {
      unshadowed[i] = relume::directIrradiance(light, receivers[i].position, receivers[i].shading);
      any |= unshadowed[i].rgb != Vec3(0.0f);
    }
    if (!any) continue;
    const bool area = light.kind == Light::Kind::kArea && light.area > 0;
    const std::uint32_t shadow_samples = area ? kAreaSamples : 1;
    for (std::uint32_t k = 0; k < shadow_samples; ++k) {
      for (std::size_t i = 0; i < count; ++i) {
        const Receiver& r = receivers[i];
        rays[i].t_max = -1.0f;
        if (unshadowed[i].rgb == Vec3(0.0f)) continue;
        const std::uint32_t stream =
            streamOf(0, r.pixel, kFirstLightDimension + static_cast<std::uint32_t>(l));
        const Point target =
            area ? pointOn(light, sobol2(r.sample * kAreaSamples + k, stream)) : light.position;
        rays[i] = shadowRay(r, light, target);
        seeds[i] = hashCombine(stream, r.sample * kAreaSamples + k);
        // A light behind a flat surface is hidden by it; asking the tracer would leave that to rounding.
        if (r.shadow_origin == r.position && glm::dot(rays[i].direction, r.geometric) <= 0)
          rays[i].t_max = -1.0f;
      }
      tracer.transmittance(std::span(rays).first(count), std::span(seeds).first(count),
                           std::span(visible).first(count));
      for (std::size_t i = 0; i < count; ++i)
        result[i] += unshadowed[i] * (visible[i] / static_cast<float>(shadow_samples));
    }
  }
}

Irradiance unoccludedIrradiance(const LightSet& lights, Point p) {
  Irradiance sum(0.0f);
  for (const Light& light : lights) sum += incidentIrradiance(light, p);
  return sum;
}

}  // namespace relume::picture
