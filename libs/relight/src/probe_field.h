// SPDX-License-Identifier: MIT
// Irradiance anywhere in space, from probes of a grid.
#pragma once
#include <span>

#include "relume/asset/transfer.h"
#include "relume/core/quantity.h"

namespace relume::relight {

class ProbeField {
 public:
  explicit ProbeField(asset::ProbeExits probes) : probes_(std::move(probes)) {}

  /// On a plane at `p` that faces along `n`, from the eight probes about p: trilinear, those behind the plane
  /// less (they may stand in another room), those in bodies not at all. rows: of the transfer, [probes][9].
  /// Beyond the grid as on its border; where no probe is near, 0. Not negative.
  Irradiance at(Point p, Normal n, std::span<const Irradiance> rows) const;

  const asset::ProbeExits& probes() const { return probes_; }

 private:
  asset::ProbeExits probes_;
};

}  // namespace relume::relight
