// SPDX-License-Identifier: MIT
// The faces of cube maps.
#pragma once
#include <array>

#include "relume/core/vec.h"

namespace relume::render {

struct CubeFace {
  Vec3 forward, up;
};
/// OpenGL's order and orientation.
inline constexpr std::array<CubeFace, 6> kCubeFaces = {{{{1, 0, 0}, {0, -1, 0}},
                                                        {{-1, 0, 0}, {0, -1, 0}},
                                                        {{0, 1, 0}, {0, 0, 1}},
                                                        {{0, -1, 0}, {0, 0, -1}},
                                                        {{0, 0, 1}, {0, -1, 0}},
                                                        {{0, 0, -1}, {0, -1, 0}}}};

}  // namespace relume::render
