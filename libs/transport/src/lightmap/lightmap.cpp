// SPDX-License-Identifier: MIT
#include "relume/transport/lightmap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>

#include "direction_batch.h"
#include "error_estimate.h"
#include "group_solving.h"
#include "lightmap/chunk.h"
#include "lightmap/directional_sums.h"
#include "lightmap/end_radiance.h"
#include "lightmap/exposure.h"
#include "lightmap/gatherer.h"
#include "lightmap/glossy_walk.h"
#include "lightmap/light_rays.h"
#include "lightmap/near_walk.h"
#include "lightmap/path_group.h"
#include "lightmap/radiance_cache.h"
#include "radiosity/radiosity.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kColumns = SampleTable::kColumns;
// Of the irradiance that a texel's tolerance is a share of: not below this part of the scene's mean.
constexpr float kDarkest = 0.25f;
// Of the scene's mean, what may come through the cracks of a closed body.
constexpr float kNoLight = 1e-4f;
constexpr std::uint32_t kLeastLightSamples = 4;  // of a texel, for the cache

/// Light samples of a first round; of gather rays these are min_samples.
std::uint32_t leastLights(const LightmapOptions& options) { return std::max(options.min_samples / 2, 4u); }

/// The means of the samples of a group's texels, round by round, and how far they may be off.
class Estimate {
 public:
  /// `unit`: what a sample of 1 stands for.
  void begin(std::size_t texels, float unit) {
    unit_ = unit;
    sum_.fill(glm::dvec3(0)), variance_.fill(0.0f), error_.fill(0.0f);
    count_ = 0, texels_ = texels;
  }

  void add(const Chunk& chunk, std::uint32_t count) {
    std::array<float, kColumns> mean;
    scratch_.resize(chunk.grey().size());
    for (std::size_t c = 0; c < kColumns; ++c) mean[c] = chunk.greySum(c) / static_cast<float>(count);
    addNetVariances(chunk.grey(), mean, scratch_, variance_);
    count_ += count;
    float typical = 0;
    for (std::size_t i = 0; i < texels_; ++i) {
      sum_[i] += glm::dvec3(chunk.sum(i));
      typical += luminance(this->mean(i)) / static_cast<float>(texels_);
    }
    for (std::size_t i = 0; i < texels_; ++i)
      error_[i] = radianceStandardError(unit_ * unit_ * variance_[i], count_, typical);
  }

  Vec3 mean(std::size_t i) const {
    return count_ > 0 ? unit_ * Vec3(sum_[i] / static_cast<double>(count_)) : Vec3(0.0f);
  }
  float error(std::size_t i) const { return error_[i]; }
  std::uint32_t count() const { return count_; }
  /// Mean square of the errors.
  float squaredError() const {
    float sum = 0;
    for (std::size_t i = 0; i < texels_; ++i) sum += error_[i] * error_[i];
    return sum / static_cast<float>(texels_);
  }

 private:
  std::array<glm::dvec3, kColumns> sum_;
  std::array<float, kColumns> variance_, error_;
  float unit_ = 1.0f;
  std::uint32_t count_ = 0;
  std::size_t texels_ = 0;
  std::vector<float> scratch_;
};

/// What all groups share.
struct Shared {
  const trace::Tracer& tracer;
  const atlas::Texels& texels;
  const LightmapOptions& options;
  const Emitters& emitters;
  const TexelLookup& lookup;
  const SampleTable& directions;
  const LightTable& lights;
  const Exposure& exposure;
  const RadianceCache& cache;
  const EndRadiance& ends;
  std::span<const float> reach;  // NearWalk::reaches
  float mean = 0;                // of the irradiance that is solved for: luminance

  bool direct() const { return options.part != Part::kIndirect && !emitters.empty(); }
  bool indirect() const { return options.part != Part::kDirect && options.max_bounces != 0; }
};

class GroupSolver {
 public:
  explicit GroupSolver(const Shared& shared)
      : shared_(shared),
        options_(shared.options),
        rays_(shared.tracer.scene(), shared.texels, shared.directions, options_.seed, kInfinity,
              Alignment::kTurned, &shared.exposure),
        gatherer_(shared.tracer, shared.lookup, shared.emitters, &shared.exposure),
        light_rays_(shared.tracer, shared.emitters, shared.lights, options_.part == Part::kDirect),
        walk_(shared.tracer, shared.lookup, shared.exposure, shared.emitters, shared.cache),
        near_(shared.tracer, shared.reach, shared.lookup, shared.exposure, shared.emitters, shared.cache,
              options_.materials),
        lit_from_(options_.receiver.get()),
        gathered_from_(options_.receiver.get()) {}

