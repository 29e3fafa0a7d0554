// SPDX-License-Identifier: MIT
#include "lightmap/radiance_cache.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "lightmap/glossy_walk.h"
#include "lightmap/light_rays.h"
#include "lightmap/reflectance.h"
#include "lightmap/substitutes.h"
#include "relume/core/parallel.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

// Light is handed on until what is still to come is this share of what there is, and that is added then.
constexpr double kConverged = 1e-3;
constexpr int kMostBounces = 4096;

// What glossy lobes of less than this share of the light send on leaves as from diffuse ones. Coats of
// dielectrics reflect some 6 %: to follow that made a Cornell box three times as noisy, for a tenth of a
// percent of bias.
constexpr float kLeastWalked = 0.15f;

double sumOf(std::span<const Vec4> values) {
  double sum = 0;
  for (const Vec4& v : values) sum += static_cast<double>(v.x + v.y + v.z);
  return sum;
}

/// A sum that grows bounce by bounce, each time by about the same part of the growth before.
class Growth {
 public:
  explicit Growth(double first = 0) : total_(first), step_(first) {}

  void to(double sum) {
    const double step = sum - total_;
    ratio_ = step_ > 0 ? std::clamp(step / step_, 0.0, kMostRatio) : kMostRatio;
    total_ = sum, step_ = step;
  }
  /// What is still to come, in last steps.
  double stepsToCome() const { return ratio_ / (1 - ratio_); }
  bool done() const { return total_ > 0 && step_ * stepsToCome() < kConverged * total_; }

 private:
  static constexpr double kMostRatio = 0.999;
  double total_, step_, ratio_ = kMostRatio;
};

}  // namespace

struct RadianceCache::Builder {
  /// A surface that an entry's rays find in glossy ones.
  struct Mirrored {
    std::uint32_t entry;
    SideOfTexel surface;
    Vec3 share;            // of a gather ray
    ggx::Reflected gloss;  // how the entry's own glossy lobes weigh that ray
  };

  /// What was found from one side of the surfaces.
  struct Found {
    std::vector<Vec3> direct;       // E, by entry
    std::vector<Vec3> glossy;       // of that, what glossy lobes reflect
    std::vector<SideOfTexel> ends;  // [entry][gather_samples]
    std::vector<Reflectance> reflectance;
    std::vector<std::uint8_t> column;  // of the sample table
    std::vector<Vec3> mirrored;        // E from emitters that are seen in glossy surfaces, by entry
    std::vector<Mirrored> ends_of_walks;
    std::vector<std::size_t> first_walk;  // by entry and one more: in ends_of_walks

    std::size_t size() const { return reflectance.size(); }
    void resize(std::size_t entries, std::uint32_t samples) {
      direct.resize(entries), glossy.resize(entries), column.resize(entries), mirrored.resize(entries);
      ends.resize(entries * samples, kNoTexel);
    }
  };

  Builder(RadianceCache& the_cache, const trace::Tracer& the_tracer, const Emitters& the_emitters,
          const TexelLookup& the_lookup, const atlas::Texels& the_texels, const TexelGroups& the_groups,
          const Exposure& the_exposure, const CacheOptions& the_options, Progress& the_progress)
      : cache(the_cache),
        tracer(the_tracer),
        emitters(the_emitters),
        lookup(the_lookup),
        texels(the_texels),
        groups(the_groups),
        exposure(the_exposure),
        options(the_options),
        progress(the_progress),
        directions(options.gather_samples, options.gather_samples, options.seed, BlockSamples::kShared),
        lights(options.light_samples, options.light_samples, options.seed, BlockSamples::kShared),
        gloss(options.materials == Materials::kFull ? directions.z : std::vector<float>()) {}

