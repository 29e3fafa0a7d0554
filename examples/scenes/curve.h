// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "mesh_builder.h"

namespace relume::scenes {

/// Smooth curve through (x, y) knots without overshoot [Steffen, A simple method for monotonic interpolation,
/// 1990].
class Curve {
 public:
  Curve(std::initializer_list<P2> knots) : k_(knots) {
    const std::size_t n = k_.size();
    slope_.assign(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == 0 || i + 1 == n) {
        slope_[i] = i == 0 ? secant(0) : secant(n - 2);
        continue;
      }
      const double a = secant(i - 1), b = secant(i), h0 = k_[i].x - k_[i - 1].x, h1 = k_[i + 1].x - k_[i].x;
      const double p = (a * h1 + b * h0) / (h0 + h1);
      slope_[i] =
          a * b <= 0 ? 0.0 : std::copysign(std::min({std::abs(a), std::abs(b), 0.5 * std::abs(p)}) * 2, a);
      if (a * b > 0 && std::abs(p) < std::abs(slope_[i])) slope_[i] = p;
    }
  }
  double operator()(double x) const {
    std::size_t i = 0;
    while (i + 2 < k_.size() && x > k_[i + 1].x) ++i;
    const double h = k_[i + 1].x - k_[i].x, t = std::clamp((x - k_[i].x) / h, 0.0, 1.0);
    return k_[i].y * (1 + 2 * t) * (1 - t) * (1 - t) + slope_[i] * h * t * (1 - t) * (1 - t) +
           k_[i + 1].y * t * t * (3 - 2 * t) + slope_[i + 1] * h * t * t * (t - 1);
  }

 private:
  double secant(std::size_t i) const { return (k_[i + 1].y - k_[i].y) / (k_[i + 1].x - k_[i].x); }
  std::vector<P2> k_;
  std::vector<double> slope_;
};

}  // namespace relume::scenes
