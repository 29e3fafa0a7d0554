// SPDX-License-Identifier: MIT
#include "relume/scene/day_sky.h"

#include <algorithm>
#include <cmath>

#include "relume/core/daylight.h"
#include "relume/scene/light_groups.h"
#include "relume/scene/sky.h"

namespace relume::scene {
namespace {

constexpr double kLowestSun = 2;  // degrees: the sky model is no good below
constexpr float kGround = 0.15f;  // albedo of what lies below the horizon
constexpr double kBlueHour = -6;  // degrees: all of the sky is of one colour

/// Lux on a horizontal plane.
double horizontalLight(const image::Image& sky) {
  double sum = 0;
  for (int y = 0; y < sky.height / 2; ++y) {
    const double top = M_PI * y / sky.height, bottom = M_PI * (y + 1) / sky.height;
    // cos(theta) sin(theta) over the row
    const double weight = 0.25 * (std::cos(2 * top) - std::cos(2 * bottom)) * 2 * M_PI / sky.width;
    for (int x = 0; x < sky.width; ++x) sum += weight * static_cast<double>(luminance(sky.rgb(x, y)));
  }
  return sum;
}

}  // namespace

Environment skyAt(const Day& day, double minutes, int height) {
  Environment environment;
  const Vec3 mean = day.meanSkyAt(minutes);
  if (mean == Vec3(0.0f)) return environment;
  if (day.sky == Day::Sky::kConstant) {
    environment.radiance = Radiance(mean);
    return environment;
  }
  const SunPosition sun = day.sunAt(minutes);
  const Direction to_sun =
      skyDirection(sun.azimuth_deg, std::max(sun.elevation_deg, kLowestSun), day.heading_deg);
  image::Image sky = skyImage(to_sun, static_cast<float>(day.turbidity), height);
  const auto even =
      static_cast<float>(std::clamp((kLowestSun - sun.elevation_deg) / (kLowestSun - kBlueHour), 0.0, 1.0));
  const double lux = M_PI * static_cast<double>(luminance(mean));
  const auto scale = static_cast<float>(lux / horizontalLight(sky));
  for (int y = 0; y < height / 2; ++y)
    for (int x = 0; x < sky.width; ++x) sky.setRgb(x, y, glm::mix(scale * sky.rgb(x, y), mean, even));
  Vec3 onto_ground = kPi * mean;
  if (const auto light = day.sunLightAt(minutes))
    onto_ground += light->colour * (light->intensity * std::max(-light->direction.y, 0.0f));
  for (int y = height / 2; y < height; ++y)
    for (int x = 0; x < sky.width; ++x) sky.setRgb(x, y, onto_ground * (kGround * kInvPi));
  environment.radiance = Radiance(1.0f);
  environment.map = std::make_shared<const image::Image>(std::move(sky));
  return environment;
}

void lightAt(Scene& scene, const Day& day, double minutes) {
  scene.lights = day.lightsAt(scene.lights, minutes);
  for (Material& material : scene.materials) material.emission *= day.gainAt(groupOf(material), minutes);
  scene.environment = skyAt(day, minutes);
}

}  // namespace relume::scene
