// SPDX-License-Identifier: MIT
// The pictures of a report: the scene from its own camera, and the pages of each layer.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "relume/bake/bake.h"
#include "relume/core/progress.h"
#include "report_parts.h"

namespace relume::app {

/// The baked scene by rays: lit where it has lamps, each layer's ambient light, texels, charts, validity.
std::vector<ReportPicture> drawScene(const std::filesystem::path& folder, const std::filesystem::path& baked,
                                     Progress& progress);

/// The kinds whose value is a share of ambient light: what the views by rays show, with errors measured by
/// the target of the quality.
bool isShareOfAmbientLight(const std::string& kind);

/// A page of a layer: as it is stored (tone-mapped where its values leave the range of a screen), its errors
/// in false colour, and the marks of its suspects.
struct PagePictures {
  std::uint32_t page = 0;
  ReportPicture values, errors, marks;
};
struct LayerPictures {
  std::vector<PagePictures> pages;  ///< the first ones of many
  std::size_t left_out = 0;
  float error_scale = 0;  ///< standard error of the brightest colour
};
LayerPictures drawPages(const std::filesystem::path& folder, const asset::Asset& asset, std::size_t layer,
                        const bake::LayerReport& report);

}  // namespace relume::app
