// SPDX-License-Identifier: MIT
// Meshes made by code, and scenes of them.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "relume/scene/scene.h"

namespace relume::atlas::test {

inline scene::Mesh emptyMesh(std::string name) {
  scene::Mesh mesh;
  mesh.name = std::move(name);
  return mesh;
}

inline std::uint32_t addVertex(scene::Mesh& mesh, Point p) {
  mesh.positions.push_back(p);
  mesh.normals.push_back({0, 1, 0});
  return static_cast<std::uint32_t>(mesh.positions.size()) - 1;
}

inline void addTriangle(scene::Mesh& mesh, Point a, Point b, Point c) {
  const std::uint32_t i = addVertex(mesh, a);
  addVertex(mesh, b);
  addVertex(mesh, c);
  mesh.triangles.push_back({i, i + 1, i + 2});
}

/// Its own four vertices, as where normals split them.
inline void addQuad(scene::Mesh& mesh, Point a, Point b, Point c, Point d) {
  const std::uint32_t i = addVertex(mesh, a);
  addVertex(mesh, b);
  addVertex(mesh, c);
  addVertex(mesh, d);
  mesh.triangles.push_back({i, i + 1, i + 2});
  mesh.triangles.push_back({i, i + 2, i + 3});
}

/// f maps [0, 1]^2 to space; vertices on closed borders are repeated, as in files with texture seams.
inline scene::Mesh sheet(std::string name, int columns, int rows,
                         const std::function<Point(float, float)>& f) {
  scene::Mesh mesh = emptyMesh(std::move(name));
  for (int y = 0; y <= rows; ++y) {
    for (int x = 0; x <= columns; ++x) {
      addVertex(mesh, f(static_cast<float>(x) / static_cast<float>(columns),
                        static_cast<float>(y) / static_cast<float>(rows)));
    }
  }
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return mesh;
}

/// Coordinates that close exactly: 0 and 1 give the same point.
inline Vec2 onCircle(float t) {
  const double angle = 2 * 3.14159265358979323846 * (t >= 1.0f ? 0.0 : double(t));
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

inline scene::Mesh grid(int n = 8, float size = 2) {
  return sheet("grid", n, n, [=](float u, float v) { return Point(size * u, 0, -size * v); });
}

inline scene::Mesh box(Point lo, Point hi, std::string name = "box") {
  scene::Mesh mesh = emptyMesh(std::move(name));
  const auto p = [&](int x, int y, int z) {
    return Point(x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z);
  };
  addQuad(mesh, p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
  addQuad(mesh, p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0));
  addQuad(mesh, p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1));
  addQuad(mesh, p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
  addQuad(mesh, p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0));
  addQuad(mesh, p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
  return mesh;
}
inline scene::Mesh cube(float size = 1) { return box(Point(0), Point(size), "cube"); }

inline void append(scene::Mesh& mesh, const scene::Mesh& other, bool inside_out = false) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  for (UVec3 t : other.triangles) {
    if (inside_out) std::swap(t.y, t.z);
    mesh.triangles.push_back(t + first);
  }
}

/// A room seen from inside, with boxes on its floor.
inline scene::Mesh room() {
  scene::Mesh mesh = emptyMesh("room");
  append(mesh, box({0, 0, 0}, {4, 2.5f, 6}), true);
  append(mesh, box({1, 0, 1}, {1.6f, 1.1f, 1.7f}));
  append(mesh, box({2.5f, 0, 3}, {3.5f, 0.4f, 5}));
  return mesh;
}

inline scene::Mesh icosphere(int levels, float radius = 1) {
  scene::Mesh mesh = emptyMesh("icosphere");
  const float g = 0.5f * (1 + std::sqrt(5.0f));
  for (const Point p : {Point(-1, g, 0), Point(1, g, 0), Point(-1, -g, 0), Point(1, -g, 0), Point(0, -1, g),
                        Point(0, 1, g), Point(0, -1, -g), Point(0, 1, -g), Point(g, 0, -1), Point(g, 0, 1),
                        Point(-g, 0, -1), Point(-g, 0, 1)}) {
    addVertex(mesh, radius * glm::normalize(p));
  }
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, fresh] = middle.try_emplace(std::minmax(a, b), 0);
      if (fresh) it->second = addVertex(mesh, radius * glm::normalize(mesh.positions[a] + mesh.positions[b]));
      return it->second;
    };
    std::vector<UVec3> finer;
    for (const UVec3 t : mesh.triangles) {
      const std::uint32_t a = between(t.x, t.y), b = between(t.y, t.z), c = between(t.z, t.x);
      finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

inline scene::Mesh torus(int around = 48, int across = 24, float large = 1, float small = 0.35f) {
  return sheet("torus", around, across, [=](float u, float v) {
    const Vec2 a = onCircle(u), b = onCircle(v);
    return Point((large + small * b.x) * a.x, small * b.y, -(large + small * b.x) * a.y);
  });
}

/// The mantle of a cylinder along y; `turn` in revolutions.
inline scene::Mesh cylinder(int around = 32, int along = 8, float radius = 0.5f, float height = 2,
                            float turn = 1) {
  return sheet("cylinder", around, along, [=](float u, float v) {
    const Vec2 c = onCircle(turn * u);
    return Point(radius * c.x, height * v, -radius * c.y);
  });
}

/// One quad with a second one on its back, sharing its vertices.
inline scene::Mesh twoSided() {
  scene::Mesh mesh = emptyMesh("two-sided");
  addQuad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  mesh.triangles.push_back({0, 2, 1});
  mesh.triangles.push_back({0, 3, 2});
  return mesh;
}

/// A flat ring of four bars, each of two triangles.
inline scene::Mesh frame(float outer = 4, float width = 0.2f) {
  scene::Mesh mesh = emptyMesh("frame");
  const float o = outer, i = outer - width, w = width;
  for (const Vec2 p :
       {Vec2(0, 0), Vec2(o, 0), Vec2(o, o), Vec2(0, o), Vec2(w, w), Vec2(i, w), Vec2(i, i), Vec2(w, i)}) {
    addVertex(mesh, {p.x, p.y, 0});
  }
  mesh.triangles = {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  return mesh;
}

/// A flat ribbon that winds twice about its axis while it rises: seen from above it covers itself.
inline scene::Mesh helix(int steps = 96) {
  return sheet("helix", 2, steps, [](float u, float v) {
    const Vec2 c = onCircle(2 * v < 1 ? 2 * v : 2 * v - 1);
    return Point((1 + u) * c.x, 0.3f * v, -(1 + u) * c.y);
  });
}

inline scene::Mesh bumps(int n = 64) {
  return sheet("bumps", n, n, [](float u, float v) {
    return Point(4 * u, 0.4f * std::sin(13 * u) * std::cos(11 * v) + 0.15f * std::sin(37 * u * v), -4 * v);
  });
}

inline scene::Mesh soup(int count, std::uint32_t seed) {
  scene::Mesh mesh = emptyMesh("soup");
  std::mt19937 random(seed);
  const auto number = [&] { return static_cast<float>(random() % 10000) * 1e-3f; };
  for (int i = 0; i < count; ++i) {
    const Point p(number(), number(), number());
    const auto near = [&] { return p + 0.1f * Point(number() - 5, number() - 5, number() - 5); };
    const Point a = near(), b = near();
    addTriangle(mesh, p, a, b);
  }
  return mesh;
}

/// A fan of sheets about one edge: non-manifold.
inline scene::Mesh book(int leaves = 5) {
  scene::Mesh mesh = emptyMesh("book");
  const std::uint32_t a = addVertex(mesh, {0, 0, 0}), b = addVertex(mesh, {0, 1, 0});
  for (int i = 0; i < leaves; ++i) {
    const float angle = 0.5f + 0.4f * static_cast<float>(i);
    const Point out(std::cos(angle), 0, std::sin(angle));
    const std::uint32_t c = addVertex(mesh, out), d = addVertex(mesh, out + Point(0, 1, 0));
    mesh.triangles.push_back({a, c, d});
    mesh.triangles.push_back({a, d, b});
  }
  return mesh;
}

inline scene::Scene sceneOf(std::vector<scene::Mesh> meshes) {
  scene::Scene scene;
  scene.name = "made.gltf";
  scene.materials.resize(1);
  for (std::uint32_t i = 0; i < meshes.size(); ++i) {
    scene::Instance instance;
    instance.name = "use of " + meshes[i].name;
    instance.mesh = i;
    scene.instances.push_back(instance);
  }
  scene.meshes = std::move(meshes);
  return scene;
}

inline scene::Instance& addUse(scene::Scene& scene, std::uint32_t mesh, const Mat4& world_from_local) {
  scene::Instance instance;
  instance.name = "use " + std::to_string(scene.instances.size());
  instance.mesh = mesh;
  instance.world_from_local = world_from_local;
  scene.instances.push_back(instance);
  return scene.instances.back();
}

}  // namespace relume::atlas::test
