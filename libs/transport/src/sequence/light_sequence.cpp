// SPDX-License-Identifier: MIT
// Places of light are numbered: fronts of points, backs that rays have met, darkness, bins of the sky.
#include "relume/transport/light_sequence.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "direction_batch.h"
#include "group_solving.h"
#include "lightmap/exposure.h"
#include "lightmap/gatherer.h"
#include "lightmap/light_rays.h"
#include "lightmap/reflectance.h"
#include "lightmap/substitutes.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "relume/transport/occlusion.h"
#include "sequence/sky_bins.h"

namespace relume::transport {
namespace {

constexpr double kConverged = 1e-3;  // what is still to come, of what there is
constexpr int kMostBounces = 256;
constexpr std::uint32_t kSkyBit = 0x40000000u;  // beside kBackBit, while rays are being traced

double sumOf(std::span<const Vec4> values) {
  double sum = 0;
  for (const Vec4& v : values) sum += static_cast<double>(v.x + v.y + v.z);
  return sum;
}

}  // namespace

struct LightSequence::Impl {
  /// Some texels whose rays are traced together, and where their rows lie.
  struct Block {
    std::vector<std::uint32_t> points, rows;
  };

  Impl(const trace::Tracer& the_tracer, const atlas::Atlas& atlas, const atlas::Texels& the_texels,
       const SequenceOptions& the_options, Progress& progress)
      : tracer(the_tracer),
        texels(the_texels),
        options(the_options),
        lookup(tracer.scene(), atlas, texels),
        groups(texels),
        exposure(tracer, texels),
        directions(options.bounce_samples, options.gather_samples, options.seed, BlockSamples::kShared),
        lights(options.light_samples, options.light_samples, options.seed, BlockSamples::kShared),
        fronts(static_cast<std::uint32_t>(texels.points.size())) {
    RELUME_CHECK_LT(fronts, kSkyBit);
    const MeanReflectance mean = meanReflectance(tracer.scene(), texels, options.materials);
    reflectance = mean.value, direct_share = mean.direct;
    back_share.resize(fronts), back_of.assign(fronts, scene::kNone), wanted.assign(fronts, 0);
    traceFronts(progress);
    traceBacks(progress);
    number();
  }

  void traceBlock(GroupRays& rays, Gatherer& gatherer, const Block& block, Side side, std::uint32_t count,
                  std::span<std::uint32_t> ends) {
    const auto size = static_cast<std::uint32_t>(block.points.size());
    rays.begin(block.points, side);
    std::array<std::uint32_t, kGroupTexels> active;
    for (std::uint32_t i = 0; i < size; ++i) active[i] = i;
    rays.select(std::span(active).first(size), options.bounce_samples);
    BackCounts met;
    gatherer.tracePackets(
        rays, 0, count, [&](std::uint32_t s, const trace::RayPacket& packet, const trace::HitPacket& hits) {
          met.add(rays, packet, hits);
          for (std::uint32_t lane = 0; lane < GroupRays::kLanes; ++lane) {
            if (!rays.used(lane) || !(packet.t_max[lane] >= 0.0f)) continue;
            const std::size_t row = block.rows[rays.texelOf(lane)];
            const bool hit = ((hits.hit >> lane) & 1u) != 0;
            const Direction d(packet.direction_x[lane], packet.direction_y[lane], packet.direction_z[lane]);
            const std::uint32_t end =
                hit ? endOf(packet, hits, lane, lookup, &exposure) : kSkyBit | SkyBins::of(d);
            ends[row * count + s + rays.sampleOf(lane)] = end;
          }
        });
    for (std::uint32_t i = 0; i < size; ++i) {
      const float share = static_cast<float>(met.backs(i)) / static_cast<float>(count);
      if (side == Side::kFront) back_share[block.points[i]] = exposure.hidden(block.points[i]) ? 1.0f : share;
      // Also of what lies inside bodies: there may be a lamp in there at some time.
      if (met.behind(i) > 0)
        for (std::uint32_t s = 0; s < count; ++s) want(ends[std::size_t{block.rows[i]} * count + s]);
    }
  }

