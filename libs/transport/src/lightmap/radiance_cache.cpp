// SPDX-License-Identifier: MIT
#include "lightmap/radiance_cache.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "lightmap/light_rays.h"
#include "lightmap/reflectance.h"
#include "lightmap/substitutes.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

// A texel of which so many rays meet the back of a face is inside something, in part at least.
constexpr float kBuriedShare = 0.25f;
// Light is handed on until what is still to come is this share of all light.
constexpr double kConverged = 1e-4;
constexpr int kMostBounces = 4096;

double sumOf(const std::vector<Vec3>& values) {
  double sum = 0;
  for (const Vec3& v : values) sum += static_cast<double>(v.x + v.y + v.z);
  return sum;
}

}  // namespace

struct RadianceCache::Builder {
  /// What was found from one side of the surfaces.
  struct Found {
    std::vector<Vec3> direct;       // E, by entry
    std::vector<SideOfTexel> ends;  // [entry][gather_samples]
    std::vector<Vec3> reflectance;  // by entry
  };

  Builder(RadianceCache& the_cache, const trace::Tracer& the_tracer, const Emitters& the_emitters,
          const TexelLookup& the_lookup, const atlas::Texels& the_texels, const TexelGroups& the_groups,
          const CacheOptions& the_options, Progress& the_progress)
      : cache(the_cache),
        tracer(the_tracer),
        emitters(the_emitters),
        lookup(the_lookup),
        texels(the_texels),
        groups(the_groups),
        options(the_options),
        progress(the_progress),
        directions(options.gather_samples, options.gather_samples, options.seed, BlockSamples::kShared),
        lights(options.light_samples, options.light_samples, options.seed, BlockSamples::kShared) {}

  void build() {
    const std::size_t points = texels.points.size();
    front.reflectance = reflectances(tracer.scene(), texels, options.materials);
    cache.back_share_.resize(points);
    front.direct.resize(points);
    front.ends.assign(points * options.gather_samples, kNoTexel);
    wanted.assign(points, 0);
    gatherFronts();
    std::vector<std::uint8_t> buried(points);
    for (std::size_t i = 0; i < points; ++i) buried[i] = cache.back_share_[i] > kBuriedShare;
    cache.substitute_ = substitutes(texels, buried);
    gatherBacks();
    handOn();
  }

 private:
  /// Solves the group for one side: row i of the found is slots[i].
  struct Worker {
    explicit Worker(const Builder& b)
        : rays(b.tracer.scene(), b.texels, b.directions, b.options.seed, kInfinity),
          gatherer(b.tracer, b.lookup, b.emitters),
          light_rays(b.tracer, b.emitters, b.lights, false) {}
    GroupRays rays;
    Gatherer gatherer;
    LightRays light_rays;
    std::vector<std::uint32_t> active;
    std::vector<Vec3> values;
  };

  void gatherGroup(Worker& w, std::span<const std::uint32_t> group, Side side,
                   std::span<const std::uint32_t> slots, Found& found) {
    const std::uint32_t n = options.gather_samples;
    w.rays.begin(group, side);
    w.active.resize(group.size());
    for (std::uint32_t i = 0; i < group.size(); ++i) w.active[i] = i;
    if (!emitters.empty()) {
      w.values.assign(std::size_t{options.light_samples} * LightTable::kColumns, Vec3(0.0f));
      w.light_rays.trace(w.rays, w.active, 0, options.light_samples, w.values);
      for (std::size_t s = 0; s < options.light_samples; ++s)
        for (std::size_t i = 0; i < group.size(); ++i)
          found.direct[slots[i]] += w.values[s * LightTable::kColumns + i];
      for (const std::uint32_t slot : slots) found.direct[slot] /= static_cast<float>(options.light_samples);
    }
    std::array<std::uint32_t, kGroupTexels> met_back{};
    w.rays.select(w.active, n);
    w.gatherer.trace(w.rays, 0, n, [&](std::uint32_t texel, std::uint32_t sample, const Arrival& arrival) {
      const std::uint32_t slot = slots[texel];
      found.direct[slot] += arrival.emitted * (kPi / static_cast<float>(n));
      found.ends[std::size_t{slot} * n + sample] = arrival.surface;
      met_back[texel] += arrival.surface != kNoTexel && (arrival.surface & kBackBit) != 0;
    });
    for (std::size_t i = 0; i < group.size(); ++i) {
      const float share = static_cast<float>(met_back[i]) / static_cast<float>(n);
      if (side == Side::kFront) cache.back_share_[group[i]] = share;
      if (met_back[i] > 0 && share <= kBuriedShare) want(slots[i], found);
    }
  }

  /// Marks the backs that an entry's rays have met.
  void want(std::size_t slot, const Found& found) {
    for (std::uint32_t s = 0; s < options.gather_samples; ++s) {
      const SideOfTexel end = found.ends[slot * options.gather_samples + s];
      if (end == kNoTexel || (end & kBackBit) == 0) continue;
      std::atomic_ref<std::uint8_t>(wanted[end & ~kBackBit]).store(1, std::memory_order_relaxed);
    }
  }

