// SPDX-License-Identifier: MIT
#include "charts/pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "charts/footprint.h"
#include "charts/page.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::atlas {
namespace {

// Texels by which footprints are grown: more than the rounding of a coordinate within a page of 16384 texels.
constexpr float kMargin = 1.0f / 512.0f;
constexpr int kMostPackings = 6;
constexpr int kSlackRows = 3;           // rows left empty that are not worth another packing
constexpr double kCloseEnough = 1.008;  // ratio of densities that is not worth another packing
constexpr double kFirstFill = 0.95;     // share of a page that footprints with gutters are expected to fill
constexpr double kFullPage = 0.97;      // share that footprints with gutters can fill at most
constexpr std::size_t kScannedBlocks = 1500;  // placed at most while scanning for a better density
constexpr double kScanStep = 5e-4;            // ratio of densities, less one
constexpr double kScannedTexels = 1e8;        // of all pages scanned
constexpr int kCoarsePage = 2048;             // texels: smaller pages are searched at full resolution
constexpr std::size_t kCoarseBlocks = 300;    // and so are fewer blocks
constexpr std::size_t kHastyBlocks = 20000;
constexpr int kMostFailures = 12;  // groups that a page may refuse before it is closed
constexpr double kShrinkStep = 0.97;

Placement boxOf(const Block& block, double density) {
  Placement p;
  p.scale = static_cast<float>(block.metres * density);
  const Vec2 extent = block.extent * p.scale;
  p.size = glm::max(IVec2(1), IVec2(glm::ceil(extent + 2.0f * kMargin)));
  p.shift = 0.5f * (Vec2(p.size) - extent);
  return p;
}

BitGrid rasterize(const Block& block, const Placement& box) {
  BitGrid grid(box.size.x, box.size.y);
  for (const std::uint32_t t : block.members) {
    Vec2 corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = block.uv[block.triangles[t][k]] * box.scale + box.shift;
    coverTriangle(grid, corner[0], corner[1], corner[2], kMargin);
  }
  return grid;
}

/// Blocks drawn at some density.
struct Drawn {
  double density = 0;
  std::vector<std::uint32_t> order;   // blocks, big first
  std::vector<Placement> placements;  // per entry of `order`
  std::vector<Footprint> footprints;  // per entry of `order`
  double claimed = 0;                 // texels with half a gutter about them
  std::size_t covered = 0;            // texels
  bool placed = false;                // on a page of several groups
  int used = 0;  // rows of the page once they are placed; beyond the page when something did not fit
};

/// A page to which groups of blocks are added whole.
class OpenPage {
 public:
  OpenPage(const PackOptions& options, Page::Search search)
      : options_(options), search_(search), page_(fresh()) {}

  bool empty() const { return done_.empty(); }

  /// Places all blocks, or none: then returns false. Notes the outcome in `drawn`.
  bool add(Drawn& drawn) {
    drawn.placed = false;
    const std::size_t before = done_.size();
    for (std::size_t k = 0; k < drawn.order.size(); ++k) {
      const std::optional<Page::Place> place = page_.find(drawn.footprints[k]);
      if (!place) {
        done_.resize(before);
        page_ = fresh();
        for (const auto& [footprint, where] : done_) page_.occupy(footprint, where);
        return false;
      }
      page_.occupy(drawn.footprints[k], *place);
      drawn.placements[k].corner = place->corner;
      drawn.placements[k].turns = place->turns;
      done_.push_back({std::move(drawn.footprints[k]), *place});
    }
    drawn.placed = true;
    return true;
  }

 private:
  Page fresh() const { return Page(options_.page_size, options_.page_size, options_.gutter, search_); }

  PackOptions options_;
  Page::Search search_;
  Page page_;
  std::vector<std::pair<Footprint, Page::Place>> done_;
};

class Packer {
 public:
  Packer(std::span<const Block> blocks, std::uint32_t groups, const PackOptions& options, Progress& progress)
      : blocks_(blocks), options_(options), progress_(progress), group_scale_(groups, 1.0) {}

