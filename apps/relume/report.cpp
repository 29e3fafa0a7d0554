// SPDX-License-Identifier: MIT
#include "report.h"

#include <fmt/format.h>

#include <vector>

#include "exposure.h"
#include "files.h"
#include "relume/core/file.h"
#include "relume/core/memory.h"
#include "relume/image/colour.h"
#include "relume/image/io.h"
#include "relume/picture/picture.h"

namespace relume::app {
namespace {

namespace fs = std::filesystem;
using picture::View;

struct Shot {
  View view;
  std::string file, caption;
  std::string layer = "";
};

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --ink: #1d2025; --soft: #69707c; --line: #d9dce1; --paper: #fbfbf9; --card: #ffffff; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8e9ea; --soft: #9aa1ad; --line: #33373e; --paper: #15171a; --card: #1c1f23; } }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper); margin: 0 auto; max-width: 1180px; padding: 2.5rem 1.5rem 4rem; }
h1 { font-size: 1.7rem; margin: 0; } h2 { font-size: 1.15rem; margin: 2.5rem 0 .75rem; } .soft { color: var(--soft); }
.grid { display: grid; grid-template-columns: repeat(auto-fit, minmax(330px, 1fr)); gap: 1.25rem; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 8px; overflow: hidden; }
figure.wide { grid-column: 1 / -1; } img { display: block; width: 100%; } figcaption { padding: .6rem .9rem; font-size: .9rem; color: var(--soft); }
table { border-collapse: collapse; width: 100%; font-size: .93rem; } th, td { text-align: left; padding: .4rem .8rem .4rem 0; border-bottom: 1px solid var(--line); }
th { font-weight: 600; color: var(--soft); } td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; } .warn li { margin: .25rem 0; }
)";

std::string escape(const std::string& text) {
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

std::vector<Shot> shotsFor(const asset::Asset& asset, bool has_lights) {
  std::vector<Shot> shots;
  if (has_lights)
    shots.push_back({View::kLit, "lit.png", "The scene's lights, with ambient light weighted by the bake"});
  for (const asset::Layer& layer : asset.layers) {
    shots.push_back({View::kObscurance, "ambient-" + layer.name + ".png",
                     "Ambient light alone, weighted by " + layer.name, layer.name});
    shots.push_back({View::kOcclusion, "layer-" + layer.name + ".png",
                     layer.name + " alone, on white surfaces", layer.name});
    if (layer.planes.size() > 1)
      shots.push_back({View::kBentNormal, "bent-" + layer.name + ".png",
                       "Bent normals of " + layer.name + ": where the open directions point", layer.name});
  }
  shots.push_back({View::kTexels, "texels.png", "Texels of the atlas: even squares mean even density"});
  shots.push_back({View::kCharts, "charts.png", "Charts of the atlas"});
  shots.push_back({View::kValidity, "validity.png",
                   "Red texels lie inside other geometry and were filled from their neighbours; magenta "
                   "objects move, so they are not baked"});
  return shots;
}

std::string figures(const std::vector<Shot>& shots) {
  std::string html = "<div class=\"grid\">\n";
  for (std::size_t i = 0; i < shots.size(); ++i)
    html += fmt::format("<figure{}><img src=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
                        i == 0 ? " class=\"wide\"" : "", shots[i].file, shots[i].caption, shots[i].caption);
  return html + "</div>\n";
}

std::string layerTable(const bake::Statistics& s) {
  std::string html =
      "<table><tr><th>Layer</th><th class=n>computed texels</th><th class=n>from the cache</th><th "
      "class=n>estimated error</th>"
      "<th class=n>stored</th><th class=n>seconds</th></tr>\n";
  for (const bake::LayerStatistics& l : s.layers)
    html += fmt::format(
        "<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{:.2f} %</td><td "
        "class=n>{}</td><td class=n>{:.2f}</td></tr>\n",
        escape(l.name), l.computed_texels, l.reused_texels, l.error_estimate * 100, formatSize(l.bytes),
        l.seconds);
  return html + "</table>\n";
}

std::string numbersTable(const bake::Statistics& s) {
  std::string html = "<table>\n";
  const auto row = [&](const std::string& what, const std::string& value) {
    html += fmt::format("<tr><td>{}</td><td class=n>{}</td></tr>\n", what, value);
  };
  row("triangles", fmt::format("{}", s.triangles));
  row("covered texels", fmt::format("{} of {} x {} x {} ({:.1f} %)", s.texels, s.atlas_width, s.atlas_height,
                                    s.atlas_pages, s.atlas.coverage * 100));
  row("charts", fmt::format("{}", s.atlas.charts));
  row("texels per metre", fmt::format("{:.2f}", s.atlas.texels_per_metre));
  row("mean stretch", fmt::format("{:.3f}", s.atlas.mean_stretch));
  row("texels inside geometry", fmt::format("{}", s.invalid_texels));
  row("rays", fmt::format("{:.2f} million, {:.2f} million a second", static_cast<double>(s.rays) * 1e-6,
                          s.rays_per_second * 1e-6));
  row("peak memory", formatSize(s.peak_rss_bytes));
  for (const bake::StageTime& stage : s.stages)
    row("time: " + escape(stage.name), fmt::format("{:.3f} s", stage.seconds));
  return html + "</table>\n";
}

}  // namespace

void writeReport(const fs::path& folder, const fs::path& baked, const bake::BakeResult& result,
                 Progress& progress) {
  makeFolder(folder);
  const auto opened = open(baked);
  const trace::Tracer tracer(opened->scene, {.isa = "", .include_dynamic = true});
  const picture::Viewpoint viewpoint = picture::defaultViewpoint(tracer, -1);
  const std::vector<Shot> shots = shotsFor(*opened->asset, !opened->scene.lights.empty());
  for (const Shot& shot : shots) {
    picture::PictureOptions options{.width = 960, .height = 540, .samples = 16, .view = shot.view};
    options.layer = shot.layer;
    options.lights = opened->scene.lights;
    options.background = Vec3(0.05f);
    if (shot.view == View::kLit) options.ambient = Irradiance(0.3f);
    const image::Image linear = picture::render(tracer, &*opened->asset, viewpoint, options, progress);
    const bool light = shot.view == View::kLit;
    image::writeImage(folder / shot.file,
                      image::toneMap(linear, light ? image::ToneCurve::kFilmic : image::ToneCurve::kPlain,
                                     light ? chooseExposure(linear, options.background, false) : 0.0f));
  }
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=en><meta charset=utf-8><meta name=viewport content=\"width=device-width\">"
      "<title>{0}</title><style>{1}</style>\n<h1>{0}</h1>\n<p class=soft>{2}, {3}</p>\n",
      escape(baked.filename().string()), kStyle, escape(result.asset.generator),
      formatSize(result.glb.size()));
  html += figures(shots);
  if (!result.warnings.empty()) {
    html += "<h2>Warnings</h2>\n<ul class=warn>\n";
    for (const Warning& warning : result.warnings) html += "<li>" + escape(warning.text()) + "</li>\n";
    html += "</ul>\n";
  }
  html += "<h2>Layers</h2>\n" + layerTable(result.statistics) + "<h2>Numbers</h2>\n" +
          numbersTable(result.statistics) + "</html>\n";
  writeFileAtomically(folder / "report.html", html);
  writeFileAtomically(folder / "report.json", bake::toJson(result.statistics));
}

}  // namespace relume::app
