// SPDX-License-Identifier: MIT
// A day's light: the sun along its path, the sky, and lamps by a timetable. All that shines is known for
// every minute beforehand.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "relume/core/light.h"
#include "relume/core/sun.h"

namespace relume {

inline constexpr double kDayMinutes = 1440;

/// A lamp at one time; what is not given stays as it is.
struct LightKey {
  double minutes = 0;  ///< since midnight, by the clock
  std::optional<float> intensity;
  std::optional<Vec3> colour;
  std::optional<Point> position;
  std::optional<Direction> direction;
};
struct KeyedLight {
  Light light;
  std::vector<LightKey> keys;  ///< by time, increasing
};
/// By how much a group of lamps is dimmed and coloured at one time.
struct GainKey {
  double minutes = 0;
  Vec3 gain{1.0f};
};

/// Between two keys all is linear; from the last one to midnight and on to the first one too, as day follows
/// day. Two keys at one time: a switch.
struct Day {
  enum class Sky : std::uint8_t { kModel, kConstant, kNone };

  Place place{55.49, 9.47};
  Date date;
  double utc_offset = 0;   ///< hours that the clock is ahead of UTC
  double heading_deg = 0;  ///< where -Z looks to, clockwise from north
  double turbidity = 3;    ///< of the air: 2 clear, 6 hazy; to 10
  float scale = 1;         ///< what lux and cd/m^2 of the sun and the sky are multiplied by
  bool sun = true;
  /// kModel: the clear sky with all that the sun's place does to it; kConstant: equal from all sides, dimmed
  /// and coloured through the day.
  Sky sky = Sky::kModel;
  double begin = 0, end = kDayMinutes;            ///< minutes; what is asked for outside is as at the nearer
  std::optional<std::vector<KeyedLight>> lights;  ///< instead of the scene's lamps
  std::map<std::string, std::vector<GainKey>> groups;  ///< of lamps and emissive surfaces, by name

  double clamped(double minutes) const;
  SunPosition sunAt(double minutes) const;
  /// Unit, to the sun.
  Direction toSun(double minutes) const;
  /// Of a group; 1 where nothing is said of it.
  Vec3 gainAt(const std::string& group, double minutes) const;
  /// Lamps at a time: `scene_lights` but for directional ones (suns), or `lights` instead; dimmed by their
  /// groups, those that are dark left out.
  LightSet lampsAt(const LightSet& scene_lights, double minutes) const;
  /// The sun in lux; nothing while it is below the horizon.
  std::optional<Light> sunLightAt(double minutes) const;
  /// Both.
  LightSet lightsAt(const LightSet& scene_lights, double minutes) const;
  /// Mean radiance of the upper hemisphere that gives the sky's illuminance.
  Vec3 meanSkyAt(double minutes) const;
  /// Where light may change its course: begin, end, keys (of a switch both
  /// sides, a second apart), the rims of the sun at the horizon, noon;
  /// increasing.
  std::vector<double> breaks() const;
};

/// "HH:MM" of minutes, seconds where there are any.
std::string clockText(double minutes);
/// Minutes of "H:MM", "HH:MM" or "HH:MM:SS"; nothing where it is no time of the day (24:00 is one).
std::optional<double> clockMinutes(const std::string& text);

}  // namespace relume
