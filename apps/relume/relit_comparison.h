// SPDX-License-Identifier: MIT
// Relit light beside its truth, as the report of `relume verify` shows it.
#pragma once
#include "comparison.h"
#include "relit_verification.h"

namespace relume::app {

nlohmann::ordered_json toJson(const RelitVerification& verification);
Comparison compareRelit(const RelitVerification& verification);

}  // namespace relume::app
