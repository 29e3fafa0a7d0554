// SPDX-License-Identifier: MIT
// Relit indirect light against path-traced truth, for random lamps of the kind that entries were made for.
#pragma once
#include <vector>

#include "verification.h"

namespace relume::app {

/// One lamp: indirect irradiance of RGB at places all over the surfaces.
struct LampAgreement {
  Light lamp;
  double clearance = 0;  ///< metres to the nearest surface
  double error = 0;      ///< ||relit - true|| / ||true||, the truth's noise taken off
  double rest = 0;       ///< the same without the places that are most wrong, a hundredth of all
  double bias = 0;       ///< sum of relit / sum of true - 1
};

struct RelitVerification {
  std::string layer;
  double spacing = 0;  ///< metres: side of a square of the median entry
  std::vector<LampAgreement> lamps;
  std::size_t points = 0;
  std::uint64_t paths = 0;
  // Over lamps.
  double median = 0, mean = 0, worst = 0;
  double median_rest = 0;     ///< of LampAgreement::rest
  double error_estimate = 0;  ///< what encoding added, as the bake measured it
};

/// `count` white point lamps in rooms, or in the open where there are none, at least an entry's spacing from
/// any surface (`near`: at most that).
/// Throws Error kNoSuchLayer, kEmptyScene where no such lamp finds room, kInterrupted.
RelitVerification verifyRelit(scene::Scene scene, asset::Asset asset, const VerifyOptions& options,
                              std::uint32_t count, bool near, Progress& progress);

}  // namespace relume::app
