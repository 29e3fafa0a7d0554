// SPDX-License-Identifier: MIT
// The report of a bake: a page with pictures and numbers that opens in any browser, and the numbers as JSON.
#pragma once
#include <filesystem>
#include <string>

#include "relume/bake/bake.h"
#include "relume/core/progress.h"

namespace relume::app {

struct ReportFacts {
  std::string input, output;
  std::string typed;    ///< the command line as it was given
  std::string command;  ///< one that gives the same bits from any folder, with every setting spelled out
};

/// Writes report.html, report.json and pictures into `folder`. The baked file must have been written.
void writeReport(const std::filesystem::path& folder, const ReportFacts& facts,
                 const bake::BakeResult& result, Progress& progress);

}  // namespace relume::app
