// SPDX-License-Identifier: MIT
#include "lightpath_errors.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "relume/codec/block_matrix.h"

namespace relume::bake {
namespace {

using transport::GatherRays;
using transport::LightPaths;
using transport::LitBy;

constexpr std::uint32_t kLamps = 16;
constexpr std::size_t kExits = 1024, kTiles = 4;

/// ||a - b|| / ||b||
float difference(std::span<const Irradiance> a, std::span<const Irradiance> b) {
  double error = 0, all = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(a[i].rgb) - glm::dvec3(b[i].rgb), e(b[i].rgb);
    error += glm::dot(d, d), all += glm::dot(e, e);
  }
  return all > 0 ? static_cast<float>(std::sqrt(error / all)) : 0.0f;
}

/// Of equal shares of what can be seen of all, as `relume verify` takes places.
std::vector<std::uint32_t> someExits(const LightPaths& paths) {
  const std::vector<transport::Exit>& exits = paths.exits().all;
  double all = 0, passed = 0;
  for (const transport::Exit& e : exits) all += static_cast<double>(e.area);
  std::vector<std::uint32_t> which;
  for (std::uint32_t x = 0; x < exits.size() && all > 0; ++x) {
    passed += static_cast<double>(exits[x].area);
    // One for each share whose middle lies in this exit; a large exit counts as often.
    while (which.size() < kExits && passed * kExits >= (static_cast<double>(which.size()) + 0.5) * all)
      which.push_back(x);
  }
  return which;
}

/// Lamps, what they give entries, and what exits have of that.
struct Lit {
  const LightPaths& paths;
  LightSet lamps;
  std::vector<float> on_entries;  // [lamps][entries]
};

/// Under each lamp, by the rows of a few tiles and by the stored matrix.
struct Products {
  std::vector<std::uint32_t> exits;
  std::vector<Irradiance> by_rows, stored;  // [lamps][exits * rows_each]
};
Products productsOf(const Lit& lit, const codec::BlockMatrix& matrix) {
  const LightPaths& paths = lit.paths;
  const transport::ExitTiles& tiles = paths.tiles();
  const std::size_t entries = paths.entries().size(), each = paths.exits().rows_each;
  const std::size_t step = std::max<std::size_t>(tiles.size() / kTiles, 1);
  Products result;
  std::vector<float> rows;  // [exits * each][3][entries]
  for (std::size_t t = step / 2; t < tiles.size(); t += step) {
    const auto of = std::span(tiles.row).subspan(tiles.first[t], tiles.first[t + 1] - tiles.first[t]);
    std::vector<float> of_tile(of.size() * each * 3 * entries);
    paths.rows(t, of_tile);
    rows.insert(rows.end(), of_tile.begin(), of_tile.end());
    result.exits.insert(result.exits.end(), of.begin(), of.end());
  }
  std::vector<float> all(std::size_t{matrix.rows} * matrix.channels);
  for (std::size_t l = 0; l < lit.lamps.size(); ++l) {
    const auto x = std::span(lit.on_entries).subspan(l * entries, entries);
    std::vector<float> white;  // [entries][channels]
    for (const float e : x) white.insert(white.end(), matrix.channels, e);
    codec::multiply(matrix, white, all);
    for (std::size_t r = 0; r < result.exits.size() * each; ++r) {
      Vec3 sum(0.0f), stored(0.0f);
      for (std::size_t c = 0; c < 3; ++c) {
        const int channel = static_cast<int>(c);
        for (std::size_t e = 0; e < entries; ++e) sum[channel] += rows[(r * 3 + c) * entries + e] * x[e];
        stored[channel] = all[(result.exits[r / each] * each + r % each) * 3 + c];
      }
      result.by_rows.emplace_back(sum), result.stored.emplace_back(stored);
    }
  }
  return result;
}

}  // namespace

std::optional<asset::TransferErrors> measureErrors(const LightPaths& paths,
                                                   const transport::LightPathOptions& options,
                                                   const codec::BlockMatrix& matrix, Progress& progress) {
  Lit lit{paths, paths.lights(kLamps, {.nearest = paths.spacing()}, options.seed * 2 + 5, progress), {}};
  if (lit.lamps.empty()) return std::nullopt;
  lit.on_entries = paths.entryIrradiance(lit.lamps, progress);
  const std::vector<std::uint32_t> which = someExits(paths);
  const auto at = [&](std::span<const std::uint32_t> exits, LitBy by, GatherRays rays) {
    return paths.irradiance(lit.lamps, by, exits, rays, progress);
  };
  const auto everywhere = at(which, LitBy::kElements, GatherRays::kSame);
  const Products products = productsOf(lit, matrix);
  asset::TransferErrors errors;
  errors.entries = difference(at(which, LitBy::kEntries, GatherRays::kSame), everywhere);
  errors.encoding = difference(products.stored, products.by_rows);
  // Two sets of rays differ by both their noises.
  errors.transfer =
      options.transfer == transport::TransferBy::kWalks
          ? difference(products.by_rows, at(products.exits, LitBy::kEntries, GatherRays::kSame))
          : difference(at(which, LitBy::kElements, GatherRays::kOther), everywhere) / std::sqrt(2.0f);
  return errors;
}

}  // namespace relume::bake
