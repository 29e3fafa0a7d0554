// SPDX-License-Identifier: MIT
#include "texel_groups.h"

#include <algorithm>
#include <array>

namespace relume::transport {

TexelGroups::TexelGroups(const atlas::Texels& texels) : texels_(texels), rows_(texels) {
  const auto width = static_cast<std::uint32_t>(texels.width),
             height = static_cast<std::uint32_t>(texels.height);
  tiles_x_ = (width + kTileBlocks * kGroupSide - 1) / (kTileBlocks * kGroupSide);
  tiles_y_ = (height + kGroupSide - 1) / kGroupSide;
}

std::size_t TexelGroups::tiles() const {
  return static_cast<std::size_t>(texels_.pages) * tiles_x_ * tiles_y_;
}

std::vector<std::size_t> TexelGroups::tilesOf(std::span<const std::uint32_t> which) const {
  const auto width = static_cast<std::uint32_t>(texels_.width),
             height = static_cast<std::uint32_t>(texels_.height);
  std::vector<std::uint8_t> touched(tiles(), which.empty() ? 1 : 0);
  for (const std::uint32_t i : which) {
    const std::uint32_t texel = texels_.points[i].texel, x = texel % width, row = texel / width;
    const std::uint32_t band = row / height * tiles_y_ + row % height / kGroupSide;
    touched[static_cast<std::size_t>(band) * tiles_x_ + x / (kTileBlocks * kGroupSide)] = 1;
  }
  std::vector<std::size_t> result;
  for (std::size_t tile = 0; tile < touched.size(); ++tile)
    if (touched[tile]) result.push_back(tile);
  return result;
}

void TexelGroups::forEachGroup(std::size_t tile,
                               const std::function<void(std::span<const std::uint32_t>)>& visit) const {
  const auto width = static_cast<std::uint32_t>(texels_.width),
             height = static_cast<std::uint32_t>(texels_.height);
  const auto tile_x = static_cast<std::uint32_t>(tile % tiles_x_);
  const auto band = static_cast<std::uint32_t>(tile / tiles_x_);
  const std::uint32_t page = band / tiles_y_, y0 = (band % tiles_y_) * kGroupSide;
  const std::uint32_t rows = std::min(kGroupSide, height - y0);
  const std::uint32_t x_begin = tile_x * kTileBlocks * kGroupSide;
  const std::uint32_t x_end = std::min(width, x_begin + kTileBlocks * kGroupSide);

  std::array<std::uint32_t, kGroupSide> next{}, row_end{}, row_texel{};
  for (std::uint32_t r = 0; r < rows; ++r) {
    const std::size_t row = static_cast<std::size_t>(page) * height + y0 + r;
    row_texel[r] = static_cast<std::uint32_t>(row) * width;
    const auto [begin, end] = rows_.within(row, x_begin, x_end);
    next[r] = begin, row_end[r] = end;
  }
  for (std::uint32_t x = x_begin; x < x_end; x += kGroupSide) {
    std::array<std::uint32_t, kGroupTexels> block;
    std::size_t count = 0;
    for (std::uint32_t r = 0; r < rows; ++r) {
      const std::uint32_t end_texel = row_texel[r] + std::min(x + kGroupSide, x_end);
      while (next[r] < row_end[r] && texels_.points[next[r]].texel < end_texel) block[count++] = next[r]++;
    }
    const auto by_chart = [&](std::uint32_t a, std::uint32_t b) {
      return texels_.points[a].chart < texels_.points[b].chart;
    };
    const auto used = std::span(block).first(count);
    if (!std::is_sorted(used.begin(), used.end(), by_chart))
      std::stable_sort(used.begin(), used.end(), by_chart);
    for (std::size_t begin = 0; begin < count;) {
      std::size_t end = begin + 1;
      while (end < count && texels_.points[block[end]].chart == texels_.points[block[begin]].chart) ++end;
      visit(std::span(block).subspan(begin, end - begin));
      begin = end;
    }
  }
}

}  // namespace relume::transport
