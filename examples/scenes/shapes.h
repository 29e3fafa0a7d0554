// SPDX-License-Identifier: MIT
// Solids and surfaces of which the example scenes are built. Metres, +Y up, outside by winding.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "mesh_builder.h"

namespace relume::scenes {

/// Faces of a box, to be left out where they would lie on something else.
enum Side : std::uint32_t { kXLo = 1, kXHi = 2, kYLo = 4, kYHi = 8, kZLo = 16, kZHi = 32 };

/// Box with bevelled edges (45 degrees, `bevel` wide along each face). Edges of a face left out stay sharp,
/// so the open box ends flush with the surface it stands on.
void box(MeshBuilder& mesh, P3 lo, P3 hi, double bevel = 0.0, std::uint32_t without = 0);

/// Surface of revolution about +Y of the profile (radius, height): a profile that rises faces outward, one
/// that falls faces the axis. `turn` < 2 pi makes a part, beginning at the angle `from` (see `lathePoint`).
void lathe(MeshBuilder& mesh, const std::vector<P2>& profile, int segments, double from = 0.0,
           double turn = kTau);
/// Point at angle theta: (r cos theta, y, r sin theta).
P3 lathePoint(P2 profile, double theta);

/// A point of a path with the frame in which a profile (s, t) stands: position + s * side + t * up. Along the
/// path lies side x up.
struct Station {
  P3 position, side, up;
};
/// Sweeps a profile along stations; a counter-clockwise profile faces outward. A closed profile joins its end
/// to its start; `caps` closes the ends of a convex one.
void sweep(MeshBuilder& mesh, const std::vector<Station>& path, const std::vector<P2>& profile, bool closed,
           bool caps);
/// Stations of a curve in a plane: side is the plane's normal, up = direction x normal; mitred at corners.
std::vector<Station> planarPath(const std::vector<P3>& points, P3 normal, bool closed = false);
/// Round tube along points with smoothly turned frames, its ends closed.
void tube(MeshBuilder& mesh, const std::vector<P3>& points, double radius, int segments);

/// Counter-clockwise circle.
std::vector<P2> circleProfile(double radius, int segments);
/// Rectangle [-w/2, w/2] x [lo, hi] with bevelled corners, counter-clockwise.
std::vector<P2> bevelledRectangle(double width, double lo, double hi, double bevel);

/// Pointed arch over [-span/2, span/2]: two arcs that rise from the springing line y = 0 to the crown y =
/// rise >= span/2.
class PointedArch {
 public:
  PointedArch(double span, double rise);
  double height(double x) const;     ///< y over x
  double halfWidth(double y) const;  ///< x >= 0 at height y
  /// Point at t in [0, 2]: from (span/2, 0) over the crown at t = 1 to (-span/2, 0); equal steps of angle.
  P2 at(double t) const;
  double span() const { return span_; }
  double rise() const { return rise_; }
  double radius() const { return radius_; }

 private:
  double span_, rise_, radius_;
};

M4 translate(P3 t);
M4 rotateY(double radians);
M4 rotate(double radians, P3 axis);
M4 scale(P3 s);

}  // namespace relume::scenes
