// SPDX-License-Identifier: MIT
#include <charconv>
#include <cmath>
#include <functional>

#include "bases/bases.h"
#include "relume/basis/direction_set.h"
#include "relume/core/error.h"

namespace relume::basis {
namespace {

constexpr std::size_t kLeastDirections = 6, kMostDirections = 64;

struct Named {
  std::string name;
  std::function<std::unique_ptr<Basis>(const BasisOptions&)> make;
};

const std::vector<Named>& table() {
  using O = BasisOptions;
  static const std::vector<Named> rows = {
      {"irradiance", [](const O&) { return makeIrradiance(); }},
      {"sh2", [](const O& o) { return makeSh(2, o.window); }},
      {"sh3", [](const O& o) { return makeSh(3, o.window); }},
      {"sh4", [](const O& o) { return makeSh(4, o.window); }},
      {"hbasis4", [](const O& o) { return makeH(4, o.window); }},
      {"hbasis6", [](const O& o) { return makeH(6, o.window); }},
      {"hl2", [](const O&) { return makeHl2(); }},
      {"ahd", [](const O&) { return makeAhd(); }},
      {"dominant", [](const O&) { return makeDominant(); }},
      {"farcry", [](const O&) { return makeFarCry(); }},
      {"sg5", [](const O&) { return makeGaussians(5); }},
      {"sg6", [](const O&) { return makeGaussians(6); }},
      {"sg7", [](const O&) { return makeGaussians(7); }},
      {"sg8", [](const O&) { return makeGaussians(8); }},
      {"sg9", [](const O&) { return makeGaussians(9); }},
      {"cube", [](const O&) { return makeCube(); }},
      {"dice", [](const O&) { return makeDice(); }},
      {"directions:14", [](const O&) { return makeDirections(minimalEnergy(14)); }}};
  return rows;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::vector<std::string> basisNames() {
  std::vector<std::string> names;
  for (const Named& row : table()) names.push_back(row.name);
  return names;
}

std::unique_ptr<Basis> makeBasis(const std::string& name, const BasisOptions& options) {
  for (const Named& row : table())
    if (row.name == name) return row.make(options);
  if (name == "directions") return makeDirections(minimalEnergy(14));
  constexpr std::string_view kPrefix = "directions:";
  if (name.starts_with(kPrefix)) {
    std::size_t n = 0;
    const char* const end = name.data() + name.size();
    const auto [last, ec] = std::from_chars(name.data() + kPrefix.size(), end, n);
    if (ec == std::errc() && last == end && n >= kLeastDirections && n <= kMostDirections)
      return makeDirections(minimalEnergy(n));
    throw Error(ErrorCode::kUsage, "receiver " + name, "is no number of directions",
                "write directions:6 to directions:64");
  }
  throw Error(ErrorCode::kUsage, "receiver " + name, "is not known", "use one of " + joined(basisNames()));
}

std::string Basis::planeName(const TexturePlane& plane) const {
  const std::string own = name();
  return own.substr(0, own.find(':')) + "-" + plane.name;
}

std::size_t Basis::bytesPerTexel(Packing packing) const {
  std::size_t bytes = 0;
  for (const TexturePlane& plane : planes(packing)) bytes += plane.bytes();
  return bytes;
}

std::size_t Basis::storedNumbers(Packing packing) const {
  std::size_t numbers = 0;
  for (const TexturePlane& plane : planes(packing)) numbers += static_cast<std::size_t>(plane.channels);
  return numbers;
}

void roundToPlanes(std::span<const TexturePlane> planes, std::span<float> stored) {
  std::size_t at = 0;
  for (const TexturePlane& plane : planes)
    for (int c = 0; c < plane.channels; ++c, ++at) {
      float& v = stored[at];
      if (plane.format == TexturePlane::Format::kUnorm8) {
        const float step = (plane.hi - plane.lo) / 255.0f;
        v = plane.lo + std::round((std::min(std::max(v, plane.lo), plane.hi) - plane.lo) / step) * step;
      } else if (v != 0) {  // 11 significant bits, fewer below 2^-14
        int exponent = 0;
        std::frexp(v, &exponent);
        const int last = std::max(exponent, -13) - 11;
        v = std::ldexp(std::nearbyint(std::ldexp(v, -last)), last);
      }
    }
}

}  // namespace relume::basis
