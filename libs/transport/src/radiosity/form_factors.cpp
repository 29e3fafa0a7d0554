// SPDX-License-Identifier: MIT
#include "radiosity/form_factors.h"

#include "radiosity/row_builder.h"

namespace relume::transport {

double FormFactors::sum(std::size_t i) const {
  double result = 0;
  for (const Entry& e : rows_[i]) result += static_cast<double>(e.value);
  return result;
}

glm::dvec3 FormFactors::times(std::size_t i, std::span<const glm::dvec3> values) const {
  glm::dvec3 result(0);
  for (const Entry& e : rows_[i]) result += static_cast<double>(e.value) * values[e.patch];
  return result;
}

std::uint64_t FormFactors::rays() const {
  std::uint64_t result = 0;
  for (const std::uint32_t r : rays_) result += r;
  return result;
}

FormFactors mergedFormFactors(const FormFactors& factors, const Patches& patches, const Parents& parents) {
  std::vector<std::vector<std::uint32_t>> parts(parents.area.size());
  for (std::uint32_t i = 0; i < patches.size(); ++i) parts[parents.of[i]].push_back(i);
  FormFactors result(parts.size());
  RowBuilder row(parts.size());
  for (std::size_t parent = 0; parent < parts.size(); ++parent) {
    std::uint32_t rays = 0;
    for (const std::uint32_t i : parts[parent]) {
      const double share = parents.area[parent] > 0 ? static_cast<double>(patches.all[i].area) /
                                                          static_cast<double>(parents.area[parent])
                                                    : 0.0;
      for (const FormFactors::Entry& e : factors.row(i))
        row.add(parents.of[e.patch], share * static_cast<double>(e.value));
      rays += factors.rays(i);
    }
    result.set(parent, row.take(), rays);
  }
  return result;
}

}  // namespace relume::transport
