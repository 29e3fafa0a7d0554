// SPDX-License-Identifier: MIT
// Where the rows of the pages begin among the points of an atlas.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "relume/atlas/texels.h"

namespace relume::transport {

class TexelRows {
 public:
  explicit TexelRows(const atlas::Texels& texels);

  struct Range {
    std::uint32_t begin, end;  ///< indices into Texels::points
  };
  /// The points of texels x_begin <= x < x_end of a row; rows count through all pages.
  Range within(std::size_t row, std::uint32_t x_begin, std::uint32_t x_end) const;

 private:
  const atlas::Texels& texels_;
  std::vector<std::uint32_t> begin_;  // [pages * height + 1]
};

}  // namespace relume::transport
