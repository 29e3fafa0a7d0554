// SPDX-License-Identifier: MIT
// Solves for k_A and W at texels.
//   k_A = (1/N) sum v(l_i)                                  [RTR] 11.8 with cosine-weighted l_i (11.14 as
//   printed halves it) W   = (1/N) sum rho(L_i), rho = 1 where nothing is hit  [IKSZ03] 3 W_c = (1/N)
//   (sum_open 1 + sum_closed (a_c / a~_c) rho(L_i))  [USKP09] section 8 per channel c; 0/0 = 0 n_bent ~ sum
//   w_i l_i                                    [RTR] 11.10, w_i = v or rho
// Beyond the sources: rays start all over the texel and are sorted. The samples of a texel are a scrambled
// net, one in each cell of the hemisphere; the rays of a 4 x 4 block of texels through the same cell make a
// packet, a slim bundle even where rays of one texel would part. In detailed scenes that is what pays: with
// 100k triangles, packets of 16 cells of one texel were 1.5 times as fast as single rays, packets of one cell
// of 16 texels 2.7 times. Which packets are formed depends on the atlas and on what the group's texels
// converge to, never on threads or on what was asked for. Limits: an opaque back face counts like any hit
// (scalar) or as black (spectral).
#include "relume/transport/occlusion.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>

#include "bundle_guess.h"
#include "direction_batch.h"
#include "error_estimate.h"
#include "group_rays.h"
#include "group_solving.h"
#include "relume/core/check.h"
#include "sample_table.h"
#include "texel_groups.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kLanes = GroupRays::kLanes, kColumns = SampleTable::kColumns;
static_assert(kGroupTexels == kColumns);
// Of a texel, to learn how much of it lies inside something: first few rays; where any of the group's meets a
// back face, more.
constexpr std::uint32_t kSuspectRays = 4, kBuriedRays = 32;
constexpr float kSuspectShare = 0.25f;  // of blocked rays, below which it is not asked more

/// The j-th of `count` samples out of `known`, both powers of two: spread evenly over the hemisphere, and
/// with different low bits, so that they are spread over the footprint too (sample_table.cpp).
std::uint32_t spreadSample(std::uint32_t j, std::uint32_t count, std::uint32_t known) {
  const std::uint32_t step = known / count;
  std::uint32_t reversed = 0;
  for (std::uint32_t bit = 1; bit < count; bit <<= 1) reversed = (reversed << 1) | ((j & bit) != 0);
  return j * step + reversed % step;
}

/// What is known of one texel after some rounds.
struct Tally {
  double sum = 0;  // of the kept values
  glm::dvec3 rgb{0}, bent{0};
  std::uint32_t kept = 0, back = 0, back_rays = 0;
  float error = 0;
  float mean() const { return kept == 0 ? 1.0f : static_cast<float>(sum / kept); }
};

/// Traces one group of texels after the other; reuses its memory. Arrays of samples have 16 columns, one for
/// each place in the group.
class GroupSolver {
 public:
  GroupSolver(const trace::Tracer& tracer, const atlas::Texels& texels, const SampleTable& samples,
              const OcclusionOptions& options)
      : tracer_(tracer),
        texels_(texels),
        samples_(samples),
        options_(options),
        any_hit_(options.kind == OcclusionKind::kScalar &&
                 options.weight.shape == DistanceWeight::Shape::kStep),
        rays_(tracer.scene(), texels, samples, options.seed, options.weight.limit),
        guess_(tracer.scene()),
        values_(std::size_t{options.max_samples} * kColumns),
        back_(std::size_t{kMaxBatch} * kColumns),
        scratch_(std::size_t{std::max(kMaxBatch, options.max_samples)} * kColumns),
        column_(options.max_samples),
        codes_(options.max_samples) {
    if (options.kind == OcclusionKind::kSpectral) rgb_.resize(back_.size());
    if (options.bent_normal) directions_.resize(back_.size());
    for (int c = 0; c < 3; ++c) {
      const float a = options.mean_albedo.rgb[c];
      inverse_mean_albedo_[c] = a > 0.0f ? 1.0f / a : 0.0f;
    }
  }

  std::uint64_t rays() const { return traced_; }