  std::uint64_t rays() const { return gatherer_.rays() + light_rays_.rays() + walk_.rays() + near_.rays(); }

  void solve(std::span<const std::uint32_t> group, std::span<const std::uint32_t> slots,
             LightmapResult& result) {
    rays_.begin(group);
    light_.begin(group.size(), 1.0f);
    gathered_.begin(group.size(), kPi);  // of cosine-weighted rays each stands for pi steradian
    lit_from_.begin(group, shared_.texels), gathered_from_.begin(group, shared_.texels);
    backs_.clear();
    all_.resize(group.size());
    std::iota(all_.begin(), all_.end(), 0u);
    const float allowed = squaredTolerance(group);
    if (shared_.direct())
      sample(leastLights(options_), allowed, light_, [&](auto first, auto count) {
        light_rays_.trace(
            rays_, all_, first, count,
            [&](std::uint32_t texel, std::uint32_t sample, Vec3 irradiance, float cosine, Direction from) {
              chunk_.add(texel, sample, irradiance);
              if (lit_from_) lit_from_.add(texel, {from, Irradiance(irradiance), cosine});
            });
      });
    // Also for direct light alone: without a gather ray nothing tells whether a texel lies inside something.
    sample(options_.min_samples, allowed, gathered_, [&](auto first, auto count) { gather(first, count); });
    for (std::uint32_t i = 0; i < group.size(); ++i) {
      const std::uint32_t slot = slots[i];
      if (slot == scene::kNone) continue;
      result.value[slot] = Irradiance(light_.mean(i) + gathered_.mean(i));
      if (const std::size_t n = lit_from_ ? options_.receiver->sums() : 0; n > 0) {
        const std::span<float> sums = std::span(result.sums).subspan(slot * n, n);
        lit_from_.addMeans(i, light_.count(), sums), gathered_from_.addMeans(i, gathered_.count(), sums);
      }
      const float cached = shared_.indirect() ? shared_.cache.error(group[i]) : 0.0f;
      result.error[slot] = std::hypot(light_.error(i), gathered_.error(i), cached);
      const bool dark = luminance(result.value[slot].rgb) <= kNoLight * shared_.mean;
      result.back_share[slot] = shared_.exposure.hidden(group[i]) ? 1.0f : backs_.share(i, dark);
    }
  }

 private:
  /// Rounds of samples until the group is good enough as a whole. A texel that stopped for itself would stop
  /// when chance has shown it too little light to make a variance: the means came out 3 % too low in a Menger
  /// sponge under the sky.
  template <class Trace>
  void sample(std::uint32_t least, float allowed, Estimate& estimate, const Trace& trace) {
    const bool adaptive = options_.target_error > 0.0f;
    // Small groups have fewer samples to learn from.
    const std::uint32_t enough = least * (all_.size() <= 2 ? 4 : all_.size() <= 8 ? 2 : 1);
    for (std::uint32_t done = 0; done < options_.max_samples;) {
      const std::uint32_t round = done > 0 ? done : adaptive ? least : options_.max_samples;
      const std::uint32_t chunk = std::min(round, kMaxBatch);
      for (std::uint32_t first = done; first < done + round; first += chunk) {
        chunk_.begin(chunk);
        trace(first, chunk);
        estimate.add(chunk_, chunk);
      }
      done += round;
      if (adaptive && done >= enough && estimate.squaredError() < allowed) break;
    }
  }

  void gather(std::uint32_t first, std::uint32_t count) {
    const bool direct = shared_.direct() && options_.part != Part::kDirect, indirect = shared_.indirect();
    rays_.select(all_, count);
    gatherer_.tracePackets(
        rays_, first, count,
        [&](std::uint32_t s, const trace::RayPacket& packet, const trace::HitPacket& hits) {
          LightLanes light;
          if (indirect) {
            const EndRadiance::Open open = shared_.ends.of(packet, hits, light);
            addWalks(first + s, packet, hits, open.walks, light);
            askNear(first + s, packet, hits, open.near, light);
          } else {
            light.fill(Vec4(0.0f));
          }
          if (direct && !gatherer_.nothingSeen()) addEmitted(first + s, packet, hits, light);
          chunk_.add(rays_, s, light);
          if (gathered_from_) gathered_from_.add(rays_, first + s, packet, light);
          backs_.add(rays_, packet, hits);
        });
  }

