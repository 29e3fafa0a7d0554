// SPDX-License-Identifier: MIT
// Texels by unbiased random walks, each for itself: the truth that faster solvers of lightmaps are held
// against.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "group_rays.h"
#include "lightmap/gatherer.h"
#include "path_tracer.h"
#include "relume/transport/lightmap.h"

namespace relume::transport {

class PathGroup {
 public:
  /// Keeps references. The first `back_rays` samples of `directions`, a whole net, tell what lies inside
  /// something: part of a net is a part of the hemisphere.
  PathGroup(const trace::Tracer& tracer, const atlas::Texels& texels, const TexelLookup& lookup,
            const Emitters& emitters, const SampleTable& directions, const Exposure& exposure,
            std::uint32_t back_rays, const LightmapOptions& options);

  std::uint64_t rays() const { return paths_; }
  /// Results of group[i] go to slots[i], unless it is scene::kNone.
  void solve(std::span<const std::uint32_t> group, std::span<const std::uint32_t> slots,
             LightmapResult& result);

 private:
  static constexpr std::uint32_t kRuns = 16;  // independent; their scatter tells the error
  struct Sums {
    std::array<glm::dvec3, kRuns> run{};
    std::uint32_t count = 0;
    Vec3 mean() const;
    float error() const;  // of luminance
  };
  void sample(std::uint32_t texel, std::uint32_t place, std::uint32_t until);
  /// Mean square of the errors is below that of what is allowed.
  bool converged(std::size_t texels) const;

  const atlas::Texels& texels_;
  const LightmapOptions& options_;
  const ReferenceOptions walk_;
  const Exposure& exposure_;
  const std::uint32_t back_rays_;
  GroupRays rays_;
  Gatherer gatherer_;
  PathTracer tracer_;
  std::array<Sums, kGroupTexels> sums_;
  std::uint64_t paths_ = 0;
};

}  // namespace relume::transport
