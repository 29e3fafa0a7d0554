// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "report_charts.h"
#include "report_parts.h"
#include "verify_report.h"

namespace relume::app {
namespace {

std::string rowsOf(const Comparison::Table& table, std::size_t begin, std::size_t end) {
  const auto number = [&](std::size_t column) {
    return column >= table.first_number ? " class=n" : " class=name";
  };
  std::string html = "<div class=scroll><table><tr>";
  for (std::size_t k = 0; k < table.head.size(); ++k)
    html += fmt::format("<th{}>{}", k >= table.first_number ? " class=n" : "", table.head[k]);
  html += "</tr>\n";
  for (std::size_t i = begin; i < end; ++i) {
    html += "<tr>";
    for (std::size_t k = 0; k < table.rows[i].size(); ++k)
      html += fmt::format("<td{}>{}", number(k), table.rows[i][k]);
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string tableOf(const Comparison::Table& table) {
  const std::size_t shown = std::min(table.shown, table.rows.size());
  std::string html =
      fmt::format("<h3>{}</h3>\n<p class=soft>{}</p>\n", table.title, table.text) + rowsOf(table, 0, shown);
  if (shown < table.rows.size())
    html += fmt::format("<details><summary>{} more</summary>\n", table.rows.size() - shown) +
            rowsOf(table, shown, table.rows.size()) + "</details>\n";
  return html;
}

std::string viewsOf(const std::vector<ShownView>& views) {
  std::string html;
  for (const ShownView& v : views) {
    html += fmt::format("<h3>{}</h3>\n<div class=\"grid three\">\n", escapeHtml(v.caption));
    for (const ReportPicture* p : {&v.baked, &v.truth, &v.difference}) html += figure(*p, p->caption);
    html += fmt::format(
        "</div>\n<p class=soft>Mean FLIP {:.3f}, of which noise of the truth {:.3f}. Linear light: mean "
        "{:+.1f} "
        "% off, pixels {:.1f} % (RMS), of which noise of the truth {:.1f} %. Both pictures at {:+.1f} stops "
        "through one tone curve; in FLIP's, what is black looks alike.</p>\n",
        v.mean_flip, v.noise_flip, 100 * v.bias, 100 * v.rmse, 100 * v.noise,
        static_cast<double>(v.exposure));
  }
  return html;
}

std::string sectionOf(const Comparison& c, const std::vector<ShownView>& views) {
  std::string html = fmt::format("<h2 id=\"{}\">{}</h2>\n<p class=soft>{}</p>\n<div class=cards>\n",
                                 escapeHtml(c.id), escapeHtml(c.title), c.summary);
  for (const Comparison::Figure& f : c.figures) html += card(f.value, f.label, f.colour);
  html += "</div>\n<ul class=notes>\n";
  for (const Comparison::Finding& f : c.findings) html += note(f.html, f.colour);
  html += "</ul>\n" + viewsOf(views) + c.plots;
  for (const Comparison::Table& table : c.tables) html += tableOf(table);
  return html;
}

}  // namespace

std::string verifyPage(const VerifyFacts& facts, const std::vector<Comparison>& comparisons,
                       const std::vector<std::vector<ShownView>>& shown) {
  const std::string name = std::filesystem::path(facts.asset).filename().string();
  std::string html = pageHead(name + " – verification");
  html += fmt::format(
      "<h1>{}</h1>\n<div class=soft>baked by {}, beside path-traced truth; lit by {}</div>\n<nav>",
      escapeHtml(name), escapeHtml(facts.generator),
      facts.lights.empty() ? "the lights of the file"
                           : escapeHtml(std::filesystem::path(facts.lights).filename().string()));
  for (const Comparison& c : comparisons)
    html += fmt::format("<a href=\"#{}\">{}</a>", escapeHtml(c.id), escapeHtml(c.title));
  html += "<a href=\"#command\">command</a><a href=\"report.json\">report.json</a></nav>\n";
  for (std::size_t i = 0; i < comparisons.size(); ++i) html += sectionOf(comparisons[i], shown[i]);
  html += "<h2 id=command>Command</h2>\n<pre>" + escapeHtml(facts.typed) + "</pre>\n";
  return html + "</body></html>\n";
}

}  // namespace relume::app