  /// What glossy surfaces send on where the rays of these lanes end.
  void addWalks(std::uint32_t first, const trace::RayPacket& packet, const trace::HitPacket& hits,
                std::uint32_t lanes, LightLanes& light) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      PathSampler sampler(options_.seed, rays_.alphaStream(rays_.texelOf(lane)), 2,
                          first + rays_.sampleOf(lane));
      const Direction d(packet.direction_x[lane], packet.direction_y[lane], packet.direction_z[lane]);
      Vec3 sum = walk_.follow(hits.where(lane), -d, sampler, walk_ends_);
      for (const GlossyWalk::End& end : walk_ends_) sum += end.share * shared_.cache.radiance(end.surface);
      light[lane] += withLuminance(shared_.ends.perWalk(hits.where(lane)) * sum);
    }
  }

  /// What is reflected where the rays of these lanes end, instead of what the cache knows of it.
  void askNear(std::uint32_t first, const trace::RayPacket& packet, const trace::HitPacket& hits,
               std::uint32_t lanes, LightLanes& light) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      if (!(packet.t_max[lane] >= 0.0f)) continue;
      PathSampler sampler(options_.seed, rays_.alphaStream(rays_.texelOf(lane)), 3,
                          first + rays_.sampleOf(lane));
      const Direction d(packet.direction_x[lane], packet.direction_y[lane], packet.direction_z[lane]);
      light[lane] = withLuminance(near_.follow(hits.where(lane), -d, sampler));
    }
  }

  void addEmitted(std::uint32_t sample, const trace::RayPacket& packet, const trace::HitPacket& hits,
                  LightLanes& light) {
    for (std::uint32_t lane = 0; lane < GroupRays::kLanes; ++lane)
      if (packet.t_max[lane] >= 0.0f)
        light[lane] += withLuminance(gatherer_.emitted(rays_, sample, packet, hits, lane));
  }

  /// Mean square of what a texel's error may be: half of it for direct light, half for gathered.
  float squaredTolerance(std::span<const std::uint32_t> group) const {
    float sum = 0;
    for (const std::uint32_t point : group) {
      Vec3 own(0.0f);
      if (shared_.direct()) own += shared_.cache.direct(point);
      if (shared_.indirect()) own += shared_.cache.indirect(point);
      const float share = luminance(own) / std::max(shared_.mean, 1e-30f);
      sum += std::clamp(share, kDarkest * kDarkest, 1.0f);
    }
    const float target =
        options_.target_error * shared_.mean * (options_.smoothed ? smoothingGain(group.size()) : 1.0f);
    return 0.5f * target * target * sum / static_cast<float>(group.size());
  }

  const Shared& shared_;
  const LightmapOptions& options_;
  GroupRays rays_;
  Gatherer gatherer_;
  LightRays light_rays_;
  GlossyWalk walk_;
  NearWalk near_;
  std::vector<GlossyWalk::End> walk_ends_;
  std::vector<std::uint32_t> all_;  // places in the group
  Chunk chunk_;
  Estimate light_, gathered_;
  DirectionalSums lit_from_, gathered_from_;
  BackCounts backs_;
};

}  // namespace

struct LightmapSolver::Impl {
  Impl(const trace::Tracer& the_tracer, const atlas::Atlas& the_atlas, const atlas::Texels& the_texels,
       const LightmapOptions& the_options)
      : tracer(the_tracer),
        texels(the_texels),
        options(the_options),
        emitters(tracer.scene(), false, EmissiveSurfaces::kIncluded, options.group),
        lookup(tracer.scene(), the_atlas, texels),
        groups(texels),
        first(options.target_error > 0.0f ? options.min_samples : options.max_samples),
        directions(first, options.max_samples, options.seed, sharing()),
        lights(options.target_error > 0.0f ? leastLights(options) : options.max_samples, options.max_samples,
               options.seed, sharing()) {}

  BlockSamples sharing() const { return options.smoothed ? BlockSamples::kShared : BlockSamples::kSeparate; }

  std::unique_ptr<RadianceCache> makeCache(Progress& progress) const {
    const std::uint64_t seed = options.seed + 0x9e3779b97f4a7c15u;  // apart from the last gathering
    if (options.method == LightmapMethod::kRadiosity)
      return std::make_unique<RadianceCache>(
          radiosity({tracer, lookup, texels, groups},
                    {options.radiosity, options.materials, options.max_bounces, seed}, progress));
    CacheOptions how;
    how.gather_samples = options.cache_samples,
    how.light_samples = std::max(options.cache_samples / 4, kLeastLightSamples);
    how.bounces = options.max_bounces < 0 ? options.max_bounces : std::max(options.max_bounces - 1, 0);
    how.materials = options.materials;
    how.seed = seed;
    return std::make_unique<RadianceCache>(tracer, emitters, lookup, texels, groups, *exposure, how,
                                           progress);
  }

