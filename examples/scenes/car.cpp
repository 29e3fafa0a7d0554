// SPDX-License-Identifier: MIT
// A small automobile on a turntable in a studio.
//
// The body is one grid of quads. A station is a plane across the car; its section runs through five guide
// points (roof centre, roof rail, belt, shoulder, sill) that follow curves along the car. Above the shoulder
// the stations are sections. Below it they bend so that they end on the lower outline, which goes around the
// wheel arches; the depth is that of the body at the bent point. From the outline the grid goes on inward, as
// wheel wells and floor, so that the shell is closed. Panes and door joints are cells set back from it.
#include <algorithm>
#include <cmath>
#include <string>

#include "curve.h"
#include "relume/core/check.h"
#include "scenes.h"
#include "shapes.h"

namespace relume::scenes {
namespace {

// x forward, y up, z to the right; the ground is y = 0.
constexpr double kFrontAxle = 1.22, kRearAxle = -1.2, kAxleHeight = 0.32, kTyre = 0.32, kArch = 0.385;
constexpr double kSill = 0.21, kFloor = 0.19, kWellDepth = 0.5;
constexpr double kNose = 1.72, kTail = -1.7, kNoseLength = 0.24,
                 kTailLength = 0.2;  // where and how far the ends round off

// The guide points of the section at x, as (z, y): roof centre, rail, belt, shoulder, sill.
std::array<P2, 5> guides(double x) {
  static const Curve top{{-1.7, 0.86},  {-1.55, 0.95}, {-1.35, 1.07}, {-0.95, 1.315}, {-0.6, 1.41},
                         {-0.15, 1.44}, {0.25, 1.405}, {0.5, 1.31},   {0.98, 0.985},  {1.06, 0.945},
                         {1.3, 0.905},  {1.55, 0.835}, {1.72, 0.76}};
  static const Curve rail_y{{-1.7, 0.85},  {-1.55, 0.93}, {-1.35, 1.04}, {-0.95, 1.25}, {-0.6, 1.325},
                            {-0.15, 1.35}, {0.25, 1.31},  {0.5, 1.215},  {0.98, 0.945}, {1.06, 0.92},
                            {1.3, 0.885},  {1.55, 0.82},  {1.72, 0.745}};
  static const Curve rail_z{{-1.7, 0.42}, {-1.35, 0.5}, {-0.95, 0.535}, {-0.15, 0.56},
                            {0.5, 0.575}, {0.98, 0.62}, {1.3, 0.56},    {1.72, 0.4}};
  static const Curve belt_y{{-1.7, 0.8},  {-1.4, 0.88}, {-0.9, 0.9},  {0.0, 0.88}, {0.8, 0.865},
                            {1.05, 0.86}, {1.3, 0.835}, {1.55, 0.77}, {1.72, 0.7}};
  static const Curve belt_z{{-1.7, 0.6},  {-1.4, 0.69},  {-0.9, 0.735}, {0.0, 0.75},
                            {0.7, 0.745}, {1.05, 0.735}, {1.4, 0.69},   {1.72, 0.57}};
  static const Curve shoulder_z{{-1.7, 0.7}, {-1.4, 0.785}, {-0.9, 0.81},  {0.0, 0.81},
                                {0.8, 0.81}, {1.3, 0.795},  {1.55, 0.745}, {1.72, 0.675}};
  static const Curve shoulder_y{{-1.7, 0.68}, {-1.4, 0.74}, {0.0, 0.735}, {1.3, 0.735}, {1.72, 0.64}};
  static const Curve sill_z{{-1.7, 0.66}, {-1.2, 0.75}, {0.0, 0.765}, {1.2, 0.755}, {1.72, 0.64}};
  return {P2(0, top(x)), P2(rail_z(x), rail_y(x)), P2(belt_z(x), belt_y(x)), P2(shoulder_z(x), shoulder_y(x)),
          P2(sill_z(x), kSill)};
}

// Section at x: s in [0, 4] through the guides (Catmull-Rom; mirrored at the roof centre).
P2 section(double x, double s) {
  const auto g = guides(x);
  const int k = std::clamp(int(s), 0, 3);
  const double t = s - k;
  const P2 b = g[k], c = g[k + 1];
  const P2 a = k == 0 ? P2(-g[1].x, g[1].y) : g[k - 1];
  const P2 d = k == 3 ? P2(g[4].x - 0.06, g[4].y - 0.25) : g[k + 2];
  // Tangents by distance, so that a short edge beside a long one does not overshoot.
  const double ab = glm::distance(a, b), bc = glm::distance(b, c), cd = glm::distance(c, d);
  const P2 tb = ((b - a) / ab * bc + (c - b) / bc * ab) / (ab + bc) * bc;
  const P2 tc = ((c - b) / bc * cd + (d - c) / cd * bc) / (bc + cd) * bc;
  return b * ((1 + 2 * t) * (1 - t) * (1 - t)) + tb * (t * (1 - t) * (1 - t)) + c * (t * t * (3 - 2 * t)) +
         tc * (t * t * (t - 1));
}

// Half width of the body's side at (x, y), y at or below the shoulder, with a flare around the wheel arches.
double sideDepth(double x, double y) {
  double lo = 3, hi = 4;
  for (int i = 0; i < 40; ++i) {
    const double mid = (lo + hi) / 2;
    (section(x, mid).y > y ? lo : hi) = mid;
  }
  double z = section(x, lo).x;
  for (const double axle : {kFrontAxle, kRearAxle}) {
    const double d = std::hypot(x - axle, y - kAxleHeight) - kArch;
    z += 0.028 * std::exp(-d * d / 0.006);
  }
  return z;
}

struct StationLine {
  double x = 0;         // of the section above the shoulder
  P2 foot{0.0};         // (x, y) on the lower outline
  double round = 0;     // 0 along the car; up to pi/2 where an end rounds off
  bool groove = false;  // between this station and the next
};

std::vector<StationLine> makeStations(int detail, double door_rear, double door_front) {
  std::vector<StationLine> out;
  const auto plain = [&](double from, double to, int n) {  // without the end
    for (int i = 0; i < n; ++i) {
      const double x = from + (to - from) * i / n;
      out.push_back({x, {x, kSill}, 0, false});
    }
  };
  const auto arch = [&](double axle) {
    const int n = 6 + 4 * detail;
    std::vector<P2> feet = {{axle - kArch - 0.014, kSill}, {axle - kArch - 0.007, (kSill + kAxleHeight) / 2}};
    for (int i = 0; i <= n; ++i) {
      const double a = kTau / 2 * (1 - double(i) / n);
      feet.push_back({axle + kArch * std::cos(a), kAxleHeight + kArch * std::sin(a)});
    }
    feet.push_back({axle + kArch + 0.007, (kSill + kAxleHeight) / 2});
    feet.push_back({axle + kArch + 0.014, kSill});
    const int m = int(feet.size()) - 1;
    for (int k = 0; k <= m; ++k) {
      const double even = 2.0 * k / m - 1, round = -std::cos(kTau / 2 * k / m);
      out.push_back({axle + (kArch + 0.02) * (0.65 * even + 0.35 * round), feet[k], 0, false});
    }
  };
  const int ends = 4 + 2 * detail;
  const double gap = 0.012, clear = kArch + 0.02 + 0.04;
  for (int i = ends; i >= 1; --i) out.push_back({kTail, {kTail, kSill}, -kTau / 4 * 0.9 * i / ends, false});
  plain(kTail, kRearAxle - clear + 0.03, 2);
  arch(kRearAxle);
  plain(kRearAxle + clear, door_rear, detail);
  out.push_back({door_rear, {door_rear, kSill}, 0, true});
  plain(door_rear + gap, door_front - gap, 3 + 4 * detail);
  out.push_back({door_front - gap, {door_front - gap, kSill}, 0, true});
  plain(door_front, kFrontAxle - clear + 0.01, 1);
  arch(kFrontAxle);
  plain(kFrontAxle + clear - 0.03, kNose, 2);
  for (int i = 0; i <= ends; ++i) out.push_back({kNose, {kNose, kSill}, kTau / 4 * 0.9 * i / ends, false});
  for (std::size_t i = 1; i < out.size(); ++i) RELUME_CHECK_LT(out[i - 1].x, out[i].x + 1e-9);
  return out;
}

/// The shell's right half as a grid p(u, v): u along the car, v from the roof's centre line around to the
/// floor's.
class Shell {
 public:
  static constexpr double kDoorRear = -0.62, kDoorFront = 0.66;

