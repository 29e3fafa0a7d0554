// SPDX-License-Identifier: MIT
// The radiosity equations and two ways to solve them:
//   B_i = E_i + rho_i (H_i + sum_j F_ij B_j)
// B: radiosity; E: exitance of the patch itself; H: irradiance from light that is no patch. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.2.1, equation 11.4.
//   [CCWG88] Cohen, Chen, Wallace, Greenberg. A Progressive Refinement Approach to Fast Radiosity Image
//   Generation. SIGGRAPH 1988: shooting, and the ambient term.
// Differs from [CCWG88]: both ways use the same stored F, shooting its columns, so they agree to the last
// residual; a column by reciprocity from the shooter's own row would agree only as far as F is right.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/form_factors.h"

namespace relume::transport {

/// All by patch.
struct RadiositySystem {
  const FormFactors& factors;
  std::span<const Vec3> exitance;     ///< E, W m^-2
  std::span<const Vec3> irradiance;   ///< H, W m^-2
  std::span<const Vec3> reflectance;  ///< rho
  std::span<const float> area;        ///< m^2
};

struct RadiosityLimits {
  /// Reflections of light that a B may hold; negative: all, up to the residual.
  int bounces = -1;
  /// Stop when what is left of the equations is below this share of B, both summed over areas and channels.
  /// B is then wrong by at most residual / (1 - the largest rho).
  double residual = 1e-6;
  /// Of shooting: stop after so many shots; 0: never. For looking at unfinished work.
  std::uint64_t shots = 0;
};

struct RadiositySolution {
  std::vector<glm::dvec3> radiosity;  ///< B, W m^-2
  double residual = 0;      ///< reached; with a limit of bounces the share of the last bounce's light instead
  std::uint64_t steps = 0;  ///< sweeps or shots
  /// Of shooting without a limit of bounces: irradiance that light not yet shot would give on average
  /// ([CCWG88]); rho times it, added to B, is the better picture of unfinished work.
  glm::dvec3 ambient{0};
};

/// Rows: sweeps of Gauss-Seidel; with a limit of k bounces k sweeps of Jacobi from B = E, which hold exactly
/// those. Bits do not depend on the number of threads.
RadiositySolution solveByGathering(const RadiositySystem& system, const RadiosityLimits& limits);

/// Columns: the patch with the most unshot power shoots; with a limit of bounces by generations of light.
RadiositySolution solveByShooting(const RadiositySystem& system, const RadiosityLimits& limits);

/// E + rho (H + F B) - B, summed as RadiosityLimits::residual.
double residualOf(const RadiositySystem& system, std::span<const glm::dvec3> radiosity);

}  // namespace relume::transport
