// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <numeric>

#include "radiosity/system.h"

namespace relume::transport {
namespace {

/// The columns of F: what arrives at others of a patch's light.
std::vector<std::vector<FormFactors::Entry>> columnsOf(const FormFactors& factors) {
  std::vector<std::size_t> counts(factors.size(), 0);
  for (std::size_t i = 0; i < factors.size(); ++i)
    for (const FormFactors::Entry& e : factors.row(i)) ++counts[e.patch];
  std::vector<std::vector<FormFactors::Entry>> columns(factors.size());
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i].reserve(counts[i]);
  for (std::uint32_t i = 0; i < factors.size(); ++i)
    for (const FormFactors::Entry& e : factors.row(i)) columns[e.patch].push_back({i, e.value});
  return columns;
}

/// The largest of many numbers that change: a tournament.
class Largest {
 public:
  explicit Largest(std::size_t count) : leaves_(std::bit_ceil(std::max<std::size_t>(count, 1))) {
    tree_.assign(2 * leaves_, -1.0);
  }
  void set(std::size_t i, double value) {
    std::size_t node = leaves_ + i;
    tree_[node] = value;
    while (node > 1) {
      node /= 2;
      const double now = std::max(tree_[2 * node], tree_[2 * node + 1]);
      if (tree_[node] == now) break;
      tree_[node] = now;
    }
  }
  double value() const { return tree_[1]; }
  std::size_t where() const {
    std::size_t node = 1;
    while (node < leaves_) node = tree_[2 * node] >= tree_[2 * node + 1] ? 2 * node : 2 * node + 1;
    return node - leaves_;
  }

 private:
  std::size_t leaves_;
  std::vector<double> tree_;
};

class Shooter {
 public:
  explicit Shooter(const RadiositySystem& system)
      : s_(system), columns_(columnsOf(system.factors)), unshot_(system.exitance.size()) {
    result_.radiosity.assign(system.exitance.begin(), system.exitance.end());
  }

  RadiositySolution all(const RadiosityLimits& limits) {
    Largest power(unshot_.size());
    double total = 0, left = 0;
    for (std::size_t i = 0; i < unshot_.size(); ++i) {
      result_.radiosity[i] += reflectedLight(i);
      unshot_[i] = result_.radiosity[i];
      power.set(i, powerOf(i, unshot_[i]));
      total += powerOf(i, unshot_[i]);
    }
    left = total;
    while (left > limits.residual * total && power.value() > 0.0 &&
           (limits.shots == 0 || result_.steps < limits.shots)) {
      const std::size_t from = power.where();
      const glm::dvec3 shot = unshot_[from];
      unshot_[from] = glm::dvec3(0);
      left -= powerOf(from, shot);
      for (const FormFactors::Entry& e : columns_[from]) {
        const glm::dvec3 arrives =
            glm::dvec3(s_.reflectance[e.patch]) * (static_cast<double>(e.value) * shot);
        result_.radiosity[e.patch] += arrives, unshot_[e.patch] += arrives;
        const double gain = powerOf(e.patch, arrives);
        total += gain, left += gain;
        if (e.patch != from) power.set(e.patch, powerOf(e.patch, unshot_[e.patch]));
      }
      power.set(from, powerOf(from, unshot_[from]));
      ++result_.steps;
    }
    result_.residual = total > 0 ? std::max(left, 0.0) / total : 0.0;
    result_.ambient = ambient();
    return std::move(result_);
  }

  RadiositySolution generations(int bounces) {
    if (bounces == 0) return std::move(result_);
    for (std::size_t i = 0; i < unshot_.size(); ++i) unshot_[i] = s_.exitance[i];
    for (int k = 0; k < bounces; ++k) {
      std::vector<glm::dvec3> next(unshot_.size(), glm::dvec3(0));
      if (k == 0)
        for (std::size_t i = 0; i < next.size(); ++i) next[i] = reflectedLight(i);
      std::vector<std::uint32_t> order(unshot_.size());
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return powerOf(a, unshot_[a]) > powerOf(b, unshot_[b]);
      });
      for (const std::uint32_t from : order) {
        if (unshot_[from] == glm::dvec3(0)) break;
        for (const FormFactors::Entry& e : columns_[from])
          next[e.patch] +=
              glm::dvec3(s_.reflectance[e.patch]) * (static_cast<double>(e.value) * unshot_[from]);
        ++result_.steps;
      }
      double last = 0, total = 0;
      for (std::size_t i = 0; i < next.size(); ++i) {
        result_.radiosity[i] += next[i];
        last += powerOf(i, next[i]), total += powerOf(i, result_.radiosity[i]);
      }
      unshot_.swap(next);
      result_.residual = total > 0 ? last / total : 0.0;
      if (last == 0.0) break;
    }
    return std::move(result_);
  }

 private:
  double powerOf(std::size_t i, glm::dvec3 b) const {
    return static_cast<double>(s_.area[i]) * (b.x + b.y + b.z);
  }
  glm::dvec3 reflectedLight(std::size_t i) const {
    return glm::dvec3(s_.reflectance[i]) * glm::dvec3(s_.irradiance[i]);
  }
  /// [CCWG88]: the mean unshot radiosity, reflected again and again by the mean reflectance.
  glm::dvec3 ambient() const {
    glm::dvec3 unshot(0), rho(0);
    double area = 0;
    for (std::size_t i = 0; i < unshot_.size(); ++i) {
      const auto a = static_cast<double>(s_.area[i]);
      unshot += a * unshot_[i], rho += a * glm::dvec3(s_.reflectance[i]), area += a;
    }
    if (!(area > 0)) return glm::dvec3(0);
    return unshot / area / (1.0 - glm::min(rho / area, glm::dvec3(0.999)));
  }

  const RadiositySystem& s_;
  const std::vector<std::vector<FormFactors::Entry>> columns_;
  std::vector<glm::dvec3> unshot_;
  RadiositySolution result_;
};

}  // namespace

RadiositySolution solveByShooting(const RadiositySystem& system, const RadiosityLimits& limits) {
  Shooter shooter(system);
  return limits.bounces < 0 ? shooter.all(limits) : shooter.generations(limits.bounces);
}

}  // namespace relume::transport