  /// Results of group[i] go to slots[i], unless it is scene::kNone.
  void solve(std::span<const std::uint32_t> group, std::span<const std::uint32_t> slots,
             OcclusionResult& result) {
    rays_.begin(group);
    guess_.begin();
    tallies_.fill(Tally());
    variance_.fill(0.0f);
    const bool adaptive = options_.target_error > 0.0f;
    const float target = options_.target_error * (options_.smoothed ? smoothingGain(group.size()) : 1.0f);
    std::vector<std::uint32_t>& active = active_;
    active.resize(group.size());
    for (std::uint32_t i = 0; i < group.size(); ++i) active[i] = i;
    std::uint32_t done = 0;
    while (!active.empty()) {
      const std::uint32_t round = done > 0 ? done : adaptive ? options_.min_samples : options_.max_samples;
      const std::uint32_t chunk = std::min(round, kMaxBatch);
      rays_.select(active, chunk);
      for (std::uint32_t first = done; first < done + round; first += chunk) solveChunk(first, chunk);
      done += round;
      for (const std::uint32_t i : active) tallies_[i].error = standardError(i, done);
      std::erase_if(active, [&](std::uint32_t i) {
        return done == options_.max_samples || (adaptive && tallies_[i].error < target);
      });
    }
    if (any_hit_) findBuried(static_cast<std::uint32_t>(group.size()));
    for (std::uint32_t i = 0; i < group.size(); ++i)
      if (slots[i] != scene::kNone) store(tallies_[i], texels_.points[group[i]], slots[i], result);
  }

 private:
  void store(const Tally& tally, const atlas::SurfacePoint& point, std::uint32_t slot,
             OcclusionResult& result) const {
    const bool spectral = options_.kind == OcclusionKind::kSpectral;
    result.value[slot] =
        spectral && tally.kept > 0 ? Vec3(tally.rgb / static_cast<double>(tally.kept)) : Vec3(tally.mean());
    result.error[slot] = tally.error;
    const std::uint32_t back_rays = any_hit_ ? tally.back_rays : tally.kept;
    result.back_share[slot] =
        back_rays == 0 ? 0.0f : static_cast<float>(tally.back) / static_cast<float>(back_rays);
    if (!options_.bent_normal) return;
    const double length = glm::length(tally.bent);
    result.bent[slot] = length > 1e-6 * tally.kept ? Direction(tally.bent / length) : point.shading_normal;
  }

