// SPDX-License-Identifier: MIT
// scatter and dilate: nothing is left empty, nothing covered changes, charts do not mix.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "relume/atlas/texels.h"
#include "relume/core/parallel.h"

namespace relume::atlas {
namespace {

struct Page {
  Texels texels;
  std::vector<float> point_values;
  std::vector<std::uint8_t> valid;
  std::vector<float> values;
  std::vector<std::uint8_t> covered;

  Page(int width, int height, std::uint32_t pages = 1) {
    texels.width = width, texels.height = height, texels.pages = pages;
  }
  /// A rectangle of a chart, x0 <= x < x1; call by rows from the top (points go by increasing texel after
  /// sorting in scatter).
  void add(std::uint32_t chart, int x0, int y0, int x1, int y1, float value, bool is_valid = true,
           std::uint32_t page = 0) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        SurfacePoint p;
        p.texel = (page * static_cast<std::uint32_t>(texels.height) + static_cast<std::uint32_t>(y)) *
                      static_cast<std::uint32_t>(texels.width) +
                  static_cast<std::uint32_t>(x);
        p.chart = chart;
        const auto at = std::lower_bound(texels.points.begin(), texels.points.end(), p.texel,
                                         [](const SurfacePoint& a, std::uint32_t b) { return a.texel < b; });
        const auto i = at - texels.points.begin();
        texels.points.insert(at, p);
        point_values.insert(point_values.begin() + i, value);
        valid.insert(valid.begin() + i, is_valid);
      }
    }
  }
  void fill(bool with_texels = true) {
    scatter(texels, point_values, 1, valid, values, covered);
    dilate(texels.width, texels.height, texels.pages, 1, values, covered, with_texels ? &texels : nullptr);
  }
  float at(int x, int y) const { return values[static_cast<std::size_t>(y * texels.width + x)]; }
};

TEST(Scatter, PutsValuesInTheirPlaceAndLeavesInvalidOnes) {
  Page page(4, 4, 2);
  page.add(0, 1, 1, 3, 2, 5.0f);
  page.add(0, 0, 0, 1, 1, 7.0f, false);
  page.add(1, 3, 3, 4, 4, 9.0f, true, 1);
  scatter(page.texels, page.point_values, 1, page.valid, page.values, page.covered);
  ASSERT_EQ(page.values.size(), 32u);
  for (std::size_t t = 0; t < 32; ++t) {
    const float expected = t == 5 || t == 6 ? 5.0f : t == 31 ? 9.0f : 0.0f;
    EXPECT_EQ(page.values[t], expected) << t;
    EXPECT_EQ(page.covered[t], expected > 0) << t;
  }
  // Without a validity array all are valid; several channels stay together.
  const std::vector<float> two{1, 2, 3, 4, 5, 6, 7, 8};
  scatter(page.texels, two, 2, {}, page.values, page.covered);
  EXPECT_EQ(page.values[0], 1.0f);
  EXPECT_EQ(page.values[1], 2.0f);
  EXPECT_EQ(page.values[2 * 31 + 1], 8.0f);
  EXPECT_EQ(page.covered[0], 1);
}

TEST(Dilate, LeavesNoTexelAndKeepsTheCoveredBits) {
  for (const int size : {1, 2, 3, 17, 64, 100}) {
    SCOPED_TRACE(size);
    Page page(size, size + 3);
    page.add(0, size / 2, size / 3, size / 2 + 1, size / 3 + 1, 0.1f);
    if (size > 16) page.add(1, 12, 14, 15, 16, 0.9f);
    page.fill();
    const std::vector<float> filled = page.values;
    scatter(page.texels, page.point_values, 1, page.valid, page.values, page.covered);
    for (std::size_t t = 0; t < filled.size(); ++t) {
      EXPECT_GE(filled[t], 0.0999f);
      EXPECT_LE(filled[t], 0.9001f);
      if (page.covered[t]) {
        EXPECT_EQ(filled[t], page.values[t]);
      }
    }
  }
}

TEST(Dilate, TheRingIsTheMeanOfItsOwnChartsNeighbours) {
  // Two charts with a gutter of two texels: each column of the gutter belongs to its side.
  Page page(12, 8);
  page.add(0, 2, 2, 5, 6, 1.0f);
  page.add(1, 7, 2, 10, 6, 5.0f);
  page.fill();
  for (int y = 1; y < 7; ++y) {
    EXPECT_EQ(page.at(5, y), 1.0f) << y;
    EXPECT_EQ(page.at(6, y), 5.0f) << y;
  }
  // A gutter of one texel: the chart with more neighbours, then the first.
  Page narrow(9, 8);
  narrow.add(0, 2, 2, 4, 6, 1.0f);
  narrow.add(1, 5, 2, 7, 7, 5.0f);
  narrow.fill();
  for (int y = 2; y < 5; ++y) EXPECT_EQ(narrow.at(4, y), 1.0f);
  EXPECT_EQ(narrow.at(4, 5), 5.0f);
  EXPECT_EQ(narrow.at(4, 6), 5.0f);
}

