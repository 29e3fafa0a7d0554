// SPDX-License-Identifier: MIT
#include "directional_planes.h"

#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::bake {
namespace {

constexpr std::size_t kGrain = 256;

}  // namespace

Receiver receiverOf(const Parameters& parameters) {
  const std::string& name = std::get<std::string>(parameters.at("receiver"));
  if (name == "irradiance") return {};
  const bool compact = std::get<std::string>(parameters.at("packing")) == "compact";
  return {basis::makeBasis(name, {.window = std::get<bool>(parameters.at("window"))}),
          compact ? basis::Packing::kCompact : basis::Packing::kHalf};
}

std::vector<PointPlane> directionalPlanes(const Receiver& receiver, const atlas::Texels& texels,
                                          std::span<const float> sums) {
  const basis::Basis& basis = *receiver.basis;
  const std::size_t points = texels.points.size(), each = basis.sums();
  RELUME_CHECK_EQ(sums.size(), points * each);
  const std::vector<basis::TexturePlane> stored = basis.planes(receiver.packing);
  std::vector<PointPlane> planes;
  for (const basis::TexturePlane& plane : stored)
    planes.push_back({.name = basis.planeName(plane),
                      .channels = plane.channels,
                      .direction = plane.direction,
                      .unorm8 = plane.format == basis::TexturePlane::Format::kUnorm8,
                      .lo = plane.lo,
                      .hi = plane.hi,
                      .values = std::vector<float>(points * static_cast<std::size_t>(plane.channels))});
  parallelFor(points, kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<float> coefficients(basis.coefficients()), numbers(basis.storedNumbers(receiver.packing));
    for (std::size_t i = begin; i < end; ++i) {
      basis.finish(basis::Receiver(texels.points[i].shading_normal), sums.subspan(i * each, each),
                   coefficients);
      basis.pack(coefficients, receiver.packing, numbers);
      auto number = numbers.begin();
      for (PointPlane& plane : planes) {
        std::copy_n(number, plane.channels, &plane.values[i * static_cast<std::size_t>(plane.channels)]);
        number += plane.channels;
      }
    }
  });
  return planes;
}

}  // namespace relume::bake
