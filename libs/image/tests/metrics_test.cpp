// SPDX-License-Identifier: MIT
#include "relume/image/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "relume/core/error.h"
#include "relume/core/parallel.h"
#include "test_files.h"

namespace relume::image {
namespace {

using test::picture;

Image uniform(int width, int height, Vec3 colour) {
  Image out(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out.setRgb(x, y, colour);
  return out;
}

template <class F>
ErrorCode codeOf(F&& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::kUsage;
}

// ---- RMSE

TEST(Rmse, SmallCaseByHand) {
  Image reference(2, 1, 3), test(2, 1, 3);
  reference.data = {1, 2, 3, 0, 4, 2};
  test.data = {2, 2, 1, 0, 4, 5};
  const Rmse r = rmse(test, reference);  // differences 1 0 -2 | 0 0 3
  EXPECT_DOUBLE_EQ(r.rmse, std::sqrt(14.0 / 6.0));
  EXPECT_DOUBLE_EQ(r.relative, std::sqrt(14.0 / 34.0));
  EXPECT_DOUBLE_EQ(r.bias, 2.0 / 12.0);
  EXPECT_EQ(r.map.data, (std::vector<float>{1.0f, 1.0f}));
  EXPECT_DOUBLE_EQ(r.max, 1.0);
}

TEST(Rmse, MaskSelectsPixels) {
  Image reference(3, 1, 1, 2.0f), test(3, 1, 1, 2.0f), mask(3, 1, 1);
  test.data = {3.0f, std::numeric_limits<float>::quiet_NaN(), 1.0f};
  mask.data = {1.0f, 0.0f, 0.6f};
  const Rmse r = rmse(test, reference, &mask);
  EXPECT_DOUBLE_EQ(r.rmse, 1.0);
  EXPECT_DOUBLE_EQ(r.relative, 0.5);
  EXPECT_DOUBLE_EQ(r.bias, 0.0);
  EXPECT_EQ(r.map.data, (std::vector<float>{1.0f, 0.0f, 1.0f}));
  EXPECT_EQ(codeOf([&] { rmse(test, reference); }), ErrorCode::kInvalidValue);
  mask.data = {0, 0, 0};
  EXPECT_EQ(codeOf([&] { rmse(test, reference, &mask); }), ErrorCode::kInvalidValue);
  const Image small(2, 1, 1);
  EXPECT_EQ(codeOf([&] { rmse(test, reference, &small); }), ErrorCode::kMismatch);
}

TEST(Rmse, QuantilesAndZeroReference) {
  Image reference(200, 1, 1), test(200, 1, 1);
  for (int i = 0; i < 200; ++i) test.data[static_cast<std::size_t>(i)] = static_cast<float>(200 - i);
  const Rmse r = rmse(test, reference);
  EXPECT_EQ(r.p99, 198.0);
  EXPECT_EQ(r.max, 200.0);
  EXPECT_TRUE(std::isinf(r.relative));
  EXPECT_EQ(rmse(reference, reference).relative, 0.0);
}

TEST(Metrics, OnlyAlikeImagesAreCompared) {
  const Image a(4, 4, 3), wider(5, 4, 3), grey(4, 4, 1), with_alpha(4, 4, 4), none;
  for (const Image* other : {&wider, &grey}) {
    EXPECT_EQ(codeOf([&] { rmse(a, *other); }), ErrorCode::kMismatch);
    EXPECT_EQ(codeOf([&] { flip(a, *other); }), ErrorCode::kMismatch);
    EXPECT_EQ(codeOf([&] { yee(a, *other); }), ErrorCode::kMismatch);
  }
  EXPECT_EQ(codeOf([&] { rmse(none, none); }), ErrorCode::kMismatch);
  EXPECT_EQ(rmse(a, with_alpha).rmse, 0.0);
  EXPECT_EQ(flip(a, with_alpha).max, 0.0);
  EXPECT_EQ(yee(a, with_alpha).visible_pixels, 0u);
  Image broken(4, 4, 3);
  broken.at(2, 1)[0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(codeOf([&] { flip(a, broken); }), ErrorCode::kInvalidValue);
  EXPECT_EQ(codeOf([&] { yee(broken, a); }), ErrorCode::kInvalidValue);
}

TEST(Metrics, ImagesSmallerThanTheFilters) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 3}, {5, 2}}) {
    EXPECT_EQ(yee(Image(width, height, 1, 0.9f), Image(width, height, 1, 0.2f)).visible_pixels,
              static_cast<std::size_t>(width * height));
    EXPECT_GT(flip(Image(width, height, 1, 0.9f), Image(width, height, 1, 0.2f)).mean, 0.3);
  }
}

