// SPDX-License-Identifier: MIT
// Means of many items (pixels, points) by random walks, each from several independent runs of low-discrepancy
// samples, whose scatter tells the standard error. Items are handled in groups; a group stops when it has
// converged. Sums are formed item by item in order of samples, so bits do not depend on threads.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "path_sampler.h"
#include "relume/core/progress.h"
#include "relume/transport/reference.h"

namespace relume::transport {

class Estimation {
 public:
  struct Layout {
    std::size_t items = 0;
    std::uint32_t runs = 1;
    std::size_t groups = 0;
    /// Items of a group.
    std::function<void(std::size_t group, std::vector<std::uint32_t>& items)> members;
  };
  using Sample = std::function<Vec3(std::uint32_t item, PathSampler& sampler)>;
  /// Makes what one worker samples with; called once for each group and round.
  using MakeSample = std::function<Sample()>;

  /// Samples until every group has options.samples paths per item, or has converged. Throws kInterrupted.
  Estimation(Layout layout, const ReferenceOptions& options, const MakeSample& make, Progress& progress);

  Vec3 mean(std::size_t item) const;
  /// Standard error of the mean by channel, and of its luminance; 0 with less than two runs.
  Vec3 error(std::size_t item) const;
  float luminanceError(std::size_t item) const;
  std::uint64_t samples() const;

 private:
  void sampleGroup(std::size_t group, std::uint32_t until, const Sample& sample);
  /// Runs that have samples, and the mean of each.
  std::uint32_t runsOf(std::size_t item) const;
  glm::dvec3 runMean(std::size_t item, std::uint32_t run) const;
  std::vector<std::size_t> unconverged(const std::vector<std::size_t>& groups) const;

  Layout layout_;
  ReferenceOptions options_;
  std::vector<glm::dvec3> sums_;       ///< shape: [item][run]
  std::vector<std::uint32_t> counts_;  ///< samples, by item; sample s belongs to run s % runs
};

}  // namespace relume::transport
