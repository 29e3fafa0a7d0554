// SPDX-License-Identifier: MIT
// Fills a Report while a bake goes on: atlas first, then layer by layer.
#pragma once
#include <span>
#include <vector>

#include "prepared.h"
#include "relume/bake/report.h"

namespace relume::bake {

class ReportGatherer {
 public:
  /// Keeps a reference to `prepared`.
  ReportGatherer(const Prepared& prepared, const BakeOptions& options);

  /// Before the layer's planes are taken apart. The reference stays good until the next call.
  LayerReport& add(const PreparedLayer& prepared, const PointLayer& layer);

  /// valid: of all layers together, shape [covered texels].
  Report take(std::span<const std::uint8_t> valid);

 private:
  const Prepared& prepared_;
  std::vector<std::uint32_t> point_of_texel_;
  Report report_;
};

}  // namespace relume::bake
