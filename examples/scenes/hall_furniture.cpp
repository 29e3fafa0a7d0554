// SPDX-License-Identifier: MIT
// Throne, cloth, lamps and tables of the castle hall.
#include <algorithm>
#include <cmath>

#include "hall_parts.h"

namespace relume::scenes::hall {
namespace {

// A candle with its flame, standing at p.
void candle(MeshBuilder& m, const Palette& p, P3 at, int detail) {
  MeshBuilder c;
  const int seg = 3 + detail;
  c.material(p.iron);
  lathe(c, {{0.0, -0.05}, {0.075, 0.0}, {0.075, 0.012}, {0.026, 0.012}}, seg);
  c.material(p.wax);
  lathe(c, {{0.026, 0.012}, {0.026, 0.18}, {0.0, 0.19}}, seg);
  c.material(p.flame);
  lathe(c, {{0.0, 0.19}, {0.021, 0.225}, {0.0, 0.3}}, seg);
  m.append(c, translate(at));
}

void ring(MeshBuilder& m, double radius, double y, double height, double thick, int seg) {
  const double b = 0.012;
  lathe(m,
        {{radius - thick, y + b},
         {radius - thick + b, y},
         {radius - b, y},
         {radius, y + b},
         {radius, y + height - b},
         {radius - b, y + height},
         {radius - thick + b, y + height},
         {radius - thick, y + height - b},
         {radius - thick, y + b}},
        seg);
}

}  // namespace

MeshBuilder throne(const Palette& p, int detail) {
  MeshBuilder m;
  m.material(p.wood);
  box(m, {-0.48, 0.0, -0.36}, {0.48, 0.1, 0.42}, 0.02, kYLo);
  box(m, {-0.4, 0.1, -0.3}, {0.4, 0.42, 0.32}, 0.015, kYLo | kYHi);
  box(m, {-0.44, 0.42, -0.34}, {0.44, 0.48, 0.38}, 0.015);
  m.material(p.red);
  box(m, {-0.34, 0.48, -0.2}, {0.34, 0.56, 0.34}, 0.03, kYLo);
  m.material(p.wood);
  for (const double s : {-1.0, 1.0}) {
    MeshBuilder post;
    post.material(p.wood);
    lathe(post, {{0.05, 0.48}, {0.06, 0.5}, {0.04, 0.56}, {0.035, 0.64}, {0.05, 0.7}, {0.05, 0.74}},
          6 + 2 * detail);
    m.append(post, translate({s * 0.39, 0, 0.3}));
    box(m, {s * 0.39 - 0.055, 0.74, -0.22}, {s * 0.39 + 0.055, 0.8, 0.4}, 0.018);
    box(m, {s * 0.39 - 0.05, 0.48, -0.33}, {s * 0.39 + 0.05, 1.85, -0.22}, 0.018, kYLo);
    MeshBuilder finial;
    finial.material(p.gold);
    lathe(finial, {{0.03, 0.0}, {0.03, 0.03}, {0.06, 0.09}, {0.065, 0.13}, {0.03, 0.19}, {0.0, 0.24}},
          6 + 3 * detail);
    m.append(finial, translate({s * 0.39, 1.85, -0.275}));
  }
  // High back ending in a pointed arch, with a padded panel.
  const PointedArch arch(0.68, 0.52);
  const int n = 4 + 2 * detail;
  const auto slab = [&](double grow, double lo, double spring, double z0, double z1, std::uint32_t material,
                        bool cushion) {
    m.material(material);
    const PointedArch a(arch.span() + 2 * grow, arch.rise() + grow);
    std::vector<P3> front = {{a.span() / 2, lo, z1}}, back = {{a.span() / 2, lo, z0}};
    for (int i = 0; i <= 2 * n; ++i) {
      const P2 q = a.at(double(i) / n);
      front.push_back({q.x, spring + q.y, z1}), back.push_back({q.x, spring + q.y, z0});
    }
    front.push_back({-a.span() / 2, lo, z1}), back.push_back({-a.span() / 2, lo, z0});
    m.strip(front, back);
    const std::size_t half = front.size() / 2;
    m.strip({front.rbegin(), front.rbegin() + half + 1}, {front.begin(), front.begin() + half + 1});
    if (cushion) {
      m.quad(back.back(), back.front(), front.front(), front.back());
    } else {
      m.strip({back.begin(), back.begin() + half + 1}, {back.rbegin(), back.rbegin() + half + 1});
    }
  };
  slab(0.0, 0.48, 1.62, -0.32, -0.24, p.wood, false);
  slab(-0.08, 0.62, 1.6, -0.24, -0.2, p.red, true);
  return m;
}

MeshBuilder banner(std::uint32_t cloth, std::uint32_t border, double width, double height, bool tails,
                   double wave, int detail) {
  MeshBuilder m;
  const int columns = 4 + detail, rows = 4 + 2 * detail;
  const double thick = 0.008;
  const auto at = [&](int i, int j, double side) {
    const double s = 2.0 * j / columns - 1, t = double(i) / rows;
    const double cut = tails ? 0.22 * width * (1 - std::abs(s)) : 0.0;
    const double z = wave * t * (std::sin(3.1 * s + 1.1) * (0.4 + 0.6 * t) + 0.35 * std::sin(7 * s));
    return P3(s * width / 2 * (1 - 0.03 * std::sin(kTau / 2 * t)), -t * (height - cut), z + side * thick);
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const bool edge = j == 0 || j == columns - 1 || i == 0 || i == rows - 1;
      m.material(edge ? border : cloth);
      m.quad(at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1), at(i, j, 1));
      m.quad(at(i, j, -1), at(i, j + 1, -1), at(i + 1, j + 1, -1), at(i + 1, j, -1));
    }
  m.material(border);
  for (int i = 0; i < rows; ++i) {
    m.quad(at(i, 0, -1), at(i + 1, 0, -1), at(i + 1, 0, 1), at(i, 0, 1));
    m.quad(at(i, columns, 1), at(i + 1, columns, 1), at(i + 1, columns, -1), at(i, columns, -1));
  }
  for (int j = 0; j < columns; ++j) {
    m.quad(at(0, j, 1), at(0, j + 1, 1), at(0, j + 1, -1), at(0, j, -1));
    m.quad(at(rows, j, -1), at(rows, j + 1, -1), at(rows, j + 1, 1), at(rows, j, 1));
  }
  return m;
}

