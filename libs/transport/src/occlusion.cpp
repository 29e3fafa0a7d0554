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

#include "error_estimate.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "texel_groups.h"
#include "texel_rays.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kLanes = trace::RayPacket::kSize;
constexpr std::uint32_t kGroupRays = kGroupTexels * kMaxBatch;
// Of a texel, to learn how much of it lies inside something: first few rays, if one meets a back face more.
constexpr std::uint32_t kSuspectRays = 8, kBuriedRays = 32;
constexpr float kSuspectShare = 0.25f;  // of blocked rays, below which it is not asked

/// What is known of one texel after some rounds.
struct Tally {
  std::vector<float> value;         // of each sample; negative: discarded
  std::vector<std::uint16_t> code;  // of each sample
  double sum = 0;                   // of the kept values
  glm::dvec3 rgb{0}, bent{0};
  std::uint32_t kept = 0, back = 0;
  float mean() const { return kept == 0 ? 1.0f : static_cast<float>(sum / kept); }
};

/// Traces one group of texels after the other; reuses its memory.
class GroupSolver {
 public:
  GroupSolver(const trace::Tracer& tracer, const atlas::Texels& texels, const OcclusionOptions& options)
      : tracer_(tracer),
        texels_(texels),
        options_(options),
        any_hit_(options.kind == OcclusionKind::kScalar &&
                 options.weight.shape == DistanceWeight::Shape::kStep),
        packets_(kGroupRays / kLanes),
        values_(kGroupRays),
        back_(kGroupRays),
        scratch_(options.max_samples) {
    if (options.kind == OcclusionKind::kSpectral) rgb_.resize(kGroupRays);
    for (int c = 0; c < 3; ++c) {
      const float a = options.mean_albedo.rgb[c];
      inverse_mean_albedo_[c] = a > 0.0f ? 1.0f / a : 0.0f;
    }
    const std::size_t samples = std::max(options.max_samples, kBuriedRays);
    for (Tally& tally : tallies_) tally.value.resize(samples), tally.code.resize(samples);
  }

  std::uint64_t rays() const { return rays_; }

  /// Results of group[i] go to slots[i], unless it is scene::kNone.
  void solve(std::span<const std::uint32_t> group, std::span<const std::uint32_t> slots,
             OcclusionResult& result) {
    sources_.clear();
    for (const std::uint32_t i : group) {
      sources_.emplace_back(tracer_.scene(), texels_, texels_.points[i], options_.seed);
    }
    std::array<float, kGroupTexels> error{};
    const bool adaptive = options_.target_error > 0.0f;
    for (std::uint32_t i = 0; i < group.size(); ++i) {
      Tally& tally = tallies_[i];
      tally.sum = 0, tally.rgb = tally.bent = glm::dvec3(0), tally.kept = tally.back = 0;
    }
    std::vector<std::uint32_t>& active = active_;
    active.resize(group.size());
    for (std::uint32_t i = 0; i < group.size(); ++i) active[i] = i;
    std::uint32_t done = 0;
    while (!active.empty()) {
      const std::uint32_t round = done > 0 ? done : adaptive ? options_.min_samples : options_.max_samples;
      const std::uint32_t batch = std::min(round, kMaxBatch);
      for (std::uint32_t first = done; first < done + round; first += batch) {
        fill(active, first, batch);
        any_hit_ ? traceAnyHit() : traceFirstHit();
        for (std::uint32_t k = 0; k < active.size(); ++k) gather(tallies_[active[k]], k, first, batch);
      }
      done += round;
      for (const std::uint32_t i : active) error[i] = standardError(tallies_[i], done);
      std::erase_if(active, [&](std::uint32_t i) {
        return done == options_.max_samples || (adaptive && error[i] < options_.target_error);
      });
    }
    const auto size = static_cast<std::uint32_t>(group.size());
    for (std::uint32_t i = 0; i < size; ++i) back_rays_[i] = tallies_[i].kept;
    if (any_hit_) findBuried(size);

    for (std::uint32_t i = 0; i < group.size(); ++i) {
      const std::uint32_t slot = slots[i];
      if (slot == scene::kNone) continue;
      const Tally& tally = tallies_[i];
      const bool spectral = options_.kind == OcclusionKind::kSpectral;
      result.value[slot] =
          spectral && tally.kept > 0 ? Vec3(tally.rgb / static_cast<double>(tally.kept)) : Vec3(tally.mean());
      result.error[slot] = error[i];
      result.back_share[slot] =
          back_rays_[i] == 0 ? 0.0f : static_cast<float>(tally.back) / static_cast<float>(back_rays_[i]);
      if (options_.bent_normal) {
        const double length = glm::length(tally.bent);
        result.bent[slot] = length > 1e-6 * tally.kept ? Direction(tally.bent / length)
                                                       : texels_.points[group[i]].shading_normal;
      }
    }
  }

