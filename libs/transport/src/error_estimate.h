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

/// Of one net of 16 columns (sample_table.h) at once: values [count][16] of a chunk in Morton order, the mean
/// of each column. Adds to `variance` [16] the estimated variance of each column's sum.
void addNetVariances(std::span<const float> values, std::span<const float, 16> mean, std::span<float> scratch,
                     std::span<float, 16> variance);

/// The standard error of the mean of `kept` values out of n, whose sum has this estimated variance.
float standardErrorOf(float variance, std::uint32_t kept, std::uint32_t n);

/// The same of a mean of n values of any size, whose mean is about `typical`.
float radianceStandardError(float variance, std::uint32_t n, float typical);

}  // namespace relume::transport
