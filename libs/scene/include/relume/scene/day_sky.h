// SPDX-License-Identifier: MIT
// The sky of a day, and a scene as the day lights it.
#pragma once
#include "relume/core/day.h"
#include "relume/scene/environment.h"
#include "relume/scene/scene.h"

namespace relume::scene {

/// The sky without the sun, in the day's units: its horizontal illuminance is Day::scale times skyIlluminance
/// (core/daylight.h). Sky::kModel: distributed as skyImage has it; from the time when the sun is 2 degrees
/// high its shape stays as it is then, turning blue and even until the sun is 6 degrees below the horizon.
/// Below the horizon lies ground of albedo 0.15 in that light and the sun's. Sky::kConstant: Day::meanSkyAt
/// from all around. Dark without a sky, and by night.
Environment skyAt(const Day& day, double minutes, int height = 64);

/// Gives the scene the lights, the emission and the sky of that time.
void lightAt(Scene& scene, const Day& day, double minutes);

}  // namespace relume::scene