// ---- FLIP: written down a second time, in double precision, with whole 2D filters and no strips.

using D3 = std::array<double, 3>;

D3 times(const double (&m)[3][3], D3 v) {
  D3 out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[i] += m[i][j] * v[j];
  return out;
}

constexpr double kToXyz[3][3] = {{0.4123907992659595, 0.3575843393838780, 0.1804807884018343},
                                 {0.2126390058715104, 0.7151686787677559, 0.0721923153607337},
                                 {0.0193308187155918, 0.1191947797946260, 0.9505321522496607}};
constexpr double kToRgb[3][3] = {{3.2409699419045226, -1.5373831775700939, -0.4986107602930034},
                                 {-0.9692436362808796, 1.8759675015077202, 0.0415550574071756},
                                 {0.0556300796969937, -0.2039769588889765, 1.0569715142428786}};
constexpr D3 kWhite = {0.9504559270516718, 1.0, 1.0890577507598784};

D3 referenceLab(D3 rgb) {
  for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
  D3 xyz = times(kToXyz, rgb), f{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = xyz[i] / kWhite[i];
    f[i] = t > 216.0 / 24389.0 ? std::cbrt(t) : 841.0 / 108.0 * t + 4.0 / 29.0;
  }
  const double l = 116 * f[1] - 16;
  return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

double referenceHyab(D3 a, D3 b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

double referenceColourError(D3 a, D3 b) {
  const double largest = std::pow(referenceHyab(referenceLab({0, 1, 0}), referenceLab({0, 0, 1})), 0.7);
  const double e = std::pow(referenceHyab(a, b), 0.7), knee = 0.4 * largest;
  return e < knee ? 0.95 * e / knee : 0.95 + 0.05 * (e - knee) / (largest - knee);
}

struct Plane64 {
  int width, height;
  std::vector<double> data;
  double at(int x, int y) const {
    return data[static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1))];
  }
  template <class F>
  double filtered(int x, int y, int r, F&& weight) const {
    double sum = 0, positive = 0, negative = 0;
    for (int j = -r; j <= r; ++j)
      for (int i = -r; i <= r; ++i) (weight(i, j) > 0 ? positive : negative) += std::abs(weight(i, j));
    for (int j = -r; j <= r; ++j)
      for (int i = -r; i <= r; ++i) {
        const double w = weight(i, j);
        sum += at(x + i, y + j) * (w > 0 ? w / positive : negative > 0 ? w / negative : 0);
      }
    return sum;
  }
};

struct ReferenceSeen {
  D3 lab;
  double edge, point;
};

std::vector<ReferenceSeen> referenceSee(const Image& image, double ppd) {
  std::array<Plane64, 3> c;
  for (auto& p : c) p = {image.width, image.height, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      D3 rgb{};
      for (int i = 0; i < 3; ++i)
        rgb[static_cast<std::size_t>(i)] = std::clamp(double{image.rgb(x, y)[i]}, 0.0, 1.0);
      const D3 xyz = times(kToXyz, rgb);
      const double yr = xyz[1] / kWhite[1];
      c[0].data.push_back(116 * yr - 16);
      c[1].data.push_back(500 * (xyz[0] / kWhite[0] - yr));
      c[2].data.push_back(200 * (yr - xyz[2] / kWhite[2]));
    }
  Plane64 grey = c[0];
  for (double& v : grey.data) v = (v + 16) / 116;

  const double pi = std::acos(-1.0), s = 0.5 * 0.082 * ppd;
  const int r = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd)),
            rf = static_cast<int>(std::ceil(3 * s));
  const auto sensitivity = [&](double a1, double b1, double a2, double b2) {
    return [=](int i, int j) {
      const double d2 = (i * i + j * j) / (ppd * ppd);
      return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * d2 / b1) +
             a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * d2 / b2);
    };
  };
  const auto g = [&](int i, int j) { return std::exp(-(i * i + j * j) / (2 * s * s)); };
  std::vector<ReferenceSeen> out;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double fy = c[0].filtered(x, y, r, sensitivity(1, 0.0047, 0, 1e-5));
      const double fx = c[1].filtered(x, y, r, sensitivity(1, 0.0053, 0, 1e-5));
      const double fz = c[2].filtered(x, y, r, sensitivity(34.1, 0.04, 13.5, 0.025));
      const double yr = (fy + 16) / 116;
      const D3 xyz = {(yr + fx / 500) * kWhite[0], yr, (yr - fz / 200) * kWhite[2]};
      ReferenceSeen seen;
      seen.lab = referenceLab(times(kToRgb, xyz));
      seen.edge = std::hypot(grey.filtered(x, y, rf, [&](int i, int j) { return -i * g(i, j); }),
                             grey.filtered(x, y, rf, [&](int i, int j) { return -j * g(i, j); }));
      seen.point =
          std::hypot(grey.filtered(x, y, rf, [&](int i, int j) { return (i * i / (s * s) - 1) * g(i, j); }),
                     grey.filtered(x, y, rf, [&](int i, int j) { return (j * j / (s * s) - 1) * g(i, j); }));
      out.push_back(seen);
    }
  return out;
}

