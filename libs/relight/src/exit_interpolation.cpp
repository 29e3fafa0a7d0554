// SPDX-License-Identifier: MIT
#include "relume/relight/exit_interpolation.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

constexpr float kTurnCosine = 0.7071f;  // 45 degrees
constexpr std::size_t kTexelsAtOnce = 4096;

struct Block {
  std::uint32_t page, chart;
  std::int64_t y, x;
  auto operator<=>(const Block&) const = default;
};

/// Where the exits are.
class ExitMap {
 public:
  ExitMap(const asset::Exits& exits, std::size_t exit_count, const asset::AtlasTable& atlas)
      : side_(exits.side), atlas_(atlas), normal_(exit_count, Vec3(0)) {
    for (std::size_t i = 0; i < exits.exit_of_texel.size(); ++i) {
      const std::uint32_t exit = exits.exit_of_texel[i];
      normal_[exit] += atlas.normal[i];
      places_.emplace_back(blockOf(i), exit);
    }
    std::sort(places_.begin(), places_.end());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
    for (Vec3& n : normal_) {
      const float length = glm::length(n);
      if (length > 0) n /= length;
    }
  }

  Block blockOf(std::size_t i) const {
    const Vec2 p = placeOf(i);
    return {page(i), atlas_.chart[i], static_cast<std::int64_t>(p.y) / side_,
            static_cast<std::int64_t>(p.x) / side_};
  }
  /// Column and row of a texel in its page.
  Vec2 placeOf(std::size_t i) const {
    const auto width = static_cast<std::uint32_t>(atlas_.width),
               height = static_cast<std::uint32_t>(atlas_.height);
    return {atlas_.texel[i] % width, atlas_.texel[i] / width % height};
  }
  std::uint32_t page(std::size_t i) const {
    return atlas_.texel[i] / static_cast<std::uint32_t>(atlas_.width) /
           static_cast<std::uint32_t>(atlas_.height);
  }

  /// The exit of a block that faces as texel i does, or none.
  const std::uint32_t* find(const Block& block, std::size_t i) const {
    const std::uint32_t* best = nullptr;
    float best_cosine = kTurnCosine;
    const auto first = std::lower_bound(places_.begin(), places_.end(), std::pair(block, std::uint32_t{0}));
    for (auto it = first; it != places_.end() && it->first == block; ++it) {
      const float cosine = glm::dot(normal_[it->second], atlas_.normal[i]);
      if (cosine > best_cosine) best = &it->second, best_cosine = cosine;
    }
    return best;
  }

 private:
  std::int64_t side_;
  const asset::AtlasTable& atlas_;
  std::vector<Normal> normal_;
  std::vector<std::pair<Block, std::uint32_t>> places_;
};

}  // namespace

ExitInterpolation::ExitInterpolation(const asset::Exits& exits, std::size_t exit_count,
                                     const asset::AtlasTable& atlas)
    : first_{0} {
  const ExitMap map(exits, exit_count, atlas);
  const auto side = static_cast<float>(exits.side);
  for (std::size_t i = 0; i < exits.exit_of_texel.size(); ++i) {
    const Block own = map.blockOf(i);
    const Vec2 place = (map.placeOf(i) + 0.5f) / side - 0.5f;
    const Vec2 low = glm::floor(place), part = place - low;
    const std::size_t begin = exit_.size();
    float sum = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const int dx = corner % 2, dy = corner / 2;
      const float weight = (dx ? part.x : 1 - part.x) * (dy ? part.y : 1 - part.y);
      Block block = own;
      block.x = static_cast<std::int64_t>(low.x) + dx, block.y = static_cast<std::int64_t>(low.y) + dy;
      const std::uint32_t* exit = block == own ? &exits.exit_of_texel[i] : map.find(block, i);
      if (!exit || !(weight > 0)) continue;
      exit_.push_back(*exit);
      weight_.push_back(weight);
      sum += weight;
    }
    for (std::size_t k = begin; k < weight_.size(); ++k) weight_[k] /= sum;
    first_.push_back(static_cast<std::uint32_t>(exit_.size()));
  }
}

ExitInterpolation::ExitInterpolation(const asset::VertexExits& vertices) : first_{0} {
  for (std::size_t i = 0; i < vertices.texel_exit.size(); i += 3) {
    for (std::size_t k = i; k < i + 3; ++k) {
      if (vertices.texel_weight[k] == 0) continue;
      exit_.push_back(vertices.texel_exit[k]);
      weight_.push_back(static_cast<float>(vertices.texel_weight[k]) / 255.0f);
    }
    first_.push_back(static_cast<std::uint32_t>(exit_.size()));
  }
}

void ExitInterpolation::apply(std::span<const Irradiance> exits, std::span<Irradiance> texels) const {
  struct Job {
    const ExitInterpolation& self;
    std::span<const Irradiance> exits;
    std::span<Irradiance> texels;
  } job{*this, exits, texels};
  parallelFor(texels.size(), kTexelsAtOnce, [&job](std::size_t begin, std::size_t end) {
    std::size_t k = job.self.first_[begin];
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 sum(0);
      for (; k < job.self.first_[i + 1]; ++k) sum += job.self.weight_[k] * job.exits[job.self.exit_[k]].rgb;
      job.texels[i] = Irradiance(sum);
    }
  });
}

}  // namespace relume::relight
