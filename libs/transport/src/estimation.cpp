// SPDX-License-Identifier: MIT
#include "estimation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kFirstRound = 32;  // samples
constexpr float kDarkShare = 0.1f;         // of the median luminance: darker counts as that

}  // namespace

Estimation::Estimation(Layout layout, const ReferenceOptions& options, const MakeSample& make,
                       Progress& progress)
    : layout_(std::move(layout)),
      options_(options),
      sums_(layout_.items * layout_.runs, glm::dvec3(0)),
      counts_(layout_.items, 0) {
  std::vector<std::size_t> active(layout_.groups);
  std::iota(active.begin(), active.end(), std::size_t{0});
  const bool adaptive = options.target_error > 0;
  std::uint32_t until = adaptive ? std::min(kFirstRound, options.samples) : options.samples;
  while (!active.empty()) {
    Stage stage(progress, adaptive ? fmt::format("paths, up to {}", until) : "paths", active.size());
    parallelFor(
        active.size(), 1,
        [&](std::size_t begin, std::size_t end) {
          const Sample sample = make();
          for (std::size_t i = begin; i < end; ++i) sampleGroup(active[i], until, sample);
        },
        &progress);
    if (until >= options.samples) break;
    active = unconverged(active);
    until = std::min(2 * until, options.samples);
  }
}

void Estimation::sampleGroup(std::size_t group, std::uint32_t until, const Sample& sample) {
  std::vector<std::uint32_t> members;
  layout_.members(group, members);
  for (const std::uint32_t item : members) {
    for (std::uint32_t s = counts_[item]; s < until; ++s) {
      const std::uint32_t run = s % layout_.runs;
      PathSampler sampler(options_.seed, item, run, s / layout_.runs);
      sums_[item * layout_.runs + run] += glm::dvec3(sample(item, sampler));
    }
    counts_[item] = until;
  }
}

std::uint32_t Estimation::runsOf(std::size_t item) const { return std::min(counts_[item], layout_.runs); }

glm::dvec3 Estimation::runMean(std::size_t item, std::uint32_t run) const {
  const std::uint32_t count = (counts_[item] - run + layout_.runs - 1) / layout_.runs;
  return sums_[item * layout_.runs + run] / static_cast<double>(count);
}

Vec3 Estimation::mean(std::size_t item) const {
  glm::dvec3 sum(0);
  for (std::uint32_t r = 0; r < layout_.runs; ++r) sum += sums_[item * layout_.runs + r];
  return sum / static_cast<double>(std::max(counts_[item], 1u));
}

Vec3 Estimation::error(std::size_t item) const {
  const std::uint32_t runs = runsOf(item);
  if (runs < 2) return Vec3(0.0f);
  const glm::dvec3 centre(mean(item));
  glm::dvec3 squares(0);
  for (std::uint32_t r = 0; r < runs; ++r) {
    const glm::dvec3 apart = runMean(item, r) - centre;
    squares += apart * apart;
  }
  return glm::sqrt(squares / (static_cast<double>(runs - 1) * runs));
}

float Estimation::luminanceError(std::size_t item) const {
  const std::uint32_t runs = runsOf(item);
  if (runs < 2) return 0.0f;
  const float centre = luminance(mean(item));
  double squares = 0;
  for (std::uint32_t r = 0; r < runs; ++r) {
    const double apart = luminance(Vec3(runMean(item, r))) - centre;
    squares += apart * apart;
  }
  return static_cast<float>(std::sqrt(squares / (static_cast<double>(runs - 1) * runs)));
}

std::uint64_t Estimation::samples() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

std::vector<std::size_t> Estimation::unconverged(const std::vector<std::size_t>& groups) const {
  struct State {
    float luminance, error;
  };
  std::vector<State> states(layout_.groups);
  parallelFor(layout_.groups, 64, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> members;
    for (std::size_t g = begin; g < end; ++g) {
      members.clear();
      layout_.members(g, members);
      double sum = 0, squares = 0;
      for (const std::uint32_t item : members) {
        const double e = luminanceError(item);
        sum += luminance(mean(item)), squares += e * e;
      }
      const auto count = static_cast<double>(members.size());
      states[g] = {static_cast<float>(sum / count), static_cast<float>(std::sqrt(squares / count))};
    }
  });
  std::vector<float> lit;
  for (const State& state : states)
    if (state.luminance > 0) lit.push_back(state.luminance);
  float least = 0;
  if (!lit.empty()) {
    const auto middle = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
    std::nth_element(lit.begin(), middle, lit.end());
    least = kDarkShare * *middle;
  }
  std::vector<std::size_t> rest;
  for (const std::size_t g : groups)
    if (states[g].error > options_.target_error * std::max(states[g].luminance, least)) rest.push_back(g);
  return rest;
}

}  // namespace relume::transport
