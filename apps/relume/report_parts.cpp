// SPDX-License-Identifier: MIT
#include "report_parts.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "report_charts.h"
#include "report_style.h"

namespace relume::app {

std::string pageHead(const std::string& title) {
  return fmt::format(
      "<!doctype html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width, initial-scale=1\"><title>{}</title><style>{}</style></head>\n<body>\n",
      escapeHtml(title), kReportStyle);
}

std::string card(const std::string& value, const std::string& label, const std::string& colour) {
  return fmt::format("<div class=card><b class=\"{}\">{}</b><span>{}</span></div>\n", colour, value, label);
}

std::string note(const std::string& html, const std::string& colour) {
  return "<li class=" + colour + "><span>" + html + "</span></li>\n";
}

std::string shortNumber(double value) {
  if (value == 0) return "0";
  if (std::abs(value) < 0.001) return fmt::format("{:.1e}", value);
  return std::abs(value) >= 1000 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string percent(double share) {
  if (share > 0 && share < 0.001) return "< 0.1 %";
  return fmt::format("{:.1f} %", share * 100);
}

std::string figure(const ReportPicture& picture, const std::string& caption, const char* kind) {
  const bool sharp = std::string_view(kind) == "texels";
  return fmt::format(
      "<figure{}><a href=\"{}\"><img src=\"{}\" width={} height={} "
      "alt=\"{}\"{}></a><figcaption>{}</figcaption></figure>\n",
      std::string_view(kind) == "wide" ? " class=wide" : "", escapeHtml(picture.file),
      escapeHtml(picture.file), picture.width, picture.height, escapeHtml(caption),
      sharp ? " class=texels" : "", escapeHtml(caption));
}

}  // namespace relume::app
