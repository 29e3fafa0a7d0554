// SPDX-License-Identifier: MIT
// Fills the holes of an image from afar.
#pragma once
#include <cstdint>
#include <span>

namespace relume::atlas {

/// Gives every pixel with known == 0 the mean of what is known around it, at the finest scale that knows
/// anything there. Known pixels keep their bits. Leaves the image as it is where nothing is known at all.
/// shape: values [height][width][channels], known [height][width]
void pushPull(int width, int height, int channels, std::span<float> values,
              std::span<const std::uint8_t> known);

}  // namespace relume::atlas
