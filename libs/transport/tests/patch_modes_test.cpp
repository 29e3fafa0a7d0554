// SPDX-License-Identifier: MIT
#include "light_paths/patch_modes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace relume::transport {
namespace {

constexpr std::size_t kPieces = 24, kLamps = 40;

/// Two patches of 12 pieces each, the second much brighter but always even; a piece of none; light on
/// the first is its mean in a shape of its own and two kinds of variation.
struct Made {
  std::vector<std::uint32_t> of;
  std::vector<float> weight;
  TrainingLight light{kLamps, {}};

  Made() {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit;
    for (std::size_t i = 0; i < kPieces; ++i) {
      of.push_back(i < 12 ? 0 : 1);
      weight.push_back(0.2f + unit(random));
    }
    of.push_back(scene::kNone), weight.push_back(1);
    std::vector<float> a(kLamps), b(kLamps), c(kLamps);
    for (std::size_t l = 0; l < kLamps; ++l)
      a[l] = 1 + unit(random), b[l] = unit(random), c[l] = unit(random);
    for (std::size_t i = 0; i <= kPieces; ++i) {
      const float s = 1 + unit(random), u = unit(random) - 0.5f, v = unit(random) - 0.5f;
      for (std::size_t l = 0; l < kLamps; ++l)
        light.on_pieces.push_back(i < 12 ? s * a[l] + u * b[l] + 0.3f * v * c[l] : 9 * a[l]);
    }
  }
  PatchModes modes(std::size_t entries) const {
    SilentProgress silent;
    return modesOf(of, 2, weight, light, entries, silent);
  }
};

/// Largest difference between the training light and what entries say of it, of the first patch.
double missed(const Made& made, const PatchModes& modes) {
  std::vector<double> said(kPieces * kLamps, 0.0);
  for (const EntryShare& s : modes.shares)
    for (std::size_t l = 0; l < kLamps; ++l)
      said[s.piece * kLamps + l] += static_cast<double>(s.value * modes.of_lamps[s.entry * kLamps + l]);
  double worst = 0;
  for (std::size_t i = 0; i < 12 * kLamps; ++i)
    worst = std::max(worst, std::abs(said[i] - static_cast<double>(made.light.on_pieces[i])));
  return worst;
}

TEST(PatchModes, GoWhereLightVariesAndThenMissNothing) {
  const Made made;
  EXPECT_EQ(made.modes(2).first, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_GT(missed(made, made.modes(2)), 0.1);
  EXPECT_EQ(made.modes(3).first, (std::vector<std::uint32_t>{0, 2, 3}));
  const double one = missed(made, made.modes(3));
  EXPECT_EQ(made.modes(4).first, (std::vector<std::uint32_t>{0, 3, 4}));
  EXPECT_LT(missed(made, made.modes(4)), 0.8 * one);
  // The shape is that of the mean lamp, so a third component may be left; then there is no more.
  const PatchModes all = made.modes(20);
  EXPECT_LT(all.first.back(), 8u);
  EXPECT_LT(missed(made, all), 1e-3);
}

TEST(PatchModes, TheMeanHasAllTheLight) {
  const Made made;
  const PatchModes modes = made.modes(5);
  std::vector<double> flux(modes.first.back(), 0.0);
  double weight[2] = {0, 0};
  for (const EntryShare& s : modes.shares) {
    EXPECT_LT(s.piece, kPieces);
    flux[s.entry] += static_cast<double>(made.weight[s.piece] * s.value);
  }
  for (std::size_t i = 0; i < kPieces; ++i) weight[made.of[i]] += static_cast<double>(made.weight[i]);
  for (std::size_t p = 0; p < 2; ++p)
    for (std::uint32_t e = modes.first[p]; e < modes.first[p + 1]; ++e)
      EXPECT_NEAR(flux[e], e == modes.first[p] ? weight[p] : 0.0, 1e-4 * weight[p]) << e;
}

TEST(PatchModes, PlacesTellThem) {
  // Places that have what pieces have: the entries of lamps come out again, but for what the estimate holds
  // back for the noise of places; of a place alone it is its mean.
  const Made made;
  const PatchModes modes = made.modes(4);
  std::vector<float> on_places;
  for (std::size_t i = 0; i < kPieces; ++i)
    for (std::size_t l = 0; l < kLamps; ++l) on_places.push_back(made.light.on_pieces[i * kLamps + l]);
  SilentProgress silent;
  const std::vector<float> mix = mixOf(modes, on_places, kLamps, 12, silent);
  ASSERT_EQ(mix.size(), 12 * 4u);
  const std::size_t count = modes.first[1];
  for (std::size_t e = 0; e < count; ++e) {
    double error = 0, all = 0;
    for (std::size_t l = 0; l < kLamps; ++l) {
      double got = 0;
      for (std::size_t k = 0; k < 12; ++k)
        got += static_cast<double>(mix[k * count + e] * on_places[k * kLamps + l]);
      const double wanted = static_cast<double>(modes.of_lamps[e * kLamps + l]);
      error += (got - wanted) * (got - wanted), all += wanted * wanted;
    }
    EXPECT_LT(std::sqrt(error / all), e == 0 ? 0.01 : 0.5) << e;
  }
  const std::vector<float> dark(2 * 12 * kLamps, 0.0f);
  const std::vector<float> of_dark = mixOf(modes, dark, kLamps, 12, silent);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_FLOAT_EQ(of_dark[k * count], 1.0f / 12);  // a patch that no lamp lights keeps its mean
    EXPECT_EQ(of_dark[k * count + 1], 0.0f);
  }
}

}  // namespace
}  // namespace relume::transport
