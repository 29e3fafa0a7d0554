// SPDX-License-Identifier: MIT
// The second UV set: charts over the static instances of a scene, packed into pages.
// Based on:
//   [IKSZ03] Iones, Krupkin, Sbert, Zhukov. Fast, Realistic Lighting for Video Games. 2003. Section 3 (clustering).
// Beyond the paper: best-fit planes and a stretch-minimizing map instead of the world axes, merging, tight bitmap packing.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "relume/core/error.h"
#include "relume/core/progress.h"
#include "relume/scene/scene.h"

namespace relume::atlas {

struct AtlasOptions {
  int page_size = 1024;              ///< texels, width and height of a page (a multiple of 4)
  float texels_per_metre = 0.0f;     ///< 0: as dense as fits into one page; otherwise as many pages as it takes
  int gutter = 2;                    ///< texels between the covered texels of two charts
  float discontinuity_angle = 1.05f; ///< radians between neighbouring faces of one chart (60 degrees, [IKSZ03] 3)
  float cone_angle = 1.2f;           ///< radians between a face and its chart's axis
  bool reuse_uv1 = true;             ///< keep a valid TEXCOORD_1
};

struct Chart {
  std::uint32_t instance = 0;        ///< index into Scene::instances
  std::uint32_t page = 0;
  std::uint32_t first_texel_x = 0, first_texel_y = 0, width = 0, height = 0;  ///< bounding box in the page, texels
  float mean_stretch = 1, max_stretch = 1;  ///< over its triangles: larger singular value of uv -> surface, relative to equal density
};

/// How the vertices of one static instance primitive are split, and where they lie.
struct InstanceUv {
  std::uint32_t instance = 0;
  std::uint32_t page = 0;                     ///< all charts of an instance primitive lie on one page
  bool reused = false;                        ///< its own TEXCOORD_1 was kept (scaled into its place)
  std::vector<std::uint32_t> source_vertex;   ///< new vertex -> vertex of the mesh
  std::vector<UVec3> triangles;               ///< of new vertices; same order as Mesh::triangles
  std::vector<Vec2> uv;                       ///< per new vertex, texel units of the page: (0,0) is the corner of texel (0,0)
  std::vector<std::uint32_t> triangle_chart;  ///< index into Atlas::charts; kNone for degenerate triangles
};

struct AtlasStatistics {
  double coverage = 0;               ///< covered texels / texels of all pages
  double mean_stretch = 1, max_stretch = 1;  ///< area-weighted L2 stretch over charts that are ours; L-infinity
  std::uint64_t overlapping_texels = 0;      ///< texels whose centre two triangles claim
  std::size_t charts = 0;
  float texels_per_metre = 0;
};

struct Atlas {
  int width = 0, height = 0;         ///< of each page, texels
  std::uint32_t pages = 0;
  std::vector<Chart> charts;
  std::vector<InstanceUv> instances; ///< one per static instance, in scene order
  AtlasStatistics statistics;

  std::size_t texels() const {
    return static_cast<std::size_t>(pages) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// Deterministic: equal geometry, equal atlas. A TEXCOORD_1 that is refused is a warning with the reason and numbers.
/// Throws Error kEmptyScene when there is nothing static to bake, kUsage for impossible options.
Atlas buildAtlas(const scene::Scene& scene, const AtlasOptions& options, Warnings& warnings, Progress& progress);

}  // namespace relume::atlas
