// SPDX-License-Identifier: MIT
// What a bake looks like from near: where its error is, what may leak, how well seams close. Gathered during
// the bake where BakeOptions::report asks for it; docs/report.md tells people how to read it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "relume/bake/layer_spec.h"
#include "relume/core/vec.h"

namespace relume::bake {

/// Counts by value. Values outside are in the first or last bin.
struct Histogram {
  std::vector<double> edges;  ///< shape: [bins + 1], increasing
  std::vector<std::uint64_t> counts;
};

/// How far the two sides of seams differ, over all seam samples and channels.
struct SeamError {
  std::size_t samples = 0;
  double rms = 0, max = 0;
};

/// A static instance: what a node shows of one primitive.
struct ObjectReport {
  std::string name;
  std::size_t charts = 0, texels = 0, invalid_texels = 0;
  double area = 0;              ///< m^2
  double texels_per_metre = 0;  ///< median over its texels
};

struct ChartReport {
  std::uint32_t object = 0;                                     ///< index into Report::objects
  std::uint32_t page = 0, x = 0, y = 0, width = 0, height = 0;  ///< bounding box, texels
  std::size_t texels = 0, invalid_texels = 0;
  double mean_stretch = 1, max_stretch = 1;
};

/// Of one layer in one chart, over its valid texels; zeros where it has none.
struct ChartError {
  double rms = 0, max = 0;  ///< of the estimated standard errors
  double mean_value = 0;
};

/// Signs by which a valid texel is suspected to show light or darkness that is not its own.
enum SuspectSign : std::uint8_t {
  kStandsOut = 1,      ///< its value is far from what its neighbours suggest
  kBesideInvalid = 2,  ///< a texel next to it lies inside other geometry
  kSeesBacks = 4,      ///< some of its own rays met back faces
};
inline constexpr std::uint8_t kInvalidMark = 8;  ///< not a suspect: it was filled from its neighbours

struct Suspect {
  std::uint32_t texel = 0;  ///< page * width * height + row * width + column
  std::uint32_t chart = 0;
  Point position{0};               ///< world
  float value = 0, suggested = 0;  ///< mean of the channels
  float severity = 0;              ///< |value - suggested| over what is tolerated; above 1 it stands out
  std::uint8_t signs = 0;
};

struct LayerReport {
  std::string name, kind;
  Parameters parameters;  ///< resolved
  double mean_value = 0;  ///< over valid texels and channels of the first plane
  double rms_error = 0, max_error = 0;
  std::size_t invalid_texels = 0;
  std::vector<ChartError> charts;  ///< shape: [charts of the atlas]
  Histogram chart_errors;          ///< charts by their rms error
  SeamError seams_before, seams_after;
  std::size_t stand_out = 0, beside_invalid = 0, see_backs = 0;  ///< texels with each sign
  std::vector<Suspect> suspects;    ///< those that stand out, the most severe first, at most kMostSuspects
  std::vector<std::uint8_t> marks;  ///< shape: [covered texels]; SuspectSign and kInvalidMark
  std::vector<float> errors;        ///< shape: [covered texels]; standard error as estimated
};
inline constexpr std::size_t kMostSuspects = 1000;

struct Report {
  Parameters settings;  ///< every setting of the bake that is not a layer's, resolved
  std::vector<ObjectReport> objects;
  std::vector<ChartReport> charts;
  Histogram texel_density;                                       ///< texels by texels per metre
  double median_density = 0, low_density = 0, high_density = 0;  ///< 50, 5 and 95 % of the texels are below
  std::vector<LayerReport> layers;
};

/// JSON of the report: objects, charts, texel_density, settings, layers (docs/report.md).
std::string toJson(const Report& report);

}  // namespace relume::bake