std::vector<double> referenceFlip(const Image& test, const Image& reference, double ppd) {
  const auto t = referenceSee(test, ppd), r = referenceSee(reference, ppd);
  std::vector<double> out;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double feature = std::max(std::abs(t[i].edge - r[i].edge), std::abs(t[i].point - r[i].point));
    out.push_back(
        std::pow(referenceColourError(t[i].lab, r[i].lab), 1 - std::sqrt(feature / std::sqrt(2.0))));
  }
  return out;
}

TEST(Flip, EqualsTheFormulasOfThePaper) {
  // 150 rows make three strips; the second pair has a hard edge, a dot and values that must be clamped.
  for (const double ppd : {67.0, 23.0}) {
    const Image a = picture(23, ppd > 50 ? 150 : 20, 3, 1);
    Image b = picture(a.width, a.height, 3, 9);
    for (int y = 0; y < a.height; ++y)
      for (int x = 12; x < a.width; ++x) b.setRgb(x, y, Vec3(1.5f, -0.2f, 0.1f));
    b.setRgb(5, 10, Vec3(0.0f, 1.0f, 1.0f));
    const std::vector<double> expected = referenceFlip(b, a, ppd);
    const Difference found = flip(b, a, ppd);
    double mean = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_NEAR(found.map.data[i], expected[i], 2e-4)
          << "pixel " << i << ", " << ppd << " pixels per degree";
      mean += expected[i] / static_cast<double>(expected.size());
    }
    EXPECT_NEAR(found.mean, mean, 2e-5);
    EXPECT_GT(found.mean, 0.1);
  }
}

// Filters keep uniform images as they are, and there are no features: only the colour difference is left.
TEST(Flip, UniformColoursDifferByTheirColourAlone) {
  const std::vector<Vec3> colours = {Vec3(0),   Vec3(1),   Vec3(0.5f),           {1, 0, 0},
                                     {0, 1, 0}, {0, 0, 1}, {0.2f, 0.21f, 0.19f}, {0.001f, 0, 0.002f}};
  for (const Vec3 a : colours)
    for (const Vec3 b : colours) {
      const double expected =
          referenceColourError(referenceLab({a.x, a.y, a.z}), referenceLab({b.x, b.y, b.z}));
      const Difference found = flip(uniform(30, 30, a), uniform(30, 30, b));
      EXPECT_NEAR(found.mean, expected, 2e-4);
      EXPECT_NEAR(found.p95, found.mean, 2e-4);
      EXPECT_NEAR(found.max, found.mean, 2e-4);
    }
  EXPECT_NEAR(flip(uniform(8, 8, {0, 1, 0}), uniform(8, 8, {0, 0, 1})).mean, 1.0, 1e-5)
      << "the largest difference";
  EXPECT_NEAR(flip(uniform(8, 8, Vec3(0)), uniform(8, 8, Vec3(1))).mean, 0.9674, 1e-4)
      << "black against white";
}

TEST(Flip, ZeroForEqualSymmetricAndWithinOne) {
  const Image a = picture(50, 40, 3, 1), b = picture(50, 40, 3, 2);
  EXPECT_EQ(flip(a, a).max, 0.0);
  const Difference ab = flip(a, b), ba = flip(b, a);
  EXPECT_EQ(ab.map.data, ba.map.data);
  EXPECT_GT(ab.mean, 0.0);
  EXPECT_LE(ab.mean, ab.p95);
  EXPECT_LE(ab.p95, ab.p99);
  EXPECT_LE(ab.p99, ab.max);
  EXPECT_LE(ab.max, 1.0);
}

