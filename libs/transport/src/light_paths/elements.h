// SPDX-License-Identifier: MIT
// Elements of radiosity that need not be blocks of an atlas: groups of pieces of surface, and what falls on
// them after any number of reflections. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.2.1, equation 11.4:
//   B_i = E_i + rho_i sum_j F_ij B_j,
// here for many sources at once, each a column. What an element sends out is not even: it has the shape of
// typical light (typical_light.h), with which F_ij is weighed.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "light_paths/members.h"
#include "light_paths/piece_entries.h"
#include "light_paths/pieces.h"
#include "light_paths/weight_sum.h"
#include "lightmap/reflectance.h"
#include "radiosity/form_factors.h"

namespace relume::transport {

struct Elements {
  std::vector<std::uint32_t> of_piece;
  std::vector<std::uint32_t> of_side;  ///< scene::kNone for buried sides
  std::vector<float> shape;            ///< by piece: irradiance on it over that on its element
  std::vector<float> area;             ///< m^2
  std::vector<Vec3> reflectance;       ///< of light that has been reflected before
  FormFactors factors{0};

  std::size_t size() const { return area.size(); }
};

/// Form factors come from the rays that Sides kept. shape: by piece. Throws Error kInterrupted.
Elements makeElements(const Sides& sides, const Pieces& pieces, const MeanReflectance& reflectance,
                      std::vector<std::uint32_t> of_piece, std::size_t count, std::vector<float> shape,
                      Progress& progress);

/// Light that comes straight from lights and is reflected once: irradiance on elements, by rows of weights of
/// the light on columns. Pieces are seen one by one.
struct FirstReflection {
  std::vector<std::size_t> first;  ///< by element, and one more
  std::vector<Weight> weights;     ///< by element, columns rising
  std::span<const Weight> of(std::size_t element) const {
    return std::span(weights).subspan(first[element], first[element + 1] - first[element]);
  }
};
/// entries: the columns. Throws Error kInterrupted.
FirstReflection firstReflection(const Elements& elements, const Sides& sides, const Pieces& pieces,
                                const MeanReflectance& reflectance, const PieceEntries& entries,
                                std::size_t columns, Progress& progress);

/// Irradiance on elements that has been reflected at least once, for many columns: in blocks of so many,
/// since a block is what the caches hold.
class ElementLight {
 public:
  static constexpr std::size_t kBlock = 32;        ///< columns
  static constexpr std::size_t kRow = 3 * kBlock;  ///< floats of an element: [channels][columns]

  /// Adds to `irradiance`, shape [elements][3][kBlock], what falls on elements after one reflection, in
  /// columns from block * kBlock on.
  using Fill = std::function<void(std::size_t block, std::span<float> irradiance)>;

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
