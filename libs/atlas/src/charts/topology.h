// SPDX-License-Identifier: MIT
// Which triangles of a mesh meet along which edges, by position: vertices that only normals or texture
// coordinates split count as one.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/scene/scene.h"

namespace relume::atlas {

using scene::kNone;

/// Half-edge h = 3 t + e runs from corner e of triangle t to corner (e + 1) % 3.
struct Topology {
  std::span<const UVec3> triangles;  ///< the mesh's
  std::vector<Vec3> position;        ///< per mesh vertex, after the metric
  std::vector<std::uint32_t> point;  ///< per mesh vertex: the first mesh vertex at its position
  std::vector<std::uint32_t> mate;   ///< per half-edge: the opposite half-edge of the neighbour, or kNone
  std::vector<Vec3> normal;          ///< per triangle, unit, by winding; zero where degenerate
  std::vector<float> area;           ///< per triangle; 0 where degenerate

  bool degenerate(std::uint32_t triangle) const { return area[triangle] == 0.0f; }
  std::uint32_t vertex(std::uint32_t half_edge) const {  ///< mesh vertex where a half-edge starts
    return triangles[half_edge / 3][static_cast<int>(half_edge % 3)];
  }
  std::uint32_t triangleCount() const { return static_cast<std::uint32_t>(area.size()); }
};

inline std::uint32_t nextHalfEdge(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline std::uint32_t previousHalfEdge(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// `metric` maps mesh space to the space in which angles and areas are measured; its determinant is positive.
/// At an edge of more than two triangles the pairs that meet most flatly are mates, so that the sides of a
/// two-sided sheet stay apart. Triangles that are wound against each other are never mates.
/// The mesh must outlive the result.
Topology connect(const scene::Mesh& mesh, const Mat3& metric);
Topology connect(scene::Mesh&& mesh, const Mat3& metric) = delete;

}  // namespace relume::atlas
