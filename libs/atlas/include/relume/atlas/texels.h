// SPDX-License-Identifier: MIT
// What each covered texel of an atlas is on the surface.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/atlas/atlas.h"
#include "relume/core/quantity.h"
#include "relume/trace/tracer.h"

namespace relume::atlas {

/// A place inside a texel's footprint, on the surface.
struct SubSample {
  Point position;
  std::uint32_t triangle = 0;  ///< of the instance's mesh
};

/// One covered texel. A texel is covered when a triangle of its chart overlaps its square; its quantities are
/// means over the part of the square that the chart covers.
struct SurfacePoint {
  std::uint32_t texel = 0;                   ///< page * width * height + y * width + x
  std::uint32_t chart = 0;                   ///< index into Atlas::charts
  std::uint32_t instance = 0, triangle = 0;  ///< of the sub-sample nearest to the centre
  Point position{0};  ///< on the surface, nearest to the texel's centre inside the chart, 0.01 texels off its
                      ///< edges; world
  Normal geometric_normal{0, 0, 1}, shading_normal{0, 0, 1};
  Vec3 dp_dx{0}, dp_dy{0};  ///< world metres per texel along the page's x and y
  float area = 0;           ///< m^2 of surface in the texel
  float coverage = 1;       ///< share of the texel's square that the chart covers, (0, 1]
  Albedo albedo;            ///< mean over the opaque part of the footprint; emission too (see RasterOptions)
  Radiance emission;
  std::uint32_t first_sample = 0,
                sample_count = 0;  ///< into Texels::samples; 0: wholly inside one flat triangle, so
                                   ///< position + x dp_dx + y dp_dy, x and y in [-1/2, 1/2], is the footprint
};

struct Texels {
  int width = 0, height = 0;
  std::uint32_t pages = 0;
  std::vector<SurfacePoint> points;  ///< by increasing texel
  std::vector<SubSample> samples;    ///< up to 16 places of each texel that needs them
};

/// A surface point in the texel's footprint for u in [0, 1)^2: equal shares of the footprint for equal shares
/// of the square.
Point footprintPosition(const Texels& texels, const SurfacePoint& point, Vec2 u);

struct RasterOptions {
  bool materials = true;  ///< false: albedo and emission stay 0, and no texture is read
};

/// Deterministic, whatever the number of threads. Of two charts that claim a texel, the one that covers more
/// of it owns it (of equals the first), and its point is made from that chart alone. Where charts do not
/// overlap, the areas of all points sum to the surface.
Texels rasterize(const scene::Scene& scene, const Atlas& atlas, Progress& progress,
                 const RasterOptions& options = {});

/// A pair of texel footprints on the two sides of a chart edge that is one edge in space: within a mesh or
/// between objects.
struct SeamSample {
  // Bilinear look-ups: value = sum weight * texel; the two sides ought to agree.
  std::uint32_t texel[2][4];
  float weight[2][4];
};
/// Samples along all seam edges, about one per texel of edge length. Edges of different objects that coincide
/// in space and whose normals agree (shading normals within 20 degrees) are seams too (modular kits), also
/// where edges overlap in part (T-junctions).
std::vector<SeamSample> findSeams(const scene::Scene& scene, const Atlas& atlas, Progress& progress);

/// Stores values of points (channels each, point-major) into full pages: returns [pages * height *
/// width][channels] and sets `covered` to 1 where a texel is covered and valid. Invalid points (valid[i] ==
/// 0) are left for dilation; no `valid`: all are.
void scatter(const Texels& texels, std::span<const float> values, int channels,
             std::span<const std::uint8_t> valid, std::vector<float>& pages,
             std::vector<std::uint8_t>& covered);

/// Fills every texel that is not covered: first inside each chart from its own valid neighbours, then
/// outwards, until none is left. The first rings about a chart take from it alone; farther texels are smooth.
/// Covered texels keep their bits. Without `texels` all covered texels count as one chart. A page without any
/// covered texel stays as it is.
void dilate(int width, int height, std::uint32_t pages, int channels, std::vector<float>& values,
            std::vector<std::uint8_t> covered, const Texels* texels = nullptr);

/// Least squares: moves texel values so that the two sides of seams agree and values change little (weight
/// `fidelity`, > 0). Only texels that a seam touches move, and none leaves the range of the values around it.
/// After dilation. covered: as scatter made it; texels it does not name (gutters, buried ones) follow the
/// covered ones. Empty: all are equal.
void stitchSeams(std::span<const SeamSample> seams, int channels, std::vector<float>& values,
                 float fidelity = 0.1f, std::span<const std::uint8_t> covered = {});

}  // namespace relume::atlas
