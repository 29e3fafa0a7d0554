// SPDX-License-Identifier: MIT
#include "relume/transport/emitters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "environment_sampler.h"
#include "light_shapes.h"
#include "light_tree.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"
#include "relume/scene/light_groups.h"
#include "relume/trace/tracer.h"
#include "spherical_triangle.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kTextureLookUps = 32;
// A textured triangle is never thought darker than this share of its factor: look-ups may have missed.
constexpr float kLeastTexture = 0.05f;
// Half of the choices are by estimated irradiance, half are even (see the header).
constexpr float kByEstimate = 0.5f;

struct Triangle {
  Point v0, v1, v2;
  Normal normal;
  std::uint32_t instance, triangle;
  bool two_sided;
};

/// A light: one without a size, or a shape that rays may meet.
using Lamp = std::variant<const Light*, Disk, Panel>;

float meanEmission(const scene::Scene& scene, const scene::Material& material, std::uint32_t instance,
                   std::uint32_t triangle) {
  const float factor = luminance(material.emission);
  if (!material.emission_texture) return factor;
  float sum = 0;
  for (std::uint32_t i = 0; i < kTextureLookUps; ++i) {
    const Vec2 u = sobol2(i, 0);
    const float root = std::sqrt(u.x);
    sum +=
        luminance(scene::surfaceAt(scene, {instance, triangle, root * (1 - u.y), root * u.y}).emission.rgb);
  }
  return std::max(sum / kTextureLookUps, kLeastTexture * factor);
}

EmitterBounds boundsOf(const Light& light) {
  EmitterBounds bounds;
  bounds.box.add(light.position);
  bounds.axis = light.direction;
  bounds.intensity = luminance(light.colour) * light.intensity;
  bounds.two_sided = light.two_sided;
  switch (light.kind) {
    case Light::Kind::kPoint:
    case Light::Kind::kDirectional:
      bounds.cos_spread = -1.0f;
      break;
    case Light::Kind::kSpot:
      bounds.cos_spread = std::cos(light.inner_cone);
      bounds.cos_emission = std::cos(light.outer_cone - light.inner_cone) - 1e-3f;
      break;
    case Light::Kind::kArea: {
      const float radius = std::sqrt(light.area * kInvPi);
      const Vec3 half = radius * glm::sqrt(glm::max(Vec3(1.0f) - light.direction * light.direction, 0.0f));
      bounds.box.add(light.position - half), bounds.box.add(light.position + half);
      bounds.intensity *= light.area;
      break;
    }
  }
  return bounds;
}

EmitterBounds boundsOf(const Panel& panel) {
  EmitterBounds bounds;
  bounds.box.add(panel.v0), bounds.box.add(panel.v1), bounds.box.add(panel.v2);
  bounds.axis = panel.normal;
  bounds.two_sided = panel.two_sided;
  bounds.intensity = luminance(panel.radiance.rgb) * 0.5f *
                     glm::length(glm::cross(panel.v1 - panel.v0, panel.v2 - panel.v0));
  return bounds;
}

}  // namespace

struct Emitters::Impl {
  Impl(const scene::Scene& the_scene, bool include_dynamic, EmissiveSurfaces surfaces,
       const std::string& the_group)
      : scene(the_scene),
        group(the_group),
        sky(shines(scene::kEnvironmentGroup) ? the_scene.environment : scene::Environment()),
        environment(sky) {
    std::vector<EmitterBounds> bounds;
    addLights(bounds);
    first_triangle.assign(scene.instances.size(), scene::kNone);
    if (surfaces == EmissiveSurfaces::kIncluded) addTriangles(bounds, include_dynamic);
    tree = std::make_unique<LightTree>(bounds);
  }

  bool shines(const std::string& of_group) const { return group.empty() || group == of_group; }

  void addLights(std::vector<EmitterBounds>& bounds) {
    for (const Light& light : scene.lights) {
      const Vec3 strength = light.colour * light.intensity;
      if (!(luminance(strength) > 0) || !shines(scene::groupOf(light))) continue;
      if (light.kind == Light::Kind::kDirectional) {
        suns.push_back({-light.direction, std::min(light.angular_radius, kPi / 2), strength});
        continue;
      }
      const Radiance radiance(strength);
      const auto shine = [&](Lamp lamp, EmitterBounds of_lamp) {
        if (!std::holds_alternative<const Light*>(lamp))
          shapes.push_back(static_cast<std::uint32_t>(lamps.size()));
        lamps.push_back(lamp), bounds.push_back(of_lamp);
      };
      for (const auto& [a, b, c] : light.triangles) {
        const Panel panel{a, b, c, light.direction, radiance, light.two_sided};
        shine(panel, boundsOf(panel));
      }
      if (!light.triangles.empty()) continue;
      if (light.kind == Light::Kind::kArea)
        shine(
            Disk{light.position, light.direction, std::sqrt(light.area * kInvPi), radiance, light.two_sided},
            boundsOf(light));
      else
        shine(&light, boundsOf(light));
    }
  }

