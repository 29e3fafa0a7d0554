// SPDX-License-Identifier: MIT
// The report of a bake: a page with pictures and numbers that opens in any browser.
#pragma once
#include <filesystem>

#include "relume/bake/bake.h"
#include "relume/core/progress.h"

namespace relume::app {

/// Writes report.html, report.json and pictures into `folder`. `baked` is the file that was written.
void writeReport(const std::filesystem::path& folder, const std::filesystem::path& baked,
                 const bake::BakeResult& result, Progress& progress);

}  // namespace relume::app
