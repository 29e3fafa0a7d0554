// SPDX-License-Identifier: MIT
// A baked day, or a DAY.json, as the commands use it.
#pragma once
#include <optional>
#include <string>

#include "relume/asset/asset.h"
#include "relume/bake/registry.h"
#include "relume/core/day.h"
#include "relume/image/image.h"
#include "relume/picture/picture.h"

namespace relume::app {

/// Reads a DAY.json; the day without a file is the summer solstice at 55.49 N, 9.47 E.
bake::DayPlan readDay(const std::string& file);

/// The layer of kind day of that name, or the first one; null where `name` is empty and there is none. Throws
/// Error kNoSuchLayer, kMismatch for a layer of another kind.
asset::Layer* dayLayer(asset::Asset& asset, const std::string& name);

/// The day that a bake holds, or that a file (where given) tells. Throws Error kUsage where there is neither.
Day dayOf(asset::Asset* asset, const std::string& layer, const std::string& file);

/// Minutes of "HH:MM". Throws Error kUsage.
double parseTime(const std::string& text);

/// Adds what a layer for the pixels of a camera holds at that time to a picture of light straight from lamps
/// and the sun. Throws Error kUsage where the picture's camera is not the layer's.
void addPixelLight(const trace::Tracer& tracer, const asset::Asset& asset, const asset::Layer& layer,
                   double minutes, const picture::Viewpoint& viewpoint,
                   const picture::PictureOptions& options, image::Image& picture, Progress& progress);

}  // namespace relume::app
