// SPDX-License-Identifier: MIT
// Cases with exact answers in the folder RELUME_SHARED, where there is one; what they say in short is in the
// other tests too.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "relume/basis/ambient.h"
#include "relume/basis/basis.h"
#include "relume/basis/direction_set.h"
#include "relume/basis/h_basis.h"
#include "relume/basis/sh.h"

namespace relume::basis {
namespace {

using Json = nlohmann::json;

Vec3 vec(const Json& j) { return {j[0].get<float>(), j[1].get<float>(), j[2].get<float>()}; }

class OracleCases : public testing::Test {
 protected:
  void SetUp() override {
    const char* shared = std::getenv("RELUME_SHARED");
    const auto file = std::filesystem::path(shared ? shared : "") / "oracle" / "cases.json";
    if (!shared || !std::filesystem::exists(file)) GTEST_SKIP() << "RELUME_SHARED is not set";
    std::ifstream in(file);
    const Json all = Json::parse(in);
    for (const Json& c : all.at("cases")) cases_[c.at("id").get<std::string>()] = c;
  }
  const Json& operator[](const std::string& id) const { return cases_.at(id); }

  std::map<std::string, Json> cases_;
};

void expectNumbers(const Json& expected, std::span<const float> measured, double tolerance) {
  for (std::size_t i = 0; i < measured.size(); ++i)
    EXPECT_NEAR(static_cast<double>(measured[i]), expected[i].get<double>(), tolerance) << i;
}

TEST_F(OracleCases, SphericalHarmonics) {
  const Json& basis = (*this)["sh.basis"];
  std::array<float, kShMost> y, signs;
  shValues(vec(basis["scene"]["direction"]), y);
  expectNumbers(basis["expected"]["positive"], y, 1e-6);
  for (std::size_t i = 0; i < kShMost; ++i) signs[i] = condonShortley(i), y[i] *= signs[i];
  expectNumbers(basis["expected"]["condon_shortley"], y, 1e-6);
  expectNumbers((*this)["sh.basis.signs"]["expected"], signs, 0);
  const Json& factors = (*this)["sh.cosine_factors"]["expected"];
  expectNumbers(factors["A"], kCosineFactor, 1e-6);
  std::array<float, 9> zonal;
  for (std::size_t l = 0; l < zonal.size(); ++l)
    zonal[l] = kCosineFactor[l] * std::sqrt((2 * static_cast<float>(l) + 1) / (4 * kPi));
  expectNumbers(factors["zh"], zonal, 1e-6);
}

TEST_F(OracleCases, IrradianceOfSphericalHarmonics) {
  const Json& delta = (*this)["sh.irradiance.delta"];
  const auto measured = [&](std::size_t bands) {
    std::array<float, kShMost> y;
    shValues(vec(delta["scene"]["light"]), y);
    std::vector<float> rgb(3 * bands * bands);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = y[i / 3];
    return static_cast<double>(shIrradiance(rgb, vec(delta["scene"]["n"])).rgb.x);
  };
  EXPECT_NEAR(measured(2), delta["expected"]["l1"].get<double>(), 1e-6);
  EXPECT_NEAR(measured(3), delta["expected"]["l2"].get<double>(), 1e-6);
  EXPECT_NEAR(measured(5), delta["expected"]["l4"].get<double>(), 1e-6);

  const std::array<float, 3> constant = {std::sqrt(4 * kPi), 0, 0};
  EXPECT_NEAR(static_cast<double>(shIrradiance(constant, {0, 1, 0}).rgb.x),
              (*this)["sh.irradiance.constant"]["expected"].get<double>(), 1e-5);

  // Radiance (w . d)+ has the coefficients A_l Y_lm(d).
  const Json& lobe = (*this)["sh.irradiance.coslobe"];
  std::array<float, 9> y;
  shValues({0, 0, 1}, y);
  std::vector<float> rgb(27);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = kCosineFactor[bandOf(i / 3)] * y[i / 3];
  for (std::size_t i = 0; i < lobe["scene"]["angles_deg"].size(); ++i) {
    const float angle = glm::radians(lobe["scene"]["angles_deg"][i].get<float>());
    const Vec3 e = shIrradiance(rgb, {std::sin(angle), 0, std::cos(angle)}).rgb;
    EXPECT_NEAR(static_cast<double>(e.x), lobe["expected"]["sh2"][i].get<double>(), 1e-5) << i;
  }
  const Json& transfer = (*this)["prt.unoccluded"];
  std::array<float, kShMost> t;
  shValues(vec(transfer["scene"]["n"]), t);
  for (std::size_t i = 0; i < kShMost; ++i) t[i] *= kCosineFactor[bandOf(i)];
  expectNumbers(transfer["expected"], t, 1e-5);
}

TEST_F(OracleCases, HBasis) {
  const Json& c = (*this)["hbasis"];
  expectNumbers(c["expected"]["values"], hValues(vec(c["scene"]["direction"])), 1e-6);
  std::array<float, 9> sh;
  shValues(vec(c["scene"]["light"]), sh);
  for (std::size_t i = 0; i < sh.size(); ++i) sh[i] *= kCosineFactor[bandOf(i)];
  expectNumbers(c["expected"]["coeffs"], hFromSh(sh), 1e-6);
}

template <class Weights>
double blended(const Json& values, const Weights& weights) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    sum += values[i].get<double>() * static_cast<double>(weights[i]);
  return sum;
}

TEST_F(OracleCases, BlendsOfDirections) {
  const Json& hl2 = (*this)["hl2.eval"];
  const Vec3 n = vec(hl2["scene"]["n"]);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(glm::length(kHl2[i] - vec(hl2["expected"]["basis"][i])), 1e-6f) << i;
  EXPECT_NEAR(blended(hl2["scene"]["E3"], hl2Weights(n)), hl2["expected"]["squared"].get<double>(), 1e-6);
  EXPECT_NEAR(blended(hl2["scene"]["E3"], hl2PlainWeights(n)), hl2["expected"]["plain"].get<double>(), 1e-6);

  const Json& cube = (*this)["ambientcube.eval"];
  for (const char* key : {"n", "n2"})
    EXPECT_NEAR(blended(cube["scene"]["c"], cubeWeights(vec(cube["scene"][key]))),
                cube["expected"][key].get<double>(), 1e-6);

  const Json& dice = (*this)["ambientdice.eval"];
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_LT(glm::length(kDice[i] - vec(dice["scene"]["vertices"][i])), 1e-6f) << i;
  const auto weights = diceWeights(vec(dice["scene"]["n"]));
  EXPECT_NEAR(blended(dice["scene"]["values"], weights), dice["expected"]["value"].get<double>(), 1e-6);
  EXPECT_NEAR(blended(Json(std::vector<double>(12, 1.0)), weights), dice["expected"]["ones"].get<double>(),
              1e-6);
}

TEST_F(OracleCases, AmbientHighlightDirection) {
  const Json& c = (*this)["ahd.eval"];
  const Vec3 d = vec(c["scene"]["d"]);
  const float ambient = c["scene"]["ambient"].get<float>(), direct = c["scene"]["direct"].get<float>();
  const std::vector<float> coefficients = {ambient, ambient, ambient, direct, direct, direct, d.x, d.y, d.z};
  const Irradiance e =
      makeBasis("ahd")->irradiance(Receiver(Normal(0, 0, 1)), coefficients, vec(c["scene"]["n"]));
  EXPECT_NEAR(static_cast<double>(e.rgb.x), c["expected"].get<double>(), 1e-6);
}

TEST_F(OracleCases, SphericalGaussians) {
  for (int i = 0; i < 5; ++i) {
    const Json& c = (*this)["sg.integrals." + std::to_string(i)];
    const float s = c["scene"]["sharpness"].get<float>();
    const float cosine = std::cos(glm::radians(c["scene"]["angle_deg"].get<float>()));
    EXPECT_NEAR(static_cast<double>(cosineIntegral(s, cosine)), c["expected"]["cosine"].get<double>(), 1e-5);
    EXPECT_NEAR(static_cast<double>(hemisphereIntegral(s, cosine)), c["expected"]["hemi"].get<double>(),
                1e-5);
    EXPECT_NEAR(static_cast<double>(integral(Gaussian{{0, 0, 1}, s, 1})),
                c["expected"]["sphere"].get<double>(), 1e-5);
  }
  const Json& c = (*this)["sg.product"];
  const Json& s = c["scene"];
  const Gaussian g = product({vec(s["mu1"]), s["l1"].get<float>(), s["a1"].get<float>()},
                             {vec(s["mu2"]), s["l2"].get<float>(), s["a2"].get<float>()});
  EXPECT_LT(glm::length(g.axis - vec(c["expected"]["axis"])), 1e-6f);
  EXPECT_NEAR(static_cast<double>(g.sharpness), c["expected"]["sharpness"].get<double>(), 1e-5);
  EXPECT_NEAR(static_cast<double>(g.amplitude), c["expected"]["amplitude"].get<double>(), 1e-5);
  EXPECT_NEAR(static_cast<double>(integral(g)), c["expected"]["integral"].get<double>(), 1e-5);
}

/// A lamp over a surface, its light shared among directions by a fine grid over the lamp.
TEST_F(OracleCases, DirectionBins) {
  const Json& c = (*this)["dlm.bins"];
  std::vector<Direction> set;
  for (const Json& d : c["scene"]["directions"]) set.push_back(vec(d));
  const Json& lamp = c["scene"]["primitives"][0];
  const glm::dvec3 p(vec(lamp["p"])), e1(vec(lamp["e1"])), e2(vec(lamp["e2"]));
  const glm::dvec3 area = glm::cross(e1, e2);
  const Normal n(0, 0, 1);
  constexpr int kGrid = 1200;
  std::vector<double> e(set.size(), 0.0);
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j) {
      const glm::dvec3 at = p + e1 * ((i + 0.5) / kGrid) + e2 * ((j + 0.5) / kGrid);
      const double r2 = glm::dot(at, at);
      const glm::dvec3 d = at / std::sqrt(r2);
      if (d.z <= 0) continue;
      e[nearestFacing(set, Vec3(d), n)] +=
          lamp["emission"].get<double>() * d.z * std::abs(glm::dot(area, d)) / r2 / kGrid / kGrid;
    }
  const double k_max = c["scene"]["kmax"].get<double>();
  double total = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    total += e[i];
    EXPECT_NEAR(e[i], c["expected"]["E"][i].get<double>(), 3e-4) << i;
    if (set[i].z <= kFacing) continue;
    const double m = e[i] / static_cast<double>(set[i].z);
    EXPECT_NEAR(m, c["expected"]["m"][i].get<double>(), 3e-4) << i;
    EXPECT_NEAR(static_cast<double>(texelOf(static_cast<float>(m), static_cast<float>(k_max))),
                c["expected"]["t"][i].get<double>(), 3e-4);
  }
  EXPECT_NEAR(total, c["expected"]["total"].get<double>(), 3.5e-5);
}

}  // namespace
}  // namespace relume::basis
