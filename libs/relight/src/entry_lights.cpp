// SPDX-License-Identifier: MIT
// I_e ([SzirmayKalos] section 10), from fixed points of the entry's patch where the paper has one point. Sums
// over lights are formed anew, in their order, so nothing depends on lights of calls before.
#include "entry_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "block_product.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

constexpr std::size_t kEntriesAtOnce = 64, kPatchesAtOnce = 16, kPointsAtOnce = 1024;

bool sameButStrength(const Light& a, const Light& b) {
  return a.kind == b.kind && a.range == b.range && a.inner_cone == b.inner_cone &&
         a.outer_cone == b.outer_cone && a.position == b.position && a.direction == b.direction &&
         a.area == b.area && a.two_sided == b.two_sided && a.triangles == b.triangles &&
         a.angular_radius == b.angular_radius;
}

bool soundAmount(float v) { return v >= 0 && v < kInfinity; }

// Null where a light can be evaluated, else what is wrong with it.
const char* problemOf(const Light& light) {
  const Vec3 strength = light.colour * light.intensity;
  for (int c = 0; c < 3; ++c)
    if (!soundAmount(light.colour[c]) || !soundAmount(strength[c]))
      return "has a colour or an intensity that is negative or not finite";
  if (!soundAmount(light.intensity)) return "has an intensity that is negative or not finite";
  if (light.kind != Light::Kind::kDirectional && !isFinite(light.position))
    return "has a position that is not finite";
  if (light.kind != Light::Kind::kPoint && !(std::abs(glm::length(light.direction) - 1) < 1e-3f))
    return "has a direction that is not of unit length";
  if (!(light.range > 0)) return "has a range that is not above 0";
  if (light.kind == Light::Kind::kArea && !soundAmount(light.area))
    return "has an area that is negative or not finite";
  if (light.kind == Light::Kind::kSpot &&
      !(light.inner_cone >= 0 && light.inner_cone <= light.outer_cone && light.outer_cone <= kPi))
    return "has a cone that makes no sense";
  return nullptr;
}

void checkLights(const LightSet& lights) {
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (const char* problem = problemOf(lights[i]))
      throw Error(ErrorCode::kInvalidValue, fmt::format("light {} \"{}\"", i, lights[i].name), problem);
}

}  // namespace

EntryLights::EntryLights(const asset::Entries& entries, std::span<const Point> points,
                         std::span<const Normal> normals)
    : samples_(entries.samples),
      first_(entries.first),
      mix_(entries.mix),
      visibility_(entries.position.size() + points.size()),
      result_(entries.size() + points.size()) {
  for (std::size_t c = 0; c < 3; ++c) {
    const int axis = static_cast<int>(c);
    for (const Point& p : entries.position) position_[c].push_back(p[axis]);
    for (const Point& p : points) position_[c].push_back(p[axis]);
    for (const Normal& n : entries.normal) normal_[c].push_back(n[axis]);
    for (const Normal& n : normals) normal_[c].push_back(n[axis]);
  }
  sum_.resize(result_.size());
}

void EntryLights::forget() {
  for (Kept& kept : kept_) kept.valid = false;
}

void EntryLights::renew(Kept& kept, const Light& light, std::size_t index,
                        const VisibilitySource& visibility) {
  kept.valid = false;
  if (visibility) {
    visibility(index, visibility_);
    for (std::size_t i = 0; i < visibility_.size(); ++i)
      if (!(visibility_[i] >= 0 && visibility_[i] <= 1))
        throw Error(ErrorCode::kInvalidValue, fmt::format("light {} \"{}\"", index, light.name),
                    fmt::format("its visibility at point {} is {}", i, visibility_[i]),
                    "answer with numbers from 0 to 1");
  }
  kept.light = light;
  kept.factor.resize(result_.size());
  struct Job {
    const EntryLights& self;
    const Received light;
    float* factor;
  } job{*this, {PreparedLight(light), visibility ? visibility_.data() : nullptr}, kept.factor.data()};
  parallelFor(first_.size() - 1, kPatchesAtOnce, [&job](std::size_t begin, std::size_t end) {
    job.self.mixPatches(job.light, job.factor, begin, end);
  });
  parallelFor(result_.size() - first_.back(), kPointsAtOnce, [&job](std::size_t begin, std::size_t end) {
    job.self.copyPoints(job.light, job.factor, begin, end);
  });
  kept.with_visibility = static_cast<bool>(visibility);
  kept.valid = true;
}