  void build() {
    const std::size_t points = texels.points.size();
    front.reflectance = reflectances(tracer.scene(), texels, options.materials);
    prepareWalks();
    cache.back_share_.resize(points);
    front.resize(points, options.gather_samples);
    wanted.assign(points, 0);
    gatherFronts();
    std::vector<std::uint8_t> buried(points);
    for (std::size_t i = 0; i < points; ++i) buried[i] = cache.back_share_[i] > kBuriedShare;
    gatherBacks();
    nothing = static_cast<std::uint32_t>(points + back.size());
    std::replace(cache.back_of_.begin(), cache.back_of_.end(), scene::kNone, nothing);
    const std::vector<std::uint32_t> substitute = substitutes(texels, buried);
    sortWalks(front), sortWalks(back);
    place(front, substitute), place(back, substitute);
    handOn();
    for (std::size_t i = 0; i < points; ++i) cache.radiance_[i] = now[substitute[i]];
    for (std::size_t i = points; i < now.size(); ++i) cache.radiance_[i] = now[i];
  }

 private:
  /// Solves the group for one side: row i of the found is slots[i].
  struct Worker {
    explicit Worker(const Builder& b)
        : rays(b.tracer.scene(), b.texels, b.directions, b.options.seed, kInfinity, Alignment::kTurned,
               &b.exposure),
          gatherer(b.tracer, b.lookup, b.emitters, &b.exposure),
          light_rays(b.tracer, b.emitters, b.lights, false),
          walk(b.tracer, b.lookup, b.exposure, b.emitters, b.cache) {}
    std::uint64_t traced() const { return gatherer.rays() + light_rays.rays() + walk.rays(); }
    GroupRays rays;
    Gatherer gatherer;
    LightRays light_rays;
    GlossyWalk walk;
    std::vector<std::uint32_t> active;
    std::vector<GlossyWalk::End> ends;
    std::vector<Mirrored> mirrored;
  };

  /// With any number of bounces, what glossy lobes send is followed from each ray that meets them; bounces
  /// that are counted would need the light of each apart.
  void prepareWalks() {
    if (options.materials != Materials::kFull || options.bounces >= 0) return;
    const auto glossy = [](const Reflectance& r) { return r.glossiness > kLeastWalked; };
    if (std::none_of(front.reflectance.begin(), front.reflectance.end(), glossy)) return;
    cache.walk_chance_.resize(front.reflectance.size());
    for (std::size_t i = 0; i < front.reflectance.size(); ++i) {
      Reflectance& r = front.reflectance[i];
      if (!glossy(r)) continue;
      cache.walk_chance_[i] = static_cast<std::uint8_t>(std::min(std::lround(256 * r.glossiness), 255l));
      r.scale = r.bias = Vec3(0.0f);
    }
  }

  /// Follows what the glossy surface sends on that a ray of an entry has met, by chance.
  void walk(Worker& w, std::uint32_t slot, std::uint32_t point, Side side, std::uint32_t sample,
            const Arrival& arrival, Found& found) {
    if (!cache.anyWalks() || arrival.surface == kNoTexel) return;
    const std::uint32_t chance = cache.walkChance(lookup.point(arrival.hit));
    if (chance == 0) return;
    PathSampler sampler(options.seed, texels.points[point].texel, side == Side::kFront ? 0 : 1, sample);
    if (!(sampler.pair().x * 256 < static_cast<float>(chance))) return;
    const float weight = 256.0f / static_cast<float>(chance);
    const Vec3 seen = w.walk.follow(arrival.hit, -arrival.direction, sampler, w.ends);
    const Vec3 irradiance = (kPi / static_cast<float>(options.gather_samples) * weight) * seen;
    const Reflectance& r = found.reflectance[slot];
    const ggx::Reflected gloss_share = glossOf(found, slot, sample);
    found.mirrored[slot] += irradiance;
    found.glossy[slot] += irradiance * (r.scale * gloss_share.scale + r.bias * gloss_share.bias);
    for (const GlossyWalk::End& end : w.ends)
      w.mirrored.push_back({slot, end.surface, weight * end.share, gloss_share});
  }

  /// From one list for each place of the parallel loop to one in the order of the entries.
  static void sortWalks(Found& found) {
    found.first_walk.assign(found.size() + 1, 0);
    for (const Mirrored& m : found.ends_of_walks) ++found.first_walk[m.entry + 1];
    std::partial_sum(found.first_walk.begin(), found.first_walk.end(), found.first_walk.begin());
    std::stable_sort(found.ends_of_walks.begin(), found.ends_of_walks.end(),
                     [](const Mirrored& a, const Mirrored& b) { return a.entry < b.entry; });
  }

