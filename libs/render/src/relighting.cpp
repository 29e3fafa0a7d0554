// SPDX-License-Identifier: MIT
#include "relighting.h"

#include <algorithm>

namespace relume::render {

Relighting::Relighting(const asset::Asset& asset, const asset::Layer& layer) : texels_(asset.atlas) {
  const asset::Transfer transfer = asset::readTransfer(layer, asset.atlas);
  std::vector<std::uint32_t> columns;
  if (transfer.exits.kind == asset::Exits::Kind::kProbes) {
    host_.emplace(asset, layer);
    columns.assign(transfer.entries.size(), 0);
    unused_ = Buffer(sizeof(Vec4));
  } else {
    product_.emplace(transfer.matrix);
    columns = product_->columns();
    texels_.interpolateBy(transfer.exits.kind == asset::Exits::Kind::kVertices
                              ? relight::ExitInterpolation(transfer.exits.vertices)
                              : relight::ExitInterpolation(transfer.exits, transfer.matrix.rows, asset.atlas),
                          transfer.near_share);
  }
  const bool with_texels = !transfer.near_share.empty();
  entries_.emplace(transfer.entries, with_texels ? std::span(asset.atlas.position) : std::span<const Point>(),
                   with_texels ? std::span(asset.atlas.normal) : std::span<const Normal>(), columns);
}

void Relighting::run(std::span<const std::uint8_t> changed, PassTimer& timer) {
  {
    const TimedPass pass(timer, "entries");
    entries_->reserve(changed.size());
    for (std::size_t i = 0; i < changed.size(); ++i)
      if (changed[i]) entries_->renew(i, true);
    entries_->sum(changed.size(), product_ ? product_->x() : unused_);
  }
  if (!product_) {
    host_->relight(entries_->readEntries());
    const TimedPass pass(timer, "texels");
    texels_.write(host_->texels());
    return;
  }
  {
    const TimedPass pass(timer, "product");
    product_->multiply();
  }
  const TimedPass pass(timer, "texels");
  texels_.run(product_->exits(), entries_->irradiance(), entries_->entries());
}

}  // namespace relume::render
