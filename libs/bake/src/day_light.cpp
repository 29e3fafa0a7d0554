// SPDX-License-Identifier: MIT
#include "day_light.h"

#include <algorithm>

#include "relume/scene/day_sky.h"
#include "relume/scene/light_groups.h"

namespace relume::bake {
namespace {

bool moves(const KeyedLight& lamp) {
  return std::any_of(lamp.keys.begin(), lamp.keys.end(),
                     [](const LightKey& key) { return key.position || key.direction; });
}

}  // namespace

DayLight::DayLight(const transport::LightSequence& sequence, const scene::Scene& scene, const Day& day)
    : sequence_(sequence), day_(day), lit_(scene), surfaces_(scene) {
  lit_.lights.clear(), surfaces_.lights.clear();
  lit_.environment = surfaces_.environment = {};
  for (scene::Material& m : lit_.materials) m.emission = Vec3(0.0f);
  if (day.lights)
    addKeyed(*day.lights);
  else
    addScene(scene.lights);
  addSurfaces();
}

DayLight::Direct DayLight::trace(const LightSet& lights) {
  lit_.lights = lights;
  return sequence_.direct(transport::Emitters(lit_));
}

void DayLight::addScene(const LightSet& lamps) {
  std::map<std::string, LightSet> groups;
  for (const relume::Light& lamp : lamps)
    if (lamp.kind != relume::Light::Kind::kDirectional) groups[scene::groupOf(lamp)].push_back(lamp);
  for (const auto& [group, lights] : groups) columns_.push_back({.group = group, .direct = trace(lights)});
}

void DayLight::addKeyed(const std::vector<KeyedLight>& lamps) {
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    if (moves(lamps[i])) {
      moving_.push_back(i);
      continue;
    }
    relume::Light unit = lamps[i].light;
    unit.intensity = 1, unit.colour = Vec3(1.0f);
    columns_.push_back({.group = scene::groupOf(unit), .keyed = i, .direct = trace({unit})});
  }
}

void DayLight::addSurfaces() {
  for (const std::string& group : scene::lightGroups(surfaces_))
    columns_.push_back({.group = group,
                        .surface = true,
                        .direct = sequence_.direct(transport::Emitters(
                            surfaces_, false, transport::EmissiveSurfaces::kIncluded, group))});
}

Vec3 DayLight::gainOf(const Column& column, double minutes) const {
  if (column.keyed == kNoLamp) return day_.gainAt(column.group, minutes);
  Day alone = day_;
  alone.lights = {(*day_.lights)[column.keyed]};
  const LightSet lamp = alone.lampsAt({}, minutes);
  return lamp.empty() ? Vec3(0.0f) : lamp[0].colour * lamp[0].intensity;
}

DayLight::Light DayLight::at(double minutes) {
  ++frames_;
  LightSet fresh;
  if (auto sun = day_.sunLightAt(minutes)) fresh.push_back(std::move(*sun));
  if (!moving_.empty()) {
    Day alone = day_;
    alone.lights.emplace();
    for (const std::size_t i : moving_) alone.lights->push_back((*day_.lights)[i]);
    const LightSet lamps = alone.lampsAt({}, minutes);
    fresh.insert(fresh.end(), lamps.begin(), lamps.end());
  }
  Direct direct = fresh.empty() ? sequence_.dark() : trace(fresh);
  for (const Column& column : columns_)
    if (const Vec3 gain = gainOf(column, minutes); gain != Vec3(0.0f)) direct.add(column.direct, gain);
  Light light = sequence_.light(direct, scene::skyAt(day_, minutes));
  for (const Column& column : columns_) {
    if (!column.surface) continue;
    const Vec3 gain = gainOf(column, minutes);
    for (std::size_t i = 0; i < light.irradiance.size(); ++i)
      light.irradiance[i] += gain * column.direct.irradiance[i];
  }
  return light;
}

}  // namespace relume::bake
