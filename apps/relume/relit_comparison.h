// SPDX-License-Identifier: MIT
// Relit light beside its truth, as the report of `relume verify` shows it.
#pragma once
#include "comparison.h"
#include "lightmap_comparison.h"
#include "relit_verification.h"
#include "relume/asset/transfer.h"

namespace relume::app {

/// errors: what the bake says of the causes.
nlohmann::ordered_json toJson(const RelitVerification& verification,
                              const std::optional<asset::TransferErrors>& errors);
Comparison compareRelit(const RelitVerification& verification,
                        const std::optional<asset::TransferErrors>& errors);

/// What is left of the median error after those causes: interpolation between exits, and elements.
double unexplained(const RelitVerification& verification, const asset::TransferErrors& errors);

/// The whole light of the median lamp and of the worst one, relit and path-traced, from cameras of the file.
std::vector<ComparedView> relitViews(scene::Scene scene, asset::Asset asset,
                                     const RelitVerification& verification, const ViewOptions& views,
                                     std::uint64_t seed, Progress& progress);

}  // namespace relume::app
