// SPDX-License-Identifier: MIT
// The report of `relume verify`: comparisons with the truth, whatever they are of.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "comparison.h"
#include "relume/core/progress.h"
#include "report_parts.h"

namespace relume::app {

struct VerifyFacts {
  std::string asset, lights;  ///< files; lights: "": the scene's own
  std::string generator;      ///< what baked it
  std::string typed;          ///< the command line
};

/// What a view looks like on a screen: pictures, and how different they look.
struct ShownView {
  std::string caption;
  ReportPicture baked, truth, difference;
  float exposure = 0;                    ///< stops
  double mean_flip = 0, noise_flip = 0;  ///< of the bake; of the truth's own noise
  double bias = 0, rmse = 0, noise = 0;  ///< of linear RGB, shares of the mean of the truth
};

/// Writes report.html, report.json and pictures into `folder`.
void writeVerifyReport(const std::filesystem::path& folder, const VerifyFacts& facts,
                       const std::vector<Comparison>& comparisons, Progress& progress);

/// shown: of each comparison its views.
std::string verifyPage(const VerifyFacts& facts, const std::vector<Comparison>& comparisons,
                       const std::vector<std::vector<ShownView>>& shown);

}  // namespace relume::app
