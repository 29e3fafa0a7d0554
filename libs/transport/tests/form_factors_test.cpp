// SPDX-License-Identifier: MIT
// Form factors against closed forms [Howell C-11, C-14, C-41], and against what holds for all of them.
#include "radiosity/form_factors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patched_scene.h"
#include "radiosity/hemicube.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

scene::Scene two(scene::Mesh a, scene::Mesh b) {
  scene::Scene scene;
  made::addInstance(scene, std::move(a));
  made::addInstance(scene, std::move(b));
  return scene;
}

scene::Mesh quad(Point p, Vec3 e1, Vec3 e2) {
  scene::Mesh mesh;
  made::addQuad(mesh, p, e1, e2);
  return mesh;
}

scene::Mesh disk(float radius, float z, bool up) {
  constexpr std::uint32_t kSides = 512;
  scene::Mesh mesh;
  mesh.positions.emplace_back(0, 0, z);
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double phi = 2.0 * M_PI * i / kSides;
    mesh.positions.push_back({radius * std::cos(phi), radius * std::sin(phi), z});
    const std::uint32_t here = 1 + i, next = 1 + (i + 1) % kSides;
    mesh.triangles.emplace_back(0, up ? here : next, up ? next : here);
  }
  mesh.normals.resize(mesh.positions.size(), Normal(0, 0, up ? 1 : -1));
  return mesh;
}

struct Case {
  const char* name;
  scene::Scene scene;
  double expected;  // from the first to the second
};

std::vector<Case> closedForms() {
  std::vector<Case> cases;
  cases.push_back({"parallel",
                   two(quad({0, 0, 0}, {1, 0, 0}, {0, 2, 0}), quad({0, 0, 1.5f}, {0, 2, 0}, {1, 0, 0})),
                   0.1759349281545157});
  cases.push_back({"perpendicular",
                   two(quad({0, 0, 0}, {1, 0, 0}, {0, 2, 0}), quad({0, 0, 0}, {0, 2, 0}, {0, 0, 1.5f})),
                   0.27488497202751844});
  cases.push_back({"disks", two(disk(0.5f, 0, true), disk(1, 0.8f, false)), 0.5724464151007544});
  return cases;
}

TEST(FormFactors, SampledAreTheClosedForms) {
  for (Case& c : closedForms()) {
    SCOPED_TRACE(c.name);
    const made::Patched pair(std::move(c.scene), 32);
    const Patches patches = pair.patches(4);
    const FormFactors factors = pair.sampled(patches, 4096);
    EXPECT_NEAR(pair.between(patches, factors, 0, 1), c.expected, 1.5e-3 * c.expected);
    // The whole of each as one patch is no different: rays start all over it.
    const Patches whole = pair.patches(64);
    EXPECT_NEAR(pair.between(whole, pair.sampled(whole, 65536), 0, 1), c.expected, 1.5e-3 * c.expected);
  }
}

TEST(FormFactors, ByHemicubeAreTheClosedFormsWherePatchesAreSmall) {
  // Seen from the middles of patches. Those along the common edge see the other side worst.
  for (Case& c : closedForms()) {
    SCOPED_TRACE(c.name);
    const made::Patched pair(std::move(c.scene), 32);
    const Patches patches = pair.patches(2);
    EXPECT_NEAR(pair.between(patches, pair.byHemicube(patches, 64), 0, 1), c.expected, 5e-3 * c.expected);
  }
}

