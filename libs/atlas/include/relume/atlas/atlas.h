// SPDX-License-Identifier: MIT
// The second UV set: charts over the static instances of a scene, packed into pages.
// Based on:
//   [IKSZ03] Iones, Krupkin, Sbert, Zhukov. Fast, Realistic Lighting for Video Games. 2003. Section 3
//   (clustering). [SSGH01] Sander, Snyder, Gortler, Hoppe. Texture Mapping Progressive Meshes. 2001. Section
//   3 (stretch).
// Beyond the paper: best-fit planes and a stretch-minimizing map instead of the world axes, merging, tight
// bitmap packing. Stretch is that of the map page -> surface, in texels of the target density: with singular
// values G >= g of a triangle's map, the mean is L2, the root of the area-weighted mean of (G^2 + g^2) / 2,
// and the largest is Linf, the largest G. Both are 1 for an isometry.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "relume/core/error.h"
#include "relume/core/progress.h"
#include "relume/scene/scene.h"

namespace relume::atlas {

struct AtlasOptions {
  int page_size = 1024;           ///< texels, width and height of a page (a multiple of 4)
  float texels_per_metre = 0.0f;  ///< 0: as dense as fits into one page; otherwise as many pages as it takes
  int gutter = 2;  ///< texels between the covered texels of two charts; half of it along the border of a page
  /// Radians between neighbouring faces of one chart while charts grow (60 degrees, [IKSZ03] 3). Charts so
  /// small that gutters would dwarf them are afterwards unfolded about sharper edges too, up to 100 degrees,
  /// never further.
  float discontinuity_angle = 1.05f;
  float cone_angle =
      1.2f;  ///< radians between a face and its chart's axis while charts grow; joins are bound by stretch
  bool reuse_uv1 = true;  ///< keep a valid TEXCOORD_1
  /// More covered texels than this are refused before any work: a slip in the options above would otherwise
  /// take all memory. The default is what a texel's index can count.
  std::uint64_t most_texels = 0xffffffffu;
};

struct Chart {
  std::uint32_t instance = 0;  ///< index into Scene::instances
  std::uint32_t page = 0;
  std::uint32_t first_texel_x = 0, first_texel_y = 0, width = 0,
                height = 0;                 ///< bounding box in the page, texels
  float mean_stretch = 1, max_stretch = 1;  ///< L2 and Linf over its triangles
};

/// How the vertices of one static instance primitive are split, and where they lie.
struct InstanceUv {
  std::uint32_t instance = 0;
  std::uint32_t page = 0;                    ///< all charts of an instance primitive lie on one page
  bool reused = false;                       ///< its own TEXCOORD_1 was kept (scaled into its place)
  std::vector<std::uint32_t> source_vertex;  ///< new vertex -> vertex of the mesh
  std::vector<UVec3>
      triangles;  ///< of new vertices; same order as Mesh::triangles. On the page those with a chart of ours
                  ///< wind one way, up to rounding, and every chart has vertices of its own
  std::vector<Vec2> uv;  ///< per new vertex, texel units of the page: (0,0) is the corner of texel (0,0)
  std::vector<std::uint32_t> triangle_chart;  ///< index into Atlas::charts; kNone for degenerate triangles
};

struct AtlasStatistics {
  double coverage = 0;                       ///< covered texels / texels of all pages
  double mean_stretch = 1, max_stretch = 1;  ///< L2 and Linf over all charts that are ours
  std::uint64_t overlapping_texels = 0;      ///< texels whose centre two triangles claim
  std::size_t charts = 0;
  float texels_per_metre =
      0;  ///< what was asked for or found; an instance too large for a page has less, with a warning
};

struct Atlas {
  int width = 0, height = 0;  ///< of each page, texels
  std::uint32_t pages = 0;
  std::vector<Chart> charts;
  std::vector<InstanceUv> instances;  ///< one per static instance, in scene order
  AtlasStatistics statistics;

  std::size_t texels() const {
    return static_cast<std::size_t>(pages) * static_cast<std::size_t>(width) *
           static_cast<std::size_t>(height);
  }
};

/// Deterministic: equal geometry, equal atlas. Instances of a mesh whose transforms differ by a similarity
/// share charts: the same source_vertex and triangles. A TEXCOORD_1 that is refused is a warning with the
/// reason and numbers. Throws Error kEmptyScene when there is nothing static to bake, kUsage for impossible
/// options and for a mesh whose charts are more than a page can hold, kOutOfMemory for more than most_texels,
/// kInterrupted.
Atlas buildAtlas(const scene::Scene& scene, const AtlasOptions& options, Warnings& warnings,
                 Progress& progress);

}  // namespace relume::atlas
