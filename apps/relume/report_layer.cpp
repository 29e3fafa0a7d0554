// SPDX-License-Identifier: MIT
#include "report_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "relume/core/memory.h"
#include "report_charts.h"
#include "report_parts.h"

namespace relume::app {
namespace {

using bake::LayerReport;

constexpr std::size_t kRows = 10;  // of a table that could have thousands

const asset::Parameter* settingOf(const bake::Report& report, const char* name) {
  const auto found = report.settings.find(name);
  return found == report.settings.end() ? nullptr : &found->second;
}

std::string rectangle(const bake::ChartReport& chart) {
  return fmt::format("page {}, {} × {} at {}, {}", chart.page, chart.width, chart.height, chart.x, chart.y);
}

std::string errorSection(const bake::Report& report, const LayerReport& layer) {
  std::vector<std::size_t> order(layer.charts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t shown = std::min(kRows, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(shown), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return std::pair(layer.charts[b].rms, a) < std::pair(layer.charts[a].rms, b);
                    });
  HistogramChart chart{.histogram = layer.chart_errors,
                       .axis = "estimated standard error (RMS over the chart's texels)",
                       .items = "charts"};
  if (const asset::Parameter* target = settingOf(report, "target_error");
      target && std::get<double>(*target) > 0 && isShareOfAmbientLight(layer.kind)) {
    chart.marker = std::get<double>(*target);
    chart.marker_label = "target " + shortNumber(*chart.marker);
  }
  std::string html = "<div class=two><div><h3>Error by chart</h3>\n" + svgHistogram(chart);
  html += fmt::format(
      "<p class=soft>Over the whole layer {} RMS, {} at worst, for a mean value of {}.</p></div>\n",
      shortNumber(layer.rms_error), shortNumber(layer.max_error), shortNumber(layer.mean_value));
  html +=
      "<div><h3>The noisiest charts</h3>\n<div class=scroll><table><tr><th>Object<th>Chart<th "
      "class=n>Texels<th "
      "class=n>Error<th class=n>Largest<th class=n>Mean value</tr>\n";
  for (std::size_t i = 0; i < shown; ++i) {
    const bake::ChartReport& where = report.charts[order[i]];
    const bake::ChartError& error = layer.charts[order[i]];
    html += fmt::format(
        "<tr><td class=name>{}<td title=\"{}\">{}<td class=n>{}<td class=n>{}<td class=n>{}<td "
        "class=n>{}</tr>\n",
        escapeHtml(report.objects[where.object].name), rectangle(where), order[i], where.texels,
        shortNumber(error.rms), shortNumber(error.max), shortNumber(error.mean_value));
  }
  return html + "</table></div></div></div>\n";
}

std::string seamSection(const LayerReport& layer) {
  const bake::SeamError &before = layer.seams_before, &after = layer.seams_after;
  if (before.samples == 0)
    return "<h3>Seams</h3>\n<p class=soft>No two chart borders run along each other.</p>\n";
  std::string html = fmt::format(
      "<h3>Seams</h3>\n<p>At {} places along borders of charts that are one edge in space, the two sides "
      "differ "
      "by</p>\n<table class=narrow><tr><th><th class=n>RMS<th class=n>Largest</tr>\n"
      "<tr><td>before stitching<td class=n>{}<td class=n>{}</tr>\n<tr><td>after stitching<td class=n>{}<td "
      "class=n>{}</tr></table>\n",
      before.samples, shortNumber(before.rms), shortNumber(before.max), shortNumber(after.rms),
      shortNumber(after.max));
  return html;
}

std::string signText(std::uint8_t signs) {
  std::string text;
  if (signs & bake::kBesideInvalid) text += "beside invalid";
  if (signs & bake::kSeesBacks) text += text.empty() ? "sees backs" : ", sees backs";
  return text.empty() ? "–" : text;
}

std::string suspectSection(const bake::BakeResult& result, const LayerReport& layer) {
  const bake::Report& report = result.report;
  std::string html = "<h3>Leak suspects</h3>\n";
  html += fmt::format(
      "<p><b>{}</b> texels stand out from their neighbours, {} lie beside texels inside other geometry, {} "
      "saw "
      "some back faces themselves. {} are inside other geometry and were filled.</p>\n",
      layer.stand_out, layer.beside_invalid, layer.see_backs, layer.invalid_texels);
  if (layer.suspects.empty()) return html;
  html +=
      "<p class=soft>A texel stands out where its value is more than a fifth away from what the texels about "
      "it in its "
      "chart suggest, its noise allowed for. Severity says how many times over.</p>\n";
  html +=
      "<div class=scroll><table><tr><th>Object<th>Place in the world, m<th class=n>Value<th "
      "class=n>Neighbours "
      "say<th class=n>Severity<th>Other signs</tr>\n";
  for (std::size_t i = 0; i < std::min(kRows, layer.suspects.size()); ++i) {
    const bake::Suspect& s = layer.suspects[i];
    html += fmt::format(
        "<tr><td class=name>{}<td>{:.2f}, {:.2f}, {:.2f}<td class=n>{}<td class=n>{}<td class=n>{:.1f} "
        "×<td>{}</tr>\n",
        escapeHtml(report.objects[report.charts[s.chart].object].name), s.position.x, s.position.y,
        s.position.z, shortNumber(s.value), shortNumber(s.suggested), s.severity, signText(s.signs));
  }
  return html + "</table></div>\n";
}

std::string pageFigures(const LayerPictures& pictures) {
  std::string html = "<div class=\"grid three\">\n";
  for (const PagePictures& p : pictures.pages) {
    const std::string page = pictures.pages.size() > 1 ? fmt::format("Page {}: ", p.page) : std::string();
    html += figure(p.values, page + p.values.caption, "texels") +
            figure(p.errors, page + p.errors.caption, "texels") +
            figure(p.marks, page + p.marks.caption, "texels");
  }
  html +=
      "</div>\n<p class=\"soft key\"><small><i style=\"background:#ff59e7\"></i>stands out<i "
      "style=\"background:#e7302b\"></i>inside other geometry, filled<i "
      "style=\"background:#26c3f3\"></i>sees "
      "back faces<i style=\"background:#f9b326\"></i>beside filled texels</small></p>\n";
  if (pictures.left_out > 0) html += fmt::format("<p class=soft>and {} more pages</p>\n", pictures.left_out);
  return html;
}

}  // namespace

std::string layerSection(const bake::BakeResult& result, std::size_t layer, const LayerPictures& pictures) {
  const LayerReport& report = result.report.layers[layer];
  const bake::LayerStatistics& numbers = result.statistics.layers[layer];
  std::string html = fmt::format(
      "<h2 id=\"layer-{0}\">Layer {0}</h2>\n<p class=soft>{1} texels traced in {2:.1f} s, {3} from the "
      "cache; {4} in the file</p>\n",
      escapeHtml(report.name), numbers.computed_texels, numbers.seconds, numbers.reused_texels,
      formatSize(numbers.bytes));
  html += pageFigures(pictures);
  html += errorSection(result.report, report);
  html += suspectSection(result, report) + seamSection(report);
  return html;
}

}  // namespace relume::app
