// SPDX-License-Identifier: MIT
#include "relume/basis/gaussian.h"

#include <gtest/gtest.h>

#include "relume/basis/glossy.h"
#include "skies.h"

namespace relume::basis {
namespace {

TEST(Gaussian, AlignedIntegralsAreTheClosedForms) {
  for (const double s : {0.5, 2.0, 9.0, 60.0}) {
    const auto sharpness = static_cast<float>(s);
    EXPECT_NEAR(static_cast<double>(integral(Gaussian{{0, 0, 1}, sharpness, 2})),
                4 * M_PI * (1 - std::exp(-2 * s)) / s, 1e-5 / s);
    const double cosine = 2 * M_PI * (1 / s - (1 - std::exp(-s)) / (s * s));
    EXPECT_NEAR(static_cast<double>(cosineIntegral(sharpness, 1)), cosine, 2e-6);
    const double half = 2 * M_PI * (1 - std::exp(-s)) / s;
    EXPECT_NEAR(static_cast<double>(hemisphereIntegral(sharpness, 1)), half, 2e-4);
  }
}

TEST(Gaussian, LeaningIntegralsAreSums) {
  const Gaussian g{glm::normalize(Vec3(0.8f, 0, 0.3f)), 5, 1};
  double cosine = 0, half = 0;
  for (const Direction d : sky::net())
    if (d.z > 0)
      half += static_cast<double>(g(d)) * sky::netWeight(),
          cosine += static_cast<double>(g(d) * d.z) * sky::netWeight();
  EXPECT_NEAR(static_cast<double>(cosineIntegral(5, g.axis.z)), cosine, 2e-4);
  EXPECT_NEAR(static_cast<double>(hemisphereIntegral(5, g.axis.z)), half, 2e-3);
}

TEST(Gaussian, ProductIsTheProductEverywhere) {
  const Gaussian a{{0, 0, 1}, 4, 1.5f}, b{{0.6f, 0, 0.8f}, 7, 2};
  const Gaussian both = product(a, b);
  for (const Direction d : sphericalFibonacci(50)) EXPECT_NEAR(both(d), a(d) * b(d), 1e-5f);
}

/// What a white sky shows in the lobe is its albedo, for Phong's up to what the horizon cuts off.
TEST(GlossyLobe, AlbedoIsTheIntegral) {
  const auto white = [](Direction) { return Vec3(1.0f); };
  const Normal n = glm::normalize(Vec3(0.2f, 0.9f, -0.3f));
  const Frame frame = tangentFrame(n);
  for (const float roughness : {0.3f, 0.5f, 0.8f})
    for (const float cosine : {1.0f, 0.7f, 0.4f}) {
      const Direction o = frame.toWorld({std::sqrt(1 - cosine * cosine), 0, cosine});
      for (const float f0 : {0.04f, 0.9f}) {
        const GlossyLobe lobe = GlossyLobe::ggx(n, o, roughness, Vec3(f0));
        EXPECT_NEAR(sky::glossy(white, lobe).x, lobe.albedo().x, 0.02f)
            << roughness << " " << cosine << " " << f0;
      }
    }
  const GlossyLobe phong = GlossyLobe::phong(n, n, 10, Vec3(0.5f));
  EXPECT_NEAR(sky::glossy(white, phong).x, 0.5f, 1e-3f);
}

TEST(GlossyLobe, ShapeHasIntegralOneAndLiesAlongTheMirrorDirection) {
  const Normal n(0, 0, 1);
  const Direction o = glm::normalize(Vec3(0.5f, 0, 1));
  const GlossyLobe lobe = GlossyLobe::ggx(n, o, 0.5f, Vec3(0.04f));
  EXPECT_NEAR(integral(lobe.shape()), 1, 1e-5f);
  EXPECT_NEAR(glm::dot(lobe.shape().axis, glm::normalize(Vec3(-0.5f, 0, 1))), 1, 1e-6f);
}

}  // namespace
}  // namespace relume::basis