MeshBuilder bannerPole(const Palette& p) {
  MeshBuilder m;
  m.material(p.iron);
  tube(m, {{0, 0, 0}, {0, 0, 0.98}}, 0.02, 6);
  return m;
}

MeshBuilder candelabrum(const Palette& p, int detail) {
  MeshBuilder m;
  m.material(p.iron);
  const int seg = 3 + detail;
  lathe(m,
        {{0.0, 0.12},
         {0.05, 0.15},
         {0.022, 0.3},
         {0.022, 0.85},
         {0.045, 0.88},
         {0.045, 0.93},
         {0.022, 0.96},
         {0.018, 1.5},
         {0.04, 1.55},
         {0.0, 1.64}},
        seg);
  for (int k = 0; k < 3; ++k) {
    const double a = kTau * k / 3 + 0.5;
    const P3 out(std::cos(a), 0, std::sin(a)), up(0, 1, 0);
    tube(m, {out * 0.02 + up * 0.22, out * 0.12 + up * 0.2, out * 0.22 + up * 0.1, out * 0.27 + up * 0.016},
         0.016, 5);
    std::vector<P3> arm;
    for (int i = 0; i <= 2 + detail; ++i) {
      const double t = double(i) / (2 + detail);
      arm.push_back(out * (0.01 + 0.27 * std::sin(kTau / 4 * t)) +
                    up * (1.45 - 0.1 * std::sin(kTau / 2 * t) + 0.14 * t * t));
    }
    tube(m, arm, 0.014, 5);
    candle(m, p, out * 0.28 + up * 1.63, detail);
    m.material(p.iron);
  }
  candle(m, p, {0, 1.68, 0}, detail);
  return m;
}

MeshBuilder chandelier(const Palette& p, double drop, int detail) {
  MeshBuilder m;
  const int seg = 8 + 6 * detail;
  m.material(p.iron);
  const double hub = -drop + 1.0;
  tube(m, {{0, 0, 0}, {0, hub, 0}}, 0.018, 6);
  lathe(m, {{0.0, hub - 0.16}, {0.05, hub - 0.1}, {0.07, hub - 0.04}, {0.05, hub + 0.02}, {0.0, hub + 0.06}},
        6 + 3 * detail);
  for (int k = 0; k < 4; ++k) {
    const double a = kTau * k / 4 + 0.2;
    tube(m,
         {{0.03 * std::cos(a), hub - 0.03, 0.03 * std::sin(a)},
          {0.87 * std::cos(a), -drop + 0.1, 0.87 * std::sin(a)}},
         0.012, 5);
  }
  m.material(p.wood);
  ring(m, 0.9, -drop, 0.11, 0.06, seg);
  for (int k = 0; k < 8; ++k) {
    const double a = kTau * k / 8 + 0.2 + kTau / 16;
    candle(m, p, {0.87 * std::cos(a), -drop + 0.16, 0.87 * std::sin(a)}, detail);
  }
  return m;
}

