// SPDX-License-Identifier: MIT
// Light as types: linear RGB, Rec. 709 primaries, radiometric, unit-agnostic (docs/concept.md). An irradiance
// is always E, never E/pi. A Radiance is not an Irradiance: the compiler refuses to mix them.
#pragma once
#include "relume/core/vec.h"

namespace relume {

namespace detail {
/// An RGB quantity; `Tag` keeps quantities of different dimension apart.
template <class Tag>
struct Rgb {
  Vec3 rgb{0.0f};

  Rgb() = default;
  explicit constexpr Rgb(Vec3 v) : rgb(v) {}
  explicit constexpr Rgb(float grey) : rgb(grey) {}
  Rgb& operator+=(Rgb o) { return rgb += o.rgb, *this; }
  friend Rgb operator+(Rgb a, Rgb b) { return Rgb(a.rgb + b.rgb); }
  friend Rgb operator-(Rgb a, Rgb b) { return Rgb(a.rgb - b.rgb); }
  friend Rgb operator*(Rgb a, float s) { return Rgb(a.rgb * s); }
  friend Rgb operator*(float s, Rgb a) { return Rgb(a.rgb * s); }
  friend bool operator==(Rgb a, Rgb b) { return a.rgb == b.rgb; }
};
}  // namespace detail

using Radiance = detail::Rgb<struct RadianceTag>;      ///< L, W m^-2 sr^-1
using Irradiance = detail::Rgb<struct IrradianceTag>;  ///< E, W m^-2
using Intensity = detail::Rgb<struct IntensityTag>;    ///< I, W sr^-1 (glTF: candela)
using Albedo = detail::Rgb<struct AlbedoTag>;  ///< diffuse reflectance in [0, 1]; baseColor * (1 - metallic)

/// Radiance that leaves a Lambertian surface: albedo * E / pi.
inline Radiance reflected(Albedo albedo, Irradiance e) { return Radiance(albedo.rgb * e.rgb * kInvPi); }

/// Luminance of a linear Rec. 709 triple.
inline float luminance(Vec3 rgb) { return glm::dot(rgb, Vec3(0.2126f, 0.7152f, 0.0722f)); }

}  // namespace relume
