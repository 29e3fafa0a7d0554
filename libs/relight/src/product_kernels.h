// SPDX-License-Identifier: MIT
// The two inner loops of a product with a BlockMatrix. Every version gives the same bits: the sums of planes
// are whole numbers, the sums of weights are formed by fused multiply-add in sixteen lanes, in one order.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace relume::relight {

inline constexpr std::size_t kLanes = 16;      ///< columns that a sum of weights takes at a time
inline constexpr std::size_t kTogether = 8;    ///< components that share their reading of x, at most
inline constexpr std::size_t kStripRows = 16;  ///< rows whose sums stay in registers
inline constexpr std::size_t kQuad = 4;        ///< planes of which a row's samples lie together
inline constexpr int kPlaneZero = 128;         ///< what a sample of planes has added to it

/// Memory that will be read soon: what a kernel fetches while it works on what is there already.
struct Ahead {
  const std::byte* next = nullptr;
  const std::byte* end = nullptr;  ///< whole lines of the cache up to here
};

/// What weigh functions multiply and where they put it.
struct Weighing {
  const float* x;       ///< [3][stride]
  std::size_t stride;   ///< floats
  std::size_t columns;  ///< of x that are taken, a multiple of kLanes
  std::size_t count;    ///< of components, 1 to kTogether
  float sums[3][kTogether];
  Ahead ahead;
};

/// sums[channel][component] = sum over columns of q |q| x[channel][column].
/// weights: [columns / kLanes][count][kLanes]
template <class Q>
using WeighFunction = void (*)(const Q* weights, Weighing& w);

struct QuadRange {
  std::size_t begin, end;
};

/// A strip of rows: what is multiplied.
struct StripPlanes {
  /// [quads][3][kStripRows][kQuad], or [quads][kStripRows][kQuad] shared by the channels; each q + kPlaneZero
  const std::uint8_t* planes;
  const std::int16_t* factors;  ///< [quads][3][kQuad], as packFactors of the kernels has left them
  /// [quads / kGroupQuads][3]: unit of the factors, and -kPlaneZero times their sum
  const float* steps;
  const std::int32_t* starts;
  const QuadRange* ranges;  ///< quads that are taken, rising and apart, each within one group
  std::size_t range_count;
  Ahead ahead;
};

/// rows[row][channel] = sum over quads of step[channel] sum over k of factors[quad][channel][k] q[k]. Groups
/// of quads are summed in whole numbers, which stay below 2^31 even with 128 added to each q: 256 planes *
/// kMostFactor * 255.
using AddStripFunction = void (*)(StripPlanes& strip, float (*rows)[3]);
inline constexpr std::size_t kGroupQuads = 64;
inline constexpr int kMostFactor = 32512;  ///< a high digit of 8 bits times 256

struct ProductKernels {
  WeighFunction<std::int8_t> weigh8;
  WeighFunction<std::int16_t> weigh16;
  AddStripFunction add_strip, add_shared_strip;
  /// Of a quad and a channel, [kQuad], into the form that add_strip wants.
  void (*pack_factors)(std::int16_t* factors, std::size_t quads);
};

/// For any processor. Slow where fused multiply-add is not an instruction.
const ProductKernels& plainKernels();
/// All that this processor can run, the fastest first and plainKernels() last.
std::span<const ProductKernels* const> kernelsHere();

}  // namespace relume::relight
