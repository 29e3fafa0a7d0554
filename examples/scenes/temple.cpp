// SPDX-License-Identifier: MIT
// A Doric temple of 6 x 9 columns on three steps: fluted shafts with entasis, triglyph frieze, tiled gable
// roof, and a cella with two columns between its antae and a statue inside. `detail` refines shafts,
// capitals, statue and roof tiles.
#include <algorithm>
#include <cmath>

#include "scenes.h"
#include "shapes.h"

namespace relume::scenes {
namespace {

// Plan: column axes every kBay metres; x across, z along, the front at +z. Heights above the stylobate.
constexpr double kBay = 2.5;
constexpr int kAcross = 6, kAlong = 9;
constexpr double kAxisX = kBay * (kAcross - 1) / 2, kAxisZ = kBay * (kAlong - 1) / 2;
constexpr double kEdge = 0.85;  // stylobate beyond the axes
constexpr double kStep = 0.34, kTread = 0.42;
constexpr double kGround = -3 * kStep;
constexpr double kShaft = 4.75, kColumn = 5.3;  // shaft, shaft and capital
constexpr double kCeiling = 6.45, kCornice = 7.0;
constexpr double kBeam = 0.52;    // half width of the architrave
constexpr double kEaves = 0.62;   // cornice beyond the architrave's face
constexpr double kPitch = 0.245;  // roof rise per metre
constexpr double kRoofX = kAxisX + kBeam + kEaves, kRoofZ = kAxisZ + kBeam + kEaves;

// Stations of a rectangle about the origin; profiles along it are (height, distance outward).
std::vector<Station> rectangle(double half_x, double half_z) {
  return planarPath({{-half_x, 0, half_z}, {half_x, 0, half_z}, {half_x, 0, -half_z}, {-half_x, 0, -half_z}},
                    {0, 1, 0}, true);
}

MeshBuilder makeColumn(std::uint32_t stone, int detail) {
  MeshBuilder m;
  m.material(stone);
  constexpr int kFlutes = 20;
  const int per_flute = detail + 1, rings = detail, n = kFlutes * per_flute;
  const auto radius = [](double t) { return 0.55 - 0.115 * t + 0.022 * std::sin(kTau / 2 * t); };  // entasis
  m.grid(n, rings, [&](int i, int j) {
    const double t = double(j) / rings, s = 2.0 * (i % per_flute) / per_flute - 1;  // s = -1 on the arris
    const double r = radius(t) * (1 - 0.075 * (1 - s * s));
    return lathePoint({r, kShaft * t}, kTau * i / n);
  });
  // Necking, annulets, echinus.
  const double r1 = radius(1.0);
  std::vector<P2> echinus = {
      {r1 * 0.9, kShaft}, {r1 + 0.02, kShaft}, {r1 + 0.02, kShaft + 0.12}, {r1 + 0.045, kShaft + 0.15}};
  const int curve = detail + 1;
  for (int k = 1; k <= curve; ++k) {
    const double a = kTau / 4 * k / curve;
    echinus.push_back({r1 + 0.045 + 0.185 * std::sin(a),
                       kShaft + 0.15 + 0.2 * (1 - std::cos(a)) * 0.85 + 0.03 * k / curve});
  }
  const double top = kShaft + 0.15 + 0.2;
  echinus.back() = {r1 + 0.23, top};
  lathe(m, echinus, 10 + 4 * detail);
  box(m, {-0.69, top, -0.69}, {0.69, kColumn, 0.69}, 0.02);
  return m;
}

void addBase(MeshBuilder& m) {
  const double x = kAxisX + kEdge, z = kAxisZ + kEdge, b = 0.03;
  std::vector<P2> profile = {{0, 0}};
  for (int k = 0; k < 3; ++k) {
    const double y = -k * kStep, out = k * kTread;
    if (k) profile.push_back({y, out - b});
    profile.push_back({y - b, out});
    profile.push_back({y - kStep, out});
  }
  profile[0] = {0, -b};
  sweep(m, rectangle(x, z), profile, false, false);
  m.quad({-x + b, 0, z - b}, {x - b, 0, z - b}, {x - b, 0, -z + b}, {-x + b, 0, -z + b});
}

void addGround(MeshBuilder& m) {
  const double x = kAxisX + kEdge + 2 * kTread, z = kAxisZ + kEdge + 2 * kTread;
  // Level around the temple, then falling away; nothing lies under the base.
  const std::vector<P2> profile = {
      {kGround, 0}, {kGround, 4}, {kGround, 10}, {kGround - 0.25, 16}, {kGround - 1.0, 24}};
  sweep(m, rectangle(x, z), profile, false, false);
}

void addEntablature(MeshBuilder& m) {
  // From the top of the cornice outward, down, under the beam and up its inner side.
  const std::vector<P2> profile = {{kCornice, kEaves - 0.12},
                                   {kCornice - 0.05, kEaves},
                                   {kCornice - 0.22, kEaves},
                                   {kCornice - 0.25, kEaves - 0.05},
                                   {kCornice - 0.3, 0.1},
                                   {kCornice - 0.42, 0.1},
                                   {kCornice - 0.42, 0.0},
                                   {kColumn + 0.72, 0.0},
                                   {kColumn + 0.72, 0.07},
                                   {kColumn + 0.62, 0.07},
                                   {kColumn + 0.62, 0.0},
                                   {kColumn, 0.0},
                                   {kColumn, -2 * kBeam},
                                   {kCeiling - 0.12, -2 * kBeam},
                                   {kCeiling - 0.12, -2 * kBeam - 0.07},
                                   {kCeiling, -2 * kBeam - 0.07}};
  sweep(m, rectangle(kAxisX + kBeam, kAxisZ + kBeam), profile, false, false);
}

// Stands on the plane z = 0 and looks to +z; its back is left out.
MeshBuilder makeTriglyph(std::uint32_t blue, std::uint32_t stone) {
  MeshBuilder m;
  m.material(blue);
  const double w = 0.27, lo = kColumn + 0.72, hi = kCornice - 0.42, d = 0.065, g = 0.05;
  // Plan of the front: two whole glyphs and two half ones.
  const std::vector<P2> front = {{-w, 0},        {-w, d - g},   {-w + 0.05, d}, {-0.13, d},
                                 {-0.08, d - g}, {-0.03, d},    {0.03, d},      {0.08, d - g},
                                 {0.13, d},      {w - 0.05, d}, {w, d - g},     {w, 0}};
  std::vector<P3> bottom, top;
  for (const P2 p : front) bottom.push_back({p.x, lo, p.y}), top.push_back({p.x, hi - 0.1, p.y});
  m.strip(top, bottom);
  box(m, {-w - 0.02, hi - 0.1, 0}, {w + 0.02, hi, d + 0.03}, 0, kZLo | kYHi);
  m.material(stone);
  box(m, {-w, kCornice - 0.375, 0.12}, {w, kCornice - 0.27, kEaves - 0.12}, 0.012,
      kYHi);                                                        // the mutule under the cornice
  box(m, {-w, lo - 0.17, 0}, {w, lo - 0.1, 0.06}, 0, kZLo | kYHi);  // regula
  return m;
}

double roofHeight(double x) { return kCornice + (kRoofX - std::abs(x)) * kPitch; }

void addRoof(MeshBuilder& m, std::uint32_t tile, std::uint32_t stone, int detail) {
  const int pans = 18, ring = 2 + detail, rows = detail <= 2 ? 1 : 2 * detail;
  const double z1 = kAxisZ + kBeam - 0.11, pan = 2 * z1 / pans, rib = 0.075;
  // Across a pan: flat, then half a round cover tile on its far edge. Heights above the roof plane.
  std::vector<P2> cover;
  for (int k = 0; k <= ring; ++k)
    cover.push_back({-rib * std::cos(kTau / 2 * k / ring), rib * std::sin(kTau / 2 * k / ring)});
  std::vector<P2> across = {{-z1, 0}};
  for (int k = 1; k < pans; ++k)
    for (const P2 c : cover) across.push_back({-z1 + k * pan + c.x, c.y});
  across.push_back({z1, 0});
  const int columns = int(across.size()) - 1;
  m.material(tile);
  for (const double side : {-1.0, 1.0}) {
    // Rows of tiles overlap: each begins a step above the end of the one below.
    std::vector<P2> down = {{0.0, 0.0}};  // (share of the slope from the ridge, lift)
    for (int r = 1; r <= rows; ++r) {
      down.push_back({double(r) / rows, rows > 1 ? 0.035 : 0.0});
      if (r < rows) down.push_back({double(r) / rows, 0.0});
    }
    const auto at = [&](int i, int j) {
      const double x = side * (kRoofX - 0.02) * down[j].x;
      return P3(x, roofHeight(x) + 0.02 + down[j].y + across[i].y, across[i].x * side);
    };
    m.grid(columns, int(down.size()) - 1, [&](int i, int j) { return at(columns - i, j); });
    std::vector<P3> lip, foot;
    for (int i = 0; i <= columns; ++i) {
      lip.push_back(at(i, int(down.size()) - 1));
      foot.push_back({lip.back().x, kCornice - 0.06, lip.back().z});
    }
    m.strip(lip, foot, true);
  }
  tube(m, {{0, roofHeight(0) + 0.06, z1 - 0.1}, {0, roofHeight(0) + 0.06, -z1 + 0.1}}, 0.11, 6 + 2 * detail);
  // Gables: tympanum, and the raking cornice over it.
  m.material(stone);
  const double face = kAxisZ + kBeam - 0.1, y0 = kCornice - 0.01;
  for (const double s : {-1.0, 1.0}) {
    const double z = s * face, x0 = kRoofX - 0.15;
    const P3 a(-s * x0, y0, z), b(s * x0, y0, z), c(0, roofHeight(0), z);
    m.triangle(a, b, c);
    const double ledge = kAxisZ + kBeam + kEaves - 0.12,
                 ledge_x = kAxisX + kBeam + kEaves - 0.12;  // top of the cornice before it
    m.quad({-s * ledge_x, kCornice, s * ledge}, {s * ledge_x, kCornice, s * ledge},
           {s * ledge_x, kCornice, z}, {-s * ledge_x, kCornice, z});
    const std::vector<P3> path = {{s * (kRoofX + 0.02), kCornice + 0.005, 0},
                                  {0, kCornice + 0.005 + (kRoofX + 0.02) * kPitch, 0},
                                  {-s * (kRoofX + 0.02), kCornice + 0.005, 0}};
    std::vector<Station> rake = planarPath(path, {0, 0, s});
    for (Station& st : rake) st.up = P3(0, 1, 0), st.position.z = s * (face - 0.02);  // plumb ends
    const double d = kRoofZ + 0.03 - (face - 0.02), top = 0.2;
    sweep(m, rake, {{0.0, -0.26}, {d - 0.1, -0.2}, {d, -0.14}, {d, top - 0.07}, {d - 0.06, top}, {0.0, top}},
          true, true);
  }
}

// A palmette on the corners and the crown of the gables.
MeshBuilder makeAcroterion(std::uint32_t stone, int detail) {
  MeshBuilder m;
  m.material(stone);
  box(m, {-0.2, 0, -0.16}, {0.2, 0.22, 0.16}, 0.02);
  lathe(m,
        {{0.1, 0.22},
         {0.13, 0.28},
         {0.07, 0.36},
         {0.1, 0.42},
         {0.2, 0.55},
         {0.215, 0.66},
         {0.16, 0.8},
         {0.07, 0.92},
         {0.0, 0.98}},
        8 + 4 * detail);
  return m;
}

constexpr double kCellaX = 3.3, kCellaFront = 5.6, kCellaBack = -6.9, kWall = 0.6, kPronaos = 2.3,
                 kDoor = 1.15, kDoorHeight = 4.1;

void addCeiling(MeshBuilder& m, std::uint32_t blue) {
  // Coffers over the colonnade, planks over the cella. Looks down.
  m.material(blue);
  const double pitch_guess = 1.25;
  const double hx = kAxisX - kBeam + 0.07, hz = kAxisZ - kBeam + 0.07;
  const int nx = int(std::round(2 * hx / pitch_guess)), nz = int(std::round(2 * hz / pitch_guess));
  const double dx = 2 * hx / nx, dz = 2 * hz / nz, rim = 0.2, deep = 0.22;
  for (int i = 0; i < nx; ++i)
    for (int k = 0; k < nz; ++k) {
      const double x0 = -hx + i * dx, x1 = x0 + dx, z0 = -hz + k * dz, z1 = z0 + dz;
      const P3 o[4] = {{x0, kCeiling, z0}, {x1, kCeiling, z0}, {x1, kCeiling, z1}, {x0, kCeiling, z1}};
      const double cx = (x0 + x1) / 2, cz = (z0 + z1) / 2;
      if (std::abs(cx) < kCellaX && cz > kCellaBack && cz < kCellaFront) {
        m.quad(o[0], o[1], o[2], o[3]);
        continue;
      }
      P3 in[4], up[4];
      for (int q = 0; q < 4; ++q) {
        in[q] = o[q] + P3(o[q].x < cx ? rim : -rim, 0, o[q].z < cz ? rim : -rim);
        up[q] = in[q] + P3(0, deep, 0);
      }
      for (int q = 0; q < 4; ++q) {
        const int r = (q + 1) % 4;
        m.quad(o[q], o[r], in[r], in[q]);
        m.quad(in[q], in[r], up[r], up[q]);
      }
      m.quad(up[0], up[1], up[2], up[3]);
    }
}

void addCella(MeshBuilder& m, std::uint32_t stone, std::uint32_t plaster, std::uint32_t wood) {
  const double xo = kCellaX, xi = kCellaX - kWall, zf = kCellaFront, zd = kCellaFront - kPronaos,
               zb = kCellaBack;
  // One outline: around outside, into the pronaos, through the door, around the room, out again.
  const std::vector<P3> outline = {{-xo, 0, zf},
                                   {-xi, 0, zf},
                                   {-xi, 0, zd},
                                   {-kDoor, 0, zd},
                                   {-kDoor, 0, zd - kWall},
                                   {-xi, 0, zd - kWall},
                                   {-xi, 0, zb + kWall},
                                   {xi, 0, zb + kWall},
                                   {xi, 0, zd - kWall},
                                   {kDoor, 0, zd - kWall},
                                   {kDoor, 0, zd},
                                   {xi, 0, zd},
                                   {xi, 0, zf},
                                   {xo, 0, zf},
                                   {xo, 0, zb},
                                   {-xo, 0, zb}};
  const auto path = planarPath(outline, {0, 1, 0}, true);
  m.material(stone);
  sweep(m, path, {{1.0, 0.0}, {0.97, 0.035}, {0.3, 0.035}, {0.22, 0.08}, {0.0, 0.08}}, false, false);
  sweep(m, path, {{kCeiling, 0.1}, {kCeiling - 0.14, 0.1}, {kCeiling - 0.26, 0.0}}, false, false);
  m.material(plaster);
  sweep(m, path, {{kCeiling - 0.26, 0.0}, {1.0, 0.0}}, false, false);
  // Over the door.
  m.quad({-kDoor, kDoorHeight, zd}, {kDoor, kDoorHeight, zd}, {kDoor, kCeiling, zd}, {-kDoor, kCeiling, zd});
  const double zi = zd - kWall;
  m.quad({kDoor, kDoorHeight, zi}, {-kDoor, kDoorHeight, zi}, {-kDoor, kCeiling, zi}, {kDoor, kCeiling, zi});
  m.quad({-kDoor, kDoorHeight, zi}, {kDoor, kDoorHeight, zi}, {kDoor, kDoorHeight, zd},
         {-kDoor, kDoorHeight, zd});
  m.material(stone);
  const double f = 0.24;  // door frame
  box(m, {-kDoor - f, 0, zd}, {-kDoor, kDoorHeight, zd + 0.14}, 0.02, kYLo | kZLo | kYHi);
  box(m, {kDoor, 0, zd}, {kDoor + f, kDoorHeight, zd + 0.14}, 0.02, kYLo | kZLo | kYHi);
  box(m, {-kDoor - f - 0.1, kDoorHeight, zd}, {kDoor + f + 0.1, kDoorHeight + 0.3, zd + 0.18}, 0.03, kZLo);
  m.material(wood);
  for (int k = 0; k < 5; ++k) {
    const double z = zb + kWall + 1.0 + k * 1.65;
    box(m, {-xi, kCeiling - 0.5, z - 0.17}, {xi, kCeiling, z + 0.17}, 0.025, kXLo | kXHi | kYHi);
  }
}

// A draped goddess with helmet, spear and shield, 3.1 m with her plinth.
MeshBuilder makeStatue(std::uint32_t stone, std::uint32_t bronze, int detail) {
  MeshBuilder m;
  m.material(stone);
  sweep(m, rectangle(0.8, 0.8),
        {{0.9, -0.8},
         {0.9, 0.06},
         {0.87, 0.1},
         {0.78, 0.1},
         {0.72, 0.0},
         {0.2, 0.0},
         {0.12, 0.12},
         {0.0, 0.12}},
        false, false);
  const int around = 18 * std::min(detail, 3), up = 6 + 4 * detail;
  // Robe: folds that fade out towards the belt.
  struct Knot {
    double y, rx, rz;
  };
  const Knot knot[] = {{0.9, 0.52, 0.46},  {1.2, 0.46, 0.4},    {1.7, 0.38, 0.31},  {2.0, 0.34, 0.26},
                       {2.17, 0.28, 0.21}, {2.3, 0.31, 0.235},  {2.5, 0.35, 0.25},  {2.66, 0.36, 0.22},
                       {2.77, 0.28, 0.16}, {2.83, 0.115, 0.11}, {2.92, 0.098, 0.1}, {3.06, 0.1, 0.11}};
  constexpr int kKnots = int(std::size(knot));
  const auto body = [&](int i, int j) {
    const double s = double(j) / up * (kKnots - 1);
    const int k = std::min(int(s), kKnots - 2);
    const double f = s - k;
    const auto mix = [&](auto member) {  // Catmull-Rom
      const double a = knot[std::max(k - 1, 0)].*member, b = knot[k].*member, c = knot[k + 1].*member,
                   d = knot[std::min(k + 2, kKnots - 1)].*member;
      return b + 0.5 * f * (c - a + f * (2 * a - 5 * b + 4 * c - d + f * (3 * (b - c) + d - a)));
    };
    const double y = mix(&Knot::y), a = kTau * i / around;
    const double fold =
        0.07 * std::clamp((2.3 - y) / 1.2, 0.0, 1.0) * std::cos(18 * a + 0.8 * std::sin(2 * a));
    return P3(mix(&Knot::rx) * (1 + fold) * std::cos(a), y, mix(&Knot::rz) * (1 + fold) * std::sin(a));
  };
  m.grid(around, up, body);
  // Head, helmet with crest, arms.
  const int seg = 10 + 4 * detail;
  const auto ellipsoid = [&](P3 centre, P3 r, double from, double to) {
    m.grid(seg, seg / 2, [&](int i, int j) {
      const double v = from + (to - from) * j / (seg / 2), a = kTau * i / seg;
      return centre + r * P3(std::cos(v) * std::cos(a), std::sin(v), std::cos(v) * std::sin(a));
    });
  };
  ellipsoid({0, 3.12, 0.015}, {0.125, 0.165, 0.145}, -kTau / 4, kTau / 4);
  const auto arm = [&](std::vector<P3> p, double r) { tube(m, p, r, 6 + 2 * detail); };
  arm({{-0.34, 2.64, 0}, {-0.46, 2.42, 0.05}, {-0.5, 2.2, 0.16}, {-0.56, 2.28, 0.36}, {-0.62, 2.4, 0.52}},
      0.068);
  arm({{0.34, 2.64, 0}, {0.47, 2.42, -0.02}, {0.52, 2.15, 0.02}, {0.57, 1.95, 0.16}, {0.6, 1.86, 0.26}},
      0.068);
  m.material(bronze);
  ellipsoid({0, 3.16, -0.005}, {0.15, 0.175, 0.172}, 0.12, kTau / 4);
  m.grid(seg, 2, [&](int i, int j) {  // brim
    const double reach[] = {0.7, 1.25, 1.0}, y[] = {3.178, 3.165, 3.181}, a = kTau * i / seg;
    return P3(0.149 * reach[j] * std::cos(a), y[j], 0.171 * reach[j] * std::sin(a) - 0.005);
  });
  {
    std::vector<P3> ridge;
    for (int k = 0; k <= seg; ++k) {
      const double a = 0.3 + (kTau / 2 + 0.25) * k / seg;
      ridge.push_back({0, 3.17 + 0.225 * std::sin(a), 0.225 * std::cos(a)});
    }
    sweep(m, planarPath(ridge, {1, 0, 0}), bevelledRectangle(0.05, -0.06, 0.06, 0.015), true, true);
  }
  tube(m, {{-0.64, 0.9, 0.55}, {-0.62, 3.35, 0.54}}, 0.022, 6 + 2 * detail);
  MeshBuilder spearhead;
  spearhead.material(bronze);
  lathe(spearhead, {{0.022, 0.0}, {0.06, 0.12}, {0.0, 0.34}}, 8);
  m.append(spearhead, translate({-0.62, 3.33, 0.54}));
  MeshBuilder shield;
  shield.material(bronze);
  lathe(shield,
        {{0.0, -0.05},
         {0.4, 0.0},
         {0.46, 0.0},
         {0.47, 0.02},
         {0.46, 0.04},
         {0.4, 0.04},
         {0.25, 0.085},
         {0.1, 0.11},
         {0.0, 0.115}},
        16 + 6 * detail);
  m.append(shield, translate({0.66, 1.42, 0.36}) * rotateY(-0.5) * rotate(kTau / 4 - 0.1, {1, 0, 0}));
  return m;
}

MeshBuilder makeBrazier(std::uint32_t bronze, std::uint32_t coal, int detail) {
  MeshBuilder m;
  m.material(bronze);
  const int seg = 10 + 3 * detail;
  lathe(m,
        {{0.0, 0.86},
         {0.16, 0.88},
         {0.33, 0.98},
         {0.4, 1.08},
         {0.43, 1.08},
         {0.43, 1.11},
         {0.4, 1.11},
         {0.37, 1.06}},
        seg);
  for (int k = 0; k < 3; ++k) {
    const double a = kTau * k / 3 + 0.3, c = std::cos(a), s = std::sin(a);
    tube(m,
         {{0.3 * c, 0.03, 0.3 * s},
          {0.24 * c, 0.12, 0.24 * s},
          {0.13 * c, 0.5, 0.13 * s},
          {0.2 * c, 0.89, 0.2 * s}},
         0.028, 6);
  }
  m.material(coal);
  lathe(m, {{0.37, 1.06}, {0.2, 1.12}, {0.0, 1.15}}, seg);
  return m;
}

MeshBuilder makeCypress(std::uint32_t leaves, std::uint32_t bark, int detail) {
  MeshBuilder m;
  m.material(bark);
  lathe(m, {{0.17, 0.0}, {0.12, 0.15}, {0.1, 0.75}}, 8);
  m.material(leaves);
  const int seg = 8 + 4 * detail, rows = 5 + 3 * detail;
  m.grid(seg, rows, [&](int i, int j) {
    const double t = double(j) / rows, a = kTau * i / seg;
    const double r = 0.78 * std::pow(std::sin(kTau / 2 * std::pow(t, 0.62)), 0.85) *
                     (1 + 0.09 * std::cos(5 * a + 9 * t) + 0.05 * std::cos(9 * a - 14 * t));
    return lathePoint({j == 0 || j == rows ? 0.0 : r, 0.55 + 5.2 * t}, a);
  });
  return m;
}

MeshBuilder makeAltar(std::uint32_t stone) {
  MeshBuilder m;
  m.material(stone);
  sweep(m, rectangle(1.2, 0.7),
        {{1.05, -0.7},
         {1.05, 0.1},
         {1.02, 0.13},
         {0.93, 0.13},
         {0.85, 0.0},
         {0.25, 0.0},
         {0.2, 0.06},
         {0.12, 0.06},
         {0.12, 0.22},
         {0.0, 0.22}},
        false, false);
  return m;
}

MeshBuilder makeDrum(std::uint32_t stone, int detail) {
  MeshBuilder m;
  m.material(stone);
  const int per_flute = detail + 1, n = 20 * per_flute;
  const auto rim = [&](int i, double y) {
    const double s = 2.0 * (i % per_flute) / per_flute - 1;
    return lathePoint({0.5 * (1 - 0.075 * (1 - s * s)), y}, kTau * i / n);
  };
  m.grid(n, 1, [&](int i, int j) { return rim(i, j * 0.95); });
  for (int i = 0; i < n; ++i)
    m.triangle({0, 0.95, 0}, rim(i + 1, 0.95), rim(i, 0.95));  // it stands on the ground: no bottom
  return m;
}

}  // namespace

GlbScene makeTemple(int detail) {
  GlbScene scene("Temple");
  const auto marble =
      scene.addMaterial({.name = "marble", .base_colour = {0.76f, 0.71f, 0.62f}, .roughness = 0.7f});
  const auto step = scene.addMaterial({.name = "limestone", .base_colour = {0.62f, 0.58f, 0.5f}});
  const auto red = scene.addMaterial({.name = "red plaster", .base_colour = {0.5f, 0.15f, 0.09f}});
  const auto blue = scene.addMaterial({.name = "blue paint", .base_colour = {0.1f, 0.2f, 0.38f}});
  const auto tile = scene.addMaterial({.name = "roof tile", .base_colour = {0.56f, 0.28f, 0.17f}});
  const auto wood = scene.addMaterial({.name = "cedar", .base_colour = {0.3f, 0.17f, 0.09f}});
  const auto bronze =
      scene.addMaterial({.name = "bronze", .base_colour = {0.36f, 0.24f, 0.1f}, .roughness = 0.4f});
  const auto coal = scene.addMaterial(
      {.name = "embers", .base_colour = {0.2f, 0.05f, 0.02f}, .emission = {6.0f, 1.8f, 0.35f}});
  const auto earth =
      scene.addMaterial({.name = "earth", .base_colour = {0.42f, 0.36f, 0.22f}, .roughness = 1.0f});
  const auto leaf = scene.addMaterial({.name = "cypress", .base_colour = {0.08f, 0.16f, 0.06f}});

  MeshBuilder base, ground, entablature, ceiling, cella, roof;
  base.material(step), ground.material(earth), entablature.material(marble);
  addBase(base), addGround(ground), addEntablature(entablature);
  addCeiling(ceiling, blue), addCella(cella, marble, red, wood), addRoof(roof, tile, marble, detail);
  scene.place("ground", scene.addMesh("ground", ground));
  scene.place("stepped base", scene.addMesh("stepped base", base));
  scene.place("entablature", scene.addMesh("entablature", entablature));
  scene.place("ceiling", scene.addMesh("ceiling", ceiling));
  scene.place("cella", scene.addMesh("cella", cella));
  scene.place("roof", scene.addMesh("roof", roof, 30.0));

  const auto column = scene.addMesh("column", makeColumn(marble, detail));
  int number = 0;
  const auto placeColumn = [&](double x, double z) {
    scene.place("column " + std::to_string(++number), column, {.position = {x, 0, z}});
  };
  for (int k = 0; k < kAlong; ++k)
    for (int i = 0; i < kAcross; ++i)
      if (i == 0 || k == 0 || i == kAcross - 1 || k == kAlong - 1)
        placeColumn(-kAxisX + i * kBay, -kAxisZ + k * kBay);
  // Between the antae, under a beam of their own.
  for (const double x : {-1.0, 1.0}) placeColumn(x * 1.08, kCellaFront - 0.5);
  MeshBuilder beam;
  beam.material(marble);
  box(beam, {-kCellaX + kWall, kColumn, kCellaFront - 0.95}, {kCellaX - kWall, kCeiling, kCellaFront - 0.05},
      0.0, kXLo | kXHi | kYHi);
  scene.place("antae beam", scene.addMesh("antae beam", beam));

  const auto triglyph = scene.addMesh("triglyph", makeTriglyph(blue, marble));
  const double face_x = kAxisX + kBeam, face_z = kAxisZ + kBeam;
  number = 0;
  const auto placeTriglyph = [&](P3 p, double turn) {
    scene.place("triglyph " + std::to_string(++number), triglyph, {.position = p, .turn_y = turn});
  };
  for (int k = 0; k < 2 * kAcross - 1; ++k) {
    const double x = (-1 + 2.0 * k / (2 * kAcross - 2)) * (face_x - 0.36);
    placeTriglyph({x, 0, face_z}, 0), placeTriglyph({x, 0, -face_z}, kTau / 2);
  }
  for (int k = 0; k < 2 * kAlong - 1; ++k) {
    const double z = (-1 + 2.0 * k / (2 * kAlong - 2)) * (face_z - 0.36);
    placeTriglyph({face_x, 0, z}, kTau / 4), placeTriglyph({-face_x, 0, z}, -kTau / 4);
  }

  const auto acroterion = scene.addMesh("acroterion", makeAcroterion(marble, detail));
  for (const double s : {-1.0, 1.0}) {
    const double z = s * (kRoofZ - 0.22);
    scene.place(s > 0 ? "acroterion front" : "acroterion back", acroterion,
                {.position = {0, roofHeight(0) + 0.16, z}, .scale = P3(1.25)});
    for (const double x : {-1.0, 1.0})
      scene.place("acroterion corner", acroterion, {.position = {x * (kRoofX - 0.25), kCornice + 0.2, z}});
  }

  scene.place("statue", scene.addMesh("statue", makeStatue(marble, bronze, detail)),
              {.position = {0, 0, -4.4}});
  const auto brazier = scene.addMesh("brazier", makeBrazier(bronze, coal, detail));
  const auto cypress = scene.addMesh("cypress", makeCypress(leaf, wood, std::min(detail, 4)), 60.0);
  const auto fire = scene.addLight({.name = "cella fire",
                                    .type = "point",
                                    .colour = {1.0f, 0.62f, 0.3f},
                                    .intensity = 5.0f,
                                    .group = "cella"});
  const auto torch = scene.addLight({.name = "front fire",
                                     .type = "point",
                                     .colour = {1.0f, 0.62f, 0.3f},
                                     .intensity = 8.0f,
                                     .group = "front"});
  const auto sun = scene.addLight({.name = "sun",
                                   .type = "directional",
                                   .colour = {1.0f, 0.95f, 0.86f},
                                   .intensity = 5.0f,
                                   .group = "sun"});
  for (const double x : {-1.0, 1.0}) {
    const std::string side = x < 0 ? " left" : " right";
    scene.place("cella brazier" + side, brazier, {.position = {x * 1.75, 0, -3.3}});
    scene.placeLight("cella fire" + side, fire, {x * 1.75, 1.45, -3.3});
    scene.place("front brazier" + side, brazier, {.position = {x * 3.1, kGround, kAxisZ + 5.1}});
    scene.placeLight("front fire" + side, torch, {x * 3.1, kGround + 1.45, kAxisZ + 5.1});
  }
  scene.placeLight("sun", sun, {30, 40, 35}, {0, 0, 2});
  scene.place("altar", scene.addMesh("altar", makeAltar(step)), {.position = {0, kGround, kAxisZ + 7.2}});
  const double edge_x = kAxisX + kEdge + 2 * kTread, edge_z = kAxisZ + kEdge + 2 * kTread;
  const P3 trees[] = {{-edge_x - 6, 1.0, 5},   {-edge_x - 4.5, 0.85, -3}, {-edge_x - 7, 1.15, -11},
                      {edge_x + 6.5, 1.1, -8}, {edge_x + 5, 0.9, -14},    {edge_x + 9, 1.2, 1}};
  for (const P3 t : trees)
    scene.place("cypress", cypress, {.position = {t.x, kGround, t.z}, .turn_y = t.x + t.z, .scale = P3(t.y)});
  const auto drum = scene.addMesh("fallen drum", makeDrum(marble, detail));
  scene.place("standing drum", drum, {.position = {edge_x + 1.6, kGround, 7.4}, .turn_y = 0.4});
  scene.place("standing drum 2", drum,
              {.position = {edge_x + 2.9, kGround, 8.8}, .turn_y = 1.1, .scale = {1, 0.62, 1}});

  scene.addCamera("front", {11.5, 1.3, edge_z + 15}, {0.3, 3.2, 2}, 42);
  scene.addCamera("colonnade", {kAxisX - 1.35, 1.7, kAxisZ - 0.4}, {kAxisX - 1.75, 1.9, -6}, 58);
  scene.addCamera("cella", {0.5, 1.75, kCellaFront - 0.9}, {0, 2.2, -4.4}, 50);
  scene.addCamera("corner", {kAxisX + 5.5, 2.2, kAxisZ + 6.5}, {kAxisX - 1.2, 4.7, kAxisZ - 1.5}, 50);
  scene.addCamera("above", {24, 19, 28}, {0, 2, -1}, 34);
  scene.note("Doric temple");
  return scene;
}

}  // namespace relume::scenes