  void gatherGroup(Worker& w, std::span<const std::uint32_t> group, Side side,
                   std::span<const std::uint32_t> slots, Found& found) {
    const std::uint32_t n = options.gather_samples;
    const std::size_t walks_before = w.mirrored.size();
    w.rays.begin(group, side);
    w.active.resize(group.size());
    for (std::uint32_t i = 0; i < group.size(); ++i) w.active[i] = i;
    for (std::uint32_t i = 0; i < group.size(); ++i)
      found.column[slots[i]] = static_cast<std::uint8_t>(w.rays.columnOf(i));
    const float light_share = 1.0f / static_cast<float>(options.light_samples);
    const auto arrived = [&](std::uint32_t slot, Vec3 irradiance, ggx::Reflected gloss_share) {
      const Reflectance& r = found.reflectance[slot];
      found.direct[slot] += irradiance;
      found.glossy[slot] += r.direct * irradiance * (r.scale * gloss_share.scale + r.bias * gloss_share.bias);
    };
    w.light_rays.trace(w.rays, w.active, 0, options.light_samples,
                       [&](std::uint32_t texel, std::uint32_t, Vec3 irradiance, float cosine, Direction) {
                         const Reflectance& r = found.reflectance[slots[texel]];
                         arrived(slots[texel], irradiance * light_share,
                                 r.glossy() ? ggx::reflected(cosine, GlossTable::alphaOf(r.roughness))
                                            : ggx::Reflected{0, 0});
                       });
    BackCounts backs;
    w.rays.select(w.active, n);
    const float ray_share = kPi / static_cast<float>(n);
    w.gatherer.trace(w.rays, 0, n, backs,
                     [&](std::uint32_t texel, std::uint32_t sample, const Arrival& arrival) {
                       const std::uint32_t slot = slots[texel];
                       if (arrival.emitted != Vec3(0.0f))
                         arrived(slot, arrival.emitted * ray_share, glossOf(found, slot, sample));
                       found.ends[std::size_t{slot} * n + sample] = arrival.surface;
                       walk(w, slot, group[texel], side, sample, arrival, found);
                     });
    for (std::size_t i = 0; i < group.size(); ++i) {
      const float share = static_cast<float>(backs.backs(i)) / static_cast<float>(n);
      if (side == Side::kFront) cache.back_share_[group[i]] = exposure.hidden(group[i]) ? 1.0f : share;
      // What is inside a body sees backs that nobody else does; no light finds it either.
      if (backs.behind(i) > 0 && (share <= kBuriedShare || found.direct[slots[i]] != Vec3(0.0f)))
        want(slots[i], found);
    }
    for (std::size_t i = walks_before; i < w.mirrored.size(); ++i) want(w.mirrored[i].surface);
  }

  /// Marks a surface that a ray has met, if it is a back.
  void want(SideOfTexel end) {
    if (end == kNoTexel || (end & kBackBit) == 0) return;
    std::atomic_ref<std::uint8_t>(wanted[end & ~kBackBit]).store(1, std::memory_order_relaxed);
  }

  /// Marks the backs that an entry's rays have met.
  void want(std::size_t slot, const Found& found) {
    for (std::uint32_t s = 0; s < options.gather_samples; ++s)
      want(found.ends[slot * options.gather_samples + s]);
  }

