// SPDX-License-Identifier: MIT
#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "relume/core/check.h"

namespace relume::scenes {

void box(MeshBuilder& mesh, P3 lo, P3 hi, double bevel, std::uint32_t without) {
  const P3 end[2] = {lo, hi};
  const auto present = [&](int axis, int side) { return !(without & (1u << (2 * axis + side))); };
  // The corner (s0, s1, s2) as seen on the face of `axis`: drawn in along the other axes where their faces
  // are there to bevel against.
  const auto corner = [&](const int s[3], int axis) {
    P3 p(end[s[0]].x, end[s[1]].y, end[s[2]].z);
    for (int other = 0; other < 3; ++other)
      if (other != axis && present(other, s[other]) && present(axis, s[axis]))
        p[other] += s[other] ? -bevel : bevel;
    return p;
  };
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    for (int side = 0; side < 2; ++side) {
      if (!present(a, side)) continue;
      P3 q[4];
      const int order[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      for (int k = 0; k < 4; ++k) {
        int s[3];
        s[a] = side, s[b] = order[k][0], s[c] = order[k][1];
        q[k] = corner(s, a);
      }
      if (side) {
        mesh.quad(q[0], q[1], q[2], q[3]);
      } else {
        mesh.quad(q[3], q[2], q[1], q[0]);
      }
    }
    if (bevel <= 0) continue;
    // The edges along axis a, between the faces of b and c.
    for (int sb = 0; sb < 2; ++sb)
      for (int sc = 0; sc < 2; ++sc) {
        if (!present(b, sb) || !present(c, sc)) continue;
        int s0[3], s1[3];
        s0[a] = 0, s1[a] = 1;
        s0[b] = s1[b] = sb, s0[c] = s1[c] = sc;
        P3 b0 = corner(s0, b), b1 = corner(s1, b), c0 = corner(s0, c), c1 = corner(s1, c);
        if ((sb != 0) == (sc != 0)) {
          mesh.quad(b0, c0, c1, b1);
        } else {
          mesh.quad(b0, b1, c1, c0);
        }
      }
  }
  if (bevel <= 0) return;
  for (int i = 0; i < 8; ++i) {
    const int s[3] = {i & 1, (i >> 1) & 1, i >> 2};
    if (!present(0, s[0]) || !present(1, s[1]) || !present(2, s[2])) continue;
    const bool even = (s[0] + s[1] + s[2]) % 2 == 1;
    mesh.triangle(corner(s, 0), corner(s, even ? 1 : 2), corner(s, even ? 2 : 1));
  }
}

P3 lathePoint(P2 profile, double theta) {
  return {profile.x * std::cos(theta), profile.y, profile.x * std::sin(theta)};
}

void lathe(MeshBuilder& mesh, const std::vector<P2>& profile, int segments, double from, double turn) {
  mesh.grid(segments, int(profile.size()) - 1,
            [&](int i, int j) { return lathePoint(profile[j], from + turn * i / segments); });
}

void sweep(MeshBuilder& mesh, const std::vector<Station>& path, const std::vector<P2>& profile, bool closed,
           bool caps) {
  const int n = int(profile.size());
  const auto at = [&](int i, int j) {
    const Station& s = path[i];
    const P2 q = profile[j % n];
    return s.position + q.x * s.side + q.y * s.up;
  };
  mesh.grid(int(path.size()) - 1, closed ? n : n - 1, at);
  if (!caps) return;
  std::vector<P3> first, last;
  for (int j = 0; j < n; ++j) first.push_back(at(0, n - 1 - j)), last.push_back(at(int(path.size()) - 1, j));
  mesh.polygon(first), mesh.polygon(last);
}

std::vector<Station> planarPath(const std::vector<P3>& points, P3 normal, bool closed) {
  // Mitred: at a corner the profile stands in the bisecting plane, stretched so that its straight parts keep
  // their width.
  std::vector<Station> path;
  const int n = int(points.size());
  for (int i = 0; i < n; ++i) {
    const P3 before = closed ? points[(i + n - 1) % n] : points[std::max(i - 1, 0)];
    const P3 after = closed ? points[(i + 1) % n] : points[std::min(i + 1, n - 1)];
    P3 in = points[i] - before, out = after - points[i];
    if (glm::length(in) == 0) in = out;
    if (glm::length(out) == 0) out = in;
    in = glm::normalize(in), out = glm::normalize(out);
    const P3 up = glm::normalize(glm::cross(glm::normalize(in + out), normal));
    path.push_back({points[i], normal, up / glm::dot(up, glm::cross(in, normal))});
  }
  if (closed) path.push_back(path.front());
  return path;
}

void tube(MeshBuilder& mesh, const std::vector<P3>& points, double radius, int segments) {
  const int n = int(points.size());
  RELUME_CHECK_LE(2, n);
  std::vector<P3> tangent(n);
  for (int i = 0; i < n; ++i)
    tangent[i] = glm::normalize(points[std::min(i + 1, n - 1)] - points[std::max(i - 1, 0)]);
  P3 side = glm::normalize(glm::cross(tangent[0], std::abs(tangent[0].y) < 0.9 ? P3(0, 1, 0) : P3(1, 0, 0)));
  std::vector<Station> path;
  const auto add = [&](P3 position, P3 t, double r) {
    side = glm::normalize(side - t * glm::dot(side, t));
    path.push_back({position, side * r, glm::cross(t, side) * r});
  };
  for (int i = 0; i < n; ++i) add(points[i], tangent[i], radius);
  sweep(mesh, path, circleProfile(1.0, segments), true, true);
}

std::vector<P2> circleProfile(double radius, int segments) {
  std::vector<P2> profile;
  for (int i = 0; i < segments; ++i)
    profile.push_back(radius * P2(std::cos(kTau * i / segments), std::sin(kTau * i / segments)));
  return profile;
}

std::vector<P2> bevelledRectangle(double width, double lo, double hi, double bevel) {
  const double w = width / 2;
  if (bevel <= 0) return {{-w, lo}, {w, lo}, {w, hi}, {-w, hi}};
  return {{-w + bevel, lo}, {w - bevel, lo},  {w, lo + bevel},  {w, hi - bevel},
          {w - bevel, hi},  {-w + bevel, hi}, {-w, hi - bevel}, {-w, lo + bevel}};
}

PointedArch::PointedArch(double span, double rise)
    : span_(span), rise_(rise), radius_((rise * rise + span * span / 4) / span) {
  RELUME_CHECK_LE(span / 2, rise + 1e-9);
}

double PointedArch::height(double x) const {
  const double d = std::abs(x) + radius_ - span_ / 2;
  return std::sqrt(std::max(radius_ * radius_ - d * d, 0.0));
}

double PointedArch::halfWidth(double y) const {
  return std::max(std::sqrt(std::max(radius_ * radius_ - y * y, 0.0)) - radius_ + span_ / 2, 0.0);
}

P2 PointedArch::at(double t) const {
  const double full = std::asin(std::min(rise_ / radius_, 1.0));
  const double u = t <= 1 ? t : 2 - t;
  const double x = radius_ * std::cos(full * u) - radius_ + span_ / 2, y = radius_ * std::sin(full * u);
  return {(t <= 1 ? 1.0 : -1.0) * (u == 1 ? 0.0 : x), u == 1 ? rise_ : y};
}

M4 translate(P3 t) { return glm::translate(M4(1.0), t); }
M4 rotateY(double radians) { return rotate(radians, P3(0, 1, 0)); }
M4 rotate(double radians, P3 axis) { return glm::rotate(M4(1.0), radians, axis); }
M4 scale(P3 s) { return glm::scale(M4(1.0), s); }

}  // namespace relume::scenes
