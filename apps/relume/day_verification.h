// SPDX-License-Identifier: MIT
// A baked day against path-traced truth, at random times.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "verification.h"

namespace relume::app {

/// Irradiance of RGB that the layer holds, at places all over the surfaces, at one time.
struct TimeAgreement {
  double minutes = 0;
  double mean_true = 0;  ///< luminance of the true irradiance
  double error = 0;      ///< ||baked - true|| / ||true||, the truth's noise taken off; 0 where all is dark
  double bias = 0;       ///< sum of baked / sum of true - 1
};

struct DayVerification {
  std::string layer;
  std::size_t points = 0;
  std::uint64_t paths = 0;
  std::vector<TimeAgreement> times;        ///< in the order of time
  double median = 0, mean = 0, worst = 0;  ///< of their errors
};

/// `count` times, uniform from the day's begin to its end. For layers of texels. Throws Error kMismatch,
/// kEmptyScene, kInterrupted.
DayVerification verifyDay(scene::Scene scene, asset::Asset asset, const VerifyOptions& options,
                          std::uint32_t count, Progress& progress);

nlohmann::ordered_json toJson(const DayVerification& v);
void print(const DayVerification& v);

}  // namespace relume::app
