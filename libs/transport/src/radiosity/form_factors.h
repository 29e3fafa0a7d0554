// SPDX-License-Identifier: MIT
// Form factors of patches: F_ij is the share of the light that leaves patch i which arrives at patch j. Based
// on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.2.1, equation 11.5.
//   [CG85] Cohen, Greenberg. The Hemi-Cube: A Radiosity Solution for Complex Environments. SIGGRAPH 1985.
// A_i F_ij = A_j F_ji; a row sums to 1 where rays from the patch always end on fronts of patches, to less in
// an open scene. Rays that end on the back of a surface bring nothing.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lightmap/texel_lookup.h"
#include "radiosity/patches.h"
#include "relume/core/progress.h"
#include "relume/trace/tracer.h"

namespace relume::transport {

class FormFactors {
 public:
  struct Entry {
    std::uint32_t patch;
    float value;
  };

  explicit FormFactors(std::size_t patches) : rows_(patches), rays_(patches, 0) {}

  std::size_t size() const { return rows_.size(); }
  /// The entries above zero of F_i., by increasing patch.
  std::span<const Entry> row(std::size_t i) const { return rows_[i]; }
  double sum(std::size_t i) const;
  /// sum_j F_ij values_j.
  glm::dvec3 times(std::size_t i, std::span<const glm::dvec3> values) const;
  /// How many rays the row was found with, and all.
  std::uint32_t rays(std::size_t i) const { return rays_[i]; }
  std::uint64_t rays() const;

  void set(std::size_t i, std::vector<Entry> row, std::uint32_t rays) {
    rows_[i] = std::move(row), rays_[i] = rays;
  }

 private:
  std::vector<std::vector<Entry>> rows_;
  std::vector<std::uint32_t> rays_;
};

/// What both ways need. References are kept while they run.
struct FormFactorScene {
  const trace::Tracer& tracer;
  const TexelLookup& lookup;
  const atlas::Texels& texels;
  const Patches& patches;
};

/// By about `rays` cosine-weighted rays from places all over each patch, 16 to 256 from each texel: every ray
/// of a texel counts the same, texels count by area. The noise of F_ij is at most sqrt(F_ij / rays). Bits do
/// not depend on the number of threads. Throws Error kInterrupted.
FormFactors sampledFormFactors(const FormFactorScene& scene, std::uint32_t rays, std::uint64_t seed,
                               Progress& progress);

/// By a hemicube at the middle of each patch ([CG85]) whose top has resolution x resolution pixels, turned
/// about the normal at random: exact in directions but for pixels, wrong by what the view from the middle
/// differs from the mean view (patches close to each other). The item buffer is made by rays.
FormFactors hemicubeFormFactors(const FormFactorScene& scene, std::uint32_t resolution, std::uint64_t seed,
                                Progress& progress);

/// Form factors of the parents of patches: F_IJ = sum_(i in I) A_i / A_I sum_(j in J) F_ij.
FormFactors mergedFormFactors(const FormFactors& factors, const Patches& patches, const Parents& parents);

}  // namespace relume::transport
