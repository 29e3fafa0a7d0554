// SPDX-License-Identifier: MIT
#include "relume/relight/transfer_relighter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "block_product.h"
#include "entry_lights.h"
#include "probe_field.h"
#include "relume/asset/transfer.h"
#include "relume/core/check.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"
#include "relume/relight/exit_interpolation.h"

namespace relume::relight {
namespace {

BlockProduct productOf(const codec::BlockMatrix& m, const asset::Layer& layer) {
  try {
    return BlockProduct(m);
  } catch (const Error& e) {
    throw Error(e.code(), "layer " + layer.name, e.problem(), e.remedy());
  }
}

ExitInterpolation interpolationOf(const asset::Exits& exits, std::size_t rows,
                                  const asset::AtlasTable& atlas) {
  if (exits.kind != asset::Exits::Kind::kTexels) return ExitInterpolation(exits.vertices);
  return {exits, rows, atlas};
}

bool sameBits(std::span<const Irradiance> a, std::span<const Irradiance> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

}  // namespace

struct TransferRelighter::Impl {
  Impl(asset::Transfer transfer, const asset::AtlasTable& atlas, const asset::Layer& layer)
      : product(productOf(transfer.matrix, layer)),
        lights(transfer.entries, transfer.near_share.empty() ? std::span<const Point>() : atlas.position,
               transfer.near_share.empty() ? std::span<const Normal>() : atlas.normal),
        interpolation(interpolationOf(transfer.exits, transfer.matrix.rows, atlas)),
        exit_kind(transfer.exits.kind),
        vertices(std::move(transfer.exits.vertices)),
        field(std::move(transfer.exits.probes)),
        entries(std::move(transfer.entries)),
        shown(entries.size()),
        exits(product.rows()),
        texels(atlas.texel.size()),
        near_share(std::move(transfer.near_share)),
        points(entries.position),
        normals(entries.normal) {
    if (exit_kind == asset::Exits::Kind::kProbes)
      texel_position = atlas.position, texel_normal = atlas.normal;
    if (near_share.empty()) return;
    points.insert(points.end(), atlas.position.begin(), atlas.position.end());
    normals.insert(normals.end(), atlas.normal.begin(), atlas.normal.end());
    direct.resize(near_share.size());
  }

  /// From exits to texels.
  void interpolate() {
    if (exit_kind != asset::Exits::Kind::kProbes) return interpolation.apply(exits, texels);
    struct Job {
      Impl& self;
    } job{*this};
    parallelFor(texels.size(), 1024, [&job](std::size_t begin, std::size_t end) {
      Impl& self = job.self;
      for (std::size_t i = begin; i < end; ++i)
        self.texels[i] = self.field.at(self.texel_position[i], self.texel_normal[i], self.exits);
    });
  }

  /// asset/transfer.h, NearShares.
  void addShortWays() {
    struct Job {
      Impl& self;
    } job{*this};
    parallelFor(texels.size(), 4096, [&job](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 near = job.self.near_share[i];
        job.self.texels[i].rgb = (job.self.texels[i].rgb + near * job.self.direct[i].rgb) / (1.0f - near);
      }
    });
  }