  void addTriangles(std::vector<EmitterBounds>& bounds, bool include_dynamic) {
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      const scene::Instance& instance = scene.instances[i];
      const scene::Mesh& mesh = scene.meshes[instance.mesh];
      const scene::Material& material = scene.materials[mesh.material];
      if ((instance.dynamic && !include_dynamic) || material.unlit || !(luminance(material.emission) > 0) ||
          !shines(scene::groupOf(material)))
        continue;
      first_triangle[i] = static_cast<std::uint32_t>(triangles.size());
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        triangles.push_back({scene::worldPosition(scene, {i, t, 0, 0}),
                             scene::worldPosition(scene, {i, t, 1, 0}),
                             scene::worldPosition(scene, {i, t, 0, 1}), scene::geometricNormal(scene, i, t),
                             i, t, material.double_sided});
    }
    const std::size_t lights = bounds.size();
    bounds.resize(lights + triangles.size());
    parallelFor(triangles.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Triangle& t = triangles[k];
        const scene::Mesh& mesh = scene.meshes[scene.instances[t.instance].mesh];
        const float area = 0.5f * glm::length(glm::cross(t.v1 - t.v0, t.v2 - t.v0));
        EmitterBounds& b = bounds[lights + k];
        b.box.add(t.v0), b.box.add(t.v1), b.box.add(t.v2);
        b.axis = t.normal;
        b.two_sided = t.two_sided;
        b.intensity =
            area > 0 ? area * meanEmission(scene, scene.materials[mesh.material], t.instance, t.triangle) : 0;
        if (!(b.intensity < kInfinity)) b.intensity = 0;
      }
    });
  }

  // The choice of a distant emitter: a sun, or after the last of them the environment.
  std::size_t distantCount() const { return suns.size() + (sky.dark() ? 0 : 1); }
  float estimate(std::size_t distant, Normal n) const {
    if (distant == suns.size()) return kPi * environment.meanLuminance();
    return suns[distant].estimate(n);
  }
  /// Estimates of all distant emitters together, and how many are not dark.
  struct Distant {
    float sum = 0;
    int lit = 0;
    float probability(float own) const {
      return own > 0 ? kByEstimate * own / sum + (1.0f - kByEstimate) / static_cast<float>(lit) : 0.0f;
    }
  };
  Distant distantAt(Normal n) const {
    Distant all;
    for (std::size_t i = 0; i < distantCount(); ++i)
      if (const float e = estimate(i, n); e > 0) all.sum += e, ++all.lit;
    return all;
  }
  float distantProbability(std::size_t distant, Normal n) const {
    return distantAt(n).probability(estimate(distant, n));
  }

  LightSample sampleLocal(std::uint32_t index, Point p, Vec2 u) const {
    if (index >= lamps.size()) return sampleTriangleLight(triangles[index - lamps.size()], p, u);
    const Lamp& lamp = lamps[index];
    if (const auto* disk = std::get_if<Disk>(&lamp)) return disk->sample(p, u);
    if (const auto* panel = std::get_if<Panel>(&lamp)) return panel->sample(p, u);
    const Light& light = *std::get<const Light*>(lamp);
    LightSample s;
    s.delta = true;
    s.direction = directionTo(light, p);
    s.end = light.position;
    s.value = incidentIrradiance(light, p).rgb;
    s.pdf = s.value == Vec3(0) ? 0.0f : 1.0f;
    return s;
  }

  LightSample sampleTriangleLight(const Triangle& t, Point p, Vec2 u) const {
    LightSample s;
    const TriangleSample place = sampleTriangle(p, t.v0, t.v1, t.v2, u);
    if (!(place.pdf > 0)) return s;
    const Point q = (1 - place.b1 - place.b2) * t.v0 + place.b1 * t.v1 + place.b2 * t.v2;
    const float distance = glm::length(q - p);
    if (!(distance > 0)) return s;
    s.direction = (q - p) / distance;
    const float facing = -glm::dot(t.normal, s.direction);
    if (!t.two_sided && !(facing > 0)) return s;
    const scene::Hit hit{t.instance, t.triangle, place.b1, place.b2};
    s.value = scene::surfaceAt(scene, hit).emission.rgb * scene::opacityAt(scene, hit);
    s.end = trace::offsetOrigin(q, facing > 0 ? t.normal : -t.normal);
    s.pdf = s.value == Vec3(0) ? 0.0f : place.pdf;
    return s;
  }

  const scene::Scene& scene;
  const std::string group;
  const scene::Environment sky;
  EnvironmentSampler environment;
  std::vector<Sun> suns;
  // Local emitters: first the lamps, then the triangles; indices of the tree.
  std::vector<Lamp> lamps;
  std::vector<std::uint32_t> shapes;  ///< lamps that rays may meet
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> first_triangle;  ///< by instance; kNone: does not emit
  std::unique_ptr<LightTree> tree;
};

