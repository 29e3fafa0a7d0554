// SPDX-License-Identifier: MIT
// Relighting with light path maps: indirect irradiance of every surface under lights that move.
// Based on:
//   [SzirmayKalos] Multi-scale precomputed radiance transfer for indirect lighting: the light path map
//   method. Section 10: I[u, v] = sum over entries e of I_e T_e[u, v].
#pragma once
#include <cstddef>
#include <memory>
#include <span>

#include "relume/asset/asset.h"
#include "relume/asset/transfer.h"
#include "relume/relight/light_set.h"
#include "relume/relight/visibility.h"

namespace relume::relight {

/// Lights to entries (the mean light of patches that it reaches first, and modes of how it varies there),
/// entries to exits (blocks of texels) by
/// one product with the stored transfer, exits to texels by interpolation within their chart. All values are
/// *indirect* irradiance: what an engine adds to its own direct light.
///
/// What comes out depends on the lights and their visibility alone: not on what was shown before, nor on the
/// number of threads. Calls allocate nothing once they have been made with as many lights (of as long names
/// and as many corners).
class TransferRelighter {
 public:
  /// Copies what it needs out of the asset. Throws Error kMismatch where `layer` holds no transfer,
  /// kCorruptAsset where it makes no sense (asset/transfer.h).
  TransferRelighter(const asset::Asset& asset, const asset::Layer& layer);
  ~TransferRelighter();
  TransferRelighter(TransferRelighter&&) noexcept;

  std::size_t entryCount() const;
  std::size_t exitCount() const;  ///< rows of the transfer: of probes 9 each
  /// Where light leaves, and at vertices and probes which row of relight() is whose.
  asset::Exits::Kind exitKind() const;
  const asset::VertexExits& vertices() const;
  const asset::ProbeExits& probes() const;
  /// Of a bake at probes: what relight gave last, on a plane at `p` that faces along `n`, e.g. of something
  /// that moves. From the eight probes about p, less from those behind the plane; 0 where none is near, and
  /// of bakes that are not at probes.
  Irradiance atProbes(Point p, Normal n) const;
  std::size_t texelCount() const;

  /// Patches, their points and the entries that are mixed from the light there.
  const asset::Entries& entries() const;
  /// The points at which light enters, each patch's together: where visibility is asked. World; shape:
  /// [patches][pointsPerPatch]
  std::span<const Point> entryPoints() const;
  std::span<const Normal> entryNormals() const;
  std::size_t pointsPerPatch() const;
  /// Where visibility is asked: the points of entries, then, of a bake that leaves short ways to obscurance,
  /// the middles of all texels.
  std::span<const Point> visibilityPoints() const;
  std::span<const Normal> visibilityNormals() const;
  /// Whether the bake leaves short ways out (asset/transfer.h, NearShares): texels need their direct light.
  bool leavesShortWays() const;
  std::span<const float> entryAreas() const;  ///< m^2; shape: [entries]

  /// What each entry has of the lights (and the direct irradiance of each texel, kept for texels(), where
  /// short ways are left out), shape: [entries]; valid until the next call. Area lights by L A cos_l / (r^2 +
  /// A / pi) ([SzirmayKalos] section 10). A light that is the same as at its place in the set of the call
  /// before, but for colour and intensity, costs nothing and its visibility is not asked again; see
  /// forgetVisibility. Throws Error kInvalidValue, and keeps what was, for a light that is not finite or is
  /// negative, and for visibility outside [0, 1]; else only what `visibility` throws.
  std::span<const Irradiance> entryIrradiance(const LightSet& lights,
                                              const VisibilitySource& visibility = {});
  /// To be called when something else than a light has moved or `visibility` answers otherwise.
  void forgetVisibility();

  /// Indirect irradiance of each exit for any irradiance of entries, e.g. from an engine's own cube maps.
  /// Shape: [exits], of probes [probes][9] coefficients; valid until the next call. Entries that are the same
  /// as in the call before cost nothing; clusters of entries that are dark cost nothing. Throws Error
  /// kInvalidValue unless all are of magnitude 1e20 or less.
  std::span<const Irradiance> relight(std::span<const Irradiance> entry_irradiance);
  /// What relight gave last, at each texel of the atlas table; zero before. Where short ways are left out,
  /// they are made up for by the direct light of the last call of entryIrradiance. Shape: [texels]; valid
  /// until the next call.
  std::span<const Irradiance> texels();

  /// All three in turn: indirect irradiance of each texel.
  std::span<const Irradiance> evaluate(const LightSet& lights, const VisibilitySource& visibility = {});

  /// Samples of the transfer that a call of relight reads where no cluster is dark, bytes.
  std::size_t sampleBytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relume::relight
