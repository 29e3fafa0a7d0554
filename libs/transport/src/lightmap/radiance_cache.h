// SPDX-License-Identifier: MIT
// What the surfaces of a scene send out, known at every texel: light is gathered once with few rays from each
// texel, the places where they end are kept, and light is then handed on along them, bounce by bounce,
// without a ray more. A gather ray that looks up its end here brings all bounces at once.
//   B_0 = rho / pi E_direct,   B_k = rho / pi (E_direct + (pi / n) sum_j B_(k-1)(where ray j ended))
// Where a ray meets the back of a surface, the 4 x 4 block of texels there gets values for its back as well,
// found in the same way. A texel inside other geometry answers with the nearest texel of its chart that is
// not. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.2.1: radiosity, here with
//   rays for form factors and texels for patches.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "lightmap/exposure.h"
#include "lightmap/gatherer.h"
#include "relume/core/progress.h"
#include "relume/transport/reference.h"
#include "texel_groups.h"

namespace relume::transport {

struct CacheOptions {
  std::uint32_t gather_samples = 16, light_samples = 8;  ///< per texel, powers of two up to kMaxBatch
  int bounces = ReferenceOptions::kUnlimited;
  Materials materials = Materials::kFull;
  std::uint64_t seed = 1;
};

class RadianceCache {
 public:
  /// What another solver found, for fronts alone; all by point.
  struct Known {
    std::vector<Vec3> radiance;          ///< that leaves the surface, reflected
    std::vector<Vec3> direct, indirect;  ///< E
    std::vector<float> back_share, error;
    std::uint64_t rays = 0;
  };
  explicit RadianceCache(Known known)
      : radiance_(std::move(known.radiance)),
        direct_(std::move(known.direct)),
        indirect_(std::move(known.indirect)),
        back_share_(std::move(known.back_share)),
        error_(std::move(known.error)),
        rays_(known.rays) {}

  /// Keeps nothing but copies. Throws Error kInterrupted.
  RadianceCache(const trace::Tracer& tracer, const Emitters& emitters, const TexelLookup& lookup,
                const atlas::Texels& texels, const TexelGroups& groups, const Exposure& exposure,
                const CacheOptions& options, Progress& progress);

  /// Radiance that leaves the surface at the end of a ray, the same in all directions. But for walkChance.
  Vec3 radiance(SideOfTexel surface) const {
    if ((surface & kBackBit) == 0) return radiance_[surface];
    if (surface == kNoTexel || back_of_.empty()) return Vec3(0.0f);
    return radiance_[back_of_[surface & ~kBackBit]];
  }

  /// Where what glossy lobes send is followed ray by ray (glossy_walk.h) and not part of radiance(): the
  /// chance in 256 with which a ray that ends at a point ought to be. Always 0: radiance() has all of it.
  std::uint32_t walkChance(std::uint32_t point) const {
    return walk_chance_.empty() ? 0 : walk_chance_[point];
  }
  bool anyWalks() const { return !walk_chance_.empty(); }

  /// An estimate of E at the front of a point, without what comes straight from emitters, and of that; noisy.
  const Vec3& indirect(std::uint32_t point) const { return indirect_[point]; }
  const Vec3& direct(std::uint32_t point) const { return direct_[point]; }
  /// Share of gather rays that met the back of a single-sided surface; 1 where nothing can be seen.
  float backShare(std::uint32_t point) const { return back_share_[point]; }

  /// Of E gathered from the cache, what its own errors make of it: an estimate of luminance; 0: not known.
  float error(std::uint32_t point) const { return error_.empty() ? 0.0f : error_[point]; }

  std::uint64_t rays() const { return rays_; }

 private:
  struct Builder;
  std::vector<Vec3> radiance_;          ///< fronts by point, then backs by number, then nothing
  std::vector<std::uint32_t> back_of_;  ///< by point: place in radiance_; empty: there are no backs
  std::vector<Vec3> direct_, indirect_;
  std::vector<float> back_share_;
  std::vector<float> error_;               ///< by point, or empty
  std::vector<std::uint8_t> walk_chance_;  ///< by point, or empty
  std::uint64_t rays_ = 0;
};

}  // namespace relume::transport