TEST(Flip, GrowsWithNoiseAndFallsWithDistance) {
  const Image clean = uniform(80, 80, Vec3(0.3f));
  const Image noise = picture(80, 80, 1, 3);
  std::vector<double> means;
  for (const float amount : {0.02f, 0.1f, 0.4f}) {
    Image noisy = clean;
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 80; ++x)
        noisy.setRgb(x, y, Vec3(0.3f + ((x + y) % 2 ? amount : -amount) * noise.at(x, y)[0]));
    EXPECT_LT(flip(noisy, clean, 134.0).mean, flip(noisy, clean, 30.0).mean) << "a checkerboard blurs away";
    means.push_back(flip(noisy, clean).mean);
  }
  EXPECT_TRUE(std::is_sorted(means.begin(), means.end()));
  EXPECT_LT(2 * means[0], means[2]);
}

TEST(Metrics, ThreadsDoNotMatter) {
  const Image a = picture(40, 300, 3, 1), b = picture(40, 300, 3, 2);
  std::vector<std::vector<float>> maps;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    maps.push_back(flip(a, b).map.data);
    maps.push_back(yee(a, b).map.data);
  }
  EXPECT_EQ(maps[0], maps[2]);
  EXPECT_EQ(maps[1], maps[3]);
}

// ---- Yee

double referenceTvi(double a) {
  const double l = std::log10(a);
  const double r = l < -3.94     ? -2.86
                   : l < -1.44   ? std::pow(0.405 * l + 1.6, 2.18) - 2.86
                   : l < -0.0184 ? l - 0.395
                   : l < 1.9     ? std::pow(0.249 * l + 0.65, 2.7) - 0.72
                                 : l - 1.255;
  return std::pow(10.0, r);
}

// A uniform image has no contrast: a change is visible exactly from the threshold against intensity on.
TEST(Yee, UniformImagesMeetTheThresholdAgainstIntensity) {
  for (const double base : {0.0005, 0.02, 0.4, 3.0, 30.0, 90.0}) {
    // The adaptation is that of the mean of both.
    double step = referenceTvi(base);
    for (int i = 0; i < 30; ++i) step = referenceTvi(base + 0.5 * step);
    const auto grey = [](double nits) { return Image(20, 20, 1, static_cast<float>(nits / 100.0)); };
    EXPECT_EQ(yee(grey(base + 0.99 * step), grey(base)).visible_pixels, 0u) << base;
    EXPECT_EQ(yee(grey(base + 1.01 * step), grey(base)).visible_pixels, 400u) << base;
  }
}

TEST(Yee, EqualImagesLookEqual) {
  const Image a = picture(64, 70, 3);
  EXPECT_EQ(yee(a, a).visible_pixels, 0u);
  const Yee black_white = yee(uniform(20, 10, Vec3(0)), uniform(20, 10, Vec3(1)));
  EXPECT_EQ(black_white.visible_pixels, 200u);
  EXPECT_EQ(black_white.map.data, std::vector<float>(200, 1.0f));
}

// The same change is seen on a plain wall and not on a contrasty texture of the same mean.
TEST(Yee, ContrastMasks) {
  const int size = 96;
  Image plain = uniform(size, size, Vec3(0.4f)), texture = plain;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) texture.setRgb(x, y, Vec3((x / 2 + y / 2) % 2 ? 0.75f : 0.05f));
  const auto brighter = [&](Image image) {
    for (int y = 18; y < 78; ++y)
      for (int x = 18; x < 78; ++x) image.setRgb(x, y, image.rgb(x, y) + Vec3(0.04f));
    return image;
  };
  EXPECT_GT(yee(brighter(plain), plain).visible_pixels, 200u);
  EXPECT_EQ(yee(brighter(texture), texture).visible_pixels, 0u);
}

TEST(Yee, ColourCountsInDaylightOnly) {
  const Vec3 green(0.0f, 0.3f / 0.7152f, 0.0f), grey(0.3f);
  EXPECT_EQ(yee(uniform(20, 20, green), uniform(20, 20, grey)).visible_pixels, 400u);
  EXPECT_EQ(yee(uniform(20, 20, green), uniform(20, 20, grey), {.colour_factor = 0.0}).visible_pixels, 0u);
  EXPECT_EQ(yee(uniform(20, 20, green), uniform(20, 20, grey), {.luminance_white = 30.0}).visible_pixels, 0u)
      << "9 cd m^-2";
}

