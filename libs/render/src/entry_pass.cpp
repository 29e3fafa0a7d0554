// SPDX-License-Identifier: MIT
#include "entry_pass.h"

#include <algorithm>

namespace relume::render {
namespace {

constexpr std::uint32_t kGroup = 64;  // local_size_x of the shaders

std::vector<Vec4> padded(std::span<const Vec3> a, std::span<const Vec3> b) {
  std::vector<Vec4> out;
  out.reserve(a.size() + b.size());
  for (const Vec3& v : a) out.emplace_back(v, 0.0f);
  for (const Vec3& v : b) out.emplace_back(v, 0.0f);
  return out;
}

/// By entry: the first point of its patch, its first mix, and how far apart its mixes are.
std::vector<glm::uvec4> mixPlaces(const asset::Entries& entries) {
  std::vector<glm::uvec4> places;
  for (std::uint32_t p = 0; p < entries.patches(); ++p) {
    const std::uint32_t begin = entries.first[p], end = entries.first[p + 1];
    for (std::uint32_t e = begin; e < end; ++e)
      places.emplace_back(p * entries.samples, begin * entries.samples + (e - begin), end - begin, 0);
  }
  return places;
}

}  // namespace

EntryPass::EntryPass(const asset::Entries& entries, std::span<const Point> points,
                     std::span<const Normal> normals, std::span<const std::uint32_t> columns)
    : entries_(entries.size()),
      samples_(entries.samples),
      patch_points_(entries.position.size()),
      points_(patch_points_ + points.size()),
      groups_(entries.size() + points.size()),
      received_program_(Program::compute("relight_received.comp.glsl")),
      factors_program_(Program::compute("relight_factors.comp.glsl")),
      sums_program_(Program::compute("relight_sums.comp.glsl")),
      positions_(padded(entries.position, points)),
      normals_(padded(entries.normal, normals)),
      mix_of_entry_(mixPlaces(entries)),
      mix_(entries.mix),
      columns_(columns.size_bytes(), columns.data()),
      received_(points_ * sizeof(float)),
      irradiance_(groups_ * sizeof(Vec4)) {
  irradiance_.clear();
}

void EntryPass::reserve(std::size_t lights) {
  if (lights <= reserved_) return;
  reserved_ = std::max(lights, 2 * reserved_);
  factors_ = Buffer(reserved_ * groups_ * sizeof(float));
}

void EntryPass::renew(std::size_t index, bool shadows) {
  positions_.bindStorage(2);
  normals_.bindStorage(3);
  received_.bindStorage(4);
  received_program_.set("u_light", static_cast<std::uint32_t>(index));
  received_program_.set("u_points", static_cast<std::uint32_t>(points_));
  received_program_.set("u_shadows", shadows ? 1u : 0u);
  received_program_.dispatch(points_, kGroup);

  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  received_.bindStorage(2);
  mix_of_entry_.bindStorage(3);
  factors_.bindStorage(4);
  mix_.bindStorage(5);
  factors_program_.set("u_light", static_cast<std::uint32_t>(index));
  factors_program_.set("u_entries", static_cast<std::uint32_t>(entries_));
  factors_program_.set("u_samples", static_cast<std::uint32_t>(samples_));
  factors_program_.set("u_groups", static_cast<std::uint32_t>(groups_));
  factors_program_.set("u_first_single", static_cast<std::uint32_t>(patch_points_));
  factors_program_.dispatch(groups_, kGroup);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);  // the next light's are received in the same place
}

void EntryPass::sum(std::size_t lights, const Buffer& x) {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  factors_.bindStorage(2);
  columns_.bindStorage(3);
  x.bindStorage(4);
  irradiance_.bindStorage(5);
  sums_program_.set("u_lights", static_cast<std::uint32_t>(lights));
  sums_program_.set("u_groups", static_cast<std::uint32_t>(groups_));
  sums_program_.set("u_entries", static_cast<std::uint32_t>(entries_));
  sums_program_.dispatch(groups_, kGroup);
}

std::vector<Irradiance> EntryPass::readEntries() const {
  std::vector<Vec4> raw(entries_);
  irradiance_.read(0, raw.size() * sizeof(Vec4), raw.data());
  std::vector<Irradiance> out;
  out.reserve(raw.size());
  for (const Vec4& v : raw) out.emplace_back(Vec3(v));
  return out;
}

}  // namespace relume::render
