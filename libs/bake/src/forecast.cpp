// SPDX-License-Identifier: MIT
#include "forecast.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <vector>

namespace relume::bake {
namespace {

// Solvers treat blocks of so many texels both ways at once: one texel alone would cost as much as its block.
constexpr std::uint32_t kBlockSide = 16;
constexpr std::size_t kFirstRound = 32;  // blocks, so that no core is idle
constexpr double kLongEnough = 0.4;      // seconds, of a round
constexpr double kGoldenRatio = 0.6180339887;

/// Pending texels block by block, in an order of which every part is spread over the atlas.
class Blocks {
 public:
  Blocks(const atlas::Texels& texels, std::span<const std::uint32_t> pending) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> by_block;
    const auto width = static_cast<std::uint32_t>(texels.width),
               height = static_cast<std::uint32_t>(texels.height);
    for (const std::uint32_t point : pending) {
      const std::uint32_t row = texels.points[point].texel / width, x = texels.points[point].texel % width;
      const std::uint64_t band = std::uint64_t{row / height} * height + row % height / kBlockSide;
      by_block.emplace_back(band * width + x / kBlockSide, point);
    }
    std::sort(by_block.begin(), by_block.end());
    for (std::size_t i = 0; i < by_block.size(); ++i) {
      if (i == 0 || by_block[i].first != by_block[i - 1].first) begin_.push_back(texels_.size());
      texels_.push_back(by_block[i].second);
    }
    begin_.push_back(texels_.size());
    if (count() == 0) return;
    stride_ = std::max<std::size_t>(1, static_cast<std::size_t>(kGoldenRatio * static_cast<double>(count())));
    while (std::gcd(stride_, count()) != 1) ++stride_;
  }

  std::size_t count() const { return begin_.size() - 1; }
  std::size_t left() const { return count() - next_; }

  /// The texels of so many blocks that were not taken before, ascending.
  std::vector<std::uint32_t> take(std::size_t blocks) {
    std::vector<std::uint32_t> taken;
    for (const std::size_t end = next_ + std::min(blocks, left()); next_ < end; ++next_) {
      const std::size_t block = next_ * stride_ % count();
      for (std::size_t i = begin_[block]; i < begin_[block + 1]; ++i) taken.push_back(texels_[i]);
    }
    std::sort(taken.begin(), taken.end());
    return taken;
  }

 private:
  std::vector<std::uint32_t> texels_;
  std::vector<std::size_t> begin_;  // of each block's texels, and the end
  std::size_t stride_ = 1, next_ = 0;
};

}  // namespace

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double forecastSeconds(const TexelSolver& solver, const atlas::Texels& texels,
                       std::span<const std::uint32_t> pending, Progress& progress, const Clock& now) {
  Blocks blocks(texels, pending);
  std::vector<float> rows;
  std::size_t solved = 0;
  const auto solve = [&](std::size_t count) {
    const std::vector<std::uint32_t> which = blocks.take(count);
    rows.resize(which.size() * static_cast<std::size_t>(solver.row));
    const double start = now();
    solver.solve(which, rows, progress);
    solved = which.size();
    return now() - start;
  };
  if (pending.empty()) return 0;
  const double first = solve(1);
  const auto texels_of_first = static_cast<double>(solved);
  double seconds = 0;
  for (std::size_t round = kFirstRound; blocks.left() > 0 && seconds < kLongEnough; round *= 2)
    seconds = solve(round);
  if (!(seconds > 0)) return first;  // there was one block only
  const double per_texel = seconds / static_cast<double>(solved);
  return std::max(first - texels_of_first * per_texel, 0.0) + per_texel * static_cast<double>(pending.size());
}

}  // namespace relume::bake
