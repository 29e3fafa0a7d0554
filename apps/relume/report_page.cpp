// SPDX-License-Identifier: MIT
#include "report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "relume/core/memory.h"
#include "report_charts.h"
#include "report_layer.h"
#include "report_parts.h"

namespace relume::app {
namespace {

using bake::BakeResult;

constexpr double kManyInvalid = 0.2;  // share of an object's texels from which it is worth a look
constexpr double kUneven = 2;         // ratio of high to low texel density from which squares look unequal

double targetOf(const bake::Report& report) {
  const auto found = report.settings.find("target_error");
  return found == report.settings.end() ? 0 : std::get<double>(found->second);
}

std::string cards(const BakeResult& result) {
  const bake::Statistics& s = result.statistics;
  const bake::Report& r = result.report;
  double error = 0, before = 0, after = 0;
  std::size_t stand_out = 0;
  for (const bake::LayerReport& layer : r.layers) {
    stand_out += layer.stand_out;
    if (layer.mean_value > 0) {
      before = std::max(before, layer.seams_before.rms / layer.mean_value);
      after = std::max(after, layer.seams_after.rms / layer.mean_value);
    }
  }
  for (const bake::LayerStatistics& layer : s.layers) error = std::max(error, layer.error_estimate);
  double seconds = 0;
  for (const bake::StageTime& stage : s.stages) seconds += stage.seconds;
  const double invalid = s.texels ? static_cast<double>(s.invalid_texels) / static_cast<double>(s.texels) : 0;
  std::string html = "<div class=cards>\n";
  html += card(percent(error), "estimated error, of the noisiest layer");
  html += card(fmt::format("{}", stand_out), "texels that stand out: leak suspects",
               stand_out ? "watch" : "good");
  html +=
      card(percent(invalid), fmt::format("of the texels lie inside other geometry ({})", s.invalid_texels));
  html += card(
      percent(after),
      fmt::format("of the mean value: RMS difference across seams, {} before stitching", percent(before)));
  html += card(shortNumber(r.median_density),
               fmt::format("texels per metre; {} texels on {} page{} of {} × {}", s.texels, s.atlas_pages,
                           s.atlas_pages == 1 ? "" : "s", s.atlas_width, s.atlas_height));
  html += card(fmt::format("{:.1f} s", seconds),
               fmt::format("to bake; {} of memory at the peak", formatSize(s.peak_rss_bytes)));
  return html + "</div>\n";
}

/// What a person should look at, in words. Empty when there is nothing.
std::vector<std::string> findings(const BakeResult& result) {
  const bake::Statistics& s = result.statistics;
  const bake::Report& r = result.report;
  std::vector<std::string> notes;
  if (s.atlas.overlapping_texels > 0)
    notes.push_back(
        fmt::format("{} texels are claimed by two triangles: the second UV set overlaps there. "
                    "<code>--new-uv</code> makes charts without overlap.",
                    s.atlas.overlapping_texels));
  for (const bake::LayerReport& layer : r.layers) {
    const double target = targetOf(r);
    if (target > 0 && layer.rms_error > target && isShareOfAmbientLight(layer.kind))
      notes.push_back(
          fmt::format("Layer {}: the error is {}, above the {} that the quality asks for. The limit of "
                      "{} rays per texel came first; a higher <code>--quality</code> allows more.",
                      escapeHtml(layer.name), shortNumber(layer.rms_error), shortNumber(target),
                      static_cast<std::uint64_t>(std::get<double>(r.settings.at("samples_max")))));
    if (!layer.suspects.empty()) {
      const bake::Suspect& worst = layer.suspects.front();
      notes.push_back(
          fmt::format("Layer {}: {} texel{} stand{} out from {} neighbours, the worst on <b>{}</b> near "
                      "({:.2f}, {:.2f}, {:.2f}).",
                      escapeHtml(layer.name), layer.stand_out, layer.stand_out == 1 ? "" : "s",
                      layer.stand_out == 1 ? "s" : "", layer.stand_out == 1 ? "its" : "their",
                      escapeHtml(r.objects[r.charts[worst.chart].object].name), worst.position.x,
                      worst.position.y, worst.position.z));
    }
  }
  std::size_t buried = 0;
  const bake::ObjectReport* most = nullptr;
  for (const bake::ObjectReport& o : r.objects) {
    if (static_cast<double>(o.invalid_texels) <= kManyInvalid * static_cast<double>(o.texels)) continue;
    ++buried;
    if (!most || o.invalid_texels > most->invalid_texels) most = &o;
  }
  if (most)
    notes.push_back(fmt::format(
        "{} object{} more than a fifth of {} texels inside other geometry, <b>{}</b> the most. "
        "Those texels are spent on what nobody sees.",
        buried, buried == 1 ? " has" : "s have", buried == 1 ? "its" : "their", escapeHtml(most->name)));
  if (r.low_density > 0 && r.high_density / r.low_density > kUneven)
    notes.push_back(
        fmt::format("Texel density is uneven: between {} and {} texels per metre on nine tenths of the "
                    "texels.",
                    shortNumber(r.low_density), shortNumber(r.high_density)));
  return notes;
}

std::string notesList(const BakeResult& result) {
  const std::vector<std::string> notes = findings(result);
  std::string html = "<ul class=notes>\n";
  for (const std::string& text : notes) html += note(text, "watch");
  for (const Warning& warning : result.warnings) html += note(escapeHtml(warning.text()), "bad");
  if (notes.empty() && result.warnings.empty()) html += note("Nothing needs a second look.", "good");
  return html + "</ul>\n";
}

std::string objectRows(const bake::Report& report, const std::vector<const bake::ObjectReport*>& objects) {
  std::string html =
      "<div class=scroll><table><tr><th>Object<th class=n>Charts<th class=n>Texels<th class=n>Inside other "
      "geometry<th class=n>Share<th class=n>Surface, m²<th class=n>Texels per metre</tr>\n";
  for (const bake::ObjectReport* o : objects) {
    const double share =
        o->texels ? static_cast<double>(o->invalid_texels) / static_cast<double>(o->texels) : 0;
    const bool odd = report.median_density > 0 && (o->texels_per_metre > kUneven * report.median_density ||
                                                   o->texels_per_metre < report.median_density / kUneven);
    html += fmt::format(
        "<tr><td class=name>{}<td class=n>{}<td class=n>{}<td class=n>{}<td class=\"n{}\">{}<td "
        "class=n>{}<td "
        "class=\"n{}\">{}</tr>\n",
        escapeHtml(o->name), o->charts, o->texels, o->invalid_texels, share > kManyInvalid ? " watch" : "",
        percent(share), shortNumber(o->area), odd ? " watch" : "", shortNumber(o->texels_per_metre));
  }
  return html + "</table></div>\n";
}

std::string objectSection(const bake::Report& report) {
  constexpr std::size_t kRows = 15, kMostRows = 2000;
  std::vector<const bake::ObjectReport*> objects;
  for (const bake::ObjectReport& o : report.objects) objects.push_back(&o);
  std::stable_sort(objects.begin(), objects.end(), [](const auto* a, const auto* b) {
    return std::pair(a->invalid_texels, a->texels) > std::pair(b->invalid_texels, b->texels);
  });
  std::string html =
      "<h2 id=objects>Objects</h2>\n<p class=soft>Those with the most texels inside other geometry come "
      "first.</p>\n";
  const auto split = objects.begin() + static_cast<std::ptrdiff_t>(std::min(kRows, objects.size()));
  html += objectRows(report, {objects.begin(), split});
  if (split != objects.end()) {
    const auto end = objects.begin() + static_cast<std::ptrdiff_t>(std::min(kMostRows, objects.size()));
    html += fmt::format("<details><summary>{} more</summary>\n", objects.end() - split) +
            objectRows(report, {split, end}) + "</details>\n";
  }
  return html;
}

std::string densitySection(const bake::Report& r, const bake::Statistics& s) {
  std::string html = "<h2 id=density>Texel density</h2>\n";
  html += svgHistogram({.histogram = r.texel_density,
                        .axis = "texels per metre",
                        .items = "texels",
                        .logarithmic = true,
                        .marker = r.median_density,
                        .marker_label = "median " + shortNumber(r.median_density)});
  return html + fmt::format(
                    "<p class=soft>Nine tenths of the texels lie between {} and {} texels per metre. {} "
                    "charts cover {} of the "
                    "atlas; mean stretch {:.3f}, largest {:.2f}.</p>\n",
                    shortNumber(r.low_density), shortNumber(r.high_density), s.atlas.charts,
                    percent(s.atlas.coverage), s.atlas.mean_stretch, s.atlas.max_stretch);
}

std::string timeSection(const bake::Statistics& s) {
  std::vector<BarRow> rows;
  for (const bake::StageTime& stage : s.stages)
    rows.push_back({stage.name, fmt::format("{:.2f} s", stage.seconds), stage.seconds});
  const std::string rays = s.rays > 0
                               ? fmt::format("{:.1f} million rays, {:.1f} million a second",
                                             static_cast<double>(s.rays) * 1e-6, s.rays_per_second * 1e-6)
                               : std::string("No rays: every texel came from the cache");
  return "<h2 id=time>Time</h2>\n" + svgBars(rows) +
         fmt::format(
             "<p class=soft>{}; {} triangles; {} of memory at the peak. Drawing this report is not "
             "counted.</p>\n",
             rays, s.triangles, formatSize(s.peak_rss_bytes));
}

std::string valueText(const asset::Parameter& parameter) {
  if (const double* v = std::get_if<double>(&parameter))
    return std::isinf(*v) ? std::string("no limit") : fmt::format("{}", static_cast<float>(*v));
  if (const bool* v = std::get_if<bool>(&parameter)) return *v ? "yes" : "no";
  return std::get<std::string>(parameter);
}

std::string parameterTable(const bake::Parameters& parameters) {
  std::string html = "<table>\n";
  for (const auto& [name, value] : parameters) {
    std::string key = name;
    std::replace(key.begin(), key.end(), '_', ' ');
    html += fmt::format("<tr><td>{}<td class=n>{}</tr>\n", escapeHtml(key), escapeHtml(valueText(value)));
  }
  return html + "</table>\n";
}

std::string settingsSection(const ReportFacts& facts, const BakeResult& result) {
  std::string html =
      "<h2 id=settings>Settings</h2>\n<p>This command makes the same file again, bit for bit, on the same "
      "kind "
      "of machine:</p>\n<pre>" +
      escapeHtml(facts.command) + "</pre>\n<details><summary>as it was typed</summary>\n<pre>" +
      escapeHtml(facts.typed) + "</pre></details>\n<div class=two>\n<div><h3>Bake</h3>\n" +
      parameterTable(result.report.settings) + "</div>\n";
  html += "<div>";
  for (const bake::LayerReport& layer : result.report.layers)
    html += "<h3>Layer " + escapeHtml(layer.name) + "</h3>\n" + parameterTable(layer.parameters);
  return html + "</div></div>\n";
}

}  // namespace

std::string reportPage(const ReportFacts& facts, const BakeResult& result,
                       const std::vector<ReportPicture>& scene, const std::vector<LayerPictures>& layers) {
  const std::string name = std::filesystem::path(facts.output).filename().string();
  std::string html = pageHead(name + " – bake report");
  html += fmt::format("<h1>{}</h1>\n<div class=soft>baked from {} by {}; {}</div>\n", escapeHtml(name),
                      escapeHtml(std::filesystem::path(facts.input).filename().string()),
                      escapeHtml(result.asset.generator), formatSize(result.glb.size()));
  html += "<nav>";
  for (const bake::LayerReport& layer : result.report.layers)
    html += fmt::format("<a href=\"#layer-{0}\">{0}</a>", escapeHtml(layer.name));
  html +=
      "<a href=\"#objects\">objects</a><a href=\"#density\">texel density</a><a href=\"#time\">time</a><a "
      "href=\"#settings\">settings</a><a href=\"report.json\">report.json</a></nav>\n";
  html += cards(result) + notesList(result);
  html += "<div class=grid>\n";
  for (std::size_t i = 0; i < scene.size(); ++i)
    html += figure(scene[i], scene[i].caption, i == 0 ? "wide" : "");
  html += "</div>\n";
  for (std::size_t i = 0; i < layers.size(); ++i) html += layerSection(result, i, layers[i]);
  html += objectSection(result.report) + densitySection(result.report, result.statistics) +
          timeSection(result.statistics) + settingsSection(facts, result);
  return html + "</body></html>\n";
}

}  // namespace relume::app
