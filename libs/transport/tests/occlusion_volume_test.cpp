// SPDX-License-Identifier: MIT
// Occlusion about a ball, which is known in closed form, and caps of directions by counting.
#include "relume/transport/occlusion_volume.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relume::transport {
namespace {

TEST(HiddenByCap, IsTheIntegralOverIt) {
  // A midpoint rule over the hemisphere: right to 0.002.
  constexpr int kRings = 400, kSectors = 400;
  for (const float share : {0.02f, 0.1f, 0.3f, 0.5f, 0.8f})
    for (const float cosine : {1.0f, 0.7f, 0.2f, 0.0f, -0.3f, -0.9f}) {
      const Direction axis(std::sqrt(1 - cosine * cosine), 0, cosine);
      double sum = 0;
      for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
          // Cosine-weighted: r^2 even, phi even.
          const double r2 = (i + 0.5) / kRings, phi = 2 * kPi * (j + 0.5) / kSectors;
          const double r = std::sqrt(r2);
          const Vec3 d(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r2));
          sum += glm::dot(d, axis) > 1 - 2 * share;
        }
      EXPECT_NEAR(hiddenByCap(share, cosine), sum / (kRings * kSectors), 0.003) << share << " " << cosine;
    }
}

scene::Scene ball() {
  constexpr int kRings = 32, kSectors = 64;
  scene::Scene scene;
  scene::Mesh mesh;
  for (int i = 0; i <= kRings; ++i)
    for (int j = 0; j <= kSectors; ++j) {
      const float theta = kPi * static_cast<float>(i) / kRings,
                  phi = 2 * kPi * static_cast<float>(j) / kSectors;
      mesh.positions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                  std::sin(theta) * std::sin(phi));
      if (i == kRings || j == kSectors) continue;
      const auto a = static_cast<std::uint32_t>(i * (kSectors + 1) + j), b = a + kSectors + 1;
      mesh.triangles.push_back({a, a + 1, b});
      mesh.triangles.push_back({b, a + 1, b + 1});
    }
  scene.meshes.push_back(mesh);
  scene.instances.push_back({});
  scene.materials.push_back({});
  return scene;
}

TEST(OcclusionVolume, OfABallIsThatOfItsSolidAngle) {
  const scene::Scene scene = ball();
  const trace::Tracer tracer(scene);
  const OcclusionVolume volume =
      occlusionVolume(tracer, {Point(-1), Point(1)}, {.side = 12, .reach = 1, .rays = 4096});
  EXPECT_EQ(volume.box.lo, Point(-3));
  ASSERT_EQ(volume.cells.size(), 12u * 12 * 12);
  for (int z = 0; z < 12; ++z)
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 12; ++x) {
        const Point p = Point(-3) + (Vec3(x, y, z) + 0.5f) * 0.5f;
        const float d = glm::length(p);
        const Vec4 cell = volume.cells[static_cast<std::size_t>((z * 12 + y) * 12 + x)];
        if (d < 1.05f) continue;
        ASSERT_NEAR(cell.w, 0.5f * (1 - std::sqrt(1 - 1 / (d * d))), 0.01f) << d;
        ASSERT_GT(glm::dot(Vec3(cell), -p / d), 0.995f);
      }
  // Inside all is hidden.
  EXPECT_EQ(volume.cells[(6 * 12 + 6) * 12 + 6].w, 1);
}

}  // namespace
}  // namespace relume::transport
