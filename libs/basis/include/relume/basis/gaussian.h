// SPDX-License-Identifier: MIT
// Spherical Gaussians G(d) = exp(sharpness (d . axis - 1)): integrals and products. Based on:
//   [WRGSG09] Wang et al. All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance. 2009: products.
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Equation (11.33) and what follows.
// The integral with a clamped cosine has no closed form for general angles; here it is a sum of zonal
// harmonics, of which some tens are enough up to the sharpness stated.
#pragma once
#include <array>
#include <cstddef>

#include "relume/core/vec.h"

namespace relume::basis {

struct Gaussian {
  Direction axis{0, 0, 1};
  float sharpness = 1.0f;  ///< above 0
  float amplitude = 1.0f;

  float operator()(Direction d) const;
};

/// Over the sphere, sr.
float integral(const Gaussian& g);
/// Also a Gaussian: the product of both at every direction.
Gaussian product(const Gaussian& a, const Gaussian& b);

/// Mean of Legendre's polynomials l = 0, 1, 2... under a Gaussian of amplitude 1 about the pole: its integral
/// over the sphere is the first times that of the Gaussian, which makes the first 1. A function with SH
/// coefficients c_lm, blurred by the Gaussian (of integral 1), has m_l c_lm.
inline constexpr std::size_t kMoments = 64;
std::array<double, kMoments> legendreMoments(double sharpness);

/// Integral of G (d . n)+ over the sphere, and of G over the half of it about n; `cosine` between axis and n.
/// To 1e-6 of integral() up to a sharpness of 100.
float cosineIntegral(float sharpness, float cosine);
float hemisphereIntegral(float sharpness, float cosine);

}  // namespace relume::basis
