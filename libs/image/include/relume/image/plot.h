// SPDX-License-Identifier: MIT
// Line plots as SVG text: for the documentation, reports and benchmarks. Needs no font or library to make;
// the text uses the viewer's sans-serif.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace relume::image {

struct Axis {
  std::string label;                               ///< with its unit, e.g. "time (s)"
  bool logarithmic = false;                        ///< decades; values must be positive
  std::optional<std::pair<double, double>> range;  ///< by default all data, widened to ticks
};

struct Series {
  std::string name;           ///< for the legend; empty: not listed
  std::vector<double> x, y;   ///< equal lengths, in drawing order
  std::vector<double> error;  ///< empty, or half the height of an error bar at each point
  bool line = true, markers = true;
  bool dashed = false;  ///< for a reference or a bound
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  int width = 640, height = 400;  ///< CSS pixels
};

/// A whole SVG document. Points that are not finite, or not positive on a logarithmic axis, break the line
/// and are left out; an empty plot shows its axes. Equal plots give equal bytes.
std::string svgPlot(const Plot& plot);

}  // namespace relume::image
