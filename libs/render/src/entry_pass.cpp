// SPDX-License-Identifier: MIT
#include "entry_pass.h"

#include <algorithm>

namespace relume::render {
namespace {

constexpr std::uint32_t kGroup = 64;  // local_size_x of both shaders

std::vector<Vec4> padded(std::span<const Vec3> a, std::span<const Vec3> b) {
  std::vector<Vec4> out;
  out.reserve(a.size() + b.size());
  for (const Vec3& v : a) out.emplace_back(v, 0.0f);
  for (const Vec3& v : b) out.emplace_back(v, 0.0f);
  return out;
}

}  // namespace

EntryPass::EntryPass(const asset::Entries& entries, std::span<const Point> points,
                     std::span<const Normal> normals, std::span<const ColumnPlace> columns)
    : entries_(entries.size()),
      samples_(entries.samples),
      groups_(entries.size() + points.size()),
      factors_program_(Program::compute("relight_factors.comp.glsl")),
      sums_program_(Program::compute("relight_sums.comp.glsl")),
      points_(padded(entries.position, points)),
      normals_(padded(entries.normal, normals)),
      columns_(columns.size_bytes(), columns.data()),
      irradiance_(groups_ * sizeof(Vec4)) {
  irradiance_.clear();
}

void EntryPass::reserve(std::size_t lights) {
  if (lights <= reserved_) return;
  reserved_ = std::max(lights, 2 * reserved_);
  factors_ = Buffer(reserved_ * groups_ * sizeof(float));
}

void EntryPass::renew(std::size_t index, bool shadows) {
  points_.bindStorage(2);
  normals_.bindStorage(3);
  factors_.bindStorage(4);
  factors_program_.set("u_light", static_cast<std::uint32_t>(index));
  factors_program_.set("u_entries", static_cast<std::uint32_t>(entries_));
  factors_program_.set("u_samples", static_cast<std::uint32_t>(samples_));
  factors_program_.set("u_groups", static_cast<std::uint32_t>(groups_));
  factors_program_.set("u_shadows", shadows ? 1u : 0u);
  factors_program_.dispatch(groups_, kGroup);
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
