// SPDX-License-Identifier: MIT
#include "relume/image/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <regex>
#include <string>
#include <vector>

namespace relume::image {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex re(pattern);
  std::vector<std::string> out;
  for (std::sregex_iterator i(text.begin(), text.end(), re), end; i != end; ++i) out.push_back((*i)[1]);
  return out;
}

// Tick texts under the plot are centred, those beside it end at the axis.
std::vector<std::string> xTicks(const std::string& svg) {
  return matches(svg, "text-anchor=\"middle\">([^<]*)<");
}
std::vector<std::string> yTicks(const std::string& svg) {
  return matches(svg, "text-anchor=\"end\">([^<]*)<");
}

Plot line(std::vector<double> x, std::vector<double> y) {
  Plot plot;
  plot.series.push_back({.name = "", .x = std::move(x), .y = std::move(y), .error = {}});
  return plot;
}

TEST(Plot, TicksAreRoundNumbers) {
  const std::string svg = svgPlot(line({0, 9.7}, {-0.013, 0.021}));
  EXPECT_THAT(xTicks(svg), ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(yTicks(svg), ElementsAre("-0.015", "-0.010", "-0.005", "0.000", "0.005", "0.010", "0.015",
                                       "0.020", "0.025"));
}

TEST(Plot, LogarithmicTicksAreDecades) {
  Plot plot = line({3, 40000}, {0.002, 0.04});
  plot.x.logarithmic = plot.y.logarithmic = true;
  const std::string svg = svgPlot(plot);
  EXPECT_THAT(xTicks(svg), ElementsAre("1", "10", "100", "1000", "10000", "10⁵"));
  EXPECT_THAT(yTicks(svg), ElementsAre("0.002", "0.005", "0.01", "0.02", "0.05"));
}

TEST(Plot, PointsStandWhereTheAxesSay) {
  Plot plot = line({0, 5, 10}, {1, 10, 100});
  plot.y.logarithmic = true;
  plot.x.range = {0, 10};
  plot.y.range = {1, 100};
  const std::string svg = svgPlot(plot);
  const auto cx = matches(svg, "circle cx=\"([^\"]*)\""), cy = matches(svg, "cy=\"([^\"]*)\"");
  ASSERT_EQ(cx.size(), 3u);
  EXPECT_NEAR(std::stod(cx[1]), 0.5 * (std::stod(cx[0]) + std::stod(cx[2])), 0.11);
  EXPECT_NEAR(std::stod(cy[1]), 0.5 * (std::stod(cy[0]) + std::stod(cy[2])), 0.11);
  EXPECT_GT(std::stod(cy[0]), std::stod(cy[2])) << "up is more";
}

TEST(Plot, HolesBreakTheLine) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = svgPlot(line({0, 1, 2, 3, 4}, {1, 2, nan, 2, 1}));
  EXPECT_EQ(matches(svg, "(<circle)").size(), 4u);
  EXPECT_EQ(matches(matches(svg, "<path d=\"([^\"]*)\"").at(0), "(M)").size(), 2u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  Plot log = line({1, 2, 3}, {1, 0, -5});
  log.y.logarithmic = true;
  EXPECT_EQ(matches(svgPlot(log), "(<circle)").size(), 1u);
}

TEST(Plot, OddPlotsAreStillPlots) {
  for (const bool logarithmic : {false, true}) {
    for (Plot plot : {Plot{}, line({}, {}), line({3}, {3}), line({1, 2}, {7, 7}), line({0, 0}, {0, 0}),
                      line({-1e300, 1e300}, {1e-300, 1})}) {
      plot.y.logarithmic = logarithmic;
      const std::string svg = svgPlot(plot);
      EXPECT_THAT(svg, HasSubstr("</svg>\n"));
      EXPECT_THAT(svg, Not(HasSubstr("nan")));
      EXPECT_THAT(svg, Not(HasSubstr("inf")));
      EXPECT_LT(svg.size(), 200000u);
    }
  }
}

TEST(Plot, TextIsEscapedAndNamed) {
  Plot plot = line({0, 1}, {0, 1});
  plot.title = "a < b & \"c\"";
  plot.x.label = "time (s)";
  plot.y.label = "error";
  plot.series[0].name = "Relume";
  plot.series[0].error = {0.1, 0.2};
  plot.series[0].dashed = true;
  const std::string svg = svgPlot(plot);
  for (const char* text :
       {"a &lt; b &amp; &quot;c&quot;", ">time (s)<", ">error<", ">Relume<", "stroke-dasharray"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_EQ(svg, svgPlot(plot));
}

}  // namespace
}  // namespace relume::image
