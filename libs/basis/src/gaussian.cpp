// SPDX-License-Identifier: MIT
#include "relume/basis/gaussian.h"

#include <algorithm>
#include <cmath>

namespace relume::basis {
namespace {

/// Sum over l of (2l + 1) / 2 weight_l moment_l P_l(c), where weight_l = integral from 0 to 1 of w(t) P_l(t):
/// the mean of w(n . d)+ under a Gaussian that leans away from n.
template <class Weight>
double zonalSum(double sharpness, double cosine, const Weight& weight) {
  const auto moment = legendreMoments(sharpness);
  double before = 1, now = cosine, sum = 0.5 * weight(0) + 1.5 * weight(1) * moment[1] * cosine;
  for (std::size_t l = 2; l < kMoments; ++l) {
    const auto k = static_cast<double>(l);
    const double next = ((2 * k - 1) * cosine * now - (k - 1) * before) / k;
    before = now, now = next;
    sum += (k + 0.5) * weight(l) * moment[l] * next;
  }
  return sum;
}

/// Integral from 0 to 1 of P_l.
double stepWeight(std::size_t l) {
  if (l == 0) return 1;
  if (l % 2 == 0) return 0;
  double w = 0.5;  // l = 1; then w_(l+2) = -w_l l / (l + 3)
  for (std::size_t k = 1; k < l; k += 2) w *= -static_cast<double>(k) / static_cast<double>(k + 3);
  return w;
}

/// Integral from 0 to 1 of t P_l.
double cosineWeight(std::size_t l) {
  if (l == 0) return 0.5;
  if (l == 1) return 1.0 / 3;
  if (l % 2 == 1) return 0;
  double w = 0.125;  // l = 2; then w_(l+2) = -w_l (l - 1) / (l + 4)
  for (std::size_t k = 2; k < l; k += 2) w *= -static_cast<double>(k - 1) / static_cast<double>(k + 4);
  return w;
}

double sphereIntegral(double s) { return -2 * M_PI * std::expm1(-2 * s) / s; }

}  // namespace

float Gaussian::operator()(Direction d) const {
  return amplitude * std::exp(sharpness * (glm::dot(d, axis) - 1.0f));
}

float integral(const Gaussian& g) {
  return g.amplitude * static_cast<float>(sphereIntegral(static_cast<double>(g.sharpness)));
}

Gaussian product(const Gaussian& a, const Gaussian& b) {
  const Vec3 sum = a.sharpness * a.axis + b.sharpness * b.axis;
  const float length = glm::length(sum);
  return {.axis = length > 0 ? sum / length : a.axis,
          .sharpness = std::max(length, 1e-6f),
          .amplitude = a.amplitude * b.amplitude * std::exp(length - a.sharpness - b.sharpness)};
}

std::array<double, kMoments> legendreMoments(double s) {
  // Ratios of modified spherical Bessel functions i_l, from far above downwards (Miller): the recurrence
  // i_(l-1) = i_(l+1) + (2l + 1) / s i_l is stable that way.
  std::array<double, kMoments> m;
  double ratio = 0;  // i_(l+1) / i_l
  constexpr std::size_t kAbove = 2 * kMoments + 128;
  for (std::size_t l = kAbove; l-- > 0;) {
    ratio = 1 / (ratio + (2 * static_cast<double>(l) + 3) / s);
    if (l < kMoments) m[l] = ratio;
  }
  double value = 1;
  for (double& x : m) {
    const double next = value * x;
    x = value, value = next;
  }
  return m;
}

float cosineIntegral(float sharpness, float cosine) {
  const double s = static_cast<double>(sharpness);
  return static_cast<float>(sphereIntegral(s) * zonalSum(s, static_cast<double>(cosine), cosineWeight));
}

float hemisphereIntegral(float sharpness, float cosine) {
  const double s = static_cast<double>(sharpness);
  return static_cast<float>(sphereIntegral(s) * zonalSum(s, static_cast<double>(cosine), stepWeight));
}

}  // namespace relume::basis
