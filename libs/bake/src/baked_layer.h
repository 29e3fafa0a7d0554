// SPDX-License-Identifier: MIT
// One layer of a bake, from its row of the registry to what the file keeps.
#pragma once
#include <span>
#include <vector>

#include "prepared.h"
#include "relume/asset/asset.h"
#include "relume/core/hash.h"
#include "report_gather.h"

namespace relume::bake {

struct BakedLayer {
  asset::Layer layer;
  LayerStatistics numbers;          ///< but for `bytes`
  Digest key;                       ///< of all that the layer depends on besides structure and placements
  std::vector<std::uint8_t> valid;  ///< by covered texel, 0: buried in geometry; empty: not known
  Warnings warnings = {};
};

/// What every layer of a bake shares. References are kept.
struct LayerTask {
  const Prepared& prepared;
  const PreparedLayer& layer;
  const LayerContext& context;
  const BakeOptions& options;
  ReportGatherer* report;  ///< null: none wanted
  Stopwatch& stopwatch;
};

/// By LayerKind::prepare: rows of texels, kept in the cache texel by texel, then smoothed and stitched along
/// `seams`.
BakedLayer bakeTexels(const LayerTask& task, std::span<const atlas::SeamSample> seams, Progress& progress);

/// By LayerKind::solve; kept in the cache whole.
BakedLayer bakeWhole(const LayerTask& task, Progress& progress);

/// Whether the cache has a sound layer for a job of that key.
bool isKept(const BakeOptions& options, const Prepared& prepared, const Digest& key);

/// Name, kind and parameters of a layer that holds nothing yet.
asset::Layer describe(const PreparedLayer& prepared);

}  // namespace relume::bake
