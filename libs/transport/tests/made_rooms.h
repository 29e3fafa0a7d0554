// SPDX-License-Identifier: MIT
// Rooms and cavities whose light is known.
#pragma once
#include <tuple>

#include "made_scenes.h"

namespace relume::transport::made {

/// A box seen from within: six faces, each its own material.
inline void addRoomFace(scene::Scene& scene, Vec3 albedo, Point p, Vec3 e1, Vec3 e2,
                        Vec3 emission = Vec3(0)) {
  addMaterial(scene, albedo).emission = emission;
  scene::Mesh mesh;
  addQuad(mesh, p, e1, e2);
  addInstance(scene, std::move(mesh), static_cast<std::uint32_t>(scene.materials.size()) - 1);
}

inline scene::Scene box(Vec3 size, Vec3 albedo, Vec3 emission) {
  scene::Scene scene;
  const Vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  for (const auto& [p, e1, e2] :
       {std::tuple{Point(0), y, z}, std::tuple{Point(x), z, y}, std::tuple{Point(0), z, x},
        std::tuple{Point(y), x, z}, std::tuple{Point(0), x, y}, std::tuple{Point(z), y, x}})
    addRoomFace(scene, albedo, p, e1, e2, emission);
  return scene;
}

/// The 2 m room: red and green walls at x = 0 and 2, a lamp in the ceiling, perhaps a block.
inline scene::Scene colouredRoom(bool block) {
  scene::Scene scene;
  const Vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), white(0.725f, 0.71f, 0.68f);
  addRoomFace(scene, {0.63f, 0.065f, 0.05f}, Point(0), y, z);
  addRoomFace(scene, {0.14f, 0.45f, 0.09f}, x, z, y);
  addRoomFace(scene, white, Point(0), z, x);
  addRoomFace(scene, white, y, x, z);
  addRoomFace(scene, white, Point(0), x, y);
  // The ceiling around the lamp.
  const auto ceiling = [&](float x0, float x1, float y0, float y1, Vec3 albedo, Vec3 emission) {
    addRoomFace(scene, albedo, {x0, y0, 2}, {0, y1 - y0, 0}, {x1 - x0, 0, 0}, emission);
  };
  ceiling(0, 2, 0, 0.75f, white, Vec3(0)), ceiling(0, 2, 1.25f, 2, white, Vec3(0));
  ceiling(0, 0.75f, 0.75f, 1.25f, white, Vec3(0)), ceiling(1.25f, 2, 0.75f, 1.25f, white, Vec3(0));
  ceiling(0.75f, 1.25f, 0.75f, 1.25f, Vec3(0), {17, 12, 4});
  if (block) {
    addMaterial(scene, white);
    scene::Mesh mesh;
    addBox(mesh, {0.35f, 1.0f, 0}, {0.95f, 1.6f, 1.2f});
    addInstance(scene, std::move(mesh), static_cast<std::uint32_t>(scene.materials.size()) - 1);
  }
  return scene;
}

/// E in the room without the block.
struct RoomCase {
  Point p;
  Normal n;
  glm::dvec3 direct, total;
};
inline const RoomCase kColouredRoom[] = {
    {{1, 1, 0}, {0, 0, 1}, {1.04083794, 0.73470913, 0.24490304}, {1.81553064, 1.15647503, 0.33666522}},
    {{0.3f, 0.4f, 0}, {0, 0, 1}, {0.71681264, 0.50598540, 0.16866180}, {1.53281411, 0.83894002, 0.24763873}},
    {{0, 1, 1}, {1, 0, 0}, {1.03933311, 0.73364690, 0.24454897}, {1.84927348, 1.28535091, 0.37032909}},
    {{2, 0.6f, 1.5f}, {-1, 0, 0}, {1.09853639, 0.77543745, 0.25847915}, {2.00218667, 1.22754678, 0.37321879}},
    {{1, 2, 0.5f}, {0, -1, 0}, {0.58701426, 0.41436301, 0.13812100}, {1.45483491, 0.90399898, 0.25304562}},
    {{0.3f, 1, 2}, {0, 0, -1}, {0, 0, 0}, {1.00965678, 0.41351443, 0.10331405}}};

inline scene::Scene floor(float z = -1) {
  scene::Mesh mesh;
  addQuad(mesh, {-50, -50, z}, {100, 0, 0}, {0, 100, 0});
  return sceneOf(std::move(mesh));
}

/// The inside of a sphere of `radius` without the part within `cap` radians of +z.
inline scene::Scene cavity(float radius, float cap, Vec3 albedo) {
  constexpr std::uint32_t kRows = 96, kColumns = 192;
  scene::Mesh mesh;
  for (std::uint32_t i = 0; i <= kRows; ++i)
    for (std::uint32_t j = 0; j <= kColumns; ++j) {
      const double theta = cap + (M_PI - cap) * i / kRows, phi = 2 * M_PI * (j % kColumns) / kColumns;
      mesh.positions.push_back(
          radius * Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  for (std::uint32_t i = 0; i < kRows; ++i)
    for (std::uint32_t j = 0; j < kColumns; ++j) {
      const std::uint32_t a = i * (kColumns + 1) + j, b = a + kColumns + 1;
      if (i + 1 < kRows) mesh.triangles.emplace_back(a, b + 1, b);
      if (i > 0 || cap > 0) mesh.triangles.emplace_back(a, a + 1, b + 1);
    }
  mesh.flat_normals = true;
  mesh.normals.assign(mesh.positions.size(), Normal(0, 0, 1));
  scene::Scene scene = sceneOf(std::move(mesh));
  scene.materials[0].base_colour = Vec4(albedo, 1);
  return scene;
}

/// A lamp and a plate in a room; walls that face outwards are met from behind, and light goes on from there.
inline scene::Scene roomOfWalls(bool outwards) {
  scene::Scene scene;
  scene::Mesh walls, plate;
  addBox(walls, {-2, -2, 0}, {2, 2, 3});
  if (!outwards) {
    for (UVec3& t : walls.triangles) std::swap(t.y, t.z);
    for (Normal& n : walls.normals) n = -n;
  }
  addInstance(scene, std::move(walls));
  addQuad(plate, {-0.5f, -0.5f, 1}, {1, 0, 0}, {0, 1, 0});
  addInstance(scene, std::move(plate));
  scene.materials[0].base_colour = Vec4(0.5f, 0.5f, 0.5f, 1);
  Light& light = scene.lights.emplace_back();
  light.position = {0.3f, 0.2f, 2}, light.intensity = 10;
  return scene;
}

}  // namespace relume::transport::made
