// SPDX-License-Identifier: MIT
// A lightmap beside its truth, for the report: numbers at places all over the surfaces, and views.
#pragma once
#include "comparison.h"
#include "relume/core/progress.h"
#include "verification.h"

namespace relume::app {

struct ViewOptions {
  IVec2 size{480, 270};
  std::uint32_t samples = 128;  ///< paths per pixel, in two independent halves
  std::uint32_t most = 4;       ///< cameras of the file; one that frames the scene where it has none
};

nlohmann::ordered_json toJson(const Verification& verification);

Comparison compareLightmap(const scene::Scene& scene, const asset::Asset& asset,
                           const Verification& verification, const VerifyOptions& options,
                           const ViewOptions& views, Progress& progress);

}  // namespace relume::app
