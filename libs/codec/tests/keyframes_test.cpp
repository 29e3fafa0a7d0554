// SPDX-License-Identifier: MIT
#include "relume/codec/keyframes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relume::codec {
namespace {

using Curve = std::function<double(double)>;

Visible differsBy(const Curve& f, double threshold) {
  return [=](const Interval& keys, double t) {
    const double share = (t - keys.before) / (keys.after - keys.before);
    return std::abs((1 - share) * f(keys.before) + share * f(keys.after) - f(t)) > threshold;
  };
}

double worst(const Curve& f, const std::vector<double>& keys) {
  double most = 0;
  for (double t = keys.front(); t <= keys.back(); t += 0.25) {
    const KeyPlace at = placeBetween(keys, t);
    const double value =
        (1 - at.share) * f(keys[at.key]) + at.share * f(keys[std::min(at.key + 1, keys.size() - 1)]);
    most = std::max(most, std::abs(value - f(t)));
  }
  return most;
}

// A parabola of curvature c is missed by c h^2 / 8 in the middle of an interval h, wherever it lies:
// intervals are halved to the first power of two below sqrt(8 threshold / c).
TEST(Keyframes, AreAsDenseAsTheCurvature) {
  const std::vector<double> seeds{0, 1024};
  for (const double curvature : {1e-5, 1e-4, 1e-3, 1e-2}) {
    const Curve f = [=](double t) { return 0.5 * curvature * t * t; };
    const std::vector<double> keys = chooseKeyframes(seeds, differsBy(f, 0.1));
    const double widest = std::sqrt(8 * 0.1 / curvature);
    double interval = 1024;
    while (interval > widest) interval /= 2;
    EXPECT_EQ(keys.size(), static_cast<std::size_t>(1024 / interval) + 1) << curvature;
    EXPECT_LE(worst(f, keys), 0.1 + 1e-9);
  }
}

TEST(Keyframes, AStraightRampNeedsNone) {
  const std::vector<double> seeds{0, 100, 1000};
  int asked = 0;
  const Visible visible = [&](const Interval& keys, double t) {
    ++asked;
    return differsBy([](double x) { return 3 * x - 5; }, 1e-6)(keys, t);
  };
  EXPECT_EQ(chooseKeyframes(seeds, visible), seeds);
  EXPECT_EQ(asked, 6);
}

// The paper's way misses it: the middle looks like the ends.
TEST(Keyframes, ABumpBesideTheMiddleIsFound) {
  const Curve bump = [](double t) { return std::exp(-std::pow((t - 250) / 40, 2)); };
  const std::vector<double> keys = chooseKeyframes(std::vector<double>{0, 1000}, differsBy(bump, 0.05));
  EXPECT_GT(keys.size(), 8u);
  EXPECT_LT(worst(bump, keys), 0.06);
  EXPECT_EQ(chooseKeyframes(std::vector<double>{0, 1000}, differsBy(bump, 0.05), {.depth = 1}).size(), 2u);
}

// A day with a sharp drop: sin^2 from 360 to 1080 minutes, and from 800 on 0.55 of it.
TEST(Keyframes, GatherWhereLightChangesSuddenly) {
  const Curve day = [](double t) {
    const double s = t < 360 || t > 1080 ? 0 : std::sin(M_PI * (t - 360) / 720);
    return s * s * (t < 800 ? 1 : 0.55);
  };
  const std::vector<double> keys =
      chooseKeyframes(std::vector<double>{0, 1440}, differsBy(day, 0.01), {.shortest = 1, .depth = 2});
  const auto among = [&](double from, double to) {
    return std::count_if(keys.begin(), keys.end(), [&](double t) { return t >= from && t < to; });
  };
  EXPECT_GE(among(790, 810), 4);
  EXPECT_LT(among(0, 300), 3);
  EXPECT_GE(keys[1] - keys[0], 1);
  for (std::size_t i = 1; i < keys.size(); ++i) EXPECT_GE(keys[i] - keys[i - 1], 1.0);
}

// Uneven keys: {time, key, share}.
TEST(Keyframes, PlacesLieBetweenUnevenKeys) {
  const std::vector<double> keys{300, 330, 345, 350, 355, 360, 390, 450};
  const double known[][3] = {{352, 3, 0.4}, {337.5, 1, 0.5}, {299, 0, 0},   {449, 6, 59.0 / 60},
                             {300, 0, 0},   {345, 2, 0},     {450, 6, 1.0}, {1440, 6, 1.0}};
  for (const auto& [time, key, share] : known) {
    const KeyPlace at = placeBetween(keys, time);
    EXPECT_EQ(at.key, static_cast<std::size_t>(key)) << time;
    EXPECT_NEAR(at.share, share, 1e-12) << time;
  }
  EXPECT_EQ(placeBetween(std::vector<double>{5}, 7).key, 0u);
  // Even ones that do not divide an hour, from an offset: 13:47 of frames every 7 minutes from minute 3.
  std::vector<double> even;
  for (double t = 3; t < 1440; t += 7) even.push_back(t);
  EXPECT_EQ(placeBetween(even, 13 * 60 + 47).key, 117u);
  EXPECT_NEAR(placeBetween(even, 13 * 60 + 47).share, 5.0 / 7, 1e-12);
}

}  // namespace
}  // namespace relume::codec
