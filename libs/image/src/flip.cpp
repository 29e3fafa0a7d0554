// SPDX-License-Identifier: MIT
// LDR-FLIP: the difference a viewer sees when two images alternate in place.
// Based on: P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. D. Fairchild. FLIP: A
// Difference Evaluator
//   for Alternating Images. Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020.
//
// Colour. Linear RGB -> YCxCz, filtered by the contrast sensitivity of the eye, as convolution with
//   g(d) = a1 sqrt(pi/b1) exp(-pi^2 d^2 / b1) + a2 sqrt(pi/b2) exp(-pi^2 d^2 / b2),  d in degrees, cut at 3
//   deviations of the widest, normalised to sum 1;  then -> RGB, clamped to [0, 1] -> L*a*b*, a and b scaled
//   by 0.01 L (Hunt), and dEc = (|dL| + |(da, db)|)^qc, mapped so that pc of the largest value becomes pt and
//   the largest 1.
// Features. Y is filtered with first and second derivatives of a Gaussian of deviation w ppd / 2 whose
// positive and whose
//   negative weights sum to 1;  dEf = (max(||e_r| - |e_t||, ||p_r| - |p_t||) / sqrt 2)^qf, e edges and p
//   points.
// Result. dE = dEc^(1 - dEf).
//
// All filters are products of two 1D filters (that of Cz a sum of two such products), so they run along rows,
// then columns. Beyond the border pixels repeat. Limits: input is clamped to [0, 1] before anything else, so
// brighter light is white.
#include <algorithm>
#include <array>
#include <cmath>

#include "metrics_common.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "relume/image/metrics.h"

