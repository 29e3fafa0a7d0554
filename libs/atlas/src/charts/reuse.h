// SPDX-License-Identifier: MIT
// Whether the second texture coordinates that came with a mesh can carry a bake.
#pragma once
#include <optional>
#include <string>

#include "charts/unwrap.h"

namespace relume::atlas {

/// A layout that came with the mesh, as charts: its islands. uv are those of the mesh less `corner`.
struct Reused {
  Unwrap layout;               ///< source_vertex counts up; uv in units of TEXCOORD_1
  Vec2 extent{0.0f};           ///< of all islands
  double metres_per_unit = 1;  ///< so that the areas of layout and surface agree, in the metric
};

/// What is wrong with a layout; empty when nothing is. Percentages are of covered texels.
using Fault = std::string;

/// Checks all that does not depend on the size it is baked at: range, degenerate triangles, overlap, even
/// density.
std::optional<Reused> reuseLayout(const scene::Mesh& mesh, const Mat3& metric, Fault& fault);

/// Checks that islands keep `gutter` texels apart when a unit of uv is `texels` wide.
bool guttersSuffice(const Reused& reused, double texels, int gutter, Fault& fault);

}  // namespace relume::atlas
