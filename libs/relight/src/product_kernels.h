// SPDX-License-Identifier: MIT
// The two inner loops of a product with a BlockMatrix. Every version gives the same bits: the sums of planes
// are whole numbers, the sums of weights are formed by fused multiply-add in eight lanes, in one order.
#pragma once
#include <cstddef>
#include <cstdint>

namespace relume::relight {

inline constexpr std::size_t kLanes = 8;       ///< columns that a sum of weights takes at a time
inline constexpr std::size_t kTogether = 4;    ///< components that share their reading of x, at most
inline constexpr std::size_t kStripRows = 16;  ///< rows whose sums stay in registers

/// What weigh functions multiply and where they put it.
struct Weighing {
  const float* x;       ///< [3][stride]
  std::size_t stride;   ///< floats
  std::size_t columns;  ///< of x that are taken, a multiple of kLanes
  std::size_t count;    ///< of components, 1 to kTogether
  float sums[3][kTogether];
};

/// sums[channel][component] = sum over columns of q |q| x[channel][column].
/// weights: [columns / kLanes][count][kLanes]
template <class Q>
using WeighFunction = void (*)(const Q* weights, Weighing& w);

struct PairRange {
  std::size_t begin, end;
};

/// A strip of rows: what is multiplied.
struct StripPlanes {
  const std::int8_t* planes;  ///< [pairs][3][kStripRows][2], or [pairs][kStripRows][2] shared by the channels
  const std::int16_t* factors;  ///< [pairs][3][2]
  const float* steps;           ///< [pairs / kGroupPairs][3], unit of the factors
  const PairRange* ranges;      ///< pairs that are taken, rising and apart, each within one group
  std::size_t range_count;
};

/// rows[row][channel] = sum over pairs of step[channel] (factors[pair][channel][0]
/// planes[pair][channel][row][0] + factors[..][1] planes[..][1]); rows[row][3] = 0. Groups of pairs are
/// summed in whole numbers, which stay below 2^31: 2 * 128 pairs * 32767 * 128.
using AddStripFunction = void (*)(const StripPlanes& strip, float (*rows)[4]);
inline constexpr std::size_t kGroupPairs = 128;

struct ProductKernels {
  WeighFunction<std::int8_t> weigh8;
  WeighFunction<std::int16_t> weigh16;
  AddStripFunction add_strip, add_shared_strip;
};

/// For any processor. Slow where fused multiply-add is not an instruction.
const ProductKernels& plainKernels();
/// The fastest that this processor can run.
const ProductKernels& bestKernels();

}  // namespace relume::relight
