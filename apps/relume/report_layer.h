// SPDX-License-Identifier: MIT
// The section of report.html that tells of one layer.
#pragma once
#include <string>

#include "relume/bake/bake.h"
#include "report_pictures.h"

namespace relume::app {

std::string layerSection(const bake::BakeResult& result, std::size_t layer, const LayerPictures& pictures);

/// <figure> of a picture; `tall` draws small pages with sharp texels.
std::string figure(const ReportPicture& picture, const std::string& caption, const char* kind = "");

/// Three digits, as people read them.
std::string shortNumber(double value);
/// "12.3 %", and "< 0.1 %" for little that is not nothing.
std::string percent(double share);

}  // namespace relume::app
