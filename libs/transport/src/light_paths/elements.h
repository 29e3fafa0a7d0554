// SPDX-License-Identifier: MIT
// Elements of radiosity that need not be blocks of an atlas: groups of pieces of surface, and what falls on
// them after any number of reflections. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.2.1, equation 11.4:
//   B_i = E_i + rho_i sum_j F_ij B_j,
// here for many sources at once, each a column.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "light_paths/members.h"
#include "light_paths/pieces.h"
#include "light_paths/weight_sum.h"
#include "lightmap/reflectance.h"
#include "radiosity/form_factors.h"

namespace relume::transport {

struct Elements {
  std::vector<std::uint32_t> of_piece;
  std::vector<float> area;        ///< m^2
  std::vector<Vec3> reflectance;  ///< of light that has been reflected before
  FormFactors factors{0};
  /// Radiosity of an element per unit of light straight from lights on a piece: by element, pieces rising.
  std::vector<std::uint32_t> first_source;
  std::vector<Weight> sources;

  std::size_t size() const { return area.size(); }
  std::span<const Weight> sourcesOf(std::size_t element) const {
    return std::span(sources).subspan(first_source[element],
                                      first_source[element + 1] - first_source[element]);
  }
};

/// Form factors come from the rays that Sides kept. Throws Error kInterrupted.
Elements makeElements(const Sides& sides, const Pieces& pieces, const MeanReflectance& reflectance,
                      std::vector<std::uint32_t> of_piece, std::size_t count, Progress& progress);

/// Irradiance on elements that has been reflected at least once, for many columns: in blocks of so many,
/// since a block is what the caches hold.
class ElementLight {
 public:
  static constexpr std::size_t kBlock = 32;        ///< columns
  static constexpr std::size_t kRow = 3 * kBlock;  ///< floats of an element: [channels][columns]

  /// Adds to `radiosity`, shape [elements][3][kBlock], what elements send out of light straight from lights,
  /// in columns from block * kBlock on.
  using Fill = std::function<void(std::size_t block, std::span<float> radiosity)>;

  /// Solves the equations of elements by sweeps of Gauss-Seidel until a sweep changes less than `residual` of
  /// all light. Bits do not depend on the number of threads. Throws Error kInterrupted.
  ElementLight(const Elements& elements, std::size_t columns, const Fill& fill, double residual,
               Progress& progress);

  std::size_t columns() const { return columns_; }
  std::size_t blocks() const { return (columns_ + kBlock - 1) / kBlock; }
  /// shape: [3][kBlock]
  const float* of(std::size_t block, std::size_t element) const {
    return light_.data() + (block * elements_ + element) * kRow;
  }
  std::uint64_t bytes() const { return light_.size() * sizeof(float); }
  std::uint32_t sweeps() const { return sweeps_; }  ///< of the block that took most

 private:
  std::size_t columns_, elements_;
  std::vector<float> light_;
  std::uint32_t sweeps_ = 0;
};

}  // namespace relume::transport
