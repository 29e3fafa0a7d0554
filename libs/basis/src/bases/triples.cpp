// SPDX-License-Identifier: MIT
#include "bases/triples.h"

#include <cmath>

namespace relume::basis {

void PositiveBasis::pack(std::span<const float> coefficients, Packing packing,
                         std::span<float> stored) const {
  if (packing == Packing::kHalf || triples() == 1) return TripleBasis::pack(coefficients, packing, stored);
  const float most = std::max(*std::max_element(coefficients.begin(), coefficients.end()), 0.0f);
  stored[0] = most;
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    stored[i + 1] = most > 0 ? std::sqrt(std::clamp(coefficients[i] / most, 0.0f, 1.0f)) : 0.0f;
}

void PositiveBasis::unpack(std::span<const float> stored, Packing packing,
                           std::span<float> coefficients) const {
  if (packing == Packing::kHalf || triples() == 1) return TripleBasis::unpack(stored, packing, coefficients);
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    coefficients[i] = stored[0] * stored[i + 1] * stored[i + 1];
}

std::vector<TexturePlane> RatioBasis::planes(Packing packing) const {
  std::vector<TexturePlane> planes = TripleBasis::planes(packing);
  if (packing == Packing::kHalf) return planes;
  for (std::size_t i = 1; i < planes.size(); ++i) {
    planes[i].format = TexturePlane::Format::kUnorm8;
    planes[i].lo = -bound(i), planes[i].hi = bound(i);
  }
  return planes;
}

void RatioBasis::pack(std::span<const float> coefficients, Packing packing, std::span<float> stored) const {
  if (packing == Packing::kHalf) return TripleBasis::pack(coefficients, packing, stored);
  const Vec3 mean = triple(coefficients, 0);
  setTriple(stored, 0, mean);
  for (std::size_t i = 1; i < triples(); ++i) {
    const Vec3 c = triple(coefficients, i);
    for (int k = 0; k < 3; ++k)
      stored[3 * i + static_cast<std::size_t>(k)] =
          mean[k] > 0 ? std::clamp(c[k] / mean[k], -bound(i), bound(i)) : 0.0f;
  }
}

void RatioBasis::unpack(std::span<const float> stored, Packing packing, std::span<float> coefficients) const {
  if (packing == Packing::kHalf) return TripleBasis::unpack(stored, packing, coefficients);
  const Vec3 mean = triple(stored, 0);
  setTriple(coefficients, 0, mean);
  for (std::size_t i = 1; i < triples(); ++i) setTriple(coefficients, i, mean * triple(stored, i));
}

}  // namespace relume::basis
