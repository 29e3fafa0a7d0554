// SPDX-License-Identifier: MIT
#include "photons/photon_source.h"

#include <algorithm>
#include <cmath>

#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kTextureLookUps = 32;
constexpr float kLeastTexture = 0.05f;  // of its factor, as in emitters.cpp: look-ups may have missed

/// The cone of a spot light: full light about the axis, a parabola of the cosine in the rim (core's
/// light.cpp).
struct Cone {
  float outer, inner, cap, rim;  // cosines; shares of the factor's integral over cosines
  explicit Cone(const Light& light)
      : outer(std::cos(light.outer_cone)),
        inner(std::max(std::cos(light.inner_cone), outer + 0.001f)),
        cap(std::max(1 - inner, 0.0f)),
        rim((inner - outer) / 3) {}
  float solidAngle() const { return 2 * kPi * (cap + rim); }  // that full light would take
  /// cos of the angle from the axis, distributed as the factor is.
  float sample(float u) const {
    const float at = u * (cap + rim);
    if (at < cap) return 1 - at;
    return std::min(outer + (inner - outer) * std::cbrt(std::max(1 - (at - cap) / rim, 0.0f)), 1.0f);
  }
};

}  // namespace

PhotonSource::PhotonSource(const scene::Scene& scene) : scene_(scene), environment_(scene.environment) {
  const Box3 bounds = scene.bounds();
  if (!bounds.empty()) centre_ = bounds.centre(), radius_ = 0.5f * bounds.diagonal();
  addLights();
  addTriangles();
  const float disk = kPi * radius_ * radius_;
  if (!scene.environment.dark())
    add({Kind::kEnvironment, 0, 0}, 4 * kPi * environment_.meanLuminance() * disk);
}

void PhotonSource::add(Emitter emitter, float power) {
  if (!(power > 0) || !(power < kInfinity)) return;
  emitters_.push_back(emitter);
  cumulative_.push_back((cumulative_.empty() ? 0.0 : cumulative_.back()) + static_cast<double>(power));
}

void PhotonSource::addLights() {
  for (std::uint32_t i = 0; i < scene_.lights.size(); ++i) {
    const Light& light = scene_.lights[i];
    const Vec3 strength = light.colour * light.intensity;
    const float grey = luminance(strength);
    const float sides = light.two_sided ? 2.0f : 1.0f;
    switch (light.kind) {
      case Light::Kind::kPoint:
        add({Kind::kPunctual, i, 0}, 4 * kPi * grey);
        break;
      case Light::Kind::kSpot:
        add({Kind::kPunctual, i, 0}, Cone(light).solidAngle() * grey);
        break;
      case Light::Kind::kDirectional:
        suns_.push_back({-light.direction, std::min(light.angular_radius, kPi / 2), strength});
        add({Kind::kSun, static_cast<std::uint32_t>(suns_.size() - 1), 0}, grey * kPi * radius_ * radius_);
        break;
      case Light::Kind::kArea:
        for (const auto& [a, b, c] : light.triangles) {
          panels_.push_back({a, b, c, light.direction, Radiance(strength), light.two_sided});
          const float area = 0.5f * glm::length(glm::cross(b - a, c - a));
          add({Kind::kPanel, static_cast<std::uint32_t>(panels_.size() - 1), 0}, kPi * area * sides * grey);
        }
        if (!light.triangles.empty()) break;
        disks_.push_back({light.position, light.direction, std::sqrt(light.area * kInvPi), Radiance(strength),
                          light.two_sided});
        add({Kind::kDisk, static_cast<std::uint32_t>(disks_.size() - 1), 0}, kPi * light.area * sides * grey);
        break;
    }
  }
}

void PhotonSource::addTriangles() {
  for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
    const scene::Instance& instance = scene_.instances[i];
    const scene::Mesh& mesh = scene_.meshes[instance.mesh];
    const scene::Material& material = scene_.materials[mesh.material];
    const float factor = luminance(material.emission);
    if (instance.dynamic || material.unlit || !(factor > 0)) continue;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Point a = scene::worldPosition(scene_, {i, t, 0, 0}),
                  b = scene::worldPosition(scene_, {i, t, 1, 0}),
                  c = scene::worldPosition(scene_, {i, t, 0, 1});
      float mean = factor;
      if (material.emission_texture) {
        float sum = 0;
        for (std::uint32_t k = 0; k < kTextureLookUps; ++k) {
          const Vec2 u = sobol2(k, 0);
          const float root = std::sqrt(u.x);
          sum += luminance(scene::surfaceAt(scene_, {i, t, root * (1 - u.y), root * u.y}).emission.rgb);
        }
        mean = std::max(sum / kTextureLookUps, kLeastTexture * factor);
      }
      const float area = 0.5f * glm::length(glm::cross(b - a, c - a));
      add({Kind::kTriangle, i, t}, kPi * area * mean * (material.double_sided ? 2.0f : 1.0f));
    }
  }
}

