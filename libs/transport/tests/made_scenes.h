// SPDX-License-Identifier: MIT
// Scenes and texels by code for the tests and benchmarks of transport. Receivers lie in the plane z = 0 and
// face +z, unless said.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/scene/scene.h"

namespace relume::transport::made {

inline void addQuad(scene::Mesh& mesh, Point p, Vec3 e1, Vec3 e2) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Point& corner : {p, p + e1, p + e1 + e2, p + e2}) {
    mesh.positions.push_back(corner);
    mesh.normals.push_back(glm::normalize(glm::cross(e1, e2)));
  }
  mesh.triangles.emplace_back(base, base + 1, base + 2);
  mesh.triangles.emplace_back(base, base + 2, base + 3);
}

/// Faces outwards.
inline void addBox(scene::Mesh& mesh, Point lo, Point hi) {
  const Vec3 x(hi.x - lo.x, 0, 0), y(0, hi.y - lo.y, 0), z(0, 0, hi.z - lo.z);
  addQuad(mesh, lo, z, y), addQuad(mesh, lo + x, y, z);
  addQuad(mesh, lo, x, z), addQuad(mesh, lo + y, z, x);
  addQuad(mesh, lo, y, x), addQuad(mesh, lo + z, x, y);
}

/// Latitude-longitude sphere, faces outwards.
inline void addSphere(scene::Mesh& mesh, Point centre, float radius, std::uint32_t rows,
                      std::uint32_t columns) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
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
      const std::uint32_t a = base + i * (columns + 1) + j, b = a + columns + 1;
      if (i + 1 < rows) mesh.triangles.emplace_back(a, b, b + 1);
      if (i > 0) mesh.triangles.emplace_back(a, b + 1, a + 1);
    }
  }
}

/// Parallel to the receivers, faces -z.
inline void addDisk(scene::Mesh& mesh, Point centre, float radius) {
  constexpr std::uint32_t kSides = 4096;
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back(centre);
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double phi = 2.0 * M_PI * i / kSides;
    mesh.positions.push_back(centre + radius * Vec3(std::cos(phi), std::sin(phi), 0));
    mesh.triangles.emplace_back(base, base + 1 + (i + 1) % kSides, base + 1 + i);
  }
  mesh.normals.resize(mesh.positions.size(), Normal(0, 0, -1));
}

inline scene::Material& addMaterial(scene::Scene& scene, Vec3 albedo = Vec3(1.0f)) {
  scene::Material& material = scene.materials.emplace_back();
  material.base_colour = Vec4(albedo, 1.0f), material.metallic = 0.0f;
  return material;
}

inline void addInstance(scene::Scene& scene, scene::Mesh mesh, std::uint32_t material = 0) {
  if (scene.materials.empty()) addMaterial(scene);
  mesh.material = material;
  scene.instances.emplace_back().mesh = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
}

inline scene::Scene sceneOf(scene::Mesh mesh) {
  scene::Scene scene;
  addInstance(scene, std::move(mesh));
  return scene;
}

/// A chart of width x height texels: the texel (x, y) is the parallelogram of dp_dx and dp_dy about corner +
/// (x + 1/2) dp_dx + (y + 1/2) dp_dy. Its instance is 0.
inline atlas::Texels texelGrid(int width, int height, Point corner, Vec3 dp_dx, Vec3 dp_dy,
                               Normal normal = {0, 0, 1}) {
  atlas::Texels texels;
  texels.width = width, texels.height = height, texels.pages = 1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      atlas::SurfacePoint& point = texels.points.emplace_back();
      point.texel = static_cast<std::uint32_t>(y * width + x);
      point.position =
          corner + (static_cast<float>(x) + 0.5f) * dp_dx + (static_cast<float>(y) + 0.5f) * dp_dy;
      point.geometric_normal = point.shading_normal = normal;
      point.dp_dx = dp_dx, point.dp_dy = dp_dy;
      point.area = glm::length(glm::cross(dp_dx, dp_dy));
    }
  }
  return texels;
}

/// `count` texels at one point: independent estimates of the same value.
inline atlas::Texels repeatedPoint(int count, Point p, Normal normal = {0, 0, 1}) {
  return texelGrid(std::min(count, 4), (count + 3) / 4, p, Vec3(0), Vec3(0),
                   normal);  // blocks: each sequence of a block in turn
}

/// Floor 20 x 20 m and an 8 x 8 grid of round columns under a slab: a temple of about `triangles` triangles.
inline scene::Scene temple(std::size_t triangles) {
  scene::Scene scene;
  scene::Mesh floor, slab, shaft;
  addQuad(floor, {-10, -10, 0}, {20, 0, 0}, {0, 20, 0});
  addInstance(scene, std::move(floor));
  addBox(slab, {-10, -10, 4}, {10, 10, 4.5f});
  addInstance(scene, std::move(slab));
  const std::uint32_t side = 8, columns = 32;
  const auto rows = static_cast<std::uint32_t>(triangles / (side * side * 2 * columns));
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
  const auto mesh = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(std::move(shaft));
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      scene::Instance& instance = scene.instances.emplace_back();
      instance.mesh = mesh;
      instance.world_from_local[3] =
          Vec4(-8.75f + 2.5f * static_cast<float>(x), -8.75f + 2.5f * static_cast<float>(y), 0.0f, 1.0f);
    }
  }
  return scene;
}

/// Two boxes in a 4 m room that is open at one side, in front of y = -2, about like the Cornell box.
inline scene::Scene room() {
  scene::Scene scene;
  scene::Mesh walls, boxes;
  addQuad(walls, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
  addQuad(walls, {-2, -2, 4}, {0, 4, 0}, {4, 0, 0});
  addQuad(walls, {-2, -2, 0}, {0, 4, 0}, {0, 0, 4});
  addQuad(walls, {2, -2, 0}, {0, 0, 4}, {0, 4, 0});
  addQuad(walls, {-2, 2, 0}, {4, 0, 0}, {0, 0, 4});
  addInstance(scene, std::move(walls));
  addBox(boxes, {-1, 0, 0}, {0, 1, 2.4f});
  addBox(boxes, {0.4f, -1, 0}, {1.4f, 0, 1.2f});
  addInstance(scene, std::move(boxes));
  return scene;
}

}  // namespace relume::transport::made