TEST(Dilate, TheRingIsTheMeanOfItsNeighbours) {
  Page page(6, 5);
  for (int y = 1; y < 4; ++y) page.add(0, 1, y, 2, y + 1, static_cast<float>(y));
  for (int y = 1; y < 4; ++y) page.add(0, 2, y, 3, y + 1, static_cast<float>(y + 2));
  page.fill();
  EXPECT_EQ(page.at(3, 2), (3.0f + 4.0f + 5.0f) / 3);
  EXPECT_EQ(page.at(3, 1), (3.0f + 4.0f) / 2);
  EXPECT_EQ(page.at(3, 0), 3.0f);
  EXPECT_EQ(page.at(2, 0), (1.0f + 3.0f) / 2);
}

TEST(Dilate, InvalidTexelsTakeFromTheirOwnChartAlone) {
  // Chart 0's right part is buried and touches chart 1, without any gutter.
  Page page(16, 6);
  page.add(0, 0, 0, 4, 6, 0.5f);
  page.add(0, 4, 0, 10, 6, 123.0f, false);
  page.add(1, 10, 0, 16, 6, 0.9f);
  page.fill();
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 10; ++x) EXPECT_EQ(page.at(x, y), 0.5f) << x << " " << y;
  }
}

TEST(Dilate, AChartWithoutAValidTexelIsFilledFromAround) {
  Page page(20, 20);
  page.add(0, 2, 2, 6, 6, 0.25f);
  page.add(1, 9, 9, 18, 18, 77.0f, false);
  page.fill();
  for (const float v : page.values) EXPECT_NEAR(v, 0.25f, 1e-6f);
}

TEST(Dilate, PagesAreApart) {
  Page page(8, 8, 3);
  page.add(0, 3, 3, 5, 5, 1.0f, true, 0);
  page.add(1, 3, 3, 5, 5, 2.0f, true, 2);
  page.fill();
  for (std::size_t t = 0; t < page.values.size(); ++t) {
    const float expected = t < 64 ? 1.0f : t < 128 ? 0.0f : 2.0f;  // nothing to take from on page 1
    EXPECT_EQ(page.values[t], expected);
  }
}

TEST(Dilate, WithoutTexels) {
  Page page(30, 30);
  page.add(0, 4, 4, 8, 8, 1.0f);
  page.add(1, 9, 4, 12, 8, 3.0f);
  page.fill(false);
  EXPECT_EQ(page.at(8, 5), 2.0f) << "no charts: all neighbours count";
  for (const float v : page.values) {
    EXPECT_GE(v, 1.0f);
    EXPECT_LE(v, 3.0f);
  }
}

TEST(Dilate, FarFromChartsValuesAreSmooth) {
  Page page(128, 128);
  page.add(0, 4, 4, 20, 20, 0.0f);
  page.add(1, 108, 108, 124, 124, 1.0f);
  page.fill();
  for (int y = 40; y < 90; ++y) {
    for (int x = 40; x < 90; ++x) {
      EXPECT_LT(std::abs(page.at(x, y) - page.at(x - 1, y)), 0.1f);
      EXPECT_LT(std::abs(page.at(x, y) - page.at(x, y - 1)), 0.1f);
    }
  }
}

TEST(Dilate, TheSameForAnyNumberOfThreads) {
  Page page(700, 500, 2);
  std::uint32_t state = 3;
  const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 16; };
  for (std::uint32_t c = 0; c < 200; ++c) {
    const int x = 35 * static_cast<int>(c % 20), y = 50 * static_cast<int>(c / 20);
    page.add(c, x, y, x + 3 + static_cast<int>(next() % 30), y + 3 + static_cast<int>(next() % 40),
             static_cast<float>(next() % 100), next() % 4 != 0, 0);
  }
  Page other = page;
  {
    const ThreadLimit limit(1);
    page.fill();
  }
  other.fill();
  EXPECT_EQ(std::memcmp(page.values.data(), other.values.data(), page.values.size() * sizeof(float)), 0);
}

}  // namespace
}  // namespace relume::atlas
