// SPDX-License-Identifier: MIT
// Light at the probes of a bake: entries on the device, through the shadow maps; the product and the look-ups
// by the run-time library.
#pragma once
#include <optional>
#include <span>

#include "entry_pass.h"
#include "gl_objects.h"
#include "pass_timer.h"
#include "relume/relight/transfer_relighter.h"
#include "shadow_maps.h"

namespace relume::render {

class ProbeLight {
 public:
  /// Throws Error kMismatch for a layer whose light does not leave at probes.
  ProbeLight(const asset::Asset& asset, const asset::Layer& layer);

  /// `changed`: by light. Lights are bound (binding 1).
  void relight(std::span<const std::uint8_t> changed, const ShadowMaps& shadows, PassTimer& timer);
  Irradiance irradiance(Point p, Normal n) const { return relighter_.atProbes(p, n); }

 private:
  relight::TransferRelighter relighter_;
  std::optional<EntryPass> entries_;
  Buffer unused_;
};

}  // namespace relume::render