  void want(SideOfTexel end) {
    if (end == kNoTexel || (end & kBackBit) == 0) return;
    std::atomic_ref<std::uint8_t>(wanted[end & ~kBackBit]).store(1, std::memory_order_relaxed);
  }

  void trace(std::span<const Block> blocks, Side side, std::uint32_t count, std::vector<std::uint32_t>& ends,
             Progress* progress) {
    const Emitters none(dark_scene);
    std::vector<std::uint64_t> rays_of(blocks.size());
    constexpr std::size_t kBlocks = 64;
    parallelFor(blocks.size(), kBlocks, [&](std::size_t begin, std::size_t end) {
      GroupRays rays(tracer.scene(), texels, directions, options.seed, kInfinity, Alignment::kTurned,
                     &exposure);
      Gatherer gatherer(tracer, lookup, none, &exposure);
      for (std::size_t b = begin; b < end; ++b) {
        if (progress && progress->cancelled()) return;
        const std::uint64_t before = gatherer.rays();
        traceBlock(rays, gatherer, blocks[b], side, count, ends);
        rays_of[b] = gatherer.rays() - before;
        if (progress) progress->advance(blocks[b].points.size());
      }
    });
    if (progress) progress->throwIfCancelled();
    for (const std::uint64_t r : rays_of) traced += r;
  }

