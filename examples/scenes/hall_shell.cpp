// SPDX-License-Identifier: MIT
// Walls, vaults, columns, roof and ground of the castle hall.
//
// A groin vault over a bay is the upper envelope of two pointed barrels of equal rise: h(x, z) = max(a(x),
// b(z)). Its groins are the curves (X(y), y, Z(y)) on which both barrels have the height y, so rows of equal
// height fit together along groins and between bays.
#include <algorithm>
#include <cmath>

#include "hall_parts.h"

namespace relume::scenes::hall {
namespace {

// Hanging rib: sides and a chamfered underside; its back lies in the vault.
std::vector<P2> ribProfile(double width, double depth, bool half) {
  const double w = width / 2, c = width * 0.28, back = 0.03;
  if (half) return {{0, -depth}, {w - c, -depth}, {w, -depth + c}, {w, back}};
  return {{-w, back}, {-w, -depth + c}, {-w + c, -depth}, {w - c, -depth}, {w, -depth + c}, {w, back}};
}

// Heights of the rows of a vault, the same over every bay.
std::vector<double> rows(int detail) {
  const PointedArch arch(kBay, kRise);
  const int n = 2 + 2 * detail;
  std::vector<double> y;
  for (int i = 0; i <= n; ++i) y.push_back(arch.at(double(i) / n).y);
  return y;
}

std::vector<P2> outline(double half_width, double bottom, double springing, const PointedArch& arch, int up,
                        int around) {
  std::vector<P2> points;
  for (int i = 0; i < up; ++i) points.push_back({half_width, bottom + (springing - bottom) * i / up});
  for (int i = 0; i <= 2 * around; ++i) points.push_back(arch.at(double(i) / around) + P2(0, springing));
  for (int i = up - 1; i >= 0; --i) points.push_back({-half_width, bottom + (springing - bottom) * i / up});
  return points;
}

std::vector<P3> inPlane(const std::vector<P2>& points, double z) {
  std::vector<P3> out;
  for (const P2 p : points) out.push_back({p.x, p.y, z});
  return out;
}

}  // namespace

MeshBuilder vault(const Palette& p, double span, int detail) {
  const PointedArch over_x(span, kRise), over_z(kBay, kRise);
  const std::vector<double> y = rows(detail);
  const int n = int(y.size()) - 1, columns = 1 + (detail + 1) / 2;
  MeshBuilder quarter;
  quarter.material(p.plaster);
  const auto lerp = [&](double a, double b, int j) { return a + (b - a) * j / columns; };
  quarter.grid(n, columns, [&](int i, int j) {
    return P3(over_x.halfWidth(y[i]), y[i], lerp(over_z.halfWidth(y[i]), kBay / 2, j));
  });
  quarter.grid(n, columns, [&](int i, int j) {
    const int k = columns - j;
    return P3(lerp(over_x.halfWidth(y[i]), span / 2, k), y[i], over_z.halfWidth(y[i]));
  });

  quarter.material(p.rib);
  const P3 along = glm::normalize(P3(span, 0, kBay));
  const P3 side(-along.z, 0, along.x);
  const double width = 0.2;
  std::vector<Station> path;
  std::vector<double> back;  // how far up the rib's sides must go to meet the webs, which part from it
  for (int i = 0; i <= n; ++i) {
    const auto at = [&](int k) { return P3(over_x.halfWidth(y[k]), y[k], over_z.halfWidth(y[k])); };
    P3 direction = i == 0 ? P3(0, 1, 0) : at(std::min(i + 1, n)) - at(i - 1);
    if (i == n) direction = -along;  // meets its opposite upright
    direction = glm::normalize(direction - side * glm::dot(direction, side));
    path.push_back({at(i), side, glm::cross(direction, side)});
    double slope = 0;
    for (const bool x : {true, false}) {
      const PointedArch& arch = x ? over_x : over_z;
      const double out = arch.halfWidth(y[i]) + arch.radius() - arch.span() / 2;
      const P3 web = glm::cross(direction, x ? P3(out, y[i], 0) : P3(0, y[i], out));
      slope = std::max(slope, std::abs(glm::dot(web, path.back().up) / glm::dot(web, side)));
    }
    back.push_back(width / 2 * std::min(slope, 1.5) + 0.012);
  }
  const std::vector<P2> profile = ribProfile(width, 0.2, false);
  quarter.grid(n, int(profile.size()) - 1, [&](int i, int j) {
    const P2 q = profile[j];
    return path[i].position + q.x * path[i].side + (q.y > 0 ? back[i] : q.y) * path[i].up;
  });

  MeshBuilder m;
  for (const double sx : {1.0, -1.0})
    for (const double sz : {1.0, -1.0}) m.append(quarter, scale({sx, 1, sz}));
  m.material(p.gold);
  lathe(m,
        {{0.0, kRise - 0.34}, {0.11, kRise - 0.3}, {0.13, kRise - 0.26}, {0.25, kRise - 0.24}, {0.27, kRise}},
        4 + 3 * detail);
  return m;
}

MeshBuilder archRib(const Palette& p, double span, double width, double depth, bool half, int detail) {
  MeshBuilder m;
  m.material(p.rib);
  const PointedArch arch(span, kRise);
  const std::vector<double> y = rows(detail);
  std::vector<P3> points;
  for (const double h : y) points.push_back({arch.halfWidth(h), h, 0});
  for (int i = int(y.size()) - 2; i >= 0; --i) points.push_back({-arch.halfWidth(y[i]), y[i], 0});
  std::vector<Station> path = planarPath(points, {0, 0, 1});
  path.front().up = {1, 0, 0}, path.back().up = {-1, 0, 0};
  sweep(m, path, ribProfile(width, depth, half), false, false);
  return m;
}

MeshBuilder pier(const Palette& p, int detail) {
  // Four shafts of radius rho stand on the circle of the core.
  MeshBuilder m;
  m.material(p.stone);
  const double core = 0.3, rho = 0.115, foot = 0.62, head = 3.86;
  const double open =
      std::acos(1 - rho * rho / (2 * core * core));             // half the angle a shaft takes of the core
  const double begin = kTau / 2 - std::acos(rho / (2 * core));  // the shaft's own angle there
  std::vector<P2> plan;
  const int around = 3 + 2 * detail, between = 1 + detail;
  for (int q = 0; q < 4; ++q) {
    const double a = kTau * (q + 0.5) / 4;
    for (int i = 0; i < around; ++i) {
      const double s = a - begin + 2 * begin * i / around;
      plan.push_back(core * P2(std::cos(a), std::sin(a)) + rho * P2(std::cos(s), std::sin(s)));
    }
    for (int i = 0; i < between; ++i) {
      const double s = a + open + (kTau / 4 - 2 * open) * i / between;
      plan.push_back(core * P2(std::cos(s), std::sin(s)));
    }
  }
  const int n = int(plan.size());
  m.grid(n, 1, [&](int i, int j) { return P3(plan[i % n].x, j ? head : foot, plan[i % n].y); });
  const int seg = 8 + 8 * detail;
  lathe(m, {{0.56, 0.0}, {0.56, 0.26}, {0.53, 0.29}, {0.5, 0.29}}, 8, kTau / 16);
  const int round = 8 + 6 * detail;
  lathe(m,
        {{0.5, 0.29},
         {0.525, 0.35},
         {0.5, 0.41},
         {0.46, 0.42},
         {0.44, 0.47},
         {0.46, 0.53},
         {0.46, 0.58},
         {0.43, 0.62},
         {0.27, 0.62}},
        round);
  // Bell of the capital with two rows of leaves.
  lathe(m, {{0.28, 3.86}, {0.43, 3.86}, {0.46, 3.905}, {0.43, 3.95}, {0.38, 3.95}}, round);
  const int up = 2 + (3 * detail) / 2, leaves = 8;
  m.grid(seg, up, [&](int i, int j) {
    const double t = double(j) / up, a = kTau * i / seg;
    const double curl = std::pow(std::sin(kTau / 2 * std::min(t * 1.04, 1.0)), 2) * t;
    const double r = 0.385 + 0.09 * t * t + 0.06 * curl * (1 + std::cos(leaves * a));
    return lathePoint({r, 3.95 + 0.43 * t}, a);
  });
  box(m, {-0.56, 4.38, -0.56}, {0.56, kSpringing, 0.56}, 0.05);
  return m;
}

MeshBuilder respond(const Palette& p, double turn, int detail) {
  MeshBuilder m;
  m.material(p.stone);
  const int seg = std::max(3, int(std::round((4 + 6 * detail) * turn / kTau)));
  const std::vector<P2> profile = {{0.36, 0.0},  {0.36, 0.26}, {0.33, 0.29}, {0.345, 0.35}, {0.33, 0.41},
                                   {0.27, 0.45}, {0.29, 0.54}, {0.21, 0.6},  {0.21, 3.86},  {0.25, 3.88},
                                   {0.25, 3.93}, {0.22, 3.95}, {0.25, 4.2},  {0.35, 4.38}};
  lathe(m, profile, seg, 0.0, turn);
  lathe(m, {{0.35, 4.38}, {0.42, 4.38}, {0.42, 4.55}, {0.38, kSpringing}, {0.0, kSpringing}},
        std::max(2, int(std::round(8 * turn / kTau))), 0.0, turn);
  return m;
}

MeshBuilder wall(const Palette& p, double span, const std::optional<Opening>& opening, int detail) {
  MeshBuilder m;
  m.material(p.plaster);
  const double w = span / 2, base = kOutside, back = -kThickness;
  const std::vector<double> y = rows(detail);
  const int around = int(y.size()) - 1, up = 4;
  const PointedArch bay(span, kRise);
  std::vector<P2> face;  // up to the vault, its rows
  for (int i = 0; i < up; ++i) face.push_back({w, kSpringing * i / up});
  for (const double h : y) face.push_back({bay.halfWidth(h), kSpringing + h});
  for (int i = around - 1; i >= 0; --i) face.push_back({-bay.halfWidth(y[i]), kSpringing + y[i]});
  for (int i = up - 1; i >= 0; --i) face.push_back({-w, kSpringing * i / up});
  if (!opening) {
    std::vector<P2> left(face.rbegin(), face.rbegin() + face.size() / 2 + 1),
        right(face.begin(), face.begin() + face.size() / 2 + 1);
    m.strip(inPlane(left, 0), inPlane(right, 0));
    m.material(p.rough);
    m.quad({w, base, back}, {-w, base, back}, {-w, kEaves, back}, {w, kEaves, back});
    return m;
  }
  const Opening& o = *opening;
  const double sill = o.sill, mid = -0.52;
  const double splay = o.door ? 0.12 : 0.2, slope = o.door ? 0.0 : 0.25;
  const auto hole = [&](double wider, double lower) {
    return outline(o.width / 2 + wider, sill - lower, o.springing,
                   PointedArch(o.width + 2 * wider, o.rise + wider), up, around);
  };
  const std::vector<P3> inner = inPlane(hole(splay, slope), 0), middle = inPlane(hole(0, 0), mid);
  const std::vector<P3> outer = inPlane(hole(0.1, o.door ? 0 : 0.12), back);
  m.strip(inPlane(face, 0), inner, true);
  if (inner.front().y > 1e-6) m.quad({-w, 0, 0}, {w, 0, 0}, inner.front(), inner.back());
  m.material(p.stone);
  m.strip(inner, middle, true), m.strip(middle, outer, true);
  m.quad(inner.back(), inner.front(), middle.front(), middle.back());
  m.quad(middle.back(), middle.front(), outer.front(), outer.back());
  m.material(p.rough);
  std::vector<P3> rectangle;
  for (int i = 0; i < up; ++i) rectangle.push_back({w, base + (kEaves - base) * i / up, back});
  for (int i = 0; i <= 2 * around; ++i) rectangle.push_back({w - span * i / (2 * around), kEaves, back});
  for (int i = up - 1; i >= 0; --i) rectangle.push_back({-w, base + (kEaves - base) * i / up, back});
  m.strip(rectangle, outer);
  m.quad({w, base, back}, {-w, base, back}, outer.back(), outer.front());

  if (o.door) {
    m.material(p.wood);  // boards with battens, in the middle of the wall
    std::vector<P3> edge, reverse;
    for (std::size_t i = 0; i < inner.size(); ++i) {
      edge.push_back(glm::mix(middle[i], inner[i], -0.12 / mid));
      reverse.push_back(glm::mix(middle[i], outer[i], 0.02 / (mid - back)));
    }
    const std::size_t half = edge.size() / 2;
    m.strip({edge.rbegin(), edge.rbegin() + half + 1}, {edge.begin(), edge.begin() + half + 1});
    m.strip({reverse.begin(), reverse.begin() + half + 1}, {reverse.rbegin(), reverse.rbegin() + half + 1});
    m.material(p.iron);
    const double door_width = o.width / 2 - 0.06;
    for (const double h : {0.6, 1.5, 2.4})
      for (const double s : {-1.0, 1.0})
        box(m, {s < 0 ? -door_width : 0.06, h, mid + 0.12},
            {s < 0 ? -0.06 : door_width, h + 0.09, mid + 0.145}, 0.01, kZLo);
    box(m, {-0.02, 0.02, mid + 0.12}, {0.02, o.springing + o.rise - 0.08, mid + 0.14}, 0, kZLo);
    return m;
  }
  // Tracery: mullions that branch into arcs of the window's own radius, and a transom.
  m.material(p.stone);
  const PointedArch arch(o.width, o.rise);
  const std::vector<P2> bar = bevelledRectangle(0.13, -0.06, 0.06, 0.035);
  for (int k = 1; k <= o.mullions; ++k) {
    const double x = o.width * (double(k) / (o.mullions + 1) - 0.5);
    for (const double s : {-1.0, 1.0}) {
      // The bar rises along x and bends with the arch that starts at the jamb on the other side: centre at x
      // - s radius.
      std::vector<P3> points;
      if (s > 0) points.push_back({x, sill - 0.1, mid});
      const int n = 4 + detail;
      for (int i = 0; i <= n; ++i) {
        const double a = 1.45 * i / n;
        const P3 q(x - s * arch.radius() * (1 - std::cos(a)), o.springing + arch.radius() * std::sin(a), mid);
        points.push_back(q);
        if (q.y - o.springing > arch.height(q.x) || std::abs(q.x) > o.width / 2) break;
      }
      sweep(m, planarPath(points, {0, 0, 1}), bar, true, false);
    }
  }
  // A rectangle's profile is symmetric, so side and up may be exchanged for the level bar.
  const double level = sill + (o.springing - sill) * 0.45;
  if (o.springing - sill > 1.5)
    for (int k = 0; k <= o.mullions; ++k) {
      const double a = o.width * (double(k) / (o.mullions + 1) - 0.5) + (k ? 0.05 : -0.02),
                   b = o.width * (double(k + 1) / (o.mullions + 1) - 0.5) - (k < o.mullions ? 0.05 : -0.02);
      sweep(m, planarPath({{b, level, mid}, {a, level, mid}}, {0, 0, 1}),
            bevelledRectangle(0.1, -0.05, 0.05, 0.025), true, false);
    }
  return m;
}

MeshBuilder buttress(const Palette& p) {
  MeshBuilder m;
  m.material(p.rough);
  const double h = 0.42;
  const std::vector<P2> side = {{0.0, 8.1},   {0.42, 7.3}, {0.42, 4.9},    {0.85, 4.2},
                                {0.85, 0.35}, {1.0, 0.15}, {1.0, kOutside}};
  std::vector<P3> left, right, foot_left, foot_right;
  for (const P2 q : side) left.push_back({-h, q.y, q.x}), right.push_back({h, q.y, q.x});
  for (const P2 q : side) foot_left.push_back({-h, q.y, 0}), foot_right.push_back({h, q.y, 0});
  m.strip(right, left), m.strip(foot_right, right), m.strip(left, foot_left);
  return m;
}

MeshBuilder battlement(const Palette& p, double span) {
  // Along x, outer face towards +z; stands on the wall top y = 0 with a moulding below.
  MeshBuilder m;
  m.material(p.rough);
  const double w = span / 2, out = 0.16;
  std::vector<Station> path = planarPath({{-w, 0, 0}, {w, 0, 0}}, {0, 1, 0});
  sweep(m, path, {{0.35, -0.5}, {0.35, out}, {0.02, out}, {-0.2, 0.0}}, false, false);
  sweep(m, path, {{0.0, -0.9}, {0.0, -0.5}, {0.35, -0.5}}, false, false);
  const int count = int(std::round(span / 1.4));
  for (int k = 0; k < count; ++k) {
    const double x = -w + span * (k + 0.5) / count;
    box(m, {x - 0.4, 0.35, -0.42}, {x + 0.4, 1.15, out - 0.04}, 0.05, kYLo);
  }
  return m;
}

MeshBuilder tower(const Palette& p, int detail) {
  MeshBuilder m;
  m.material(p.rough);
  const double r = 1.35, top = 10.4;
  const int seg = 4 * (2 + detail);
  const P3 centre(kWallX + kThickness, 0, kWallZ + kThickness);
  MeshBuilder drum;
  drum.material(p.rough);
  lathe(drum, {{r + 0.14, kOutside}, {r + 0.14, 0.1}, {r, 0.3}, {r, kEaves - 0.2}, {r, kEaves}}, seg * 3 / 4,
        -kTau / 4, 0.75 * kTau);
  lathe(drum,
        {{r, kEaves},
         {r, top},
         {r + 0.2, top + 0.25},
         {r + 0.2, top + 0.6},
         {r - 0.12, top + 0.6},
         {r - 0.12, top + 0.2},
         {r - 0.3, top + 0.2}},
        seg);
  for (int k = 0; k < 8; ++k) {
    MeshBuilder merlon;
    merlon.material(p.rough);
    box(merlon, {r - 0.1, top + 0.6, -0.3}, {r + 0.16, top + 1.2, 0.3}, 0.0, kYLo);
    drum.append(merlon, rotateY(kTau * k / 8));
  }
  drum.material(p.slate);
  lathe(drum,
        {{r - 0.3, top + 0.2},
         {r - 0.3, top + 0.45},
         {r - 0.1, top + 0.42},
         {0.62, top + 2.2},
         {0.05, top + 3.7},
         {0.0, top + 3.75}},
        seg);
  drum.material(p.gold);
  lathe(drum,
        {{0.0, top + 3.68}, {0.09, top + 3.75}, {0.11, top + 3.85}, {0.05, top + 3.95}, {0.0, top + 4.25}},
        10);
  m.append(drum, translate(centre));
  return m;
}

MeshBuilder roof(const Palette& p) {
  MeshBuilder m;
  const double x = kWallX + kThickness - 0.75, z = kWallZ + kThickness - 0.35, ridge = 13.4;
  m.material(p.slate);
  // Courses of slate: each begins a step above the end of the one below.
  const int courses = 12;
  for (const double side : {1.0, -1.0}) {
    std::vector<P3> a, b;
    for (int k = 0; k <= courses; ++k) {
      const double t = double(k) / courses;
      const P3 q(side * x * t, ridge + (kEaves - ridge) * t, 0);
      if (k) a.push_back(q + P3(0, 0.05, 0));
      if (k < courses) a.push_back(q);
    }
    for (P3& q : a) b.push_back({q.x, q.y, -z}), q.z = z;
    m.strip(a, b, side > 0);
    const P3 lip = a.back(), lip2 = b.back();
    m.strip({lip, lip2}, {{lip.x, kEaves, z}, {lip2.x, kEaves, -z}}, side < 0);
  }
  // Gables and their coping.
  m.material(p.rough);
  const double g = kWallZ + kThickness, gx = kWallX + kThickness;
  const double peak = kEaves + (ridge - kEaves) * gx / x;
  for (const double s : {1.0, -1.0}) {
    m.triangle({-s * gx, kEaves, s * g}, {s * gx, kEaves, s * g}, {0, peak, s * g});
    std::vector<Station> rake =
        planarPath({{s * gx, kEaves, s * z}, {0, peak, s * z}, {-s * gx, kEaves, s * z}}, {0, 0, s});
    sweep(m, rake,
          {{-0.04, -0.62},
           {0.0, -0.62},
           {0.45, -0.15},
           {0.45, 0.16},
           {0.38, 0.23},
           {0.03, 0.23},
           {-0.04, 0.16}},
          true, true);
  }
  return m;
}

MeshBuilder floor(const Palette& p) {
  MeshBuilder m;
  m.material(p.floor);
  m.uv([](P3 q) { return P2(q.x, q.z) / 2.4; });
  const double runner = 0.8, end = 9.4;
  const std::vector<double> xs = {-kWallX, -kDaisX, -runner, runner, kDaisX, kWallX},
                            zs = {-kWallZ, kDaisZ, end, kWallZ};
  for (std::size_t i = 0; i + 1 < xs.size(); ++i)
    for (std::size_t k = 0; k + 1 < zs.size(); ++k) {
      if (k == 0 && i > 0 && i < 4) continue;  // the dais
      if (k == 1 && i == 2) continue;          // the carpet
      m.quad({xs[i], 0, zs[k + 1]}, {xs[i + 1], 0, zs[k + 1]}, {xs[i + 1], 0, zs[k]}, {xs[i], 0, zs[k]});
    }
  m.uv({});
  const double h = 0.018, seam = 0.07;
  const P3 a(-runner, h, end), b(runner, h, end), c(runner, h, kDaisZ), d(-runner, h, kDaisZ);
  const P3 in(seam, 0, 0);
  m.material(p.red);
  m.quad(a + in, b - in, c - in, d + in);
  m.material(p.gold);
  m.quad(a, a + in, d + in, d), m.quad(b - in, b, c, c - in);
  m.quad({a.x, 0, a.z}, a, d, {d.x, 0, d.z}), m.quad(b, {b.x, 0, b.z}, {c.x, 0, c.z}, c),
      m.quad({a.x, 0, a.z}, {b.x, 0, b.z}, b, a);
  return m;
}

MeshBuilder dais(const Palette& p) {
  MeshBuilder m;
  m.material(p.stone);
  const double step = kDaisHeight / 3, tread = 0.34, b = 0.025;
  const double x = kDaisX - 2 * tread, z = kDaisZ - 2 * tread;
  std::vector<P2> profile = {{kDaisHeight, -b}};
  for (int k = 0; k < 3; ++k) {
    const double y = kDaisHeight - k * step, out = k * tread;
    if (k) profile.push_back({y, out - b});
    profile.push_back({y - b, out});
    profile.push_back({y - step, out});
  }
  sweep(m, planarPath({{-x, 0, -kWallZ}, {-x, 0, z}, {x, 0, z}, {x, 0, -kWallZ}}, {0, 1, 0}), profile, false,
        false);
  m.uv({});
  m.quad({-x + b, kDaisHeight, z - b}, {x - b, kDaisHeight, z - b}, {x - b, kDaisHeight, -kWallZ},
         {-x + b, kDaisHeight, -kWallZ});
  return m;
}

MeshBuilder ground(const Palette& p) {
  MeshBuilder m;
  m.material(p.grass);
  const double x = kWallX + kThickness, z = kWallZ + kThickness;
  std::vector<P2> profile;
  for (const double d : {0.0, 2.0, 6.0, 14.0, 30.0}) profile.push_back({kOutside - 0.0012 * d * d, d});
  sweep(m, planarPath({{-x, 0, z}, {x, 0, z}, {x, 0, -z}, {-x, 0, -z}}, {0, 1, 0}, true), profile, false,
        false);
  return m;
}

MeshBuilder frontSteps(const Palette& p) {
  MeshBuilder m;
  m.material(p.stone);
  const double z = kWallZ + kThickness, b = 0.025, step = 0.2, tread = 0.36, x = 1.5, deep = 1.0;
  std::vector<P2> profile = {{0.0, -b}};
  for (int k = 0; k < 3; ++k) {
    if (k) profile.push_back({-k * step, k * tread - b});
    profile.push_back({-k * step - b, k * tread});
    profile.push_back({-(k + 1) * step - (k == 2 ? 0.02 : 0.0), k * tread});
  }
  sweep(m, planarPath({{-x, 0, z}, {-x, 0, z + deep}, {x, 0, z + deep}, {x, 0, z}}, {0, 1, 0}), profile,
        false, false);
  m.quad({-x + b, 0, z + deep - b}, {x - b, 0, z + deep - b}, {x - b, 0, z}, {-x + b, 0, z});
  return m;
}

}  // namespace relume::scenes::hall