  explicit Shell(int detail) : stations_(makeStations(detail, kDoorRear, kDoorFront)) {
    const auto add = [&](double from, std::initializer_list<double> shares) {
      for (const double s : shares) upper_.push_back(from + s);
    };
    add(0, {0.0, 0.25, 0.5, 0.72, 0.88});
    add(1, {0.0, 0.14, 0.4, 0.65, 0.86});
    add(2, {0.0, 0.25, 0.5, 0.75});
    upper_.push_back(3.0);
    lower_ = {0.12, 0.3, 0.5, 0.68, 0.8, 0.83, 0.92, 1.0};
    for (int u = 0; u < stationCount(); ++u)
      for (int v = 0; v < rowCount(); ++v) points_.push_back(compute(u, v));
  }

  int stationCount() const { return int(stations_.size()); }
  int rowCount() const { return int(upper_.size() + lower_.size()) + 6; }
  const StationLine& station(int u) const { return stations_[u]; }
  P3 at(int u, int v) const { return points_[u * rowCount() + v]; }
  int outlineRow() const { return int(upper_.size() + lower_.size()) - 1; }
  int row(double s) const {
    return int(std::lower_bound(upper_.begin(), upper_.end(), s - 1e-9) - upper_.begin());
  }
  int lowerRow(double share) const {
    return int(upper_.size() +
               (std::lower_bound(lower_.begin(), lower_.end(), share - 1e-9) - lower_.begin()));
  }
  int stationAt(double x) const {
    int best = 0;
    for (int u = 0; u < stationCount(); ++u)
      if (std::abs(stations_[u].x - x) < std::abs(stations_[best].x - x)) best = u;
    return best;
  }
  P3 normal(int u, int v) const {
    const int u0 = std::max(u - 1, 0), u1 = std::min(u + 1, stationCount() - 1),
              v1 = std::min(v + 1, rowCount() - 1);
    P3 across = v == 0 ? P3(0, at(u, 1).y - at(u, 0).y, 2 * at(u, 1).z) : at(u, v1) - at(u, v - 1);
    if (v == 0) across = P3(0, 0, 1);
    return glm::normalize(glm::cross(across, at(u1, v) - at(u0, v)));
  }

