// SPDX-License-Identifier: MIT
// Lightmaps where light is prone to leak and rims to darken: a thin wall, a sheet, bodies that stand on, over
// and in a floor, a lamp in its shade. Truth is path-traced at places that can be seen; which these are is
// told by the scene's coordinates, not by the solver.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "lit_scene.h"
#include "made_scenes.h"
#include "relume/core/sampling.h"
#include "relume/transport/reference.h"

namespace relume::transport {
namespace {

using made::Lit;

constexpr float kBuried = 0.25f;  // share of backs from which a texel is left to its neighbours

/// A box seen from within, one mesh: floor, ceiling and walls run through.
void addShell(scene::Scene& scene, Point lo, Point hi) {
  scene::Mesh mesh;
  made::addBox(mesh, lo, hi);
  for (UVec3& t : mesh.triangles) std::swap(t.y, t.z);
  for (Normal& n : mesh.normals) n = -n;
  made::addInstance(scene, std::move(mesh));
  scene.materials[0].base_colour = Vec4(0.75f, 0.75f, 0.75f, 1);
}

/// Shines downwards.
void addPanel(scene::Scene& scene, Point middle, float half) {
  made::addMaterial(scene, Vec3(0)).emission = Vec3(20);
  scene::Mesh mesh;
  made::addQuad(mesh, middle - Vec3(half, half, 0), {0, 2 * half, 0}, {2 * half, 0, 0});
  made::addInstance(scene, std::move(mesh), static_cast<std::uint32_t>(scene.materials.size()) - 1);
}

LightmapOptions options() {
  return {.materials = Materials::kLambert, .min_samples = 64, .max_samples = 64, .cache_samples = 16};
}

/// Truth of a texel: mean over the places of its footprint that `seen` names; and how many these are.
struct Truth {
  float value = 0;
  std::uint32_t places = 0;
};
Truth truthOf(const Lit& lit, const Reference& reference, const atlas::SurfacePoint& point,
              const std::function<bool(Point)>& seen) {
  constexpr std::uint32_t kPlaces = 16;
  std::vector<Receiver> receivers;
  for (std::uint32_t i = 0; i < kPlaces; ++i) {
    const Point p = atlas::footprintPosition(lit.texels, point, sobol2(i, 1));
    if (seen(p)) receivers.push_back({p, point.geometric_normal, point.shading_normal});
  }
  Truth truth{.places = static_cast<std::uint32_t>(receivers.size())};
  if (receivers.empty()) return truth;
  SilentProgress silent;
  const auto found =
      reference.irradiance(receivers, {.samples = 64, .materials = Materials::kLambert}, silent);
  for (const Irradiance& e : found.value) truth.value += luminance(e.rgb) / static_cast<float>(truth.places);
  return truth;
}

/// Texels of an instance near `where`, each against the truth: RMS and mean of the relative differences.
struct Rim {
  double rms = 0, mean = 0, worst = 0;
  int texels = 0;
};
Rim compareRim(const Lit& lit, const LightmapResult& e,
               const std::function<bool(const atlas::SurfacePoint&)>& where,
               const std::function<bool(Point)>& seen) {
  const Reference reference(lit.scene);
  Rim rim;
  for (std::size_t i = 0; i < e.value.size(); ++i) {
    const atlas::SurfacePoint& p = lit.texels.points[i];
    if (e.back_share[i] > kBuried || !where(p)) continue;
    const Truth truth = truthOf(lit, reference, p, seen);
    // What is all but covered holds its neighbours' light.
    if (truth.places < 3) continue;
    const double off = static_cast<double>(luminance(e.value[i].rgb) / truth.value - 1);
    rim.rms += off * off, rim.mean += off, rim.worst = std::max(rim.worst, std::abs(off)), ++rim.texels;
  }
  rim.rms = std::sqrt(rim.rms / rim.texels), rim.mean /= rim.texels;
  std::printf("%d texels: RMS %.2f %%, mean %+.2f %%, worst %.1f %%\n", rim.texels, 100 * rim.rms,
              100 * rim.mean, 100 * rim.worst);
  return rim;
}

TEST(Leaks, ThinWallsAndSheetsKeepRoomsDark) {
  // The lit room is that about x = 0. Left of it a wall of 2 cm, a fifth of a texel; right a sheet.
  scene::Scene scene;
  addShell(scene, {-2, -0.75f, 0}, {2, 0.75f, 1.5f});
  scene::Mesh wall, sheet;
  made::addQuad(wall, {-1.03f, -0.75f, 0}, {0, 0, 1.5f}, {0, 1.5f, 0});
  made::addQuad(wall, {-1.01f, -0.75f, 0}, {0, 1.5f, 0}, {0, 0, 1.5f});
  made::addInstance(scene, std::move(wall));
  made::addQuad(sheet, {1.03f, -0.75f, 0}, {0, 0, 1.5f}, {0, 1.5f, 0});
  made::addMaterial(scene, Vec3(0.75f)).double_sided = true;
  made::addInstance(scene, std::move(sheet), 1);
  addPanel(scene, {0, 0, 1.48f}, 0.3f);
  const Lit lit(std::move(scene), 96);
  for (const LightmapMethod method : {LightmapMethod::kGather, LightmapMethod::kPath}) {
    LightmapOptions how = options();
    how.method = method;
    if (method == LightmapMethod::kPath) how.min_samples = how.max_samples = 16;
    const LightmapResult e = lit.solve(how);
    double lit_sum = 0;
    int lit_count = 0, dark_count = 0, dark_valid = 0;
    float brightest = 0;
    for (std::size_t i = 0; i < e.value.size(); ++i) {
      const atlas::SurfacePoint& p = lit.texels.points[i];
      const float x = p.position.x, value = luminance(e.value[i].rgb);
      const bool in_shell = p.instance == 0;
      if (in_shell && std::abs(x) < 0.9f) lit_sum += static_cast<double>(value), ++lit_count;
      const bool dark =
          (in_shell && (x < -1.03f || x > 1.03f)) || (p.instance == 1 && p.geometric_normal.x < 0);
      if (!dark) continue;
      ++dark_count;
      if (e.back_share[i] > kBuried) continue;
      ++dark_valid;
      brightest = std::max(brightest, value);
    }
    const double mean = lit_sum / lit_count;
    EXPECT_GT(mean, 1);
    EXPECT_LT(brightest, 1e-3 * mean);
    // A room that sees the sheet from behind is no inside of a body: its own darkness counts.
    EXPECT_GT(dark_valid, 0.98 * dark_count);
  }
}

TEST(Leaks, NoRimAroundWhatStandsOnAFloor) {
  // On it with coinciding faces, 1 mm over it, 1 cm in it.
  struct Body {
    float x, bottom;
  };
  constexpr Body kBodies[] = {{-1.21f, 0}, {-0.13f, 0.001f}, {0.87f, -0.01f}};
  scene::Scene scene;
  addShell(scene, {-2, -1.5f, 0}, {2, 1.5f, 2.5f});
  for (const Body& b : kBodies) {
    scene::Mesh mesh;
    made::addBox(mesh, {b.x, 0.43f, b.bottom}, {b.x + 0.7f, 0.83f, 1.1f + b.bottom});
    made::addInstance(scene, std::move(mesh));
  }
  addPanel(scene, {0, -0.3f, 2.48f}, 0.3f);
  const auto beside = [&](Point p, float margin) {
    for (const Body& b : kBodies)
      if (p.x > b.x - margin && p.x < b.x + 0.7f + margin && p.y > 0.43f - margin && p.y < 0.83f + margin)
        return true;
    return false;
  };
  const Lit lit(std::move(scene), 128);
  const LightmapResult e = lit.solve(options());
  const Rim rim = compareRim(
      lit, e,
      [&](const atlas::SurfacePoint& p) {
        return p.instance == 0 && p.geometric_normal.z > 0.9f && beside(p.position, 0.1f);
      },
      [&](Point p) { return !beside(p, 0); });
  EXPECT_GT(rim.texels, 60);
  EXPECT_LT(rim.rms, 0.05);
  EXPECT_NEAR(rim.mean, 0, 0.02);
}

TEST(Leaks, NoRimWhereBodiesCross) {
  // A board leans through the floor, a box is sunk into it, turned against the texels.
  scene::Scene scene;
  addShell(scene, {-1.5f, -1.5f, 0}, {1.5f, 1.5f, 2.5f});
  scene::Mesh box, board;
  made::addBox(box, {-0.4f, -0.3f, -0.3f}, {0.4f, 0.3f, 0.5f});
  made::addBox(board, {-0.06f, -0.5f, -0.8f}, {0.06f, 0.5f, 0.8f});
  const auto turned = [](scene::Mesh& mesh, float about_z, float lean, Vec3 move) {
    const auto turn = [&](Vec3 v) {
      v = {v.x * std::cos(lean) + v.z * std::sin(lean), v.y, v.z * std::cos(lean) - v.x * std::sin(lean)};
      return Vec3(v.x * std::cos(about_z) - v.y * std::sin(about_z),
                  v.x * std::sin(about_z) + v.y * std::cos(about_z), v.z);
    };
    for (Point& p : mesh.positions) p = turn(p) + move;
    for (Normal& n : mesh.normals) n = turn(n);
  };
  turned(box, 0.4f, 0, {-0.4f, 0, 0}), turned(board, 0.7f, 0.5f, {0.3f, 0.2f, 0.4f});
  // Inside of a body whose faces are made of two triangles, a quad each.
  const auto within = [](const scene::Mesh& body, Point p, float margin) {
    for (std::size_t i = 0; i < body.positions.size(); i += 4)
      if (glm::dot(body.normals[i], p - body.positions[i]) > margin) return false;
    return true;
  };
  const scene::Mesh bodies[] = {box, board};
  const auto inside = [&](Point p, float margin) {
    return within(bodies[0], p, margin) || within(bodies[1], p, margin);
  };
  made::addInstance(scene, std::move(box)), made::addInstance(scene, std::move(board));
  addPanel(scene, {0.2f, -0.5f, 2.48f}, 0.3f);
  const Lit lit(std::move(scene), 128);
  const LightmapResult e = lit.solve(options());
  const Rim rim = compareRim(
      lit, e,
      [&](const atlas::SurfacePoint& p) {
        return p.instance == 0 && p.geometric_normal.z > 0.9f && inside(p.position, 0.08f);
      },
      [&](Point p) { return !inside(p, 0); });
  EXPECT_GT(rim.texels, 60);
  EXPECT_LT(rim.rms, 0.05);
  EXPECT_NEAR(rim.mean, 0, 0.02);
}

TEST(Leaks, AShadeIsBrightInsideAndDarkOutside) {
  // Four walls of 2 mm, open above and below; texels of 5 cm.
  scene::Scene scene;
  addShell(scene, {-1.2f, -1.2f, 0}, {1.2f, 1.2f, 2.4f});
  scene::Mesh shade, bulb;
  const auto walls = [&](float r, bool outwards) {
    const Vec3 up(0, 0, 0.3f);
    const Point a(-r, -r, 1), b(r, -r, 1), c(r, r, 1), d(-r, r, 1);
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}})
      outwards ? made::addQuad(shade, from, to - from, up) : made::addQuad(shade, from, up, to - from);
  };
  walls(0.15f, true), walls(0.148f, false);
  made::addInstance(scene, std::move(shade));
  made::addMaterial(scene, Vec3(0)).emission = Vec3(200);
  made::addSphere(bulb, {0, 0, 1.15f}, 0.04f, 12, 24);
  made::addInstance(scene, std::move(bulb), 1);
  const Lit lit(std::move(scene), 192);
  const LightmapResult e = lit.solve(options());
  std::vector<std::uint32_t> outer;
  double inner = 0, inner_count = 0;
  for (std::uint32_t i = 0; i < e.value.size(); ++i) {
    const atlas::SurfacePoint& p = lit.texels.points[i];
    if (p.instance != 1) continue;
    EXPECT_LE(e.back_share[i], kBuried);
    if (glm::dot(p.geometric_normal, Vec3(p.position.x, p.position.y, 0)) > 0) {
      outer.push_back(i);
    } else {
      inner += static_cast<double>(luminance(e.value[i].rgb)), ++inner_count;
    }
  }
  ASSERT_GT(outer.size(), 80u);
  LightmapOptions how = options();
  how.method = LightmapMethod::kPath;
  how.min_samples = how.max_samples = 512;
  const LightmapResult truth = lit.solve(how, outer);
  // Side by side: single texels of the truth are too noisy.
  for (const Vec3 side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
    double baked = 0, expected = 0, noise2 = 0, count = 0;
    for (std::size_t k = 0; k < outer.size(); ++k) {
      if (glm::dot(lit.texels.points[outer[k]].geometric_normal, side) < 0.9f) continue;
      baked += static_cast<double>(luminance(e.value[outer[k]].rgb));
      expected += static_cast<double>(luminance(truth.value[k].rgb));
      noise2 += static_cast<double>(truth.error[k]) * static_cast<double>(truth.error[k]), ++count;
    }
    std::printf("inside %.3g, outside %.4g, true %.4g +- %.2g\n", inner / inner_count, baked / count,
                expected / count, std::sqrt(noise2) / count);
    EXPECT_GT(inner / inner_count, 20 * baked / count);
    EXPECT_NEAR(baked, expected, 3 * std::sqrt(noise2) + 0.03 * expected);
  }
}

}  // namespace
}  // namespace relume::transport