  std::vector<std::uint32_t> allBlocks() const {
    std::vector<std::uint32_t> all(blocks_.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }

  /// Texels per metre at which the boxes of all blocks would fill half a page.
  double densityByArea(const std::vector<std::uint32_t>& members) const {
    double area = 0;
    for (const std::uint32_t i : members) {
      const Block& b = blocks_[i];
      area += double(b.extent.x) * double(b.extent.y) * std::pow(b.metres * group_scale_[b.group], 2);
    }
    return std::sqrt(0.5 * pageTexels() / std::max(area, 1e-30));
  }

  /// The largest density found at which `members` fit on a page; nothing when not even a texel each fits.
  std::optional<Drawn> packOnePage(const std::vector<std::uint32_t>& members) const {
    const double densest = densityOfLongest(members);
    double density = std::min(densest, densityByArea(members));
    for (int i = 0; i < 3; ++i) {
      density =
          std::min(densest, density * std::sqrt(kFirstFill * pageTexels() / draw(members, density).claimed));
    }
    std::optional<Drawn> best;
    double too_big = 0;
    // Used rows grow with the square of the density, more or less.
    const Page::Search search = searchFor(members.size());
    const int packings = search == Page::Search::kHasty ? kMostPackings / 2 : kMostPackings;
    for (int packing = 0; packing < packings; ++packing) {
      Drawn drawn = fill(draw(members, density), options_.page_size + options_.page_size / 4, search);
      const int used = drawn.used;
      if (used <= lastRow()) {
        best = std::move(drawn);
        if (used + kSlackRows >= lastRow() || density == densest) break;
      } else {
        too_big = density;
      }
      if (best && too_big > 0) {
        if (too_big < kCloseEnough * best->density) break;
        density = std::sqrt(best->density * too_big);
      } else {
        density *=
            std::clamp(std::sqrt(static_cast<double>(lastRow()) / used), 0.8, 1.2) * (best ? 1.003 : 0.998);
        density = std::min(density, densest);
      }
    }
    for (int i = 0; !best && i < 100; ++i) {
      density *= 0.93;
      Drawn drawn = fill(draw(members, density), options_.page_size, search);
      if (drawn.used <= lastRow()) {
        best = std::move(drawn);
      } else if (drawn.covered == members.size()) {
        break;  // a texel each, and still too many
      }
    }
    if (best) scanAbove(members, densest, *best);
    return best;
  }

  Packing packPages(double density) {
    const std::size_t groups = group_scale_.size();
    std::vector<std::vector<std::uint32_t>> members(groups);
    for (const std::uint32_t i : allBlocks()) members[blocks_[i].group].push_back(i);
    std::vector<double> claimed(groups, 0.0);
    std::vector<std::uint32_t> order;
    for (std::uint32_t g = 0; g < groups; ++g) {
      if (members[g].empty()) continue;
      claimed[g] = shrinkToPage(g, members[g], density);
      order.push_back(g);
    }
    const auto larger = [&](std::uint32_t a, std::uint32_t b) { return claimed[a] > claimed[b]; };
    std::stable_sort(order.begin(), order.end(), larger);

    Packing packing;
    packing.placements.resize(blocks_.size());
    packing.texels_per_metre = density;
    for (; !order.empty(); ++packing.pages) {
      // Groups by size, each whole or not at all, while there is room.
      std::vector<std::uint32_t> left;
      OpenPage page(options_, searchFor(blocks_.size()));
      double room = kFullPage * pageTexels();
      int failures = 0;
      for (const std::uint32_t g : order) {
        progress_.throwIfCancelled();
        if (!page.empty() && (claimed[g] > room || failures == kMostFailures)) {
          left.push_back(g);
          continue;
        }
        Drawn drawn = draw(members[g], density);
        while (!page.add(drawn)) {
          if (!page.empty()) break;
          group_scale_[g] *= kShrinkStep;
          drawn = draw(members[g], density);
        }
        if (!drawn.placed) {
          ++failures;
          left.push_back(g);
          continue;
        }
        room -= drawn.claimed;
        add(drawn, packing);
      }
      order = std::move(left);
    }
    packing.group_scale = group_scale_;
    return packing;
  }

  Packing onePage(const Drawn& drawn) const {
    Packing packing;
    packing.placements.resize(blocks_.size());
    packing.texels_per_metre = drawn.density;
    packing.group_scale = group_scale_;
    add(drawn, packing);
    packing.pages = 1;
    return packing;
  }

 private:
  double pageTexels() const { return static_cast<double>(options_.page_size) * options_.page_size; }
  Page::Search searchFor(std::size_t blocks) const {
    if (blocks >= kHastyBlocks) return Page::Search::kHasty;
    return options_.page_size >= kCoarsePage && blocks >= kCoarseBlocks ? Page::Search::kCoarse
                                                                        : Page::Search::kEverywhere;
  }
  int lastRow() const { return options_.page_size - options_.gutter / 2; }

  /// Texels per metre at which the longest block just fits a page.
  double densityOfLongest(const std::vector<std::uint32_t>& members) const {
    double longest = 0;
    for (const std::uint32_t i : members) {
      const Block& b = blocks_[i];
      longest = std::max(longest, std::max(b.extent.x, b.extent.y) * b.metres * group_scale_[b.group]);
    }
    const double room = options_.page_size - 2 * (options_.gutter / 2) - 2.0 * kMargin - 1e-3;
    return longest > 0 ? room / longest : std::numeric_limits<double>::infinity();
  }

  /// With few blocks what fits goes by steps (three walls side by side, or two), so the search by rows misses
  /// densities: a scan from above finds them, and costs little.
  void scanAbove(const std::vector<std::uint32_t>& members, double densest, Drawn& best) const {
    const double full = std::min(densest, 1.01 * best.density * std::sqrt(pageTexels() / best.claimed));
    const double gain = std::log(full / best.density);
    const auto steps = static_cast<int>(std::min({static_cast<double>(kScannedBlocks / members.size()),
                                                  kScannedTexels / pageTexels(), gain / kScanStep}));
    if (steps < 1) return;
    constexpr int kBatch = 4;
    for (int first = 0; first < steps; first += kBatch) {
      std::vector<Drawn> drawn(std::min(kBatch, steps - first));
      parallelFor(drawn.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const double density = full * std::exp(-gain * (first + static_cast<double>(k)) / steps);
          drawn[k] =
              fill(draw(members, density), options_.page_size,
                   options_.page_size >= kCoarsePage ? Page::Search::kCoarse : Page::Search::kEverywhere);
        }
      });
      for (Drawn& d : drawn) {
        if (d.used > lastRow()) continue;
        best = std::move(d);
        return;
      }
    }
  }

