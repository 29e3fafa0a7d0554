// SPDX-License-Identifier: MIT
// report.html: one file that needs nothing but the pictures beside it.
#pragma once
#include <string>
#include <vector>

#include "report.h"
#include "report_pictures.h"

namespace relume::app {

std::string reportPage(const ReportFacts& facts, const bake::BakeResult& result,
                       const std::vector<ReportPicture>& scene, const std::vector<LayerPictures>& layers);

}  // namespace relume::app