  /// Traces samples first .. first + count - 1 of the selected texels and adds what they find.
  void solveChunk(std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t s = 0; s < count; s += rays_.samplesPerPacket()) {
      rays_.packet(first + s, packet_);
      if (!any_hit_)
        traceFirstHit(first + s, s);
      else if (first == 0 && tellsBackFaces(s, count))
        traceNearestHit(s);
      else
        traceAnyHit(first + s);
    }
    const float* values = &values_[std::size_t{first} * kColumns];
    std::array<float, kColumns> sum{}, mean{};
    std::array<std::uint32_t, kColumns> kept{}, back{};
    for (std::size_t s = 0; s < count; ++s) {
      for (std::size_t c = 0; c < kColumns; ++c) {
        const float value = values[s * kColumns + c];
        sum[c] += std::max(value, 0.0f);
        kept[c] += value >= 0.0f;
      }
    }
    for (std::size_t s = 0; !any_hit_ && s < count; ++s)
      for (std::size_t c = 0; c < kColumns; ++c) back[c] += back_[s * kColumns + c];
    for (const std::uint32_t i : active_) {
      Tally& tally = tallies_[i];
      tally.sum += sum[i], tally.kept += kept[i], tally.back += back[i];
      mean[i] = kept[i] > 0 ? sum[i] / static_cast<float>(kept[i]) : 0.0f;
      traced_ += kept[i];
      if (!rgb_.empty() || !directions_.empty()) gatherVectors(tally, i, values, count);
    }
    if (options_.smoothed || first == 0)
      addNetVariances({values, std::size_t{count} * kColumns}, mean, scratch_, variance_);
  }

  void gatherVectors(Tally& tally, std::uint32_t i, const float* values, std::uint32_t count) {
    Vec3 rgb(0), bent(0);
    for (std::size_t at = i; at < std::size_t{count} * kColumns; at += kColumns) {
      if (values[at] < 0.0f) continue;
      if (!rgb_.empty()) rgb += rgb_[at];
      if (!directions_.empty()) bent += values[at] * directions_[at];
    }
    tally.rgb += glm::dvec3(rgb), tally.bent += glm::dvec3(bent);
  }

  /// Calls visit(lane, index of the lane's sample in arrays whose first row is sample 0 of the packet).
  template <class Visit>
  void forEachLane(Visit visit) const {
    for (std::uint32_t lane = 0; lane < kLanes; ++lane)
      if (rays_.used(lane)) visit(lane, rays_.slotOf(lane));
  }

  void keepDirections(std::uint32_t in_chunk) {
    if (directions_.empty()) return;
    Vec3* directions = &directions_[std::size_t{in_chunk} * kColumns];
    forEachLane([&](std::uint32_t lane, std::uint32_t at) {
      directions[at] = {packet_.direction_x[lane], packet_.direction_y[lane], packet_.direction_z[lane]};
    });
  }

  void traceAnyHit(std::uint32_t sample) { keepHits(sample, tracer_.occludedPacket(packet_)); }

  /// As traceAnyHit, and counts the back faces. Little dearer, because most rays meet nothing.
  void traceNearestHit(std::uint32_t sample) {
    trace::HitPacket hits;
    tracer_.intersectPacket(packet_, hits);
    keepHits(sample, hits.hit);
    if (hits.back_face == 0) return;
    forEachLane([&](std::uint32_t lane, std::uint32_t) {
      tallies_[rays_.texelOf(lane)].back += (hits.back_face >> lane) & 1u;
    });
  }

  /// Of the packets of the first `known` samples a few, spread over them, look for the nearest hit.
  bool tellsBackFaces(std::uint32_t sample, std::uint32_t known) const {
    const std::uint32_t packets = std::max(known / rays_.samplesPerPacket(), 1u);
    const std::uint32_t wanted = std::clamp(kSuspectRays / rays_.samplesPerPacket(), 1u, packets);
    for (std::uint32_t j = 0; j < wanted; ++j)
      if (spreadSample(j, wanted, packets) * rays_.samplesPerPacket() == sample) return true;
    return false;
  }

  void keepHits(std::uint32_t sample, std::uint32_t hit) {
    std::array<float, kLanes> found;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane)
      found[lane] = packet_.t_max[lane] < 0.0f ? -1.0f : (hit & (1u << lane)) != 0 ? 0.0f : 1.0f;
    float* values = &values_[std::size_t{sample} * kColumns];
    if (rays_.everyLaneInItsSlot())
      std::copy(found.begin(), found.end(), values);
    else
      forEachLane([&](std::uint32_t lane, std::uint32_t at) { values[at] = found[lane]; });
    keepDirections(sample % kMaxBatch);
  }

  void traceFirstHit(std::uint32_t sample, std::uint32_t in_chunk) {
    trace::HitPacket hits;
    tracer_.intersectPacket(packet_, hits, guess_.next());
    guess_.met(hits);
    float* values = &values_[std::size_t{sample} * kColumns];
    const std::size_t base = std::size_t{in_chunk} * kColumns;
    forEachLane([&](std::uint32_t lane, std::uint32_t at) {
      const bool hit = ((hits.hit >> lane) & 1u) != 0, back = ((hits.back_face >> lane) & 1u) != 0;
      back_[base + at] = back;
      const float rho = hit ? options_.weight(hits.t[lane]) : 1.0f;
      const bool kept = packet_.t_max[lane] >= 0.0f;
      values[at] = kept ? rho : -1.0f;
      if (rgb_.empty()) return;
      const bool closed = hit && hits.t[lane] < options_.weight.limit;
      const Vec3 reflectance =
          !closed ? Vec3(1.0f)
          : back  ? Vec3(0.0f)
                  : scene::surfaceAt(tracer_.scene(), hits.where(lane)).albedo().rgb * inverse_mean_albedo_;
      const Vec3 w = reflectance * rho;
      rgb_[base + at] = w;
      if (kept) values[at] = (w.x + w.y + w.z) * (1.0f / 3.0f);
    });
    keepDirections(in_chunk);
  }

  std::uint32_t firstChunk() const {
    return std::min(options_.target_error > 0.0f ? options_.min_samples : options_.max_samples, kMaxBatch);
  }

  float standardError(std::uint32_t i, std::uint32_t n) {
    if (options_.smoothed || n <= firstChunk()) return standardErrorOf(variance_[i], tallies_[i].kept, n);
    const std::uint32_t column = rays_.columnOf(i);
    for (std::size_t s = 0; s < n; ++s)
      column_[s] = values_[s * kColumns + i], codes_[s] = samples_.code[s * kColumns + column];
    return netStandardError(std::span(column_).first(n), std::span(codes_).first(n), scratch_);
  }

  /// Any-hit rays do not tell back faces. Where one of the few that do met any, blocked rays of the texels of
  /// which enough are blocked (at most so many can have met a back face) are traced again, now to their first
  /// hits.
  void findBuried(std::uint32_t group) {
    const auto met = [](const Tally& tally) { return tally.back > 0; };
    if (std::none_of(tallies_.begin(), tallies_.begin() + group, met)) return;
    std::vector<std::uint32_t>& suspects = active_;
    suspects.clear();
    for (std::uint32_t i = 0; i < group; ++i) {
      tallies_[i].back = 0;
      if (tallies_[i].mean() < 1.0f - kSuspectShare) suspects.push_back(i);
    }
    if (suspects.empty()) return;
    const std::uint32_t known = firstChunk(), count = std::min(kBuriedRays, known);
    rays_.select(suspects, 1);
    for (std::uint32_t j = 0; j < count; ++j) {
      const std::uint32_t s = spreadSample(j, count, known);
      rays_.packet(s, packet_);
      trace::HitPacket hits;
      forEachLane([&](std::uint32_t lane, std::uint32_t) {
        const float value = values_[std::size_t{s} * kColumns + rays_.texelOf(lane)];
        tallies_[rays_.texelOf(lane)].back_rays += value >= 0.0f;
        if (value != 0.0f) packet_.t_max[lane] = -1.0f;
        traced_ += value == 0.0f;
      });
      tracer_.intersectPacket(packet_, hits);
      forEachLane([&](std::uint32_t lane, std::uint32_t) {
        tallies_[rays_.texelOf(lane)].back += (hits.back_face >> lane) & 1u;
      });
    }
  }

  const trace::Tracer& tracer_;
  const atlas::Texels& texels_;
  const SampleTable& samples_;
  const OcclusionOptions& options_;
  const bool any_hit_;
  Vec3 inverse_mean_albedo_{0};
  GroupRays rays_;
  BundleGuess guess_;
  trace::RayPacket packet_;
  std::vector<float> values_;           // [max_samples][16]; negative: discarded
  std::vector<std::uint8_t> back_;      // of a chunk, as those below
  std::vector<Vec3> rgb_, directions_;  // empty unless needed
  std::vector<float> scratch_, column_;
  std::vector<std::uint16_t> codes_;
  std::vector<std::uint32_t> active_;
  std::array<Tally, kColumns> tallies_;
  std::array<float, kColumns> variance_{};
  std::uint64_t traced_ = 0;
};

