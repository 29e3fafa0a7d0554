// SPDX-License-Identifier: MIT
// Ticks are at 1, 2 or 5 times a power of ten; a logarithmic axis has them at powers of ten and, over few
// decades, at 2 and 5.
#include "relume/image/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/core/check.h"

namespace relume::image {
namespace {

// Okabe and Ito's palette without its yellow: told apart by colour-blind eyes, dark enough on white.
constexpr std::array<const char*, 7> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#444444"};
constexpr double kMarkerRadius = 3.2, kFontSize = 12.0;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20) out += c;  // XML has no control characters
    }
  }
  return out;
}

std::string superscript(int exponent) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(exponent))) out += kDigits[c - '0'];
  return out;
}

struct Tick {
  double value;
  std::string text;  // empty: a minor tick
};

/// One axis: values to [0, 1], and the ticks.
class Scale {
 public:
  Scale(const Axis& axis, std::vector<double> values) : logarithmic_(axis.logarithmic) {
    std::erase_if(values, [&](double v) { return !usable(v); });
    if (values.empty()) values = logarithmic_ ? std::vector<double>{1, 10} : std::vector<double>{0, 1};
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    lo_ = *least, hi_ = *most;
    if (axis.range) {
      lo_ = axis.range->first, hi_ = axis.range->second;
      RELUME_CHECK(usable(lo_) && usable(hi_));
      RELUME_CHECK_LT(lo_, hi_);
    }
    logarithmic_ ? makeLogarithmic(!axis.range) : makeLinear(!axis.range);
  }

  bool usable(double v) const { return std::isfinite(v) && (!logarithmic_ || v > 0.0); }
  double at(double v) const {
    return logarithmic_ ? std::log(v / lo_) / std::log(hi_ / lo_) : (v - lo_) / (hi_ - lo_);
  }
  /// As at(), but an error bar that ends outside the scale ends at its border.
  double clampedAt(double v) const { return usable(v) ? std::clamp(at(v), 0.0, 1.0) : 0.0; }
  const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  void makeLinear(bool widen) {
    if (hi_ - lo_ <= 1e-12 * std::max(std::abs(lo_), std::abs(hi_))) {
      const double half = lo_ == 0.0 ? 1.0 : 0.5 * std::abs(lo_);
      lo_ -= half, hi_ += half;
    }
    // Data that starts near zero is read best from zero.
    if (widen && lo_ > 0.0 && lo_ < 0.5 * hi_) lo_ = 0.0;
    const double rough = (hi_ - lo_) / 5.0, decade = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = decade * (rough / decade < 1.5   ? 1.0
                                  : rough / decade < 3.5 ? 2.0
                                  : rough / decade < 7.5 ? 5.0
                                                         : 10.0);
    if (widen) lo_ = step * std::floor(lo_ / step + 1e-9), hi_ = step * std::ceil(hi_ / step - 1e-9);
    const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
    const bool scientific = std::max(std::abs(lo_), std::abs(hi_)) >= 1e6 || decimals > 5;
    for (double i = std::ceil(lo_ / step - 1e-9); i * step <= hi_ + 1e-9 * step; ++i) {
      const double v = i == 0.0 ? 0.0 : i * step;
      ticks_.push_back({v, scientific ? fmt::format("{:g}", v) : fmt::format("{:.{}f}", v, decimals)});
    }
  }

  void makeLogarithmic(bool widen) {
    if (hi_ / lo_ < 1.0 + 1e-9) lo_ *= 0.5, hi_ *= 2.0;
    const double few_decades = 2.5;
    std::vector<double> steps = {1.0, 2.0, 5.0};
    if (std::log10(hi_ / lo_) > few_decades) steps = {1.0};
    if (widen) widenToSteps(steps);
    const int every = std::max(1, static_cast<int>(std::ceil(std::log10(hi_ / lo_) / 8.0)));
    for (int e = static_cast<int>(std::floor(std::log10(lo_))) - 1; std::pow(10.0, e) <= hi_ * (1 + 1e-9);
         ++e) {
      for (int m = 1; m < 10; ++m) {
        const double v = m * std::pow(10.0, e);
        if (v < lo_ * (1 - 1e-9) || v > hi_ * (1 + 1e-9)) continue;
        const bool named = std::find(steps.begin(), steps.end(), m) != steps.end() && e % every == 0;
        ticks_.push_back({v, named ? label(m, e) : ""});
      }
    }
  }