  void traceFronts(Progress& progress) {
    const Stage stage(progress, "transport", fronts);
    for (std::size_t tile = 0; tile < groups.tiles(); ++tile)
      groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
        front_blocks.push_back({{group.begin(), group.end()}, {group.begin(), group.end()}});
      });
    gathered.assign(std::size_t{fronts} * options.gather_samples, kNoTexel);
    trace(front_blocks, Side::kFront, options.gather_samples, gathered, &progress);
  }

  /// Backs that rays have met, then those that the rays from these meet, until there are no new ones.
  void traceBacks(Progress& progress) {
    for (;;) {
      std::vector<Block> blocks;
      for (const Block& front : front_blocks) {
        const auto is_wanted = [&](std::uint32_t i) { return wanted[i] != 0; };
        if (back_of[front.points[0]] != scene::kNone ||
            std::none_of(front.points.begin(), front.points.end(), is_wanted))
          continue;
        Block block{front.points, {}};
        for (const std::uint32_t i : block.points) {
          block.rows.push_back(backs), back_of[i] = backs++;
          back_points.push_back(i);
        }
        blocks.push_back(std::move(block));
      }
      if (blocks.empty()) return;
      back_ends.resize(std::size_t{backs} * options.bounce_samples, kNoTexel);
      trace(blocks, Side::kBack, options.bounce_samples, back_ends, nullptr);
      back_blocks.insert(back_blocks.end(), blocks.begin(), blocks.end());
      progress.throwIfCancelled();
    }
  }

  /// Ends of rays become places of light.
  void number() {
    valid.resize(fronts);
    std::vector<std::uint8_t> buried(fronts);
    for (std::uint32_t i = 0; i < fronts; ++i) {
      buried[i] = back_share[i] > kBuriedShare;
      valid[i] = !buried[i];
    }
    const std::vector<std::uint32_t> substitute = substitutes(texels, buried);
    const std::uint32_t nothing = fronts + backs;
    const auto placeOf = [&](std::uint32_t end) {
      if (end == kNoTexel) return nothing;
      if ((end & kBackBit) != 0) {
        const std::uint32_t back = back_of[end & ~kBackBit];
        return back == scene::kNone ? nothing : fronts + back;
      }
      if ((end & kSkyBit) != 0) return nothing + 1 + (end & ~kSkyBit);
      return substitute[end];
    };
    for (auto* ends : {&gathered, &back_ends})
      parallelFor(ends->size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) (*ends)[i] = placeOf((*ends)[i]);
      });
  }

  std::size_t entries() const { return std::size_t{fronts} + backs; }
  std::uint32_t pointOf(std::size_t entry) const {
    return entry < fronts ? static_cast<std::uint32_t>(entry) : back_points[entry - fronts];
  }

  Direct direct(const Emitters& emitters) {
    Direct result{std::vector<Vec3>(entries(), Vec3(0.0f))};
    if (emitters.empty()) return result;
    const std::size_t blocks = front_blocks.size() + back_blocks.size();
    std::vector<std::uint64_t> rays_of(blocks);
    const float share = 1.0f / static_cast<float>(options.light_samples);
    constexpr std::size_t kBlocks = 64;
    parallelFor(blocks, kBlocks, [&](std::size_t begin, std::size_t end) {
      GroupRays rays(tracer.scene(), texels, directions, options.seed, kInfinity, Alignment::kTurned,
                     &exposure);
      LightRays light_rays(tracer, emitters, lights, true);
      std::array<std::uint32_t, kGroupTexels> active;
      for (std::uint32_t i = 0; i < active.size(); ++i) active[i] = i;
      for (std::size_t b = begin; b < end; ++b) {
        const bool front = b < front_blocks.size();
        const Block& block = front ? front_blocks[b] : back_blocks[b - front_blocks.size()];
        const std::uint64_t before = light_rays.rays();
        rays.begin(block.points, front ? Side::kFront : Side::kBack);
        light_rays.trace(rays, std::span(active).first(block.points.size()), 0, options.light_samples,
                         [&](std::uint32_t texel, std::uint32_t, Vec3 irradiance, float, Direction) {
                           const std::size_t entry = block.rows[texel] + (front ? 0u : fronts);
                           result.irradiance[entry] += share * irradiance;
                         });
        rays_of[b] = light_rays.rays() - before;
      }
    });
    for (const std::uint64_t r : rays_of) traced += r;
    return result;
  }

  /// Sum over the first `count` rays of an entry.
  Vec4 gather(std::span<const Vec4> now, std::size_t entry, std::uint32_t from, std::uint32_t to) const {
    const std::uint32_t* end = entry < fronts ? &gathered[entry * options.gather_samples]
                                              : &back_ends[(entry - fronts) * options.bounce_samples];
    Vec4 sum(0.0f);
    for (std::uint32_t s = from; s < to; ++s) sum += now[end[s]];
    return sum;
  }

  /// Radiance of all places after all bounces.
  std::vector<Vec4> bounced(const Direct& direct, const scene::Environment& environment) const {
    const std::size_t count = entries();
    std::vector<Vec4> now(count + 1 + SkyBins::kCount, Vec4(0.0f));
    const std::vector<Vec3> sky = SkyBins::radiance(environment);
    for (std::size_t i = 0; i < sky.size(); ++i) now[count + 1 + i] = Vec4(sky[i], 0);
    std::vector<Vec4> first(count), next = now;
    const auto reflected = [&](std::size_t entry, Vec4 gathered_light) {
      return Vec4(kInvPi * reflectance[pointOf(entry)], 0) * gathered_light;
    };
    for (std::size_t i = 0; i < count; ++i)
      now[i] = first[i] = reflected(i, Vec4(direct_share[pointOf(i)] * direct.irradiance[i], 0));
    const float per_ray = kPi / static_cast<float>(options.bounce_samples);
    double total = sumOf(std::span(now).first(count)), step = total;
    for (int k = 0; k < kMostBounces; ++k) {
      parallelFor(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          next[i] = first[i] + reflected(i, per_ray * gather(now, i, 0, options.bounce_samples));
      });
      now.swap(next);
      const double sum = sumOf(std::span(now).first(count)), more = sum - total;
      const double ratio = step > 0 && k > 0 ? std::clamp(more / step, 0.0, 0.999) : 0.999;
      total = sum, step = more;
      const double to_come = ratio / (1 - ratio);
      if (!(step * to_come >= kConverged * total)) {
        for (std::size_t i = 0; i < count; ++i) now[i] += static_cast<float>(to_come) * (now[i] - next[i]);
        break;
      }
    }
    return now;
  }

  Light light(const Direct& direct, const scene::Environment& environment) const {
    const std::vector<Vec4> now = bounced(direct, environment);
    const std::uint32_t n = options.gather_samples, half = n / 2;
    const float per_ray = kPi / static_cast<float>(n);
    Light result{std::vector<Vec3>(fronts), std::vector<float>(fronts)};
    parallelFor(front_blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        float sum2 = 0;
        for (const std::uint32_t i : front_blocks[b].points) {
          const Vec4 one = gather(now, i, 0, half), other = gather(now, i, half, n);
          result.irradiance[i] = per_ray * Vec3(one + other);
          const float difference = per_ray * luminance(Vec3(one - other));
          sum2 += difference * difference;
        }
        const float error = std::sqrt(sum2 / static_cast<float>(front_blocks[b].points.size()));
        for (const std::uint32_t i : front_blocks[b].points) result.error[i] = error;
      }
    });
    return result;
  }

  const trace::Tracer& tracer;
  const atlas::Texels& texels;
  const SequenceOptions options;
  const scene::Scene dark_scene;
  const TexelLookup lookup;
  const TexelGroups groups;
  const Exposure exposure;
  const SampleTable directions;
  const LightTable lights;
  const std::uint32_t fronts;
  std::uint32_t backs = 0;
  std::vector<Vec3> reflectance;    // by point
  std::vector<float> direct_share;  // likewise
  std::vector<Block> front_blocks, back_blocks;
  std::vector<std::uint32_t> gathered;   // shape [fronts][gather_samples]: ends of rays
  std::vector<std::uint32_t> back_ends;  // shape [backs][bounce_samples]
  std::vector<float> back_share;
  std::vector<std::uint8_t> valid, wanted;
  std::vector<std::uint32_t> back_of, back_points;
  std::uint64_t traced = 0;
};