  void fillCache(Progress& progress) {
    if (cache) return;
    exposure = std::make_unique<Exposure>(tracer, texels);
    cache = makeCache(progress);
    std::vector<float> all(texels.points.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = luminance(cache->direct(i) + cache->indirect(i));
    exposure->preferDark(all);
    double sum = 0, area = 0;
    for (std::uint32_t i = 0; i < texels.points.size(); ++i) {
      if (cache->backShare(i) > kBuriedShare) continue;
      Vec3 own(0.0f);
      if (options.part != Part::kIndirect) own += cache->direct(i);
      if (options.part != Part::kDirect) own += cache->indirect(i);
      const double weight = static_cast<double>(texels.points[i].area);
      sum += weight * static_cast<double>(luminance(own)), area += weight;
    }
    mean = area > 0 ? static_cast<float>(sum / area) : 0.0f;
    ends = std::make_unique<EndRadiance>(lookup, *exposure, *cache);
    // Bounces that are counted would need the light of each apart; patches are not as fine as texels anyway.
    if (options.max_bounces < 0 && options.method == LightmapMethod::kGather) {
      reach = NearWalk::reaches(texels, *cache);
      ends->watchNear(reach);
    }
    shared.emplace(Shared{tracer, texels, options, emitters, lookup, directions, lights, *exposure, *cache,
                          *ends, reach, mean});
  }

  const trace::Tracer& tracer;
  const atlas::Texels& texels;
  const LightmapOptions options;
  const Emitters emitters;
  const TexelLookup lookup;
  const TexelGroups groups;
  const std::uint32_t first;
  const SampleTable directions;
  const LightTable lights;
  std::unique_ptr<Exposure> exposure;
  std::unique_ptr<RadianceCache> cache;
  std::unique_ptr<EndRadiance> ends;
  std::vector<float> reach;
  float mean = 0;
  std::optional<Shared> shared;  // of what stands above; made with the cache
  SolverPool<GroupSolver> gatherers;
  SolverPool<PathGroup> walkers;
};

LightmapSolver::LightmapSolver(const trace::Tracer& tracer, const atlas::Atlas& atlas,
                               const atlas::Texels& texels, const LightmapOptions& options) {
  RELUME_CHECK(std::has_single_bit(options.min_samples) && std::has_single_bit(options.max_samples) &&
               std::has_single_bit(options.cache_samples));
  RELUME_CHECK_LE(options.min_samples, options.max_samples);
  RELUME_CHECK_LE(options.max_samples, kMaxSequence);
  RELUME_CHECK_LE(options.cache_samples, kMaxBatch);
  RELUME_CHECK(!options.receiver || options.method != LightmapMethod::kPath);
  impl_ = std::make_unique<Impl>(tracer, atlas, texels, options);
}
LightmapSolver::~LightmapSolver() = default;
LightmapSolver::LightmapSolver(LightmapSolver&&) noexcept = default;

LightmapResult LightmapSolver::solve(Progress& progress, std::span<const std::uint32_t> which) {
  // For paths too: what is found there says which part of a texel counts.
  const bool first = !impl_->cache;
  impl_->fillCache(progress);
  Impl& impl = *impl_;
  LightmapResult result;
  const std::size_t count = which.empty() ? impl.texels.points.size() : which.size();
  result.value.resize(count), result.error.resize(count), result.back_share.resize(count);
  if (impl.options.receiver) result.sums.resize(count * impl.options.receiver->sums());
  const auto solve = [&](auto& solver, auto group, auto slots) { solver.solve(group, slots, result); };
  if (impl.options.method == LightmapMethod::kPath) {
    const auto make = [&] {
      return std::make_unique<PathGroup>(impl.tracer, impl.texels, impl.lookup, impl.emitters,
                                         impl.directions, *impl.exposure, std::min(impl.first, kMaxBatch),
                                         impl.options);
    };
    result.rays = solveGroups(impl.groups, impl.texels, which, progress, impl.walkers, make, solve);
    return result;
  }
  const auto make = [&] { return std::make_unique<GroupSolver>(*impl.shared); };
  result.rays = solveGroups(impl.groups, impl.texels, which, progress, impl.gatherers, make, solve);
  if (first) result.rays += impl.cache->rays();
  return result;
}

}  // namespace relume::transport