MeshBuilder table(const Palette& p, double length, int detail) {
  MeshBuilder m;
  m.material(p.wood);
  const double h = length / 2;
  for (int k = 0; k < 3; ++k) {  // boards, along z
    const double x = -0.42 + 0.28 * k;
    box(m, {x + 0.004, 0.72, -h}, {x + 0.276, 0.77, h}, 0.01);
  }
  for (const double z : {-h + 0.5, 0.0, h - 0.5}) {
    box(m, {-0.34, 0, z - 0.05}, {0.34, 0.09, z + 0.05}, 0.0, kYLo);
    box(m, {-0.1, 0.09, z - 0.04}, {0.1, 0.64, z + 0.04}, 0.0, kYLo | kYHi);
    box(m, {-0.36, 0.64, z - 0.05}, {0.36, 0.72, z + 0.05}, 0.0, kYHi);
  }
  for (const double s : {-1.0, 1.0}) {
    box(m, {s * 0.72 - 0.15, 0.42, -h + 0.1}, {s * 0.72 + 0.15, 0.46, h - 0.1}, 0.01);
    for (const double z : {-h + 0.5, 0.0, h - 0.5})
      box(m, {s * 0.72 - 0.13, 0, z - 0.03}, {s * 0.72 + 0.13, 0.42, z + 0.03}, 0.0, kYLo | kYHi);
  }
  const int seg = 6 + detail;
  MeshBuilder goblet, bowl;
  goblet.material(p.gold), bowl.material(p.gold);
  lathe(goblet,
        {{0.045, 0.0},
         {0.04, 0.012},
         {0.012, 0.025},
         {0.012, 0.075},
         {0.035, 0.095},
         {0.042, 0.13},
         {0.04, 0.165},
         {0.036, 0.165},
         {0.036, 0.13},
         {0.0, 0.105}},
        seg);
  lathe(bowl, {{0.08, 0.0}, {0.09, 0.015}, {0.17, 0.06}, {0.2, 0.1}, {0.19, 0.1}, {0.16, 0.07}, {0.0, 0.025}},
        seg);
  const double step = length / 5;
  for (int k = 0; k < 4; ++k) {
    const double z = -h + (k + 1) * step;
    m.append(goblet, translate({k % 2 ? 0.28 : -0.26, 0.77, z + 0.1}));
    if (k % 2 == 0) m.append(bowl, translate({0.02, 0.77, z + step / 2}));
  }
  return m;
}

MeshBuilder chest(const Palette& p, int detail) {
  MeshBuilder m;
  m.material(p.wood);
  box(m, {-0.6, 0, -0.32}, {0.6, 0.46, 0.32}, 0.015, kYLo | kYHi);
  const int n = 5 + 2 * detail;
  std::vector<P3> left, right;
  for (int i = 0; i <= n; ++i) {
    const double a = kTau / 2 * i / n;
    left.push_back({-0.62, 0.46 + 0.2 * std::sin(a), 0.34 * std::cos(a)}),
        right.push_back({0.62, left.back().y, left.back().z});
  }
  m.strip(left, right);
  std::vector<P3> cap(right.rbegin(), right.rend());
  m.polygon(left), m.polygon(cap);
  m.quad({-0.62, 0.46, -0.34}, {0.62, 0.46, -0.34}, {0.62, 0.46, 0.34}, {-0.62, 0.46, 0.34});
  m.material(p.iron);
  for (const double x : {-0.4, 0.4}) {
    std::vector<P3> strap;
    for (int i = 0; i <= n; ++i) {
      const double t = kTau / 2 * i / n;
      strap.push_back({x, 0.46 + 0.2 * std::sin(t), 0.34 * std::cos(t)});
    }
    sweep(m, planarPath(strap, {-1, 0, 0}),
          {{0.035, -0.01}, {0.035, 0.012}, {-0.035, 0.012}, {-0.035, -0.01}}, false, false);
  }
  box(m, {-0.06, 0.36, 0.32}, {0.06, 0.5, 0.36}, 0.01, kZLo);
  return m;
}

}  // namespace relume::scenes::hall
