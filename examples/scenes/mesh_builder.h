// SPDX-License-Identifier: MIT
// Collects faces of a mesh in double precision and turns them into indexed triangles with creased normals.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "relume/core/vec.h"

namespace relume::scenes {

using P2 = glm::dvec2;
using P3 = glm::dvec3;
using M4 = glm::dmat4;

inline constexpr double kTau = 6.283185307179586476925;

/// One glTF primitive: indexed triangles of one material.
struct Primitive {
  std::uint32_t material = 0;
  std::vector<Point> positions;
  std::vector<Normal> normals;
  std::vector<Vec2> uv;  ///< per vertex, or empty
  std::vector<UVec3> triangles;
};

/// Faces in metres, counter-clockwise from outside. Vertices need not be shared: `primitives` welds them by
/// position.
class MeshBuilder {
 public:
  using UvOf = std::function<P2(P3)>;

  /// Material of the faces that follow.
  void material(std::uint32_t m) { material_ = m; }
  /// Texture coordinates of the faces that follow, from their position as given; an empty function: none.
  void uv(UvOf of) { uv_ = std::move(of); }

  void triangle(P3 a, P3 b, P3 c);
  /// Split along the shorter diagonal. Corners may coincide: what has no area is left out.
  void quad(P3 a, P3 b, P3 c, P3 d);
  /// Convex polygon in a plane, as a fan.
  void polygon(const std::vector<P3>& corners);
  /// (rows x columns) quads of the surface p(i, j), 0 <= i <= rows, 0 <= j <= columns; outside is dp/dj x
  /// dp/di.
  void grid(int rows, int columns, const std::function<P3(int, int)>& p);
  /// Quads between two polylines of equal length: outside is (b - a) x (direction of a), reversed by `flip`.
  void strip(const std::vector<P3>& a, const std::vector<P3>& b, bool flip = false);
  /// All faces of another mesh, moved; a mirroring matrix keeps the outside outside. Materials and uv stay
  /// the other's.
  void append(const MeshBuilder& other, const M4& move = M4(1.0));

  std::size_t triangleCount() const { return faces_.size(); }

  /// Welds corners on a grid of 2^-14 m, leaves out triangles without area, and gives each corner the
  /// angle-weighted mean normal of the faces around it that lie within `crease_deg` of its own. Sorted by
  /// material; same faces, same bytes.
  std::vector<Primitive> primitives(double crease_deg) const;

 private:
  struct Face {
    std::array<P3, 3> p;
    std::array<P2, 3> uv;
    std::uint32_t material;
    bool has_uv;
  };
  std::vector<Face> faces_;
  std::uint32_t material_ = 0;
  UvOf uv_;
};

}  // namespace relume::scenes