 private:
  /// The next rays of `active` texels, the k-th ray of each side by side.
  void fill(std::span<const std::uint32_t> active, std::uint32_t first, std::uint32_t count) {
    const auto stride = static_cast<std::uint32_t>(active.size());
    used_ = (count * stride + kLanes - 1) / kLanes;
    for (std::uint32_t k = 0; k < stride; ++k) {
      sources_[active[k]].generate(first, count, options_.weight.limit, batch_);
      Tally& tally = tallies_[active[k]];
      std::copy_n(batch_.code.begin(), count, tally.code.begin() + first);
      for (std::uint32_t s = 0; s < count; ++s) {
        const std::uint32_t ray = s * stride + k;
        trace::RayPacket& packet = packets_[ray / kLanes];
        const std::uint32_t lane = ray % kLanes;
        packet.origin_x[lane] = batch_.origin_x[s], packet.origin_y[lane] = batch_.origin_y[s];
        packet.origin_z[lane] = batch_.origin_z[s], packet.direction_x[lane] = batch_.direction_x[s];
        packet.direction_y[lane] = batch_.direction_y[s], packet.direction_z[lane] = batch_.direction_z[s];
        packet.t_max[lane] = batch_.t_max[s], packet.alpha_seed[lane] = batch_.alpha_seed[s];
      }
    }
    stride_ = stride;
    for (std::uint32_t ray = count * stride; ray < used_ * kLanes; ++ray)
      packets_[ray / kLanes].t_max[ray % kLanes] = -1.0f;
  }

  void traceAnyHit() {
    for (std::uint32_t p = 0; p < used_; ++p) {
      const trace::RayPacket& packet = packets_[p];
      const std::uint32_t hit = tracer_.occludedPacket(packet);
      float* values = values_.data() + static_cast<std::size_t>(p) * kLanes;
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        values[lane] = packet.t_max[lane] < 0.0f ? -1.0f : ((hit >> lane) & 1u) != 0 ? 0.0f : 1.0f;
      }
    }
    std::fill_n(back_.begin(), used_ * kLanes, std::uint8_t{0});
  }

  void traceFirstHit() {
    trace::HitPacket hits;
    for (std::uint32_t p = 0; p < used_; ++p) {
      const trace::RayPacket& packet = packets_[p];
      tracer_.intersectPacket(packet, hits);
      const std::size_t base = static_cast<std::size_t>(p) * kLanes;
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const bool hit = ((hits.hit >> lane) & 1u) != 0, back = ((hits.back_face >> lane) & 1u) != 0;
        back_[base + lane] = back;
        const float rho = hit ? options_.weight(hits.t[lane]) : 1.0f;
        values_[base + lane] = packet.t_max[lane] < 0.0f ? -1.0f : rho;
        if (options_.kind != OcclusionKind::kSpectral) continue;
        const bool closed = hit && hits.t[lane] < options_.weight.limit;
        const Vec3 reflectance =
            !closed ? Vec3(1.0f)
            : back  ? Vec3(0.0f)
                    : scene::surfaceAt(tracer_.scene(), hits.where(lane)).albedo().rgb * inverse_mean_albedo_;
        rgb_[base + lane] = reflectance * rho;
        if (values_[base + lane] >= 0.0f) {
          const Vec3 w = rgb_[base + lane];
          values_[base + lane] = (w.x + w.y + w.z) * (1.0f / 3.0f);
        }
      }
    }
  }

  /// Adds what the k-th active texel's rays have found.
  void gather(Tally& tally, std::uint32_t k, std::uint32_t first, std::uint32_t count) {
    float sum = 0.0f;
    std::uint32_t kept = 0, back = 0;
    for (std::uint32_t s = 0; s < count; ++s) {
      const std::size_t ray = static_cast<std::size_t>(s) * stride_ + k;
      const float value = values_[ray];
      tally.value[first + s] = value;
      sum += std::max(value, 0.0f);
      kept += value >= 0.0f;
      back += back_[ray];
    }
    tally.sum += sum, tally.kept += kept, tally.back += back;
    rays_ += kept;
    if (!rgb_.empty() || options_.bent_normal) gatherVectors(tally, k, count);
  }

  void gatherVectors(Tally& tally, std::uint32_t k, std::uint32_t count) {
    Vec3 rgb(0), bent(0);
    for (std::uint32_t s = 0; s < count; ++s) {
      const std::size_t ray = static_cast<std::size_t>(s) * stride_ + k;
      const float value = values_[ray];
      if (value < 0.0f) continue;
      if (!rgb_.empty()) rgb += rgb_[ray];
      const trace::RayPacket& packet = packets_[ray / kLanes];
      const std::size_t lane = ray % kLanes;
      bent += value * Vec3(packet.direction_x[lane], packet.direction_y[lane], packet.direction_z[lane]);
    }
    tally.rgb += glm::dvec3(rgb), tally.bent += glm::dvec3(bent);
  }

  float standardError(const Tally& tally, std::uint32_t n) {
    return netStandardError(std::span(tally.value).first(n), std::span(tally.code).first(n), scratch_);
  }

  /// Back faces after any-hit rays, which do not tell them: first hits of a few rays of those texels where
  /// enough rays are blocked (at most so many can have met a back face).
  void findBuried(std::uint32_t group) {
    std::vector<std::uint32_t>& suspects = active_;
    suspects.clear();
    for (std::uint32_t i = 0; i < group; ++i) {
      if (tallies_[i].mean() < 1.0f - kSuspectShare) suspects.push_back(i);
    }
    for (const std::uint32_t count : {kSuspectRays, kBuriedRays}) {
      if (suspects.empty()) return;
      fill(suspects, 0, count);
      traceFirstHit();
      for (std::uint32_t k = 0; k < suspects.size(); ++k) {
        std::uint32_t back = 0, kept = 0;
        for (std::uint32_t s = 0; s < count; ++s) {
          const std::size_t ray = static_cast<std::size_t>(s) * stride_ + k;
          back += back_[ray], kept += values_[ray] >= 0.0f;
        }
        tallies_[suspects[k]].back = back, back_rays_[suspects[k]] = kept;
        rays_ += kept;
      }
      std::erase_if(suspects, [&](std::uint32_t i) { return tallies_[i].back == 0; });
    }
  }

  const trace::Tracer& tracer_;
  const atlas::Texels& texels_;
  const OcclusionOptions& options_;
  const bool any_hit_;
  Vec3 inverse_mean_albedo_{0};
  std::vector<trace::RayPacket> packets_;
  std::vector<float> values_;
  std::vector<std::uint8_t> back_;
  std::vector<Vec3> rgb_;
  std::vector<float> scratch_;
  std::vector<TexelRays> sources_;
  std::vector<std::uint32_t> active_;
  std::array<Tally, kGroupTexels> tallies_;
  std::array<std::uint32_t, kGroupTexels> back_rays_{};
  RayBatch batch_;
  std::uint32_t used_ = 0, stride_ = 0;
  std::uint64_t rays_ = 0;
};

