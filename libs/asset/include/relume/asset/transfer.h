// SPDX-License-Identifier: MIT
// Transfer of light as a layer keeps it: what the bake writes and the run time reads (docs/format.md, kind
// `lightpath`).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/codec/block_matrix.h"

namespace relume::asset {

/// Where light enters: patches of the surface, each with fixed points at which irradiance is taken. A patch
/// has one entry or several: first its mean light, then modes of how it varies, which may be below 0.
struct Entries {
  std::uint32_t samples = 1;         ///< points of a patch, equal shares of its light
  std::vector<Point> position;       ///< world; shape: [patches][samples]
  std::vector<Normal> normal;        ///< world, unit length; shape: [patches][samples]
  std::vector<std::uint32_t> first;  ///< by patch, and one more: its entries
  /// Shape: by patch [samples][entries of the patch]. An entry is the sum over its patch's points of mix
  /// times the direct irradiance there. The file keeps 8 bits of it.
  std::vector<float> mix;
  std::vector<float> area;  ///< m^2; shape: [entries]; equal shares of the patch's

  std::size_t size() const { return area.size(); }
  std::size_t patches() const { return first.empty() ? 0 : first.size() - 1; }
  /// One entry for each of so many patches, the mean over its points.
  void setMeans(std::size_t count);
};

/// Exits at vertices of meshes: a row of the matrix for each. A vertex of a mesh has the exit at its place in
/// the world whose normal is its own.
struct VertexExits {
  std::vector<Point> position;  ///< world; shape: [exits]
  std::vector<Normal> normal;   ///< world, unit length; shape: [exits]
  // The triangle that a texel lies on. shape: [texels of the atlas table][3]
  std::vector<std::uint32_t> texel_exit;
  std::vector<std::uint8_t> texel_weight;  ///< of 255, which they sum to
};

/// Exits at probes: places origin + spacing (i, j, k), i < count[0] and so on. A probe has 9 rows of the
/// matrix: irradiance along n is the sum of row 9 p + m times basis::sh9(n)[m].
struct ProbeExits {
  static constexpr std::uint32_t kRows = 9;
  static constexpr std::uint32_t kNoProbe = 0xffffffffu;
  Point origin{0};
  float spacing = 1;  ///< metres
  std::array<std::uint32_t, 3> count{};
  std::vector<std::uint32_t> probe;  ///< shape: [count[2]][count[1]][count[0]]; kNoProbe: in a body
};

/// Where it leaves: blocks of side x side texels of the atlas, of one chart each, or one of the others.
struct Exits {
  enum class Kind : std::uint8_t { kTexels, kVertices, kProbes };
  Kind kind = Kind::kTexels;
  std::uint32_t side = 1;                    ///< texels along a block; 0: exits are no blocks
  std::vector<std::uint32_t> exit_of_texel;  ///< shape: [texels of the atlas table]; a row of the matrix
  VertexExits vertices;
  ProbeExits probes;
};

/// What the matrix leaves out of light whose last way is short, by texel: the share of directions in which
/// surfaces are near, times their reflectance. With `far` what exits give a texel, E its direct irradiance
/// and c the share, its indirect irradiance is (far + c E) / (1 - c): near surfaces are taken to be lit as
/// the texel is. The file keeps shares to 1 / 510.
using NearShares = std::vector<Vec3>;  ///< shape: [texels of the atlas table], or empty: nothing is left out

/// What the bake found of its own errors, under random lamps of its own that keep an entry's width from all
/// surfaces: roots of summed squares at exits over that of the light.
struct TransferErrors {
  float entries = 0;   ///< of taking irradiance at entries instead of everywhere
  float transfer = 0;  ///< noise of the transfer
  float encoding = 0;  ///< of the stored matrix
};

/// Irradiance of exit x = sum over entries e of matrix[x][e] e. Indirect light alone: the direct light at the
/// exit is not in it.
struct Transfer {
  codec::BlockMatrix matrix;  ///< rows: exits (of probes 9 for each), columns: entries
  Entries entries;
  Exits exits;
  NearShares near_share;
  std::optional<TransferErrors> errors;

  /// Throws Error kCorruptAsset, naming `layer`, unless the parts fit each other and `atlas`, numbers are
  /// finite, areas not negative, normals of unit length, and every block of texels lies in one
  /// chart.
  void check(const AtlasTable& atlas, const std::string& layer) const;
};

/// The grid that positions of entry points are kept on, metres: one may come back up to 0.87 steps off, and
/// so under its surface. Points that rays will start from are better moved up a step first.
float entryPointStep(const Entries& entries);

/// Tables for Layer::tables. Positions of entry points are kept to 2^-12 of the mean entry's side (or 2^-23
/// of the extent, where that is coarser), normals to 1e-4 rad, mix to 1/254 of the largest of its entry, all
/// else bit for bit. Throws as check().
std::vector<Table> transferTables(const Transfer& transfer, const AtlasTable& atlas);

/// Throws Error kMismatch where `layer` has no transfer, kCorruptAsset where its tables do not make a sound
/// one.
Transfer readTransfer(const Layer& layer, const AtlasTable& atlas);

}  // namespace relume::asset
