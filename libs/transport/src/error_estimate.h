// SPDX-License-Identifier: MIT
// The standard error of a mean over a randomized net, from one set of samples.
#pragma once
#include <cstdint>
#include <span>

namespace relume::transport {

/// `values` and `codes` (direction_batch.h) of the first n samples of a sequence, n a power of two; negative
/// values are discarded samples. `scratch`: at least n. Returns the standard error of the mean of the kept
/// values, never 0.
float netStandardError(std::span<const float> values, std::span<const std::uint16_t> codes,
                       std::span<float> scratch);

}  // namespace relume::transport
