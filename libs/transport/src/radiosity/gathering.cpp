// SPDX-License-Identifier: MIT
#include <cmath>

#include "radiosity/system.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

constexpr std::uint64_t kMostSweeps = 4096;
constexpr std::size_t kGrain = 256;  // patches

double sumOf(glm::dvec3 v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

glm::dvec3 gathered(const RadiositySystem& s, std::span<const glm::dvec3> b, std::size_t i) {
  return glm::dvec3(s.exitance[i]) +
         glm::dvec3(s.reflectance[i]) * (glm::dvec3(s.irradiance[i]) + s.factors.times(i, b));
}

/// Sum of |to - from| over that of |to|.
double change(const RadiositySystem& s, std::span<const glm::dvec3> from, std::span<const glm::dvec3> to) {
  double difference = 0, all = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const auto area = static_cast<double>(s.area[i]);
    difference += area * sumOf(to[i] - from[i]), all += area * sumOf(to[i]);
  }
  return all > 0 ? difference / all : 0.0;
}

void sweep(const RadiositySystem& s, std::span<const glm::dvec3> from, std::span<glm::dvec3> to) {
  parallelFor(to.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) to[i] = gathered(s, from, i);
  });
}

/// One sweep in place, each row solved for its own unknown.
void relax(const RadiositySystem& s, std::vector<glm::dvec3>& b) {
  for (std::size_t i = 0; i < b.size(); ++i) {
    glm::dvec3 arriving(s.irradiance[i]);
    double own = 0;
    for (const FormFactors::Entry& e : s.factors.row(i)) {
      if (e.patch == i) {
        own = static_cast<double>(e.value);
      } else {
        arriving += static_cast<double>(e.value) * b[e.patch];
      }
    }
    const glm::dvec3 rho(s.reflectance[i]);
    b[i] = (glm::dvec3(s.exitance[i]) + rho * arriving) / (1.0 - rho * own);
  }
}

}  // namespace

double residualOf(const RadiositySystem& system, std::span<const glm::dvec3> radiosity) {
  std::vector<glm::dvec3> next(radiosity.size());
  sweep(system, radiosity, next);
  return change(system, next, radiosity);
}

RadiositySolution solveByGathering(const RadiositySystem& system, const RadiosityLimits& limits) {
  RadiositySolution result;
  std::vector<glm::dvec3>& b = result.radiosity;
  b.assign(system.exitance.begin(), system.exitance.end());
  std::vector<glm::dvec3> before;
  if (limits.bounces >= 0) {
    while (result.steps < static_cast<std::uint64_t>(limits.bounces)) {
      before = b;
      sweep(system, before, b);
      ++result.steps;
      result.residual = change(system, before, b);
      if (result.residual == 0.0) break;
    }
    return result;
  }
  do {
    before = b;
    relax(system, b);
    ++result.steps;
    // A sweep changes each B by about what is left of its equation: the exact sum is worth its cost only
    // then.
    result.residual = change(system, before, b);
    if (result.residual <= limits.residual) result.residual = residualOf(system, b);
  } while (result.residual > limits.residual && result.steps < kMostSweeps);
  return result;
}

}  // namespace relume::transport