LightSequence::LightSequence(const trace::Tracer& tracer, const atlas::Atlas& atlas,
                             const atlas::Texels& texels, const SequenceOptions& options,
                             Progress& progress) {
  for (const std::uint32_t n : {options.gather_samples, options.bounce_samples, options.light_samples})
    RELUME_CHECK(std::has_single_bit(n));
  RELUME_CHECK_LE(options.bounce_samples, std::min(kMaxBatch, options.gather_samples / 2));
  RELUME_CHECK_LE(options.light_samples, kMaxBatch);
  impl_ = std::make_unique<Impl>(tracer, atlas, texels, options, progress);
}
LightSequence::~LightSequence() = default;

void LightSequence::Direct::add(const Direct& other, Vec3 gain) {
  RELUME_CHECK_EQ(irradiance.size(), other.irradiance.size());
  for (std::size_t i = 0; i < irradiance.size(); ++i) irradiance[i] += gain * other.irradiance[i];
}

LightSequence::Direct LightSequence::dark() const {
  return {std::vector<Vec3>(impl_->entries(), Vec3(0.0f))};
}
LightSequence::Direct LightSequence::direct(const Emitters& emitters) const {
  return impl_->direct(emitters);
}
LightSequence::Light LightSequence::light(const Direct& direct, const scene::Environment& environment) const {
  return impl_->light(direct, environment);
}
std::span<const std::uint8_t> LightSequence::valid() const { return impl_->valid; }
std::span<const float> LightSequence::backShare() const { return impl_->back_share; }
std::uint64_t LightSequence::rays() const { return impl_->traced; }

}  // namespace relume::transport
