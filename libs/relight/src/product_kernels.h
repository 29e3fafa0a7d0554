// SPDX-License-Identifier: MIT
// The two inner loops of a product with a BlockMatrix. Every version gives the same bits: the sums of planes
// are whole numbers, the sums of weights are formed in eight lanes in one order, without fused operations.
#pragma once
#include <cstddef>
#include <cstdint>

namespace relume::relight {

inline constexpr std::size_t kLanes = 8;       ///< columns that a sum of weights takes at a time
inline constexpr std::size_t kTogether = 4;    ///< components that share their reading of x
inline constexpr std::size_t kStripRows = 16;  ///< rows whose sums stay in registers

/// sums[channel][component] = sum over columns of q |q| x[channel][column].
/// weights: [columns / kLanes][kTogether][kLanes]; x: [3][stride], of which `columns`, a multiple of kLanes,
/// are taken; sums: [3][kTogether]. `ahead`: memory that is read next, fetched meanwhile, one line for each
/// kLanes columns; it need not exist.
template <class Q>
using WeighFunction = void (*)(const Q* weights, const float* x, std::size_t stride, std::size_t columns,
                               float* sums, const std::int8_t* ahead);

/// sums[row] += sum over pairs of factors[pair][0] planes[pair][row][0] + factors[pair][1]
/// planes[pair][row][1]. planes: [pairs][kStripRows][2]; sums: [kStripRows]. Must stay within 31 bits.
using AddPairsFunction = void (*)(const std::int8_t* planes, const std::int16_t* factors, std::size_t pairs,
                                  std::int32_t* sums);

struct ProductKernels {
  WeighFunction<std::int8_t> weigh8;
  WeighFunction<std::int16_t> weigh16;
  AddPairsFunction add_pairs;
};

/// For any processor.
const ProductKernels& plainKernels();
/// The fastest that this processor can run.
const ProductKernels& bestKernels();

}  // namespace relume::relight
