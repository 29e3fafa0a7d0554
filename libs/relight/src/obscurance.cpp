// SPDX-License-Identifier: MIT
// E = (I_A + I'_S) W + I_S ([IKSZ03] eq 5 without reflectances), I_S = sum of visible lights' I_j / r_j^2
// cos+ (eq 6; the clamp is missing in print), I'_S = beta sum of all lights' I_j / r_j^2 (eq 7: no cosine, no
// visibility). Differs from the paper: lights have glTF's range window and cones; area and directional
// lights; W may have a colour. Texels are taken in blocks and each block sees all lights in order, so sums do
// not depend on the number of threads. With a visibility source lights come kLightsAtOnce at a time, which
// bounds the memory for their visibility.
#include "relume/relight/obscurance.h"

#include <fmt/format.h>

#include <algorithm>

#include "light_kernel.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

constexpr std::size_t kGrain = 4 * kBlock;  // texels a task takes at a time
constexpr std::size_t kLightsAtOnce = 8;

}  // namespace

ObscuranceRelighter::ObscuranceRelighter(const asset::Asset& asset, const asset::Layer& layer) {
  const asset::AtlasTable& atlas = asset.atlas;
  const asset::Plane& value = layer.plane("value");
  const auto channels = static_cast<std::size_t>(value.channels);
  if ((channels != 1 && channels != 3) || value.values.size() != atlas.pageTexels() * channels)
    throw Error(
        ErrorCode::kMismatch, "layer " + layer.name,
        fmt::format("its values ({} channels, {} numbers) are not obscurance over the {} texels of the atlas",
                    channels, value.values.size(), atlas.pageTexels()),
        "relight a layer of kind obscurance or spectral");
  const std::size_t count = atlas.texel.size();
  for (std::size_t c = 0; c < 3; ++c) {
    const auto component = static_cast<int>(c);
    position_[c].resize(count);
    normal_[c].resize(count);
    w_[c].resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      position_[c][i] = atlas.position[i][component];
      normal_[c][i] = atlas.normal[i][component];
      w_[c][i] = value.values[atlas.texel[i] * channels + (channels == 3 ? c : 0)];
    }
  }
  result_.resize(count);
}

ObscuranceRelighter::~ObscuranceRelighter() = default;
ObscuranceRelighter::ObscuranceRelighter(ObscuranceRelighter&&) noexcept = default;

void ObscuranceRelighter::addLights(std::size_t begin, std::size_t first, std::size_t last,
                                    bool use_visibility, LightSums& sums) const {
  TexelBlock block;
  for (std::size_t c = 0; c < 3; ++c) {
    block.position[c] = position_[c].data() + begin;
    block.normal[c] = normal_[c].data() + begin;
  }
  block.count = std::min(kBlock, result_.size() - begin);
  for (std::size_t j = first; j < last; ++j) {
    block.visibility = use_visibility ? visibility_.data() + (j - first) * result_.size() + begin : nullptr;
    addLight(prepared_[j], block, sums);
  }
}

void ObscuranceRelighter::finish(std::size_t begin, const LightSums& sums, const ObscuranceOptions& options) {
  const std::size_t count = std::min(kBlock, result_.size() - begin);
  for (int c = 0; c < 3; ++c) {
    const float* w = w_[static_cast<std::size_t>(c)].data() + begin;
    for (std::size_t i = 0; i < count; ++i)
      result_[begin + i].rgb[c] =
          (options.ambient.rgb[c] + options.beta * sums.incident[c][i]) * w[i] + sums.direct[c][i];
  }
}

std::span<const Irradiance> ObscuranceRelighter::evaluate(const LightSet& lights,
                                                          const ObscuranceOptions& options,
                                                          const VisibilitySource& visibility) {
  const std::size_t count = result_.size();
  prepared_.clear();
  for (const Light& light : lights) prepared_.emplace_back(light);
  // The bodies of the loops capture one reference: a std::function of that size does not allocate.
  struct Job {
    ObscuranceRelighter& self;
    const ObscuranceOptions& options;
    std::size_t first, last;
  } job{*this, options, 0, lights.size()};

  if (!visibility) {
    parallelFor(count, kGrain, [&job](std::size_t begin, std::size_t end) {
      for (; begin < end; begin += kBlock) {
        LightSums sums{};
        job.self.addLights(begin, job.first, job.last, false, sums);
        job.self.finish(begin, sums, job.options);
      }
    });
    return result_;
  }

  visibility_.resize(count * kLightsAtOnce);
  sums_.resize((count + kBlock - 1) / kBlock);
  std::fill(sums_.begin(), sums_.end(), LightSums{});
  for (; job.first < lights.size(); job.first = job.last) {
    job.last = std::min(lights.size(), job.first + kLightsAtOnce);
    for (std::size_t j = job.first; j < job.last; ++j)
      visibility(j, std::span(visibility_).subspan((j - job.first) * count, count));
    parallelFor(count, kGrain, [&job](std::size_t begin, std::size_t end) {
      for (; begin < end; begin += kBlock)
        job.self.addLights(begin, job.first, job.last, true, job.self.sums_[begin / kBlock]);
    });
  }
  parallelFor(count, kGrain, [&job](std::size_t begin, std::size_t end) {
    for (; begin < end; begin += kBlock) job.self.finish(begin, job.self.sums_[begin / kBlock], job.options);
  });
  return result_;
}

}  // namespace relume::relight