  void widenToSteps(const std::vector<double>& steps) {
    const auto grid = [&](double v, bool up) {
      const double decade = std::pow(10.0, std::floor(std::log10(v) + 1e-9));
      double best = up ? 10.0 * decade : decade;
      for (const double s : steps) {
        const double g = s * decade;
        if (up ? g >= v * (1 - 1e-9) && g < best : g <= v * (1 + 1e-9) && g > best) best = g;
      }
      return best;
    };
    lo_ = grid(lo_, false), hi_ = grid(hi_, true);
  }

  static std::string label(int mantissa, int exponent) {
    if (exponent >= -3 && exponent <= 4)
      return fmt::format("{:.{}f}", mantissa * std::pow(10.0, exponent), std::max(0, -exponent));
    return (mantissa == 1 ? "10" : fmt::format("{}·10", mantissa)) + superscript(exponent);
  }

  bool logarithmic_;
  double lo_ = 0, hi_ = 1;
  std::vector<Tick> ticks_;
};

struct Frame {
  double left, top, width, height;
  double x(double t) const { return left + t * width; }
  double y(double t) const { return top + (1.0 - t) * height; }
};

// Text is about this wide for its font size; only used to leave room.
double textWidth(const std::string& utf8) {
  const auto count = std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xc0) != 0x80; });
  return 0.6 * kFontSize * static_cast<double>(count);
}

void drawText(std::string& out, double x, double y, const char* anchor, const std::string& text,
              const char* more = "") {
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                     escaped(text));
}

void drawLine(std::string& out, double x1, double y1, double x2, double y2, const std::string& style) {
  out += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2,
                     style);
}

void drawAxes(std::string& out, const Frame& frame, const Scale& sx, const Scale& sy) {
  for (const Tick& t : sx.ticks()) {
    const double x = frame.x(sx.at(t.value));
    drawLine(out, x, frame.top, x, frame.top + frame.height,
             t.text.empty() ? "stroke=\"#f3f3f3\"" : "stroke=\"#dddddd\"");
    if (!t.text.empty()) drawText(out, x, frame.top + frame.height + 18, "middle", t.text);
  }
  for (const Tick& t : sy.ticks()) {
    const double y = frame.y(sy.at(t.value));
    drawLine(out, frame.left, y, frame.left + frame.width, y,
             t.text.empty() ? "stroke=\"#f3f3f3\"" : "stroke=\"#dddddd\"");
    if (!t.text.empty()) drawText(out, frame.left - 8, y + 4, "end", t.text);
  }
  out += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"#888888\"/>\n",
      frame.left, frame.top, frame.width, frame.height);
}

std::string stroke(const Series& series, const char* colour) {
  return fmt::format("stroke=\"{}\" stroke-width=\"2\"{}", colour,
                     series.dashed ? " stroke-dasharray=\"6 4\"" : "");
}

void drawSeries(std::string& out, const Frame& frame, const Scale& sx, const Scale& sy, const Series& series,
                const char* colour) {
  std::string path, marks;
  bool pen_down = false;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!sx.usable(series.x[i]) || !sy.usable(series.y[i])) {
      pen_down = false;
      continue;
    }
    // Far outside of a given range, coordinates stay small enough for every viewer; the clip hides them.
    const double px = frame.x(std::clamp(sx.at(series.x[i]), -10.0, 11.0));
    const double py = frame.y(std::clamp(sy.at(series.y[i]), -10.0, 11.0));
    path += fmt::format("{}{:.1f} {:.1f}", pen_down ? " L" : path.empty() ? "M" : " M", px, py);
    pen_down = true;
    if (!series.error.empty() && std::isfinite(series.error[i])) {
      const double y1 = frame.y(sy.clampedAt(series.y[i] - series.error[i])),
                   y2 = frame.y(sy.clampedAt(series.y[i] + series.error[i]));
      const std::string style = fmt::format("stroke=\"{}\" stroke-width=\"1.2\"", colour);
      drawLine(marks, px, y1, px, y2, style);
      for (const double y : {y1, y2}) drawLine(marks, px - 3.5, y, px + 3.5, y, style);
    }
    if (series.markers)
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", px, py,
                           kMarkerRadius, colour);
  }
  if (series.line && !path.empty())
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke-linejoin=\"round\" {}/>\n", path,
                       stroke(series, colour));
  out += marks;
}

