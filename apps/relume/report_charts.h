// SPDX-License-Identifier: MIT
// Small drawings inside the page, in its own colours (CSS variables), so that they follow its light or dark
// scheme.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "relume/bake/report.h"

namespace relume::app {

std::string escapeHtml(const std::string& text);

/// Bars of a histogram over a numeric axis; `marker` draws a line at that value with a label.
struct HistogramChart {
  const bake::Histogram& histogram;
  std::string axis;   ///< label with the unit
  std::string items;  ///< what is counted: "texels"
  bool logarithmic = false;
  std::optional<double> marker = std::nullopt;
  std::string marker_label = "";
};
std::string svgHistogram(const HistogramChart& chart);

/// One bar for each row.
struct BarRow {
  std::string label, value;
  double length = 0;
};
std::string svgBars(const std::vector<BarRow>& rows);

}  // namespace relume::app
