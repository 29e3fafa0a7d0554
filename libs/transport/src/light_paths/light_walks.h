// SPDX-License-Identifier: MIT
// The transfer by random light paths, as published: slow and noisy, and right. Based on:
//   [USKP09] Umenhoffer et al. Multi-scale precomputed radiance transfer. Section 7.2.
//   [Keller97] Keller. Instant Radiosity. 1997.
// From an entry of unit irradiance walks go on by sampling of the diffuse BRDF and Russian roulette. Where
// they meet surfaces virtual lights stand, connected to every exit that sees them:
//   T_xe = sum over virtual lights of e of power / pi cos+ cos+ / r^2 v.
// Its variance is without bound where surfaces meet; connections shorter than `near` are left out.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light_paths/members.h"
#include "light_paths/piece_entries.h"
#include "light_paths/pieces.h"
#include "light_paths/side_rays.h"
#include "light_paths/sides.h"
#include "lightmap/reflectance.h"
#include "radiosity/patches.h"

namespace relume::transport {

/// Sends out `power` as a diffuse reflector does, for each unit of irradiance on its entry.
struct VirtualLight {
  std::uint32_t entry = 0;
  Point position{0};
  Normal normal{0, 0, 1};  ///< geometric
  Vec3 power{0};           ///< m^2: W for each W / m^2
};

/// Where walks of an entry begin: a share of its area, by side of a texel.
struct WalkStart {
  std::uint32_t entry = 0, side = 0;
  Point position{0};
  Normal normal{0, 0, 1};
  float area = 0;           ///< m^2; below 0 for parts of a mode that are darker for it
  std::uint32_t walks = 1;  ///< that share it
};

/// Everything that walks need. References are kept by who walks.
struct WalkScene {
  const SurfaceScene& surface;
  const Sides& sides;
  const MeanReflectance& reflectance;
};

/// What light on patches is, by the entries of each.
struct PatchLight {
  const Pieces& pieces;
  const PieceEntries& on_pieces;
  std::span<const std::uint32_t> first;  ///< by patch, and one more: its entries
};

/// `walks` walks of each entry, which begin all over its patch. patches: sides of each.
std::vector<WalkStart> startsOnPatches(const SurfaceScene& scene, const Sides& sides, const PatchLight& light,
                                       const Members& patches, std::uint32_t walks, std::uint64_t seed);

/// The side of a texel where a ray ends; scene::kNone: none.
std::uint32_t sideWhere(const SurfaceScene& scene, const Sides& sides, const trace::Ray& ray,
                        const trace::RayHit& hit);

/// By start and walk. Bits do not depend on the number of threads. Throws Error kInterrupted.
std::vector<VirtualLight> walk(const WalkScene& scene, std::span<const WalkStart> starts, std::uint64_t seed,
                               Progress& progress);

/// Adds what virtual lights bring to an exit, one place of it for each: a row [3][entries]. `exit`: of
/// `exits`, numbers the random places.
void connect(const SurfaceScene& scene, std::span<const VirtualLight> lights, const Patches& exits,
             std::size_t exit, float near, std::uint64_t seed, std::size_t entries, std::span<float> row);

}  // namespace relume::transport