// In the corner that the fewest points occupy.
void drawLegend(std::string& out, const Frame& frame, const Scale& sx, const Scale& sy, const Plot& plot) {
  constexpr double kLine = 18, kSample = 26, kInset = 10, kPad = 6;
  double width = 0, rows = 0;
  for (const Series& s : plot.series)
    if (!s.name.empty()) width = std::max(width, textWidth(s.name)), ++rows;
  if (rows == 0) return;
  width += kSample + 3 * kPad;
  const double height = rows * kLine + kPad;
  double best_x = 0, best_y = 0;
  long least = -1;
  for (const bool top : {true, false}) {
    for (const bool right : {true, false}) {
      const double x = right ? frame.left + frame.width - width - kInset : frame.left + kInset;
      const double y = top ? frame.top + kInset : frame.top + frame.height - height - kInset;
      long inside = 0;
      const auto covers = [&](double px, double py) {
        return px > x - 6 && px < x + width + 6 && py > y - 6 && py < y + height + 6;
      };
      for (const Series& s : plot.series) {
        std::optional<std::pair<double, double>> last;
        for (std::size_t i = 0; i < s.x.size(); ++i) {
          if (!sx.usable(s.x[i]) || !sy.usable(s.y[i])) {
            last.reset();
            continue;
          }
          const std::pair<double, double> here(frame.x(sx.at(s.x[i])), frame.y(sy.at(s.y[i])));
          if (!last || !s.line) last = here;
          for (int k = 1; k <= 16; ++k)
            inside += covers(std::lerp(last->first, here.first, k / 16.0),
                             std::lerp(last->second, here.second, k / 16.0));
          last = here;
        }
      }
      if (least < 0 || inside < least) least = inside, best_x = x, best_y = y;
    }
  }
  out += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"3\" fill=\"#ffffff\" "
      "fill-opacity=\"0.85\" stroke=\"#cccccc\"/>\n",
      best_x, best_y, width, height);
  double y = best_y + kPad + 0.5 * (kLine - kPad) + 2;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& s = plot.series[i];
    if (s.name.empty()) continue;
    const char* colour = kColours[i % kColours.size()];
    if (s.line) drawLine(out, best_x + kPad, y, best_x + kPad + kSample, y, stroke(s, colour));
    if (s.markers)
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n",
                         best_x + kPad + kSample / 2, y, kMarkerRadius, colour);
    drawText(out, best_x + 2 * kPad + kSample, y + 4, "start", s.name);
    y += kLine;
  }
}

Scale makeScale(const Plot& plot, bool vertical) {
  std::vector<double> values;
  for (const Series& s : plot.series) {
    RELUME_CHECK_EQ(s.x.size(), s.y.size());
    RELUME_CHECK(s.error.empty() || s.error.size() == s.y.size());
    const auto& v = vertical ? s.y : s.x;
    values.insert(values.end(), v.begin(), v.end());
    if (!vertical) continue;
    for (std::size_t i = 0; i < s.error.size(); ++i) {
      values.push_back(s.y[i] + s.error[i]);
      values.push_back(s.y[i] - s.error[i]);
    }
  }
  return {vertical ? plot.y : plot.x, std::move(values)};
}

}  // namespace

std::string svgPlot(const Plot& plot) {
  const Scale sx = makeScale(plot, false), sy = makeScale(plot, true);
  double tick_width = 0;
  for (const Tick& t : sy.ticks()) tick_width = std::max(tick_width, textWidth(t.text));
  const double left = tick_width + 14 + (plot.y.label.empty() ? 6 : 24), top = plot.title.empty() ? 16 : 40;
  const double right = 20, bottom = plot.x.label.empty() ? 30 : 52;
  const Frame frame{left, top, std::max(plot.width - left - right, 1.0),
                    std::max(plot.height - top - bottom, 1.0)};

  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"{2}\" fill=\"#222222\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      plot.width, plot.height, kFontSize);
  if (!plot.title.empty())
    drawText(out, frame.left + 0.5 * frame.width, 24, "middle", plot.title,
             " font-size=\"15\" font-weight=\"bold\"");
  drawAxes(out, frame, sx, sy);
  if (!plot.x.label.empty())
    drawText(out, frame.left + 0.5 * frame.width, plot.height - 12.0, "middle", plot.x.label);
  if (!plot.y.label.empty()) {
    const double y = frame.top + 0.5 * frame.height;
    drawText(out, 16, y, "middle", plot.y.label,
             fmt::format(" transform=\"rotate(-90 16 {:.1f})\"", y).c_str());
  }
  // A nested viewport clips without an id, so that several plots can stand in one page. One pixel more shows
  // border lines whole.
  out += fmt::format(
      "<svg x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{3:.1f}\" viewBox=\"{0:.1f} {1:.1f} "
      "{2:.1f} {3:.1f}\">\n",
      frame.left - 4, frame.top - 4, frame.width + 8, frame.height + 8);
  for (std::size_t i = 0; i < plot.series.size(); ++i)
    drawSeries(out, frame, sx, sy, plot.series[i], kColours[i % kColours.size()]);
  out += "</svg>\n";
  drawLegend(out, frame, sx, sy, plot);
  return out + "</svg>\n";
}

}  // namespace relume::image