Photon PhotonSource::fromPunctual(const Light& light, Vec2 u) const {
  const Vec3 strength = light.colour * light.intensity;
  Photon p;
  p.range = light.range;
  p.ray.origin = light.position;
  if (light.kind == Light::Kind::kPoint) {
    p.ray.direction = squareToSphere(u);
    p.power = 4 * kPi * strength;
    return p;
  }
  const Cone cone(light);
  const float c = cone.sample(u.x), s = std::sqrt(std::max(1 - c * c, 0.0f)), phi = 2 * kPi * u.y;
  p.ray.direction = Frame::about(light.direction).toWorld({s * std::cos(phi), s * std::sin(phi), c});
  p.power = cone.solidAngle() * strength;
  return p;
}

Photon PhotonSource::fromArea(const Place& from, float side, Vec2 direction) const {
  const Normal out = from.two_sided && side < 0.5f ? -from.normal : from.normal;
  Photon p;
  p.ray.origin = trace::offsetOrigin(from.position, out);
  p.ray.direction = Frame::about(out).toWorld(squareToCosineHemisphere(direction));
  p.power = kPi * from.area * (from.two_sided ? 2.0f : 1.0f) * from.radiance;
  return p;
}

Photon PhotonSource::fromTriangle(const Emitter& e, Vec2 place, float side, Vec2 direction) const {
  const float root = std::sqrt(place.x);
  const scene::Hit hit{e.index, e.triangle, root * (1 - place.y), root * place.y};
  const Point a = scene::worldPosition(scene_, {e.index, e.triangle, 0, 0}),
              b = scene::worldPosition(scene_, {e.index, e.triangle, 1, 0}),
              c = scene::worldPosition(scene_, {e.index, e.triangle, 0, 1});
  const scene::Material& material = scene_.materials[scene_.meshes[scene_.instances[e.index].mesh].material];
  return fromArea({scene::worldPosition(scene_, hit), scene::geometricNormal(scene_, e.index, e.triangle),
                   scene::surfaceAt(scene_, hit).emission.rgb * scene::opacityAt(scene_, hit),
                   0.5f * glm::length(glm::cross(b - a, c - a)), material.double_sided},
                  side, direction);
}

Photon PhotonSource::fromAfar(Direction to_light, Vec3 irradiance, Vec2 place) const {
  const Frame frame = Frame::about(to_light);
  const Vec2 on_disk = radius_ * squareToDisk(place);
  Photon p;
  p.ray.origin = centre_ + radius_ * to_light + on_disk.x * frame.t + on_disk.y * frame.b;
  p.ray.direction = -to_light;
  p.power = kPi * radius_ * radius_ * irradiance;
  return p;
}

Photon PhotonSource::emit(Vec2 choice, Vec2 place, Vec2 direction) const {
  const double at = static_cast<double>(choice.x) * cumulative_.back();
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, at);
  const auto chosen = static_cast<std::size_t>(found - cumulative_.begin());
  const Emitter& e = emitters_[chosen];
  const double own = cumulative_[chosen] - (chosen > 0 ? cumulative_[chosen - 1] : 0.0);
  Photon photon;
  switch (e.kind) {
    case Kind::kPunctual:
      photon = fromPunctual(scene_.lights[e.index], direction);
      break;
    case Kind::kDisk: {
      const Disk& disk = disks_[e.index];
      const Frame frame = Frame::about(disk.normal);
      const Vec2 on_disk = disk.radius * squareToDisk(place);
      photon = fromArea({disk.centre + on_disk.x * frame.t + on_disk.y * frame.b, disk.normal,
                         disk.radiance.rgb, kPi * disk.radius * disk.radius, disk.two_sided},
                        choice.y, direction);
      break;
    }
    case Kind::kPanel: {
      const Panel& panel = panels_[e.index];
      const float root = std::sqrt(place.x);
      const Vec3 u = panel.v1 - panel.v0, v = panel.v2 - panel.v0;
      photon = fromArea({panel.v0 + root * (1 - place.y) * u + root * place.y * v, panel.normal,
                         panel.radiance.rgb, 0.5f * glm::length(glm::cross(u, v)), panel.two_sided},
                        choice.y, direction);
      break;
    }
    case Kind::kTriangle:
      photon = fromTriangle(e, place, choice.y, direction);
      break;
    case Kind::kSun: {
      const LightSample sun = suns_[e.index].sample(direction);
      photon = fromAfar(sun.direction, sun.value / sun.pdf, place);
      break;
    }
    case Kind::kEnvironment: {
      const Direction d = environment_.sample(Normal(0), direction);
      const float pdf = environment_.pdf(Normal(0), d);
      photon = fromAfar(d, pdf > 0 ? scene_.environment.from(d).rgb / pdf : Vec3(0.0f), place);
      break;
    }
  }
  photon.power *= static_cast<float>(cumulative_.back() / own);
  return photon;
}

}  // namespace relume::transport