TEST(FormFactors, OfAClosedRoomSumToOneAndAreReciprocal) {
  // Rays of every patch end on patches, all of them. Reciprocity is not built in: both sides are sampled.
  const made::Patched room(made::box({4, 3, 2.5f}, Vec3(0.5f), Vec3(0)));
  const Patches patches = room.patches(2);
  const auto check = [&](const FormFactors& factors, double tolerance) {
    for (std::uint32_t i = 0; i < patches.size(); ++i) EXPECT_NEAR(factors.sum(i), 1.0, 1e-6) << i;
    for (std::uint32_t a = 0; a < 6; ++a)
      for (std::uint32_t b = 0; b < a; ++b) {
        const double area_a = a < 2 ? 7.5 : a < 4 ? 10 : 12, area_b = b < 2 ? 7.5 : b < 4 ? 10 : 12;
        const double there = area_a * room.between(patches, factors, a, b),
                     back = area_b * room.between(patches, factors, b, a);
        EXPECT_NEAR(there, back, tolerance * there) << a << " and " << b;
      }
  };
  check(room.sampled(patches, 1024), 5e-3);
  check(room.byHemicube(patches, 32), 2e-2);
}

TEST(FormFactors, OfAnOpenSceneSumToLessAndBacksBringNothing) {
  const made::Patched floor(two(quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), quad({0, 0, 1}, {1, 0, 0}, {0, 1, 0})),
                            16);
  const Patches patches = floor.patches(4);
  const FormFactors factors = floor.sampled(patches, 256), cubes = floor.byHemicube(patches, 16);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    EXPECT_EQ(factors.sum(i), 0.0);
    EXPECT_EQ(cubes.sum(i), 0.0);
  }
}

TEST(FormFactors, AHemicubesPixelsAreExact) {
  for (const std::uint32_t resolution : {8u, 32u, 64u}) {
    const std::vector<HemicubePixel> pixels = hemicube(resolution);
    ASSERT_EQ(pixels.size(), 3 * resolution * resolution);
    double sum = 0, top = 0, moment = 0;
    for (const HemicubePixel& p : pixels) {
      const auto f = static_cast<double>(p.form_factor);
      sum += f;
      if (std::max(std::abs(p.direction.x), std::abs(p.direction.y)) < p.direction.z) top += f;
      moment += f * static_cast<double>(p.direction.z);
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
    // The square opposite at distance 1 with sides 2 [Howell B-4]: 4 / pi * sqrt(1/2) * atan(sqrt(1/2)).
    EXPECT_NEAR(top, 4 / M_PI * std::sqrt(0.5) * std::atan(std::sqrt(0.5)) * 1.0, 1e-6);
    // The mean cosine of cosine-weighted directions is 2/3.
    EXPECT_NEAR(moment, 2.0 / 3, 3.0 / (resolution * resolution));
  }
}

TEST(FormFactors, MergedAreThoseOfLargerPatches) {
  const made::Patched room(made::colouredRoom(true), 32);
  const Patches fine = room.patches(4), coarse = room.patches(8);
  const Parents parents = parentsOf(fine);
  const FormFactors merged = mergedFormFactors(room.sampled(fine, 1024), fine, parents);
  const FormFactors own = room.sampled(coarse, 4096);
  for (std::uint32_t i = 0; i < fine.size(); ++i) {
    const std::uint32_t parent = parents.of[i], same = coarse.patch_of[fine.membersOf(i)[0]];
    EXPECT_NEAR(merged.sum(parent), own.sum(same), 1e-3);
  }
}

TEST(FormFactors, BitsDoNotDependOnThreads) {
  const made::Patched room(made::colouredRoom(true), 32);
  const Patches patches = room.patches(4);
  const auto same = [&](const FormFactors& a, const FormFactors& b) {
    for (std::size_t i = 0; i < patches.size(); ++i) {
      ASSERT_EQ(a.row(i).size(), b.row(i).size());
      for (std::size_t k = 0; k < a.row(i).size(); ++k) {
        EXPECT_EQ(a.row(i)[k].patch, b.row(i)[k].patch);
        EXPECT_EQ(a.row(i)[k].value, b.row(i)[k].value);
      }
    }
  };
  const FormFactors sampled = room.sampled(patches, 256), cubes = room.byHemicube(patches, 16);
  const ThreadLimit limit(1);
  same(sampled, room.sampled(patches, 256));
  same(cubes, room.byHemicube(patches, 16));
}

}  // namespace
}  // namespace relume::transport
