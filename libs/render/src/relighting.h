// SPDX-License-Identifier: MIT
// Relighting of one layer of transfer, from lights to the pages of the atlas. The product runs on the device
// for exits at texels and vertices; light at probes, which is evaluated at all directions, is left to the
// run-time library's own.
#pragma once
#include <memory>
#include <optional>

#include "entry_pass.h"
#include "pass_timer.h"
#include "product_pass.h"
#include "relume/relight/transfer_relighter.h"
#include "texel_pass.h"

namespace relume::render {

class Relighting {
 public:
  Relighting(const asset::Asset& asset, const asset::Layer& layer);

  /// `changed`: by light, whether it or its shadows did. Lights are bound (binding 1), and shadow maps are.
  void run(std::span<const std::uint8_t> changed, PassTimer& timer);
  /// For the shadow maps' uniforms.
  const Program& received() const { return entries_->receivedProgram(); }
  const Texture& pages() const { return texels_.pages(); }
  std::vector<Irradiance> readEntries() const { return entries_->readEntries(); }
  std::vector<Irradiance> readTexels() const { return texels_.read(); }
  std::size_t sampleBytes() const { return product_ ? product_->sampleBytes() : host_->sampleBytes(); }

 private:
  TexelPass texels_;
  std::optional<ProductPass> product_;
  std::optional<relight::TransferRelighter> host_;
  std::optional<EntryPass> entries_;
  Buffer unused_;
};

}  // namespace relume::render