 private:
  P3 compute(int u, int v) const {
    const StationLine& s = stations_[u];
    P3 p;
    const int outline = outlineRow();
    if (v < int(upper_.size())) {
      const P2 q = section(s.x, upper_[v]);
      p = {s.x, q.y, q.x};
      if (v + 1 == int(upper_.size())) p.z = sideDepth(s.x, q.y);
    } else if (v <= outline) {
      const P2 from(s.x, section(s.x, 3.0).y);
      const double w = lower_[v - upper_.size()];
      // Rows keep level along the doors and wrap around the arches; x moves to the foot faster than y falls.
      const P2 q(from.x + (s.foot.x - from.x) * (1 - (1 - w) * (1 - w)), from.y + (s.foot.y - from.y) * w);
      p = {q.x, q.y, sideDepth(q.x, q.y)};
    } else {
      const double rim = sideDepth(s.foot.x, s.foot.y), step = v - outline;
      if (step <= 3) {  // lip, then inward
        const double z = step == 1 ? rim - 0.02 : step == 2 ? (rim + kWellDepth) / 2 : kWellDepth;
        p = {s.foot.x, s.foot.y, z};
      } else {
        p = {s.foot.x, step == 4 ? (s.foot.y + kFloor) / 2 : kFloor, step <= 5 ? kWellDepth : 0.0};
      }
    }
    if (s.round != 0) {
      const double c = std::cos(s.round), length = s.round > 0 ? kNoseLength : kTailLength,
                   centre = s.round > 0 ? 0.46 : 0.54;
      p.x += length * std::sin(s.round);
      p.z *= std::pow(c, 0.5);
      p.y = centre + (p.y - centre) * std::pow(c, 0.62);
    }
    return p;
  }