  BlockProduct product;
  EntryLights lights;
  ExitInterpolation interpolation;  ///< of blocks and vertices
  asset::Exits::Kind exit_kind;
  asset::VertexExits vertices;
  ProbeField field;
  asset::Entries entries;
  std::vector<Irradiance> shown;  ///< what exits were computed for, zero at first
  std::vector<Irradiance> exits, texels;
  asset::NearShares near_share;       ///< empty: no short ways are left out
  std::vector<Irradiance> direct;     ///< by texel, where they are
  std::vector<Point> texel_position;  ///< of probes
  std::vector<Normal> texel_normal;
  std::vector<Point> points;  ///< where visibility is asked
  std::vector<Normal> normals;
  bool texels_current = true;
};

TransferRelighter::TransferRelighter(const asset::Asset& asset, const asset::Layer& layer)
    : impl_(std::make_unique<Impl>(asset::readTransfer(layer, asset.atlas), asset.atlas, layer)) {}

TransferRelighter::~TransferRelighter() = default;
TransferRelighter::TransferRelighter(TransferRelighter&&) noexcept = default;

std::size_t TransferRelighter::entryCount() const { return impl_->entries.size(); }
std::size_t TransferRelighter::exitCount() const { return impl_->exits.size(); }
std::size_t TransferRelighter::texelCount() const { return impl_->texels.size(); }
asset::Exits::Kind TransferRelighter::exitKind() const { return impl_->exit_kind; }
const asset::VertexExits& TransferRelighter::vertices() const { return impl_->vertices; }
const asset::ProbeExits& TransferRelighter::probes() const { return impl_->field.probes(); }
Irradiance TransferRelighter::atProbes(Point p, Normal n) const {
  if (impl_->exit_kind != asset::Exits::Kind::kProbes) return Irradiance(0.0f);
  return impl_->field.at(p, n, impl_->exits);
}
std::span<const Point> TransferRelighter::entryPoints() const { return impl_->entries.position; }
std::span<const Normal> TransferRelighter::entryNormals() const { return impl_->entries.normal; }
std::size_t TransferRelighter::pointsPerPatch() const { return impl_->entries.samples; }
const asset::Entries& TransferRelighter::entries() const { return impl_->entries; }
std::span<const Point> TransferRelighter::visibilityPoints() const { return impl_->points; }
std::span<const Normal> TransferRelighter::visibilityNormals() const { return impl_->normals; }
bool TransferRelighter::leavesShortWays() const { return !impl_->near_share.empty(); }
std::span<const float> TransferRelighter::entryAreas() const { return impl_->entries.area; }
std::size_t TransferRelighter::sampleBytes() const { return impl_->product.sampleBytes(); }

std::span<const Irradiance> TransferRelighter::entryIrradiance(const LightSet& lights,
                                                               const VisibilitySource& visibility) {
  Impl& i = *impl_;
  const std::span<const Irradiance> all = i.lights.evaluate(lights, visibility);
  if (!i.direct.empty()) {
    const auto direct = all.subspan(i.entries.size());
    std::copy(direct.begin(), direct.end(), i.direct.begin());
    i.texels_current = false;
  }
  return all.first(i.entries.size());
}

void TransferRelighter::forgetVisibility() { impl_->lights.forget(); }

std::span<const Irradiance> TransferRelighter::relight(std::span<const Irradiance> entry_irradiance) {
  Impl& i = *impl_;
  RELUME_CHECK_EQ(entry_irradiance.size(), i.entries.size());
  if (sameBits(entry_irradiance, i.shown)) return i.exits;
  for (std::size_t e = 0; e < entry_irradiance.size(); ++e)
    for (int c = 0; c < 3; ++c)
      if (!(std::abs(entry_irradiance[e].rgb[c]) <= BlockProduct::kLargest))
        throw Error(ErrorCode::kInvalidValue, fmt::format("the irradiance of entry {}", e),
                    fmt::format("is {} W/m^2", entry_irradiance[e].rgb[c]));
  i.product.multiply(entry_irradiance, i.exits);
  std::copy(entry_irradiance.begin(), entry_irradiance.end(), i.shown.begin());
  i.texels_current = false;
  return i.exits;
}

std::span<const Irradiance> TransferRelighter::texels() {
  Impl& i = *impl_;
  if (!i.texels_current) {
    i.interpolate();
    if (!i.near_share.empty()) i.addShortWays();
  }
  i.texels_current = true;
  return i.texels;
}

std::span<const Irradiance> TransferRelighter::evaluate(const LightSet& lights,
                                                        const VisibilitySource& visibility) {
  relight(entryIrradiance(lights, visibility));
  return texels();
}

}  // namespace relume::relight