void checkOptions(const OcclusionOptions& options) {
  RELUME_CHECK(std::has_single_bit(options.min_samples) && std::has_single_bit(options.max_samples));
  RELUME_CHECK_LE(options.min_samples, options.max_samples);
  RELUME_CHECK_LE(options.max_samples, kMaxSequence);
  RELUME_CHECK(options.weight.limit > 0.0f && options.weight.tau > 0.0f);
}

}  // namespace

OcclusionResult solveOcclusion(const trace::Tracer& tracer, const atlas::Texels& texels,
                               const OcclusionOptions& options, Progress& progress,
                               std::span<const std::uint32_t> which) {
  checkOptions(options);
  const std::size_t points = texels.points.size(), count = which.empty() ? points : which.size();
  OcclusionResult result;
  result.value.resize(count);
  result.error.resize(count);
  result.back_share.resize(count);
  if (options.bent_normal) result.bent.resize(count);
  std::vector<std::uint32_t> slot_of;  // by point; only for a selection
  if (!which.empty()) {
    slot_of.assign(points, scene::kNone);
    for (std::size_t i = 0; i < which.size(); ++i) {
      RELUME_CHECK_LT(which[i], points);
      slot_of[which[i]] = static_cast<std::uint32_t>(i);
    }
  }

  const TexelGroups groups(texels);
  std::vector<std::uint64_t> rays(groups.tiles(), 0);
  parallelFor(groups.tiles(), 4, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<GroupSolver> solver;  // much of an atlas may be empty
    for (std::size_t tile = begin; tile < end; ++tile) {
      groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
        std::array<std::uint32_t, kGroupTexels> slots;
        std::transform(group.begin(), group.end(), slots.begin(),
                       [&](std::uint32_t i) { return slot_of.empty() ? i : slot_of[i]; });
        const auto used = std::span(slots).first(group.size());
        const auto skipped = std::count(used.begin(), used.end(), scene::kNone);
        if (skipped == std::ssize(used) || progress.cancelled()) return;
        const WorkItem item("texel", texels.points[group[0]].texel);
        if (!solver) solver = std::make_unique<GroupSolver>(tracer, texels, options);
        const std::uint64_t before = solver->rays();
        solver->solve(group, used, result);
        rays[tile] += solver->rays() - before;
        progress.advance(used.size() - static_cast<std::size_t>(skipped));
      });
    }
  });
  progress.throwIfCancelled();
  for (const std::uint64_t r : rays) result.rays += r;
  return result;
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
