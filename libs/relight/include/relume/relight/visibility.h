// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <functional>
#include <span>

namespace relume::relight {

/// Visibility of `light` (its index in the set) at every point that a relighter asks about: fills with values
/// in [0, 1]. The run-time has no rays; an engine answers from its shadow maps, the command line from rays.
/// None: every light is seen everywhere. Called from the thread that evaluates, lights in order.
using VisibilitySource = std::function<void(std::size_t light, std::span<float> visibility)>;

}  // namespace relume::relight
