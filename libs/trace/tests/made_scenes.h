// SPDX-License-Identifier: MIT
// Scenes by code for the tests and benchmarks of the tracer.
#pragma once
#include <cmath>
#include <utility>

#include "relume/scene/scene.h"

namespace relume::trace::made {

inline void addQuad(scene::Mesh& mesh, Point p, Vec3 e1, Vec3 e2) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Point& corner : {p, p + e1, p + e1 + e2, p + e2}) {
    mesh.positions.push_back(corner);
    mesh.normals.push_back(glm::normalize(glm::cross(e1, e2)));
  }
  mesh.triangles.emplace_back(base, base + 1, base + 2);
  mesh.triangles.emplace_back(base, base + 2, base + 3);
}

/// Faces outwards; shared corners, so that edges are shared exactly.
inline scene::Mesh box(Point lo, Point hi) {
  scene::Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    mesh.normals.push_back(glm::normalize(mesh.positions.back() - 0.5f * (lo + hi)));
  }
  for (const auto& [a, b, c, d] : {std::array<std::uint32_t, 4>{0, 4, 6, 2},
                                   {1, 3, 7, 5},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 2, 3, 1},
                                   {4, 5, 7, 6}}) {
    mesh.triangles.emplace_back(a, b, c);
    mesh.triangles.emplace_back(a, c, d);
  }
  return mesh;
}

/// Latitude-longitude sphere, faces outwards, pole +z, with degenerate triangles left out.
inline scene::Mesh sphere(Point centre, float radius, std::uint32_t rows, std::uint32_t columns) {
  scene::Mesh mesh;
  for (std::uint32_t i = 0; i <= rows; ++i) {
    for (std::uint32_t j = 0; j <= columns; ++j) {
      const double theta = M_PI * i / rows, phi = 2.0 * M_PI * (j % columns) / columns;
      const Vec3 n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      mesh.positions.push_back(centre + radius * n);
      mesh.normals.push_back(n);
    }
  }
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t a = i * (columns + 1) + j, b = a + columns + 1;
      if (i + 1 < rows) mesh.triangles.emplace_back(a, b, b + 1);
      if (i > 0) mesh.triangles.emplace_back(a, b + 1, a + 1);
    }
  }
  return mesh;
}

inline scene::Material& addMaterial(scene::Scene& scene) { return scene.materials.emplace_back(); }

inline std::uint32_t addInstance(scene::Scene& scene, std::uint32_t mesh,
                                 const Mat4& world_from_local = Mat4(1.0f)) {
  scene::Instance& instance = scene.instances.emplace_back();
  instance.mesh = mesh, instance.world_from_local = world_from_local;
  return static_cast<std::uint32_t>(scene.instances.size() - 1);
}

inline std::uint32_t addMesh(scene::Scene& scene, scene::Mesh mesh, std::uint32_t material = 0) {
  if (scene.materials.empty()) addMaterial(scene);
  mesh.material = material;
  scene.meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

inline scene::Scene sceneOf(scene::Mesh mesh) {
  scene::Scene scene;
  addInstance(scene, addMesh(scene, std::move(mesh)));
  return scene;
}

/// Floor 20 x 20 m and a grid of round columns under a slab: a temple of about `triangles` triangles, one
/// mesh per part.
inline scene::Scene temple(std::size_t triangles) {
  scene::Scene scene;
  scene::Mesh floor;
  addQuad(floor, {-10, -10, 0}, {20, 0, 0}, {0, 20, 0});
  addInstance(scene, addMesh(scene, std::move(floor)));
  addInstance(scene, addMesh(scene, box({-10, -10, 4}, {10, 10, 4.5f})));
  const std::uint32_t side = 8, columns = 32;
  const auto rows = static_cast<std::uint32_t>(triangles / (side * side * 2 * columns));
  scene::Mesh shaft;
  for (std::uint32_t i = 0; i <= rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const float phi = 2.0f * kPi * static_cast<float>(j) / columns,
                  h = static_cast<float>(i) / static_cast<float>(rows);
      const float r = 0.45f - 0.1f * h + (j % 2 ? 0.0f : 0.02f);  // fluted, tapering
      shaft.positions.emplace_back(r * std::cos(phi), r * std::sin(phi), 4.0f * h);
      shaft.normals.emplace_back(std::cos(phi), std::sin(phi), 0.0f);
    }
  }
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t k = (j + 1) % columns;
      const std::uint32_t a = i * columns + j, b = i * columns + k, c = a + columns, d = b + columns;
      shaft.triangles.emplace_back(a, b, d);
      shaft.triangles.emplace_back(a, d, c);
    }
  }
  const std::uint32_t mesh = addMesh(scene, std::move(shaft));
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      Mat4 place(1.0f);
      place[3] =
          Vec4(-8.75f + 2.5f * static_cast<float>(x), -8.75f + 2.5f * static_cast<float>(y), 0.0f, 1.0f);
      addInstance(scene, mesh, place);
    }
  }
  return scene;
}

}  // namespace relume::trace::made
