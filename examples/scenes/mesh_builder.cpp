// SPDX-License-Identifier: MIT
// Creased normals: the normal of face f at its corner v is normalize(sum of alpha_g n_g), over the faces g
// around v (welded by position) with n_g . n_f >= cos(crease), alpha_g being g's angle at v [Thuermer,
// Wuethrich, Computing vertex normals from polygonal facets, 1998]. Positions and normals are rounded to
// fixed binary grids, so that the last bit of a library's sine does not reach the file.
#include "mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "relume/core/check.h"

namespace relume::scenes {
namespace {

constexpr double kPositionGrid = 16384.0;  // 2^-14 m = 0.06 mm
constexpr double kNormalGrid = 4096.0;
constexpr double kUvGrid = 65536.0;
constexpr double kSmallestArea = 2e-8;  // m^2: a sliver of rounding

P3 snap(P3 p) { return glm::round(p * kPositionGrid) / kPositionGrid + P3(0.0); }  // + 0: no negative zero

double angleAt(P3 v, P3 a, P3 b) {
  return std::acos(std::clamp(glm::dot(glm::normalize(a - v), glm::normalize(b - v)), -1.0, 1.0));
}

using Key3 = std::array<double, 3>;
Key3 key(P3 p) { return {p.x, p.y, p.z}; }

}  // namespace

void MeshBuilder::triangle(P3 a, P3 b, P3 c) {
  Face f{{a, b, c}, {}, material_, bool(uv_)};
  if (uv_) f.uv = {uv_(a), uv_(b), uv_(c)};
  for (P3& p : f.p) p = snap(p);
  if (glm::length(glm::cross(f.p[1] - f.p[0], f.p[2] - f.p[0])) < 2 * kSmallestArea) return;
  faces_.push_back(f);
}

void MeshBuilder::quad(P3 a, P3 b, P3 c, P3 d) {
  if (glm::distance(a, c) <= glm::distance(b, d) + 1e-9) {
    triangle(a, b, c), triangle(a, c, d);
  } else {
    triangle(a, b, d), triangle(b, c, d);
  }
}

void MeshBuilder::polygon(const std::vector<P3>& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) triangle(corners[0], corners[i - 1], corners[i]);
}

void MeshBuilder::grid(int rows, int columns, const std::function<P3(int, int)>& p) {
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) quad(p(i, j), p(i, j + 1), p(i + 1, j + 1), p(i + 1, j));
}

void MeshBuilder::strip(const std::vector<P3>& a, const std::vector<P3>& b, bool flip) {
  RELUME_CHECK_EQ(a.size(), b.size());
  for (std::size_t i = 1; i < a.size(); ++i) {
    if (flip) {
      quad(a[i - 1], a[i], b[i], b[i - 1]);
    } else {
      quad(a[i - 1], b[i - 1], b[i], a[i]);
    }
  }
}

void MeshBuilder::append(const MeshBuilder& other, const M4& move) {
  const bool mirrored = glm::determinant(glm::dmat3(move)) < 0;
  for (Face f : other.faces_) {
    for (P3& p : f.p) p = snap(P3(move * glm::dvec4(p, 1.0)));
    if (mirrored) std::swap(f.p[1], f.p[2]), std::swap(f.uv[1], f.uv[2]);
    faces_.push_back(f);
  }
}

std::vector<Primitive> MeshBuilder::primitives(double crease_deg) const {
  const double cos_crease = std::cos(crease_deg * kTau / 360.0);
  std::vector<P3> face_normal(faces_.size());
  std::map<Key3, std::vector<std::pair<std::uint32_t, double>>>
      around;  // welded position -> (face, angle there)
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    const auto& p = faces_[f].p;
    face_normal[f] = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    for (int k = 0; k < 3; ++k)
      around[key(p[k])].push_back({f, angleAt(p[k], p[(k + 1) % 3], p[(k + 2) % 3])});
  }

  std::map<std::uint32_t, Primitive> parts;
  using VertexKey = std::tuple<std::uint32_t, Key3, Key3, double, double>;
  std::map<VertexKey, std::uint32_t> vertices;
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    Primitive& part = parts[face.material];
    part.material = face.material;
    UVec3 corner;
    for (int k = 0; k < 3; ++k) {
      P3 n(0.0);
      for (const auto& [g, angle] : around[key(face.p[k])])
        if (glm::dot(face_normal[g], face_normal[f]) >= cos_crease) n += angle * face_normal[g];
      n = glm::round(glm::normalize(n) * kNormalGrid) / kNormalGrid + P3(0.0);
      const P2 t = glm::round(face.uv[k] * kUvGrid) / kUvGrid + P2(0.0);
      const auto [at, is_new] = vertices.try_emplace(
          VertexKey{face.material, key(face.p[k]), key(n), t.x, t.y}, std::uint32_t(part.positions.size()));
      if (is_new) {
        part.positions.push_back(Point(face.p[k]));
        part.normals.push_back(Normal(n));
        if (face.has_uv) part.uv.push_back(Vec2(t));
      }
      corner[k] = at->second;
    }
    part.triangles.push_back(corner);
  }

  std::vector<Primitive> out;
  for (auto& [material, part] : parts) {
    RELUME_CHECK(part.uv.empty() || part.uv.size() == part.positions.size());
    out.push_back(std::move(part));
  }
  return out;
}

}  // namespace relume::scenes