void checkOptions(const OcclusionOptions& options) {
  RELUME_CHECK(std::has_single_bit(options.min_samples) && std::has_single_bit(options.max_samples));
  RELUME_CHECK_LE(options.min_samples, options.max_samples);
  RELUME_CHECK_LE(options.max_samples, kMaxSequence);
  RELUME_CHECK(options.weight.limit > 0.0f && options.weight.tau > 0.0f);
}

}  // namespace

struct OcclusionSolver::Impl {
  Impl(const trace::Tracer& tracer_, const atlas::Texels& texels_, const OcclusionOptions& options_)
      : tracer(tracer_),
        texels(texels_),
        options(options_),
        groups(texels_),
        samples(options_.target_error > 0.0f ? options_.min_samples : options_.max_samples,
                options_.max_samples, options_.seed,
                options_.smoothed ? BlockSamples::kShared : BlockSamples::kSeparate) {}

  const trace::Tracer& tracer;
  const atlas::Texels& texels;
  const OcclusionOptions options;
  const TexelGroups groups;
  const SampleTable samples;
  SolverPool<GroupSolver> pool;
};

OcclusionSolver::OcclusionSolver(const trace::Tracer& tracer, const atlas::Texels& texels,
                                 const OcclusionOptions& options) {
  checkOptions(options);
  impl_ = std::make_unique<Impl>(tracer, texels, options);
}
OcclusionSolver::~OcclusionSolver() = default;
OcclusionSolver::OcclusionSolver(OcclusionSolver&&) noexcept = default;

OcclusionResult OcclusionSolver::solve(Progress& progress, std::span<const std::uint32_t> which) {
  Impl& impl = *impl_;
  OcclusionResult result;
  const std::size_t count = which.empty() ? impl.texels.points.size() : which.size();
  result.value.resize(count);
  result.error.resize(count);
  result.back_share.resize(count);
  if (impl.options.bent_normal) result.bent.resize(count);
  const auto make = [&] {
    return std::make_unique<GroupSolver>(impl.tracer, impl.texels, impl.samples, impl.options);
  };
  result.rays =
      solveGroups(impl.groups, impl.texels, which, progress, impl.pool, make,
                  [&](GroupSolver& solver, auto group, auto slots) { solver.solve(group, slots, result); });
  return result;
}

OcclusionResult solveOcclusion(const trace::Tracer& tracer, const atlas::Texels& texels,
                               const OcclusionOptions& options, Progress& progress,
                               std::span<const std::uint32_t> which) {
  return OcclusionSolver(tracer, texels, options).solve(progress, which);
}

Albedo meanAlbedo(const atlas::Texels& texels) {
  glm::dvec3 sum(0);
  double area = 0;
  for (const atlas::SurfacePoint& point : texels.points) {
    sum += static_cast<double>(point.area) * glm::dvec3(point.albedo.rgb);
    area += point.area;
  }
  return area > 0 ? Albedo(Vec3(sum / area)) : Albedo();
}

}  // namespace relume::transport