  void gatherFronts() {
    const Stage stage(progress, "bounces", texels.points.size());
    std::vector<std::uint64_t> rays(groups.tiles());
    parallelFor(groups.tiles(), 4, [&](std::size_t begin, std::size_t end) {
      Worker worker(*this);
      for (std::size_t tile = begin; tile < end; ++tile) {
        const std::uint64_t before = worker.gatherer.rays() + worker.light_rays.rays();
        groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
          if (progress.cancelled()) return;
          gatherGroup(worker, group, Side::kFront, group, front);
          progress.advance(group.size());
        });
        rays[tile] = worker.gatherer.rays() + worker.light_rays.rays() - before;
      }
    });
    progress.throwIfCancelled();
    for (const std::uint64_t r : rays) cache.rays_ += r;
  }

  /// Backs that rays have met, then those that the rays from these meet, until there are no new ones.
  void gatherBacks() {
    if (std::find(wanted.begin(), wanted.end(), 1) == wanted.end()) return;
    cache.back_of_.assign(texels.points.size(), scene::kNone);
    for (;;) {
      struct Block {
        std::vector<std::uint32_t> points, slots;
      };
      std::vector<Block> blocks;
      auto next = static_cast<std::uint32_t>(back.reflectance.size());
      for (std::size_t tile = 0; tile < groups.tiles(); ++tile) {
        groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
          const auto is_wanted = [&](std::uint32_t i) { return wanted[i] != 0; };
          if (cache.back_of_[group[0]] != scene::kNone || std::none_of(group.begin(), group.end(), is_wanted))
            return;
          Block block{{group.begin(), group.end()}, {}};
          for (const std::uint32_t i : group) {
            block.slots.push_back(next);
            cache.back_of_[i] = next++;
            back.reflectance.push_back(front.reflectance[i]);
          }
          blocks.push_back(std::move(block));
        });
      }
      if (blocks.empty()) return;
      back.direct.resize(next);
      back.ends.resize(std::size_t{next} * options.gather_samples, kNoTexel);
      std::vector<std::uint64_t> rays(blocks.size());
      parallelFor(
          blocks.size(), 64,
          [&](std::size_t begin, std::size_t end) {
            Worker worker(*this);
            for (std::size_t b = begin; b < end; ++b) {
              const std::uint64_t before = worker.gatherer.rays() + worker.light_rays.rays();
              gatherGroup(worker, blocks[b].points, Side::kBack, blocks[b].slots, back);
              rays[b] = worker.gatherer.rays() + worker.light_rays.rays() - before;
            }
          },
          &progress);
      for (const std::uint64_t r : rays) cache.rays_ += r;
    }
  }

  /// E of an entry from what its rays find in the cache of the bounce before.
  Vec3 gathered(const Found& found, std::size_t entry) const {
    const std::uint32_t n = options.gather_samples;
    Vec3 sum(0.0f);
    for (std::uint32_t s = 0; s < n; ++s) {
      const SideOfTexel end = found.ends[entry * n + s];
      if (end != kNoTexel) sum += cache.radiance(end);
    }
    return sum * (kPi / static_cast<float>(n));
  }

  void bounce(const Found& found, std::vector<Vec3>& indirect, std::vector<Vec3>& out) const {
    parallelFor(found.direct.size(), 2048, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        indirect[i] = gathered(found, i);
        out[i] = found.reflectance[i] * kInvPi * (found.direct[i] + indirect[i]);
      }
    });
  }

  void handOn() {
    std::vector<Vec3> back_indirect(back.direct.size()), next_front(front.direct.size()),
        next_back(back.direct.size());
    cache.indirect_.assign(front.direct.size(), Vec3(0.0f));
    cache.front_.resize(front.direct.size()), cache.back_.resize(back.direct.size());
    for (std::size_t i = 0; i < front.direct.size(); ++i)
      cache.front_[i] = front.reflectance[i] * kInvPi * front.direct[i];
    for (std::size_t i = 0; i < back.direct.size(); ++i)
      cache.back_[i] = back.reflectance[i] * kInvPi * back.direct[i];
    const int most = options.bounces < 0 ? kMostBounces : options.bounces;
    double total = sumOf(cache.front_) + sumOf(cache.back_), change = total;
    for (int k = 0; k < most && total > 0; ++k) {
      bounce(front, cache.indirect_, next_front), bounce(back, back_indirect, next_back);
      cache.front_.swap(next_front), cache.back_.swap(next_back);
      const double now = sumOf(cache.front_) + sumOf(cache.back_), step = now - total;
      // Each bounce adds less than the last by about the same ratio.
      const double ratio = change > 0 ? std::min(step / change, 0.999) : 0;
      total = now, change = step;
      if (step * ratio / (1 - ratio) < kConverged * total) break;
      progress.throwIfCancelled();
    }
    cache.direct_ = std::move(front.direct);
  }

  RadianceCache& cache;
  const trace::Tracer& tracer;
  const Emitters& emitters;
  const TexelLookup& lookup;
  const atlas::Texels& texels;
  const TexelGroups& groups;
  const CacheOptions& options;
  Progress& progress;
  const SampleTable directions;
  const LightTable lights;
  Found front, back;
  std::vector<std::uint8_t> wanted;  // by point: its back is
};

RadianceCache::RadianceCache(const trace::Tracer& tracer, const Emitters& emitters, const TexelLookup& lookup,
                             const atlas::Texels& texels, const TexelGroups& groups,
                             const CacheOptions& options, Progress& progress) {
  Builder(*this, tracer, emitters, lookup, texels, groups, options, progress).build();
}

}  // namespace relume::transport
