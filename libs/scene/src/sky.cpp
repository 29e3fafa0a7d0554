// SPDX-License-Identifier: MIT
#include "relume/scene/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/core/error.h"
#include "relume/core/parallel.h"
#include "relume/scene/environment.h"

namespace relume::scene {
namespace {

/// Perez's distribution F(theta, gamma) = (1 + A e^(B / cos theta)) (1 + C e^(D gamma) + E cos^2 gamma).
struct Perez {
  double a, b, c, d, e;
  double operator()(double cos_theta, double gamma) const {
    const double cos_gamma = std::cos(gamma);
    return (1 + a * std::exp(b / cos_theta)) * (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
  }
};

/// One of the sky's quantities Y, x, y: its value at the zenith and its distribution.
struct Quantity {
  double zenith;
  Perez shape;
  double at(double cos_theta, double gamma, double theta_sun) const {
    return zenith * shape(cos_theta, gamma) / shape(1.0, theta_sun);
  }
};

double chromaticityAtZenith(const double (&m)[3][4], double t, double s) {
  const std::array<double, 3> powers{t * t, t, 1.0};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += powers[i] * (((m[i][0] * s + m[i][1]) * s + m[i][2]) * s + m[i][3]);
  return sum;
}

class Sky {
 public:
  Sky(Direction to_sun, double t) : to_sun_(to_sun) {
    if (!(to_sun.y > 0))
      throw Error(ErrorCode::kInvalidValue, "the sun", "is below the horizon", "the sky model ends there");
    if (!(t >= 2 && t <= 10))
      throw Error(ErrorCode::kInvalidValue, "turbidity", fmt::format("is {}", t), "choose one from 2 to 10");
    theta_sun_ = std::acos(std::min(1.0, static_cast<double>(to_sun.y)));
    const double chi = (4.0 / 9.0 - t / 120.0) * (M_PI - 2 * theta_sun_);
    constexpr double kZenithX[3][4] = {{0.00166, -0.00375, 0.00209, 0.0},
                                       {-0.02903, 0.06377, -0.03202, 0.00394},
                                       {0.11693, -0.21196, 0.06052, 0.25886}};
    constexpr double kZenithY[3][4] = {{0.00275, -0.00610, 0.00317, 0.0},
                                       {-0.04214, 0.08970, -0.04153, 0.00516},
                                       {0.15346, -0.26756, 0.06670, 0.26688}};
    luminance_ = {1000 * std::max((4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192, 0.0),
                  {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                   -0.0670 * t + 0.3703}};
    x_ = {chromaticityAtZenith(kZenithX, t, theta_sun_),
          {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
           -0.0033 * t + 0.0452}};
    y_ = {chromaticityAtZenith(kZenithY, t, theta_sun_),
          {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
           -0.0109 * t + 0.0529}};
  }

  Vec3 at(Direction d) const {
    if (!(d.y > 0)) return Vec3(0.0f);
    const double gamma = std::acos(std::clamp(static_cast<double>(glm::dot(d, to_sun_)), -1.0, 1.0));
    const double cos_theta = d.y;
    const double luminance = luminance_.at(cos_theta, gamma, theta_sun_),
                 x = x_.at(cos_theta, gamma, theta_sun_), y = y_.at(cos_theta, gamma, theta_sun_);
    const double cx = luminance * x / y, cz = luminance * (1 - x - y) / y;
    const Vec3 rgb(3.2404542 * cx - 1.5371385 * luminance - 0.4985314 * cz,
                   -0.9692660 * cx + 1.8760108 * luminance + 0.0415560 * cz,
                   0.0556434 * cx - 0.2040259 * luminance + 1.0572252 * cz);
    return glm::max(rgb, Vec3(0.0f));
  }

 private:
  Direction to_sun_;
  double theta_sun_ = 0;
  Quantity luminance_{}, x_{}, y_{};
};

}  // namespace

Vec3 skyLuminance(Direction to_sun, float turbidity, Direction d) { return Sky(to_sun, turbidity).at(d); }

image::Image skyImage(Direction to_sun, float turbidity, int height) {
  const Sky sky(to_sun, turbidity);
  image::Image result(2 * height, height, 3);
  parallelFor(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < result.width; ++x) {
        const Vec2 uv = (Vec2(x, y) + 0.5f) / Vec2(result.width, height);
        result.setRgb(x, static_cast<int>(y), sky.at(directionFromEquirect(uv)));
      }
  });
  return result;
}

}  // namespace relume::scene