Emitters::Emitters(const scene::Scene& scene, bool include_dynamic, EmissiveSurfaces surfaces,
                   const std::string& group)
    : impl_(std::make_unique<Impl>(scene, include_dynamic, surfaces, group)) {}
Emitters::~Emitters() = default;
Emitters::Emitters(Emitters&&) noexcept = default;

bool Emitters::empty() const { return !has(Reach::kLocal) && !has(Reach::kDistant); }
std::size_t Emitters::triangleCount() const { return impl_->triangles.size(); }

bool Emitters::has(Reach reach) const {
  return reach == Reach::kLocal ? !impl_->tree->empty() : impl_->distantCount() > 0;
}

bool Emitters::emits(std::uint32_t instance) const { return impl_->first_triangle[instance] != scene::kNone; }
bool Emitters::seenBesideSurfaces() const {
  const auto sized = [](const Sun& sun) { return !sun.delta(); };
  return !impl_->shapes.empty() || !impl_->sky.dark() ||
         std::any_of(impl_->suns.begin(), impl_->suns.end(), sized);
}

bool Emitters::seenBeforeSurfaces() const { return !impl_->shapes.empty(); }

LightSample Emitters::sample(Reach reach, Point p, Normal n, Vec2 u, float choice) const {
  LightSample s;
  if (reach == Reach::kLocal) {
    const LightTree::Choice chosen = impl_->tree->choose(p, n, choice);
    if (!(chosen.probability > 0)) return s;
    s = impl_->sampleLocal(chosen.emitter, p, u);
    s.pdf *= chosen.probability;
    return s;
  }
  const Impl::Distant all = impl_->distantAt(n);
  std::size_t distant = 0;
  float probability = 0.0f, below = 0.0f;
  // The last one that is not dark takes what rounding leaves over.
  for (std::size_t i = 0; i < impl_->distantCount(); ++i) {
    const float own = all.probability(impl_->estimate(i, n));
    if (!(own > 0)) continue;
    distant = i, probability = own, below += own;
    if (choice < below) break;
  }
  if (!(probability > 0)) return s;
  if (distant < impl_->suns.size()) {
    s = impl_->suns[distant].sample(u);
  } else {
    s.direction = impl_->environment.sample(n, u);
    s.endless = true;
    s.value = impl_->sky.from(s.direction).rgb;
    s.pdf = impl_->environment.pdf(n, s.direction);
  }
  s.pdf *= probability;
  return s;
}

LightSeen Emitters::onSurface(Point p, Normal n, Direction d, const scene::Hit& hit, float distance,
                              bool back_face) const {
  const std::uint32_t first = impl_->first_triangle[hit.instance];
  if (first == scene::kNone || back_face) return {};
  LightSeen seen{scene::surfaceAt(impl_->scene, hit).emission, 0.0f};
  const Triangle& t = impl_->triangles[first + hit.triangle];
  const auto emitter = static_cast<std::uint32_t>(impl_->lamps.size()) + first + hit.triangle;
  if (const float chosen = impl_->tree->probability(p, n, emitter); chosen > 0)
    seen.pdf = chosen * trianglePdf(p, t.v0, t.v1, t.v2, d, distance);
  return seen;
}

void Emitters::onRay(Point p, Normal n, Direction d, float from, float to,
                     std::vector<LightSeen>& seen) const {
  const OpenRay ray{p, d, from, to};
  for (const std::uint32_t lamp : impl_->shapes) {
    const auto* disk = std::get_if<Disk>(&impl_->lamps[lamp]);
    std::optional<LightSeen> light = disk ? disk->seen(ray) : std::get<Panel>(impl_->lamps[lamp]).seen(ray);
    if (!light) continue;
    light->pdf *= impl_->tree->probability(p, n, lamp);
    seen.push_back(*light);
  }
  if (to < kInfinity) return;
  for (std::size_t i = 0; i < impl_->suns.size(); ++i) {
    const Sun& sun = impl_->suns[i];
    if (sun.delta() || !sun.covers(d)) continue;
    seen.push_back({sun.radiance(), impl_->distantProbability(i, n) * sun.pdf()});
  }
  const scene::Environment& environment = impl_->sky;
  if (environment.dark()) return;
  seen.push_back(
      {environment.from(d), impl_->distantProbability(impl_->suns.size(), n) * impl_->environment.pdf(n, d)});
}

}  // namespace relume::transport