  std::vector<StationLine> stations_;
  std::vector<double> upper_, lower_;
  std::vector<P3> points_;
};

struct Paints {
  std::uint32_t body, glass, rubber, metal, dark, lamp, tail, plate, floor, backdrop, softbox;
};

enum class Cell { kBody, kGlass, kGroove, kUnder };

MeshBuilder makeBody(const Shell& shell, const Paints& paint) {
  const int us = shell.stationCount(), vs = shell.rowCount();
  const int sill_groove = shell.lowerRow(0.8);
  const auto kind = [&](int u, int v) {  // cell between u and u + 1, v and v + 1
    const double x = (shell.station(u).x + shell.station(u + 1).x) / 2;
    if (v >= shell.outlineRow() + 1) return Cell::kUnder;
    const bool rounded = shell.station(u).round != 0 || shell.station(u + 1).round != 0;
    if (!rounded && v < shell.row(0.88)) {
      if (x > 0.36 && x < 0.95) return Cell::kGlass;
      if (x > -1.42 && x < -0.86) return Cell::kGlass;
    }
    if (v >= shell.row(1.14) && v < shell.row(1.86)) {
      if (x > Shell::kDoorRear + 0.06 && x < 0.72) return Cell::kGlass;
      if (x > -1.16 && x < Shell::kDoorRear - 0.03) return Cell::kGlass;
    }
    if (shell.station(u).groove && v >= shell.row(2.0) && v <= sill_groove) return Cell::kGroove;
    if (v == sill_groove && x > Shell::kDoorRear && x < Shell::kDoorFront) return Cell::kGroove;
    return Cell::kBody;
  };
  const auto depth = [](Cell c) { return c == Cell::kGlass ? 0.012 : c == Cell::kGroove ? 0.011 : 0.0; };
  MeshBuilder half;
  const auto corner = [&](int u, int v, double in) {
    P3 p = shell.at(u, v) - in * shell.normal(u, v);
    if (v == 0) p.z = 0;
    return p;
  };
  for (int u = 0; u + 1 < us; ++u)
    for (int v = 0; v + 1 < vs; ++v) {
      const Cell c = kind(u, v);
      const double in = depth(c);
      half.material(c == Cell::kGlass                         ? paint.glass
                    : c == Cell::kGroove || c == Cell::kUnder ? paint.dark
                                                              : paint.body);
      half.quad(corner(u, v, in), corner(u, v + 1, in), corner(u + 1, v + 1, in), corner(u + 1, v, in));
      if (in == 0) continue;
      // Walls of the recess, where a neighbour lies higher.
      half.material(c == Cell::kGlass ? paint.body : paint.dark);
      const auto wall = [&](int u0, int v0, int u1, int v1, bool neighbour, Cell n) {
        const double out = neighbour ? depth(n) : in;
        if (out < in)
          half.quad(corner(u0, v0, out), corner(u1, v1, out), corner(u1, v1, in), corner(u0, v0, in));
      };
      wall(u, v, u, v + 1, u > 0, u > 0 ? kind(u - 1, v) : c);
      wall(u + 1, v + 1, u + 1, v, u + 2 < us, u + 2 < us ? kind(u + 1, v) : c);
      wall(u + 1, v, u, v, v > 0, v > 0 ? kind(u, v - 1) : c);
      wall(u, v + 1, u + 1, v + 1, v + 2 < vs, v + 2 < vs ? kind(u, v + 1) : c);
    }
  // Ends: a recessed grille in front, a recessed plate behind.
  for (const bool front : {false, true}) {
    const int u = front ? us - 1 : 0;
    const double into = front ? -0.03 : 0.012;
    const P3 centre(shell.at(u, 0).x + into, (shell.at(u, 0).y + shell.at(u, vs - 1).y) / 2, 0);
    const auto inset = [&](int v) {
      const P3 p = shell.at(u, v);
      return P3(centre.x, centre.y + 0.9 * (p.y - centre.y), 0.94 * p.z);
    };
    for (int v = 0; v + 1 < vs; ++v) {
      const P3 a = shell.at(u, v), b = shell.at(u, v + 1), c = inset(v), d = inset(v + 1);
      half.material(front ? paint.metal : paint.body);
      if (front) {
        half.quad(a, b, d, c);
      } else {
        half.quad(b, a, c, d);
      }
      half.material(front ? paint.dark : paint.plate);
      if (front) {
        half.triangle(centre, c, d);
      } else {
        half.triangle(centre, d, c);
      }
    }
  }
  MeshBuilder body = half;
  body.append(half, scale({1, 1, -1}));
  return body;
}

/// Moves +Y to `direction` at `position`.
M4 stand(P3 position, P3 direction) {
  const P3 y = glm::normalize(direction), x = glm::normalize(glm::cross(y, P3(0, 0.3, 1))),
           z = glm::cross(x, y);
  return M4(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(position, 1));
}

// Lamps, handles, mirrors, bumpers and wipers: what is fixed to the shell.
MeshBuilder makeFittings(const Shell& shell, const Paints& paint, int detail) {
  MeshBuilder half, both;
  const int seg = 12 + 6 * detail;
  const auto fix = [&](const MeshBuilder& part, int u, int v, double sink, P3 bend = P3(0.0)) {
    half.append(part, stand(shell.at(u, v) - sink * shell.normal(u, v), shell.normal(u, v) + bend));
  };
  MeshBuilder head;
  head.material(paint.metal);
  lathe(head, {{0.125, -0.05}, {0.125, 0.035}, {0.115, 0.05}, {0.105, 0.04}}, seg);
  head.material(paint.lamp);
  lathe(head, {{0.105, 0.04}, {0.085, 0.055}, {0.05, 0.068}, {0.0, 0.073}}, seg);
  const int nose = shell.stationCount() - 1 - (4 + 2 * detail);
  fix(head, nose + 1, shell.row(2.25), 0.02, {0.45, -0.25, 0});
  MeshBuilder rear;
  rear.material(paint.metal);
  lathe(rear, {{0.075, -0.05}, {0.075, 0.022}, {0.068, 0.03}}, seg);
  rear.material(paint.tail);
  lathe(rear, {{0.068, 0.03}, {0.05, 0.042}, {0.0, 0.05}}, seg);
  const int tail = 4 + 2 * detail;
  fix(rear, tail - 1, shell.row(2.75), 0.012, {-0.3, 0, 0});

  half.material(paint.metal);  // door handle
  {
    const int u = shell.stationAt(Shell::kDoorRear + 0.22), v = shell.row(2.5);
    const P3 p = shell.at(u, v), n = shell.normal(u, v);
    tube(half,
         {p + P3(-0.09, 0, 0) - 0.01 * n, p + P3(-0.075, 0, 0) + 0.022 * n, p + P3(0.075, 0, 0) + 0.022 * n,
          p + P3(0.09, 0, 0) - 0.01 * n},
         0.013, 6 + detail);
  }
  {  // mirror: a stalk and a pod
    const int u = shell.stationAt(0.6), v = shell.row(2.0);
    const P3 p = shell.at(u, v), pod = p + P3(0.03, 0.085, 0.13);
    half.material(paint.dark);
    tube(half, {p - P3(0, 0.02, 0.02), p + P3(0.01, 0.03, 0.05), pod}, 0.017, 6 + detail);
    half.material(paint.body);
    MeshBuilder cap;
    cap.material(paint.body);
    std::vector<P2> bowl;
    const int rows = 4 + detail;
    for (int i = 0; i <= rows; ++i)
      bowl.push_back({std::sin(kTau / 4 * (rows - i) / rows), std::cos(kTau / 4 * (rows - i) / rows)});
    lathe(cap, bowl, seg);
    cap.material(paint.glass);
    lathe(cap, {{0.0, 0.06}, {0.88, 0.06}, {0.94, 0.0}, {1.0, 0.0}}, seg);
    half.append(cap, stand(pod - P3(0.03, 0, 0), {1, 0, 0.12}) * scale({0.075, 0.085, 0.115}));
  }
  // Bumpers follow the shell a hand's breadth above the sill.
  for (const bool front : {true, false}) {
    const double y = front ? 0.36 : 0.4;
    std::vector<P3> right;
    const int from = front ? shell.stationAt(kFrontAxle + kArch + 0.06)
                           : shell.stationAt(kRearAxle - kArch - 0.06),
              to = front ? shell.stationCount() - 1 : 0;
    for (int u = from; front ? u <= to : u >= to; u += front ? 1 : -1) {
      // Where the station crosses the bumper's height.
      int v = shell.row(3.0);
      while (v < shell.outlineRow() && shell.at(u, v + 1).y > y) ++v;
      const P3 a = shell.at(u, v), b = shell.at(u, v + 1);
      if (a.y < y || b.y > y) continue;
      P3 p = a + (b - a) * ((a.y - y) / (a.y - b.y));
      p.y = y;
      if (right.empty() || glm::distance(right.back(), p) > 0.02) right.push_back(p);
    }
    std::vector<P3> path = right;
    for (auto it = right.rbegin(); it != right.rend(); ++it) path.push_back({it->x, it->y, -it->z});
    if (!front) std::reverse(path.begin(), path.end());
    both.material(paint.metal);
    std::vector<Station> stations = planarPath(path, {0, 1, 0});
    const int n = int(stations.size());
    for (int i = 0; i < n; ++i) {  // ends taper into the body
      const double t = std::min(std::min(i, n - 1 - i) / 2.5, 1.0),
                   size = 0.35 + 0.65 * std::sqrt(t * (2 - t));
      stations[i].side *= size, stations[i].up *= size;
    }
    sweep(both, stations,
          {{-0.034, -0.012},
           {0.034, -0.012},
           {0.04, 0.015},
           {0.028, 0.038},
           {0.0, 0.046},
           {-0.028, 0.038},
           {-0.04, 0.015}},
          true, true);
  }
  // Bars of the grille.
  const int last = shell.stationCount() - 1;
  const double x = shell.at(last, 0).x - 0.012, lo = shell.at(last, shell.rowCount() - 1).y,
               hi = shell.at(last, 0).y;
  double wide = 0;
  for (int v = 0; v < shell.rowCount(); ++v) wide = std::max(wide, shell.at(last, v).z);
  const int bars = 9;
  for (int k = 1; k < bars; ++k) {
    const double z = wide * 0.86 * (2.0 * k / bars - 1);
    both.material(paint.metal);
    box(both, {x - 0.02, lo + 0.025, z - 0.006}, {x, hi - 0.025, z + 0.006}, 0.0, kXLo);
  }
  both.append(half);
  both.append(half, scale({1, 1, -1}));
  // Wipers lie along the foot of the windscreen.
  both.material(paint.dark);
  const int low = shell.stationAt(0.93), high = shell.stationAt(0.84);
  const auto onScreen = [&](int u, int v, double side, double lift) {
    return (shell.at(u, v) + lift * shell.normal(u, v)) * P3(1, 1, side);
  };
  tube(both, {onScreen(low, 3, 1, -0.01), onScreen(low, 2, 1, 0.012), onScreen(high, 0, 1, -0.003)}, 0.006,
       5);
  tube(both, {onScreen(low, 0, 1, -0.01), onScreen(low, 1, -1, 0.012), onScreen(high, 3, -1, -0.003)}, 0.006,
       5);
  return both;
}

// About +Y, its outer side up.
MeshBuilder makeWheel(const Paints& paint, int detail) {
  MeshBuilder m;
  const int seg = 20 + 10 * detail;
  const double w = 0.095;
  m.material(paint.rubber);
  lathe(m,
        {{0.205, -w + 0.012},
         {0.225, -w},
         {0.27, -w - 0.004},
         {0.305, -w + 0.012},
         {0.318, -w + 0.03},
         {kTyre, -0.022},
         {kTyre - 0.008, -0.018},
         {kTyre - 0.008, 0.018},
         {kTyre, 0.022},
         {0.318, w - 0.03},
         {0.305, w - 0.012},
         {0.27, w + 0.004},
         {0.225, w},
         {0.205, w - 0.012}},
        seg);
  m.material(paint.metal);
  lathe(m,
        {{0.205, w - 0.012},
         {0.205, w + 0.002},
         {0.197, w + 0.004},
         {0.188, w - 0.01},
         {0.178, 0.03},
         {0.178, -0.02}},
        seg);
  m.material(paint.dark);
  lathe(m, {{0.178, -0.02}, {0.12, -0.012}, {0.0, -0.012}}, seg);
  lathe(m, {{0.0, -w + 0.02}, {0.12, -w + 0.02}, {0.205, -w + 0.012}}, seg);
  m.material(paint.metal);
  const int spokes = 5;
  for (int k = 0; k < spokes; ++k) {
    MeshBuilder spoke;
    spoke.material(paint.metal);
    std::vector<Station> path;
    for (int i = 0; i <= 3 + detail; ++i) {
      const double t = double(i) / (3 + detail), r = 0.035 + 0.157 * t;
      const double width = 0.036 - 0.012 * std::sin(kTau / 2 * t) + 0.016 * t * t;
      path.push_back({{r, 0.048 + 0.008 * std::sin(kTau / 4 * t), 0}, {0, 0, -width}, {0, 0.02, 0}});
    }
    sweep(spoke, path, {{-1, -1.2}, {1, -1.2}, {0.85, 0.6}, {0.5, 1}, {-0.5, 1}, {-0.85, 0.6}}, true, false);
    m.append(spoke, rotateY(kTau * k / spokes));
  }
  lathe(m, {{0.05, -0.012}, {0.05, 0.078}, {0.042, 0.086}, {0.03, 0.088}, {0.027, 0.095}, {0.0, 0.1}},
        8 + 4 * detail);
  return m;
}

// Emits towards +z from inside a shallow case; its stand reaches down to y = 0.
MeshBuilder makeSoftbox(const Paints& paint, double height) {
  MeshBuilder m, head;
  const double w = 0.75, h = 0.5, d = 0.35, tx = 0.5, ty = 0.3;
  const P3 front[4] = {{-w, -h, 0}, {w, -h, 0}, {w, h, 0}, {-w, h, 0}},
           back[4] = {{-tx, -ty, -d}, {tx, -ty, -d}, {tx, ty, -d}, {-tx, ty, -d}};
  head.material(paint.dark);
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    head.quad(front[j], front[i], back[i], back[j]);
    const P3 a = front[i], b = front[j], in_a = a * P3(0.96, 0.94, 1) - P3(0, 0, 0.03),
             in_b = b * P3(0.96, 0.94, 1) - P3(0, 0, 0.03);
    head.quad(a, b, in_b, in_a);
  }
  head.quad(back[3], back[2], back[1], back[0]);
  head.material(paint.softbox);
  P3 glow[4];
  for (int i = 0; i < 4; ++i) glow[i] = front[i] * P3(0.96, 0.94, 1) - P3(0, 0, 0.03);
  head.quad(glow[0], glow[1], glow[2], glow[3]);
  m.append(head, translate({0, height, 0}) * rotate(0.42, {1, 0, 0}));
  m.material(paint.metal);
  tube(m, {{0, 0.25, -0.3}, {0, height - 0.02, -0.26}}, 0.022, 8);
  for (int k = 0; k < 3; ++k) {
    const double a = kTau * k / 3;
    tube(m, {{0, 0.62, -0.3}, {0.5 * std::cos(a), 0.015, -0.3 + 0.5 * std::sin(a)}}, 0.015, 6);
  }
  return m;
}

}  // namespace