namespace relume::image {
namespace {

constexpr float kQc = 0.7f, kPc = 0.4f, kPt = 0.95f, kQf = 0.5f;
constexpr double kFeatureWidth = 0.082;  // degrees, w of the paper
constexpr double kPi64 = 3.14159265358979323846;

// sRGB primaries and white D65, exact fractions of the chromaticities in IEC 61966-2-1.
const glm::dmat3 kXyzFromRgb =
    glm::transpose(glm::dmat3(10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0,  //
                              2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0,    //
                              1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0));

struct Colours {
  Mat3 xyz_from_rgb, rgb_from_xyz;  // XYZ relative to white, which is (1, 1, 1)
  Colours() {
    glm::dmat3 m = kXyzFromRgb;
    const glm::dvec3 white = m * glm::dvec3(1.0);
    for (int column = 0; column < 3; ++column) m[column] /= white;
    xyz_from_rgb = Mat3(m);
    rgb_from_xyz = Mat3(glm::inverse(m));
  }
};

Vec3 ycxczFromXyz(Vec3 v) { return {116.0f * v.y - 16.0f, 500.0f * (v.x - v.y), 200.0f * (v.y - v.z)}; }

Vec3 xyzFromYcxcz(Vec3 v) {
  const float y = (v.x + 16.0f) / 116.0f;
  return {y + v.y / 500.0f, y, y - v.z / 200.0f};
}

Vec3 huntLab(Vec3 xyz) {
  constexpr float kDelta = 6.0f / 29.0f;
  const auto f = [](float t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
  };
  const float fx = f(xyz.x), fy = f(xyz.y), fz = f(xyz.z);
  const float lightness = 116.0f * fy - 16.0f;
  return {lightness, 0.01f * lightness * 500.0f * (fx - fy), 0.01f * lightness * 200.0f * (fy - fz)};
}

float hyab(Vec3 a, Vec3 b) {
  const Vec3 d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// A 1D filter, odd number of weights, the middle one at the pixel.
using Kernel = std::vector<float>;
int radius(const Kernel& k) { return static_cast<int>(k.size() / 2); }

// exp(-pi^2 d^2 / b) at pixels of 1 / ppd degrees, normalised; `sum` gets the sum before.
Kernel sensitivityKernel(double b, double pixels_per_degree, int r, double& sum) {
  std::vector<double> w;
  for (int i = -r; i <= r; ++i) {
    const double d = i / pixels_per_degree;
    w.push_back(std::exp(-kPi64 * kPi64 * d * d / b));
  }
  sum = 0;
  for (const double v : w) sum += v;
  Kernel k;
  for (const double v : w) k.push_back(static_cast<float>(v / sum));
  return k;
}

void normaliseSigns(std::vector<double>& w) {
  double positive = 0, negative = 0;
  for (const double v : w) (v > 0 ? positive : negative) += std::abs(v);
  for (double& v : w) v /= v > 0 ? positive : std::max(negative, 1e-300);
}

struct Filters {
  Kernel luminance, red_green, blue_yellow[2];
  float blue_yellow_share[2];  // of the two Gaussians
  Kernel smooth, first, second;

  explicit Filters(double ppd) {
    constexpr double kA = 0.0047, kRg = 0.0053, kBy[2] = {0.04, 0.025}, kByWeight[2] = {34.1, 13.5};
    const int r = static_cast<int>(std::ceil(3.0 * std::sqrt(kBy[0] / (2.0 * kPi64 * kPi64)) * ppd));
    double sum = 0, share[2];
    luminance = sensitivityKernel(kA, ppd, r, sum);
    red_green = sensitivityKernel(kRg, ppd, r, sum);
    for (int i = 0; i < 2; ++i) {
      blue_yellow[i] = sensitivityKernel(kBy[i], ppd, r, sum);
      share[i] = kByWeight[i] * std::sqrt(kPi64 / kBy[i]) * sum * sum;
    }
    for (int i = 0; i < 2; ++i) blue_yellow_share[i] = static_cast<float>(share[i] / (share[0] + share[1]));

    const double deviation = 0.5 * kFeatureWidth * ppd;
    const int rf = static_cast<int>(std::ceil(3.0 * deviation));
    std::vector<double> g, d, dd;
    for (int i = -rf; i <= rf; ++i) {
      g.push_back(std::exp(-0.5 * i * i / (deviation * deviation)));
      d.push_back(-i * g.back());
      dd.push_back((i * i / (deviation * deviation) - 1.0) * g.back());
    }
    for (auto* w : {&g, &d, &dd}) normaliseSigns(*w);
    smooth.assign(g.begin(), g.end());
    first.assign(d.begin(), d.end());
    second.assign(dd.begin(), dd.end());
  }
  int reach() const { return std::max(radius(luminance), radius(smooth)); }
};

// shape: [rows][width]
struct Plane {
  int width = 0, first_row = 0;
  std::vector<float> data;
  Plane(int w, int first, int rows)
      : width(w), first_row(first), data(static_cast<std::size_t>(w) * static_cast<std::size_t>(rows)) {}
  float* row(int y) {
    return data.data() + static_cast<std::size_t>(y - first_row) * static_cast<std::size_t>(width);
  }
  const float* row(int y) const { return const_cast<Plane*>(this)->row(y); }
};

// `padded` starts `pad` pixels left of the row. Kernels are applied as convolutions: symmetric ones, and odd
// ones whose sign is lost in |gradient|.
void filterRow(const float* padded, int pad, const Kernel& k, float* out, int width) {
  std::fill_n(out, width, 0.0f);
  const float* left = padded + pad - radius(k);
  for (const float w : k) {
    for (int x = 0; x < width; ++x) out[x] += w * left[x];
    ++left;
  }
}

void filterColumn(const Plane& in, int y, int height, const Kernel& k, float* out) {
  std::fill_n(out, in.width, 0.0f);
  for (int i = -radius(k); i <= radius(k); ++i) {
    const float w = k[static_cast<std::size_t>(i + radius(k))];
    const float* row = in.row(std::clamp(y + i, 0, height - 1));
    for (int x = 0; x < in.width; ++x) out[x] += w * row[x];
  }
}

// Rows filtered along x, those that the columns' filters need. shape of each plane: [rows][width]
struct FilteredRows {
  Plane luminance, red_green, blue_yellow[2], smooth, first, second;

  FilteredRows(const Image& image, int begin, int end, const Filters& filters, const Colours& colours)
      : FilteredRows(Plane(image.width, begin, end - begin)) {
    const int pad = filters.reach();
    const auto padded_width = static_cast<std::size_t>(image.width + 2 * pad);
    std::array<std::vector<float>, 3> line;
    for (auto& channel : line) channel.resize(padded_width);
    for (int y = begin; y < end; ++y) {
      for (int x = -pad; x < image.width + pad; ++x) {
        const Vec3 rgb = glm::clamp(image.rgb(std::clamp(x, 0, image.width - 1), y), 0.0f, 1.0f);
        const Vec3 v = ycxczFromXyz(colours.xyz_from_rgb * rgb);
        for (int c = 0; c < 3; ++c)
          line[static_cast<std::size_t>(c)][static_cast<std::size_t>(x + pad)] = v[c];
      }
      filterRow(line[0].data(), pad, filters.luminance, luminance.row(y), image.width);
      filterRow(line[1].data(), pad, filters.red_green, red_green.row(y), image.width);
      for (int i = 0; i < 2; ++i)
        filterRow(line[2].data(), pad, filters.blue_yellow[i], blue_yellow[i].row(y), image.width);
      for (float& v : line[0]) v = (v + 16.0f) / 116.0f;
      filterRow(line[0].data(), pad, filters.smooth, smooth.row(y), image.width);
      filterRow(line[0].data(), pad, filters.first, first.row(y), image.width);
      filterRow(line[0].data(), pad, filters.second, second.row(y), image.width);
    }
  }

 private:
  explicit FilteredRows(const Plane& empty)
      : luminance(empty),
        red_green(empty),
        blue_yellow{empty, empty},
        smooth(empty),
        first(empty),
        second(empty) {}
};

// What the eye makes of rows [begin, end) of one image. shape of each: [rows][width]
struct Seen {
  std::vector<Vec3> lab;           // Hunt-adjusted
  std::vector<float> edge, point;  // lengths of the feature vectors
};

Seen see(const Image& image, int begin, int end, const Filters& filters, const Colours& colours) {
  const int width = image.width, height = image.height, reach = filters.reach();
  const FilteredRows rows(image, std::max(0, begin - reach), std::min(height, end + reach), filters, colours);
  const auto row_pixels = static_cast<std::size_t>(width);
  std::array<std::vector<float>, 4> line;
  for (auto& l : line) l.resize(row_pixels);
  Seen out;
  out.lab.reserve(row_pixels * static_cast<std::size_t>(end - begin));
  out.edge.reserve(out.lab.capacity());
  out.point.reserve(out.lab.capacity());
  for (int y = begin; y < end; ++y) {
    filterColumn(rows.luminance, y, height, filters.luminance, line[0].data());
    filterColumn(rows.red_green, y, height, filters.red_green, line[1].data());
    for (std::size_t i = 0; i < 2; ++i)
      filterColumn(rows.blue_yellow[i], y, height, filters.blue_yellow[i], line[2 + i].data());
    for (std::size_t x = 0; x < row_pixels; ++x) {
      const float cz = filters.blue_yellow_share[0] * line[2][x] + filters.blue_yellow_share[1] * line[3][x];
      const Vec3 rgb = colours.rgb_from_xyz * xyzFromYcxcz({line[0][x], line[1][x], cz});
      out.lab.push_back(huntLab(colours.xyz_from_rgb * glm::clamp(rgb, 0.0f, 1.0f)));
    }
    filterColumn(rows.first, y, height, filters.smooth, line[0].data());
    filterColumn(rows.smooth, y, height, filters.first, line[1].data());
    filterColumn(rows.second, y, height, filters.smooth, line[2].data());
    filterColumn(rows.smooth, y, height, filters.second, line[3].data());
    for (std::size_t x = 0; x < row_pixels; ++x) {
      out.edge.push_back(std::sqrt(line[0][x] * line[0][x] + line[1][x] * line[1][x]));
      out.point.push_back(std::sqrt(line[2][x] * line[2][x] + line[3][x] * line[3][x]));
    }
  }
  return out;
}

float colourDifference(Vec3 a, Vec3 b, float largest) {
  const float e = std::pow(hyab(a, b), kQc), knee = kPc * largest;
  return e < knee ? kPt / knee * e : kPt + (e - knee) / (largest - knee) * (1.0f - kPt);
}

}  // namespace

Difference flip(const Image& test, const Image& reference, double pixels_per_degree) {
  RELUME_CHECK(pixels_per_degree > 0.0 && pixels_per_degree < 1e4);
  detail::requireComparable(test, reference);
  detail::requireFinite(test, "first image");
  detail::requireFinite(reference, "second image");

  const Filters filters(pixels_per_degree);
  const Colours colours;
  const Vec3 green = huntLab(colours.xyz_from_rgb * Vec3(0, 1, 0));
  const Vec3 blue = huntLab(colours.xyz_from_rgb * Vec3(0, 0, 1));
  const float largest = std::pow(hyab(green, blue), kQc);

  Difference out;
  out.map = Image(test.width, test.height, 1);
  parallelFor(
      static_cast<std::size_t>(test.height), detail::kStripRows, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<int>(begin), last = static_cast<int>(end);
        const Seen t = see(test, first, last, filters, colours);
        const Seen r = see(reference, first, last, filters, colours);
        float* map = out.map.at(0, first);
        for (std::size_t i = 0; i < t.lab.size(); ++i) {
          const float feature = std::max(std::abs(t.edge[i] - r.edge[i]), std::abs(t.point[i] - r.point[i]));
          const float feature_difference = std::pow(feature / std::sqrt(2.0f), kQf);
          map[i] = std::pow(colourDifference(t.lab[i], r.lab[i], largest), 1.0f - feature_difference);
        }
      });
  double sum = 0;
  for (const float v : out.map.data) sum += v;
  out.mean = sum / static_cast<double>(out.map.data.size());
  std::vector<float> values = out.map.data;
  out.p95 = detail::quantile(values, 0.95);
  out.p99 = detail::quantile(values, 0.99);
  out.max = detail::quantile(values, 1.0);
  return out;
}

}  // namespace relume::image
