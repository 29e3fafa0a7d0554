// SPDX-License-Identifier: MIT
// What ordinary viewers show of a bake: 8-bit textures made from its layers, one for each page.
#pragma once
#include <vector>

#include "relume/asset/asset.h"
#include "relume/scene/gltf.h"

namespace relume::bake {

/// Fills occlusion_png or lightmap of `output`. A bake with a layer of kind `lightmap` gets its irradiance
/// alone: viewers dim a lightmap by the occlusion texture beside it, and irradiance is occluded already. Else
/// `ao`, else `obscurance` becomes occlusion; else nothing.
void addViewerTextures(const asset::Asset& asset, scene::gltf::BakeOutput& output);

/// The pages of a layer with irradiance (first plane, 3 channels). Each has its own intensity: the largest
/// covered value, so nothing is clipped but, at most four times above all others, outliers (one in 65536
/// texels). A step is intensity / 255, which is coarse in the dark of a bright page, so values are dithered:
/// each texel is off by less than a step, and the mean of neighbours by much less.
std::vector<scene::gltf::LightmapPage> lightmapPages(const asset::AtlasTable& atlas,
                                                     const asset::Layer& layer);

}  // namespace relume::bake