  void gatherFronts() {
    const Stage stage(progress, "bounces", texels.points.size());
    std::vector<std::uint64_t> rays(groups.tiles());
    std::vector<std::vector<Mirrored>> walks(groups.tiles());
    parallelFor(groups.tiles(), 4, [&](std::size_t begin, std::size_t end) {
      Worker worker(*this);
      for (std::size_t tile = begin; tile < end; ++tile) {
        const std::uint64_t before = worker.traced();
        groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
          if (progress.cancelled()) return;
          gatherGroup(worker, group, Side::kFront, group, front);
          progress.advance(group.size());
        });
        rays[tile] = worker.traced() - before;
        walks[tile].swap(worker.mirrored);
      }
    });
    progress.throwIfCancelled();
    for (const std::uint64_t r : rays) cache.rays_ += r;
    for (const auto& list : walks)
      front.ends_of_walks.insert(front.ends_of_walks.end(), list.begin(), list.end());
  }

  /// Backs that rays have met, then those that the rays from these meet, until there are no new ones.
  void gatherBacks() {
    if (std::find(wanted.begin(), wanted.end(), 1) == wanted.end()) return;
    const auto points = static_cast<std::uint32_t>(texels.points.size());
    cache.back_of_.assign(points, scene::kNone);
    for (;;) {
      struct Block {
        std::vector<std::uint32_t> points, slots;
      };
      std::vector<Block> blocks;
      auto next = static_cast<std::uint32_t>(back.size());
      for (std::size_t tile = 0; tile < groups.tiles(); ++tile) {
        groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
          const auto is_wanted = [&](std::uint32_t i) { return wanted[i] != 0; };
          if (cache.back_of_[group[0]] != scene::kNone || std::none_of(group.begin(), group.end(), is_wanted))
            return;
          Block block{{group.begin(), group.end()}, {}};
          for (const std::uint32_t i : group) {
            block.slots.push_back(next);
            cache.back_of_[i] = points + next++;
            back.reflectance.push_back(front.reflectance[i]);
          }
          blocks.push_back(std::move(block));
        });
      }
      if (blocks.empty()) return;
      back.resize(next, options.gather_samples);
      std::vector<std::uint64_t> rays(blocks.size());
      std::vector<std::vector<Mirrored>> walks(blocks.size());
      parallelFor(
          blocks.size(), 64,
          [&](std::size_t begin, std::size_t end) {
            Worker worker(*this);
            for (std::size_t b = begin; b < end; ++b) {
              const std::uint64_t before = worker.traced();
              gatherGroup(worker, blocks[b].points, Side::kBack, blocks[b].slots, back);
              rays[b] = worker.traced() - before;
              walks[b].swap(worker.mirrored);
            }
          },
          &progress);
      for (const std::uint64_t r : rays) cache.rays_ += r;
      for (const auto& list : walks)
        back.ends_of_walks.insert(back.ends_of_walks.end(), list.begin(), list.end());
    }
  }

  /// How glossy lobes weigh the light of a gather sample.
  ggx::Reflected glossOf(const Found& found, std::size_t entry, std::uint32_t sample) const {
    const Reflectance& r = found.reflectance[entry];
    if (!r.glossy()) return {0, 0};
    return gloss.at(r.roughness, std::size_t{sample} * SampleTable::kColumns + found.column[entry]);
  }

  /// Ends of rays become places in `now`.
  void place(Found& found, const std::vector<std::uint32_t>& substitute) const {
    const auto placeOf = [&](SideOfTexel surface) {
      if ((surface & kBackBit) == 0) return substitute[surface];
      const bool known = surface != kNoTexel && !cache.back_of_.empty();
      return known ? cache.back_of_[surface & ~kBackBit] : nothing;
    };
    parallelFor(found.ends.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) found.ends[i] = placeOf(found.ends[i]);
    });
    for (Mirrored& m : found.ends_of_walks) m.surface = placeOf(m.surface);
  }

  /// Light of the bounce before that an entry's rays find; what then leaves the entry.
  Vec4 reflect(const Found& found, std::size_t entry, Vec3* indirect) const {
    const std::uint32_t n = options.gather_samples;
    const Reflectance& r = found.reflectance[entry];
    const std::uint32_t* end = &found.ends[entry * n];
    const auto walks =
        std::span(found.ends_of_walks)
            .subspan(found.first_walk[entry], found.first_walk[entry + 1] - found.first_walk[entry]);
    Vec4 sum(0.0f), glossy(0.0f);
    if (!r.glossy()) {
      for (std::uint32_t s = 0; s < n; ++s) sum += now[end[s]];
      for (const Mirrored& m : walks) sum += Vec4(m.share, 0) * now[m.surface];
    } else {
      Vec4 scaled(0.0f), biased(0.0f);
      const auto add = [&](Vec4 radiance, ggx::Reflected share) {
        sum += radiance, scaled += radiance * share.scale, biased += radiance * share.bias;
      };
      for (std::uint32_t s = 0; s < n; ++s) add(now[end[s]], glossOf(found, entry, s));
      for (const Mirrored& m : walks) add(Vec4(m.share, 0) * now[m.surface], m.gloss);
      glossy = Vec4(r.scale, 0) * scaled + Vec4(r.bias, 0) * biased;
    }
    const float per_ray = kPi / static_cast<float>(n);
    const Vec4 arriving = per_ray * sum + Vec4(found.mirrored[entry], 0);
    if (indirect) *indirect = Vec3(arriving);
    return kInvPi * (Vec4(r.diffuse, 0) * (Vec4(r.direct * found.direct[entry], 0) + arriving) +
                     Vec4(found.glossy[entry], 0) + per_ray * glossy);
  }

  /// Calls body(found, entry, place in `now`) for all entries.
  template <class Body>
  void forEachEntry(const Body& body) const {
    const std::size_t fronts = front.size();
    parallelFor(fronts + back.size(), 2048, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) i < fronts ? body(front, i, i) : body(back, i - fronts, i);
    });
  }

  /// Irradiance that is handed on to the fronts of texels that lie outside of bodies.
  double seenLight() const {
    double sum = 0;
    for (std::size_t i = 0; i < cache.indirect_.size(); ++i) {
      const Vec3& e = cache.indirect_[i];
      if (!(cache.back_share_[i] > kBuriedShare)) sum += static_cast<double>(e.x + e.y + e.z);
    }
    return sum;
  }

  /// Adds the last step so many times.
  void extrapolate(std::span<const Vec4> before, float times) {
    for (std::size_t i = 0; i < now.size(); ++i) now[i] += times * (now[i] - before[i]);
  }

  void handOn() {
    now.assign(front.size() + back.size() + 1, Vec4(0.0f));
    std::vector<Vec4> next(now.size(), Vec4(0.0f));
    cache.indirect_.assign(front.size(), Vec3(0.0f));
    cache.radiance_.assign(now.size(), Vec3(0.0f));
    forEachEntry([&](const Found& found, std::size_t entry, std::size_t place) {
      const Reflectance& r = found.reflectance[entry];
      now[place] = Vec4(kInvPi * (r.diffuse * r.direct * found.direct[entry] + found.glossy[entry]), 0);
    });
    const bool endless = options.bounces < 0;
    const int most = endless ? kMostBounces : options.bounces;
    // White walls inside of bodies hand on for hundreds of bounces what nobody sees: where texels that are
    // seen get no more light, the rest may be as it is.
    const double first = sumOf(now);
    Growth all(first), seen;
    // Light of emitters may come by glossy surfaces alone.
    for (int k = 0; k < most && (first > 0 || k > 0 || cache.anyWalks()); ++k) {
      forEachEntry([&](const Found& found, std::size_t entry, std::size_t place) {
        next[place] = reflect(found, entry, &found == &front ? &cache.indirect_[entry] : nullptr);
      });
      now.swap(next);
      all.to(sumOf(now)), seen.to(seenLight());
      progress.throwIfCancelled();
      if (!all.done() && !seen.done()) continue;
      if (endless) extrapolate(next, static_cast<float>(std::min(all.stepsToCome(), seen.stepsToCome())));
      break;
    }
    cache.direct_ = std::move(front.direct);
  }

  RadianceCache& cache;
  const trace::Tracer& tracer;
  const Emitters& emitters;
  const TexelLookup& lookup;
  const atlas::Texels& texels;
  const TexelGroups& groups;
  const Exposure& exposure;
  const CacheOptions& options;
  Progress& progress;
  const SampleTable directions;
  const LightTable lights;
  const GlossTable gloss;
  Found front, back;
  std::uint32_t nothing = 0;         // place in `now` that stays dark
  std::vector<Vec4> now;             // radiance: fronts, backs, nothing; four wide for vector code
  std::vector<std::uint8_t> wanted;  // by point: its back is
};

RadianceCache::RadianceCache(const trace::Tracer& tracer, const Emitters& emitters, const TexelLookup& lookup,
                             const atlas::Texels& texels, const TexelGroups& groups, const Exposure& exposure,
                             const CacheOptions& options, Progress& progress) {
  Builder(*this, tracer, emitters, lookup, texels, groups, exposure, options, progress).build();
}

}  // namespace relume::transport
