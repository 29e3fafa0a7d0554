// SPDX-License-Identifier: MIT
// Coefficients as RGB triples, one after the other: what most bases are.
#pragma once
#include <algorithm>
#include <string>

#include "relume/basis/basis.h"

namespace relume::basis {

inline Vec3 triple(std::span<const float> numbers, std::size_t i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}
inline void setTriple(std::span<float> numbers, std::size_t i, Vec3 v) {
  numbers[3 * i] = v.x, numbers[3 * i + 1] = v.y, numbers[3 * i + 2] = v.z;
}
inline void addTriple(std::span<double> numbers, std::size_t i, Vec3 v) {
  numbers[3 * i] += static_cast<double>(v.x), numbers[3 * i + 1] += static_cast<double>(v.y),
      numbers[3 * i + 2] += static_cast<double>(v.z);
}
/// Radiance times solid angle of what arrives.
inline Vec3 flux(const Arrival& light) { return light.e.rgb / light.cosine; }
/// Mean radiance of what gives the irradiance e along d, when none of it comes from below the surface.
inline Vec3 meanRadiance(Irradiance e, Direction d, const Receiver& at) {
  return e.rgb * (2 * kInvPi / (1 + std::max(glm::dot(d, at.normal), 0.0f)));
}
inline Irradiance notNegative(Vec3 e) { return Irradiance(glm::max(e, Vec3(0.0f))); }

/// A basis of RGB triples that are stored half by half.
class TripleBasis : public Basis {
 public:
  TripleBasis(std::string name, std::size_t triples) : name_(std::move(name)), triples_(triples) {}
  std::string name() const override { return name_; }
  std::size_t coefficients() const override { return 3 * triples_; }

  std::vector<TexturePlane> planes(Packing) const override {
    std::vector<TexturePlane> planes;
    for (std::size_t i = 0; i < triples_; ++i) planes.push_back({.name = std::to_string(i)});
    return planes;
  }
  void pack(std::span<const float> coefficients, Packing, std::span<float> stored) const override {
    std::copy(coefficients.begin(), coefficients.end(), stored.begin());
  }
  void unpack(std::span<const float> stored, Packing, std::span<float> coefficients) const override {
    std::copy(stored.begin(), stored.end(), coefficients.begin());
  }

 protected:
  std::size_t triples() const { return triples_; }

 private:
  std::string name_;
  std::size_t triples_;
};

/// The same where no coefficient is negative. Compact: the largest number as a half float, of the others the
/// square root of their share in it, 8 bit (error at most 0.4 % of the largest, less of small ones).
class PositiveBasis : public TripleBasis {
 public:
  using TripleBasis::TripleBasis;
  std::vector<TexturePlane> planes(Packing packing) const override {
    std::vector<TexturePlane> planes = TripleBasis::planes(packing);
    if (packing == Packing::kHalf || triples() == 1) return planes;
    for (TexturePlane& plane : planes) plane.format = TexturePlane::Format::kUnorm8;
    planes.insert(planes.begin(), {.name = "scale", .channels = 1});
    return planes;
  }
  void pack(std::span<const float> coefficients, Packing packing, std::span<float> stored) const override;
  void unpack(std::span<const float> stored, Packing packing, std::span<float> coefficients) const override;
};

/// Triples whose first is the mean of a function that is nowhere negative, so that no other is more than
/// `bound(i)` times the first. Compact: the first as half floats, of the others that share, 8 bit.
class RatioBasis : public TripleBasis {
 public:
  using TripleBasis::TripleBasis;
  std::vector<TexturePlane> planes(Packing packing) const override;
  void pack(std::span<const float> coefficients, Packing packing, std::span<float> stored) const override;
  void unpack(std::span<const float> stored, Packing packing, std::span<float> coefficients) const override;

 protected:
  virtual float bound(std::size_t index) const = 0;
};

}  // namespace relume::basis