  Drawn draw(const std::vector<std::uint32_t>& members, double density) const {
    std::vector<Placement> placements(members.size());
    std::vector<Footprint> footprints(members.size());
    parallelFor(members.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m) {
        const Block& block = blocks_[members[m]];
        placements[m] = boxOf(block, density * group_scale_[block.group]);
        footprints[m] = Footprint{placements[m].size.x, placements[m].size.y, {}, 0};
        // What is larger than a page cannot be placed and need not be drawn.
        if (std::max(placements[m].size.x, placements[m].size.y) > options_.page_size) continue;
        footprints[m] = footprintOf(rasterize(block, placements[m]));
      }
    });
    std::vector<std::uint32_t> by_size(members.size());
    std::iota(by_size.begin(), by_size.end(), 0u);
    const auto size = [&](std::uint32_t m) {
      return std::pair(footprints[m].width + footprints[m].height, footprints[m].texels);
    };
    std::stable_sort(by_size.begin(), by_size.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return size(a) > size(b); });
    Drawn drawn;
    drawn.density = density;
    const double rim = 0.5 * options_.gutter;
    for (const std::uint32_t m : by_size) {
      const Footprint& f = footprints[m];
      drawn.covered += f.texels;
      const double texels = f.runs.empty() ? double(f.width) * f.height : double(f.texels);
      drawn.claimed += texels + 2 * rim * (double(f.width) + f.height) + 4 * rim * rim;
      drawn.order.push_back(members[m]);
      drawn.placements.push_back(placements[m]);
      drawn.footprints.push_back(std::move(footprints[m]));
    }
    return drawn;
  }

  /// Places blocks on an empty page of `height` rows.
  Drawn fill(Drawn drawn, int height, Page::Search search) const {
    Page page(options_.page_size, height, options_.gutter, search);
    for (std::size_t k = 0; k < drawn.order.size(); ++k) {
      progress_.throwIfCancelled();
      const std::optional<Page::Place> place = page.find(drawn.footprints[k]);
      if (!place) {
        drawn.used = height + 1;
        break;
      }
      page.occupy(drawn.footprints[k], *place);
      drawn.placements[k].corner = place->corner;
      drawn.placements[k].turns = place->turns;
      drawn.used = std::max(drawn.used, place->bottom);
    }
    drawn.footprints = {};
    return drawn;
  }

  static void add(const Drawn& drawn, Packing& packing) {
    for (std::size_t k = 0; k < drawn.order.size(); ++k) {
      Placement& placement = packing.placements[drawn.order[k]];
      placement = drawn.placements[k];
      placement.page = packing.pages;
    }
    packing.covered += drawn.covered;
  }

  /// Scales a group down until it fits a page alone; returns the texels it claims then.
  double shrinkToPage(std::uint32_t group, const std::vector<std::uint32_t>& members, double density) {
    const double claimed = draw(members, density).claimed;
    if (claimed <= 0.6 * pageTexels() && density <= densityOfLongest(members)) return claimed;
    const std::optional<Drawn> alone = packOnePage(members);
    if (!alone) {
      throw Error(ErrorCode::kUsage, "atlas",
                  fmt::format("{} charts of one mesh do not fit a page of {} x {} texels", members.size(),
                              options_.page_size, options_.page_size),
                  "use a larger atlas size");
    }
    if (alone->density >= density) return claimed;
    group_scale_[group] *= alone->density / density;
    return draw(members, density).claimed;
  }

  std::span<const Block> blocks_;
  PackOptions options_;
  Progress& progress_;
  std::vector<double> group_scale_;
};

}  // namespace

Vec2 place(const Placement& placement, Vec2 uv) {
  const Vec2 p = uv * placement.scale + placement.shift;
  const Vec2 box(placement.size), corner(placement.corner);
  switch (placement.turns) {
    case 1:
      return corner + Vec2(box.y - p.y, p.x);
    case 2:
      return corner + box - p;
    case 3:
      return corner + Vec2(p.y, box.x - p.x);
    default:
      return corner + p;
  }
}

Packing packBlocks(std::span<const Block> blocks, std::uint32_t groups, const PackOptions& options,
                   Progress& progress) {
  RELUME_CHECK(!blocks.empty());
  Packer packer(blocks, groups, options, progress);
  if (options.texels_per_metre > 0) return packer.packPages(options.texels_per_metre);
  if (const std::optional<Drawn> drawn = packer.packOnePage(packer.allBlocks()))
    return packer.onePage(*drawn);
  // So many blocks that one texel each is too much for a page.
  return packer.packPages(packer.densityByArea(packer.allBlocks()));
}

}  // namespace relume::atlas
