// SPDX-License-Identifier: MIT
#include "probe_light.h"

#include <cstdint>
#include <vector>

#include "relume/core/error.h"

namespace relume::render {

ProbeLight::ProbeLight(const asset::Asset& asset, const asset::Layer& layer)
    : relighter_(asset, layer), unused_(sizeof(Vec4)) {
  if (relighter_.exitKind() != asset::Exits::Kind::kProbes)
    throw Error(ErrorCode::kMismatch, "layer " + layer.name, "holds no probes",
                "bake lightpath:exits=probes");
  const asset::Transfer transfer = asset::readTransfer(layer, asset.atlas);
  const std::vector<std::uint32_t> columns(transfer.entries.size(), 0);
  entries_.emplace(transfer.entries, std::span<const Point>(), std::span<const Normal>(), columns);
}

void ProbeLight::relight(std::span<const std::uint8_t> changed, const ShadowMaps& shadows, PassTimer& timer) {
  {
    const TimedPass pass(timer, "entries of probes");
    shadows.bind(entries_->receivedProgram());
    entries_->reserve(changed.size());
    // What changed while probes lit nothing is not known: all anew.
    for (std::size_t i = 0; i < changed.size(); ++i) entries_->renew(i, true);
    entries_->sum(changed.size(), unused_);
  }
  relighter_.relight(entries_->readEntries());
}

}  // namespace relume::render