GlbScene makeCar(int detail) {
  GlbScene scene("Automobile");
  Paints paint{};
  const auto plain = [&](const char* name, Vec3 colour, float roughness) {
    return scene.addMaterial({.name = name, .base_colour = colour, .roughness = roughness});
  };
  paint.body = plain("paint", {0.42f, 0.045f, 0.03f}, 0.35f);
  paint.glass = plain("window", {0.03f, 0.04f, 0.045f}, 0.1f);
  paint.rubber = plain("rubber", {0.035f, 0.035f, 0.035f}, 0.9f);
  paint.metal = plain("bright metal", {0.62f, 0.62f, 0.6f}, 0.25f);
  paint.dark = plain("black trim", {0.03f, 0.03f, 0.03f}, 0.8f);
  paint.lamp = plain("lamp glass", {0.8f, 0.8f, 0.76f}, 0.1f);
  paint.tail = plain("tail lamp", {0.4f, 0.02f, 0.015f}, 0.2f);
  paint.plate = plain("plate", {0.75f, 0.74f, 0.68f}, 0.6f);
  paint.floor = plain("turntable", {0.32f, 0.33f, 0.34f}, 0.6f);
  paint.backdrop = plain("backdrop", {0.6f, 0.62f, 0.64f}, 1.0f);
  paint.softbox =
      scene.addMaterial({.name = "softbox", .base_colour = Vec3(0.8f), .emission = {9.0f, 9.0f, 8.6f}});

  const double deck = 0.14;
  const Shell shell(detail);
  scene.place("body", scene.addMesh("body", makeBody(shell, paint), 42.0), {.position = {0, deck, 0}});
  scene.place("fittings", scene.addMesh("fittings", makeFittings(shell, paint, detail)),
              {.position = {0, deck, 0}});
  MeshBuilder wheel;
  wheel.append(makeWheel(paint, detail), rotate(kTau / 4, {1, 0, 0}));  // axle along z, outer side towards +z
  const auto wheels = scene.addMesh("wheel", wheel);
  const double track = 0.695, steer = 0.17;
  for (const double s : {-1.0, 1.0}) {
    const double out = s > 0 ? 0.0 : kTau / 2;
    const std::string side = s > 0 ? " right" : " left";
    scene.place("front wheel" + side, wheels,
                {.position = {kFrontAxle, deck + kAxleHeight, s * track}, .turn_y = out + steer});
    scene.place("rear wheel" + side, wheels,
                {.position = {kRearAxle, deck + kAxleHeight, s * track}, .turn_y = out});
  }

  MeshBuilder table, studio;
  table.material(paint.floor);
  const double r = 2.75;
  lathe(table,
        {{r + 0.05, 0.0},
         {r + 0.05, 0.03},
         {r, 0.05},
         {r, deck - 0.02},
         {r - 0.02, deck},
         {r - 0.25, deck},
         {r - 0.25, deck - 0.012},
         {r - 0.29, deck - 0.012},
         {r - 0.29, deck},
         {0.0, deck}},
        32 + 16 * detail);
  scene.place("turntable", scene.addMesh("turntable", table), {});
  // A round studio: the floor rises in a hollow curve into the wall.
  studio.material(paint.backdrop);
  const double wall = 7.0, hollow = 1.4;
  const int bend = 3 + 3 * detail;
  std::vector<P2> profile = {{wall, 4.2}};
  for (int i = 0; i <= bend; ++i) {
    const double a = kTau / 4 * (1 - double(i) / bend);
    profile.push_back({wall - hollow * (1 - std::sin(a)), hollow * (1 - std::cos(a))});
  }
  for (const double at : {4.6, 3.6, r + 0.05}) profile.push_back({at, 0.0});
  lathe(studio, profile, 32 + 16 * detail);
  scene.place("studio", scene.addMesh("studio", studio), {});
  const auto softbox = scene.addMesh("softbox", makeSoftbox(paint, 2.6));
  scene.place("softbox left", softbox, {.position = {-3.3, 0, 3.4}, .turn_y = kTau * 0.38});
  scene.place("softbox right", softbox, {.position = {3.9, 0, 2.3}, .turn_y = -kTau * 0.33});

  const auto spot = [&](const char* name, Vec3 colour, float intensity, P3 from, P3 to) {
    const auto light = scene.addLight({.name = name,
                                       .type = "spot",
                                       .colour = colour,
                                       .intensity = intensity,
                                       .group = name,
                                       .inner_cone = 0.25,
                                       .outer_cone = 0.6});
    scene.placeLight(name, light, from, to);
  };
  spot("key", {1.0f, 0.95f, 0.88f}, 160.0f, {3.2, 4.2, 3.8}, {0.2, 0.5, 0});
  spot("fill", {0.75f, 0.85f, 1.0f}, 60.0f, {-4.2, 3.2, 3.0}, {0, 0.5, 0});
  spot("rim", {1.0f, 1.0f, 1.0f}, 90.0f, {-2.5, 4.0, -4.4}, {0, 0.6, 0});

  scene.addCamera("front three quarter", {3.7, 1.5, 3.6}, {0.1, 0.7, 0.0}, 30);
  scene.addCamera("side", {0.0, 1.0, 5.6}, {0, 0.78, 0}, 30);
  scene.addCamera("rear three quarter", {-3.8, 1.75, 3.3}, {-0.1, 0.7, 0}, 30);
  scene.addCamera("wheel", {2.35, 0.6, 2.1}, {1.2, 0.45, 0.7}, 42);
  scene.note("automobile");
  return scene;
}

}  // namespace relume::scenes
