// SPDX-License-Identifier: MIT
#include "scenes.h"

namespace relume::scenes {

std::span<const SceneEntry> allScenes() {
  static constexpr SceneEntry kScenes[] = {{"cornell", makeCornell},     {"hall", makeHall},
                                           {"temple", makeTemple},       {"car", makeCar},
                                           {"halls", makeHalls},         {"rooms", makeRooms},
                                           {"crossing", makeCrossing},   {"lampshade", makeLampshade},
                                           {"furniture", makeFurniture}, {"glossy_room", makeGlossyRoom},
                                           {"courtyard", makeCourtyard}, {"vase", makeVase},
                                           {"day_hall", makeDayHall}};
  return kScenes;
}

}  // namespace relume::scenes
