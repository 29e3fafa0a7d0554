// SPDX-License-Identifier: MIT
// The section of report.html that tells of one layer.
#pragma once
#include <string>

#include "relume/bake/bake.h"
#include "report_pictures.h"

namespace relume::app {

std::string layerSection(const bake::BakeResult& result, std::size_t layer, const LayerPictures& pictures);

}  // namespace relume::app