/// Of points [first, last), or as many as go at once; how many.
std::size_t EntryLights::receive(const Received& light, std::size_t first, std::size_t last,
                                 float* received) const {
  TexelBlock block;
  for (std::size_t c = 0; c < 3; ++c)
    block.position[c] = position_[c].data() + first, block.normal[c] = normal_[c].data() + first;
  block.visibility = light.visibility ? light.visibility + first : nullptr;
  block.count = std::min(kBlock, last - first);
  receivedFactors(light.prepared, block, received);
  return block.count;
}

/// Entries of patches [begin, end).
void EntryLights::mixPatches(const Received& light, float* factor, std::size_t begin, std::size_t end) const {
  std::fill(factor + first_[begin], factor + first_[end], 0.0f);
  float received[kBlock];
  std::size_t patch = begin, sample = 0;
  const float* mix = mix_.data() + std::size_t{samples_} * first_[begin];
  for (std::size_t at = begin * samples_; at < end * samples_;) {
    const std::size_t count = receive(light, at, end * samples_, received);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t modes = first_[patch + 1] - first_[patch];
      float* of_patch = factor + first_[patch];
      for (std::size_t m = 0; m < modes; ++m) of_patch[m] += mix[m] * received[i];
      mix += modes;
      if (++sample == samples_) sample = 0, ++patch;
    }
    at += count;
  }
}

/// Single points [begin, end), which come after the entries' points.
void EntryLights::copyPoints(const Received& light, float* factor, std::size_t begin, std::size_t end) const {
  const std::size_t points = (first_.size() - 1) * samples_;
  for (std::size_t at = begin; at < end;)
    at += receive(light, points + at, points + end, factor + first_.back() + at);
}

void EntryLights::addUp(const LightSet& lights) {
  strength_.clear();
  for (const Light& light : lights) strength_.push_back(light.colour * light.intensity);
  struct Job {
    EntryLights& self;
  } job{*this};
  parallelFor(sum_.size(), kEntriesAtOnce, [&job](std::size_t begin, std::size_t end) {
    Irradiance* sum = job.self.sum_.data();
    std::fill(sum + begin, sum + end, Irradiance());
    for (std::size_t l = 0; l < job.self.strength_.size(); ++l) {
      const Vec3 strength = job.self.strength_[l];
      const float* factor = job.self.kept_[l].factor.data();
      for (std::size_t e = begin; e < end; ++e) sum[e].rgb += strength * factor[e];
    }
  });
  for (std::size_t e = 0; e < sum_.size(); ++e)
    for (int c = 0; c < 3; ++c)
      if (!(std::abs(sum_[e].rgb[c]) <= BlockProduct::kLargest))
        throw Error(ErrorCode::kInvalidValue, fmt::format("the irradiance of entry {}", e),
                    fmt::format("is {} W/m^2", sum_[e].rgb[c]), "take lights that are less bright");
  result_.swap(sum_);
}

std::span<const Irradiance> EntryLights::evaluate(const LightSet& lights,
                                                  const VisibilitySource& visibility) {
  checkLights(lights);
  if (kept_.size() < lights.size()) kept_.resize(lights.size());
  for (std::size_t i = lights.size(); i < kept_.size(); ++i) kept_[i].valid = false;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    Kept& kept = kept_[i];
    if (!kept.valid || kept.with_visibility != static_cast<bool>(visibility) ||
        !sameButStrength(kept.light, lights[i]))
      renew(kept, lights[i], i, visibility);
  }
  addUp(lights);
  return result_;
}

}  // namespace relume::relight
