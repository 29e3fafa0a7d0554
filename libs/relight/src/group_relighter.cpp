// SPDX-License-Identifier: MIT
#include "relume/relight/group_relighter.h"

#include <fmt/format.h>

#include <algorithm>

#include "relume/core/check.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

constexpr std::size_t kBlockTexels = 1024;

}  // namespace

GroupRelighter::GroupRelighter(const asset::Asset& asset, const asset::Layer& layer) {
  const std::vector<std::uint32_t>& texel = asset.atlas.texel;
  for (const asset::Plane& plane : layer.planes) {
    if (plane.channels != 3 || plane.values.size() != asset.atlas.pageTexels() * 3) continue;
    names_.push_back(plane.name);
    auto& group = values_.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      group[c].resize(texel.size());
      for (std::size_t i = 0; i < texel.size(); ++i)
        group[c][i] = plane.values[3 * std::size_t{texel[i]} + c];
    }
  }
  if (layer.kind != "lightgroups" || names_.empty())
    throw Error(ErrorCode::kMismatch, "layer " + layer.name, "has no light groups",
                "relight a layer of kind lightgroups");
  result_.resize(texel.size());
}

std::span<const Irradiance> GroupRelighter::evaluate(std::span<const Vec3> gains) {
  RELUME_CHECK_EQ(gains.size(), groupCount());
  for (std::size_t g = 0; g < gains.size(); ++g)
    for (int c = 0; c < 3; ++c)
      if (!(gains[g][c] >= 0 && gains[g][c] < kInfinity))
        throw Error(ErrorCode::kInvalidValue, "group " + names_[g],
                    fmt::format("has the gain {}", gains[g][c]), "take numbers of 0 and above");
  struct Job {
    GroupRelighter& self;
    std::span<const Vec3> gains;
  } job{*this, gains};
  parallelFor(result_.size(), kBlockTexels, [&job](std::size_t begin, std::size_t end) {
    float sums[3][kBlockTexels] = {};
    const std::size_t count = end - begin;
    for (std::size_t g = 0; g < job.gains.size(); ++g)
      for (std::size_t c = 0; c < 3; ++c) {
        const float gain = job.gains[g][static_cast<int>(c)];
        if (gain == 0) continue;
        const float* value = job.self.values_[g][c].data() + begin;
        for (std::size_t i = 0; i < count; ++i) sums[c][i] += gain * value[i];
      }
    for (std::size_t i = 0; i < count; ++i)
      job.self.result_[begin + i] = Irradiance({sums[0][i], sums[1][i], sums[2][i]});
  });
  return result_;
}

}  // namespace relume::relight
