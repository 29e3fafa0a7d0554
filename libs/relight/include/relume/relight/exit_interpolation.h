// SPDX-License-Identifier: MIT
// From exits to texels: bilinear between the middles of blocks, within a chart; of vertices within a
// triangle.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/asset/transfer.h"
#include "relume/core/quantity.h"

namespace relume::relight {

class ExitInterpolation {
 public:
  /// Blocks of one chart blend with their neighbours of the same chart, but not where normals turn by more
  /// than 45 degrees; where a neighbour is missing those that are there share its weight.
  ExitInterpolation(const asset::Exits& exits, std::size_t exit_count, const asset::AtlasTable& atlas);

  explicit ExitInterpolation(const asset::VertexExits& vertices);

  std::size_t texelCount() const { return first_.size() - 1; }
  /// As a sparse matrix by rows, for renderers that multiply it themselves: of texel i the terms first()[i]
  /// up to first()[i + 1].
  std::span<const std::uint32_t> first() const { return first_; }
  std::span<const std::uint32_t> exit() const { return exit_; }
  std::span<const float> weight() const { return weight_; }
  /// exits: [exits]; texels: [texels of the atlas table]
  void apply(std::span<const Irradiance> exits, std::span<Irradiance> texels) const;

 private:
  std::vector<std::uint32_t> first_;  ///< of each texel, into exit_ and weight_
  std::vector<std::uint32_t> exit_;
  std::vector<float> weight_;  ///< of a texel sum to 1
};

}  // namespace relume::relight
