// SPDX-License-Identifier: MIT
#include "report_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace relume::app {
namespace {

std::string number(double value) {
  return value != 0 && std::abs(value) < 0.001 ? fmt::format("{:.1e}", value) : fmt::format("{:.3g}", value);
}

}  // namespace

std::string escapeHtml(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string svgHistogram(const HistogramChart& chart) {
  constexpr double kWidth = 560, kHeight = 190, kLeft = 8, kRight = 8, kTop = 24, kBottom = 44;
  const bake::Histogram& h = chart.histogram;
  if (h.counts.empty()) return "";
  const double most =
      std::max<double>(1, static_cast<double>(*std::max_element(h.counts.begin(), h.counts.end())));
  const auto scaled = [&](double v) { return chart.logarithmic ? std::log(v) : v; };
  const double lo = scaled(h.edges.front()), hi = scaled(h.edges.back());
  const auto x = [&](double v) {
    const double t = std::clamp((scaled(v) - lo) / (hi - lo), 0.0, 1.0);
    return kLeft + t * (kWidth - kLeft - kRight);
  };
  const double base = kHeight - kBottom, room = base - kTop;
  std::string svg = fmt::format("<svg class=plot viewBox=\"0 0 {} {}\" role=img aria-label=\"{}\">\n", kWidth,
                                kHeight, escapeHtml(chart.axis));
  for (std::size_t i = 0; i < h.counts.size(); ++i) {
    if (h.counts[i] == 0) continue;
    const double x0 = x(h.edges[i]), x1 = x(h.edges[i + 1]);
    // A bin with anything in it is seen.
    const double height = std::max(1.5, room * static_cast<double>(h.counts[i]) / most);
    svg += fmt::format(
        "<rect class=bar x={:.1f} y={:.1f} width={:.1f} height={:.1f} rx=1.5><title>{} {}: {} to "
        "{}</title></rect>\n",
        x0 + 0.75, base - height, std::max(1.0, x1 - x0 - 1.5), height, h.counts[i], chart.items,
        number(h.edges[i]), number(h.edges[i + 1]));
  }
  svg += fmt::format("<line class=axis x1={} x2={} y1={} y2={} />\n", kLeft, kWidth - kRight, base, base);
  const std::size_t step = std::max<std::size_t>(1, h.counts.size() / 6);
  for (std::size_t i = 0; i < h.edges.size(); i += step) {
    const char* anchor = i == 0 ? "start" : i + 1 == h.edges.size() ? "end" : "middle";
    svg += fmt::format("<text x={:.1f} y={} text-anchor={}>{}</text>\n", x(h.edges[i]), base + 16, anchor,
                       number(h.edges[i]));
  }
  svg += fmt::format("<text class=label x={} y={} text-anchor=middle>{}</text>\n", kWidth / 2, kHeight - 8,
                     escapeHtml(chart.axis));
  svg += fmt::format("<text class=label x={} y=12>up to {:.0f} {}</text>\n", kLeft, most,
                     escapeHtml(chart.items));
  if (chart.marker && *chart.marker >= h.edges.front() && *chart.marker <= h.edges.back()) {
    const double at = x(*chart.marker);
    const bool left = at > kWidth * 0.7;
    svg += fmt::format("<line class=marker x1={0:.1f} x2={0:.1f} y1={1} y2={2} />\n", at, 14, base);
    svg += fmt::format("<text class=marker x={:.1f} y=12 text-anchor={}>{}</text>\n", at + (left ? -5 : 5),
                       left ? "end" : "start", escapeHtml(chart.marker_label));
  }
  return svg + "</svg>\n";
}

std::string svgBars(const std::vector<BarRow>& rows) {
  constexpr double kWidth = 560, kRow = 24, kLabels = 150, kValues = 80;
  double most = 0;
  for (const BarRow& row : rows) most = std::max(most, row.length);
  const double room = kWidth - kLabels - kValues;
  std::string svg = fmt::format("<svg class=plot viewBox=\"0 0 {} {}\" role=img>\n", kWidth,
                                kRow * static_cast<double>(rows.size()) + 4);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double y = kRow * static_cast<double>(i) + 2;
    const double length = most > 0 ? std::max(1.0, room * rows[i].length / most) : 1;
    svg += fmt::format(
        "<text x={} y={:.1f} text-anchor=end>{}</text><rect class=bar x={} y={:.1f} width={:.1f} height={} "
        "rx=2 />"
        "<text class=label x={:.1f} y={:.1f}>{}</text>\n",
        kLabels - 10, y + 16, escapeHtml(rows[i].label), kLabels, y + 4, length, kRow - 8,
        kLabels + length + 8, y + 16, escapeHtml(rows[i].value));
  }
  return svg + "</svg>\n";
}

}  // namespace relume::app