// A second, plain version: whole planes, double precision, 2D kernel. A pixel within 1e-3 of its threshold
// may fall either way.
// Returns how many pixels are visible and how many are masked by a factor that is inside its limits of 1
// and 10.
std::pair<std::size_t, std::size_t> expectYeeEqualsTheFormulas(double field_of_view_deg, float contrast) {
  const int w = 37, h = 150;
  Image a = picture(w, h, 1, 1);
  for (float& v : a.data) v = 0.4f + contrast * (v - 0.4f);
  // A slow ramp changes little contrast, so thresholds are crossed at all factors; the noise grows with the
  // contrast.
  Image b = a;
  std::uint32_t state = 5;
  for (std::size_t i = 0; i < b.data.size(); ++i) {
    state = state * 1664525u + 1013904223u;
    const float noise = static_cast<float>(state >> 8) * 0x1p-24f - 0.5f;
    b.data[i] = std::max(0.0f, b.data[i] + 0.3f * contrast * noise +
                                   0.25f * static_cast<float>(i) / static_cast<float>(b.data.size()));
  }
  const auto pyramid = [&](const Image& image) {
    std::vector<Plane64> levels = {{w, h, {}}};
    for (const float v : image.data) levels[0].data.push_back(100.0 * v);
    const double k[] = {0.05, 0.25, 0.4, 0.25, 0.05};
    const auto mirror = [](int i, int n) { return i < 0 ? -i : i >= n ? 2 * n - i - 1 : i; };
    while (levels.size() < 8) {
      Plane64 next{w, h, {}};
      for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
          double sum = 0;
          for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i)
              sum += k[i + 2] * k[j + 2] * levels.back().at(mirror(x + i, w), mirror(y + j, h));
          next.data.push_back(sum);
        }
      levels.push_back(next);
    }
    return levels;
  };
  const auto la = pyramid(a), lb = pyramid(b);
  const auto csf = [](double f, double l) {
    const double p = 440 * std::pow(1 + 0.7 / l, -0.2), q = 0.3 * std::pow(1 + 100 / l, 0.15);
    return p * f * std::exp(-q * f) * std::sqrt(1 + 0.06 * std::exp(q * f));
  };
  const double pi = std::acos(-1.0);
  const double degrees = 2 * std::tan(field_of_view_deg * pi / 360) * 180 / pi;
  std::size_t adapting = 0;
  for (double pixels = 1; pixels <= degrees && adapting < 7; pixels *= 2) ++adapting;
  const Yee found = yee(b, a, {.field_of_view_deg = field_of_view_deg});
  std::size_t near = 0, masked = 0, wrong = 0, inside_visible = 0, inside_masked = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double adaptation = 0.5 * (la[adapting].at(x, y) + lb[adapting].at(x, y));
      double sum = 0, factor = 0;
      for (std::size_t i = 0; i < 6; ++i) {
        const double change = std::max(std::abs(la[i].at(x, y) - la[i + 1].at(x, y)),
                                       std::abs(lb[i].at(x, y) - lb[i + 1].at(x, y)));
        const double c = change / std::max(la[i + 2].at(x, y), lb[i + 2].at(x, y)),
                     f = 0.5 * w / degrees / std::exp2(i);
        const double m =
            std::pow(1 + std::pow(0.0153 * std::pow(392.498 * c * csf(f, adaptation), 0.7), 4), 0.25);
        sum += c;
        factor += c * csf(3.248, 100) / csf(f, 100) * m;
      }
      const double threshold = std::clamp(factor / sum, 1.0, 10.0) * referenceTvi(adaptation);
      const double change = std::abs(la[0].at(x, y) - lb[0].at(x, y));
      const bool above = change > referenceTvi(adaptation),
                 inside = factor / sum > 1.01 && factor / sum < 9.9;
      masked += above && change <= threshold;
      inside_masked += inside && above && change <= threshold;
      inside_visible += inside && change > threshold;
      if (std::abs(change / threshold - 1) < 1e-3) {
        ++near;
        continue;
      }
      wrong += (*found.map.at(x, y) > 0.5f) != (change > threshold);
    }
  EXPECT_EQ(wrong, 0u);
  EXPECT_LT(near, 100u);
  EXPECT_GT(masked, 100u) << "the case must exercise masking";
  return {inside_visible, inside_masked};
}

TEST(Yee, EqualsTheFormulas) {
  std::size_t visible = 0, masked = 0;
  for (const double field_of_view_deg : {2.0, 5.0, 45.0, 150.0})
    for (const float contrast : {0.02f, 0.1f, 1.0f}) {
      SCOPED_TRACE(testing::Message() << field_of_view_deg << " degrees, contrast " << contrast);
      const auto [v, m] = expectYeeEqualsTheFormulas(field_of_view_deg, contrast);
      visible += v, masked += m;
    }
  EXPECT_GT(visible, 2000u) << "frequencies and masking must matter";
  EXPECT_GT(masked, 2000u) << "frequencies and masking must matter";
}

}  // namespace
}  // namespace relume::image
