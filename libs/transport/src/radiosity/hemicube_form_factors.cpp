// SPDX-License-Identifier: MIT
// The item buffer of a hemicube by rays: a packet for each block of 4 x 4 pixels.
#include "group_rays.h"
#include "radiosity/form_factors.h"
#include "radiosity/hemicube.h"
#include "radiosity/row_builder.h"
#include "ray_frame.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

constexpr std::size_t kGrain = 16;  // patches
constexpr std::uint32_t kTurnStream = 21, kAlphaStream = 22;

void solve(const FormFactorScene& scene, std::span<const HemicubePixel> pixels, std::uint64_t seed,
           std::uint32_t patch_index, RowBuilder& row) {
  const Patch& patch = scene.patches.all[patch_index];
  const RayFrame source(patch.normal, patch.geometric_normal);
  // Pixels in line with walls alias; turned by chance they only make noise.
  const Frame frame = Turn(streamOf(seed, patch_index, kTurnStream))(source.shading);
  const Point origin = trace::offsetOrigin(patch.centre, patch.geometric_normal);
  const std::uint32_t alpha = streamOf(seed, patch_index, kAlphaStream);
  trace::RayPacket packet;
  trace::HitPacket hits;
  for (std::size_t first = 0; first < pixels.size(); first += trace::RayPacket::kSize) {
    for (std::size_t i = 0; i < trace::RayPacket::kSize; ++i) {
      const Direction d = frame.toWorld(pixels[first + i].direction);
      packet.origin_x[i] = origin.x, packet.origin_y[i] = origin.y, packet.origin_z[i] = origin.z;
      packet.direction_x[i] = d.x, packet.direction_y[i] = d.y, packet.direction_z[i] = d.z;
      packet.t_max[i] = RayFrame::above(d, source.geometric) ? kInfinity : -1.0f;
      packet.alpha_seed[i] = alpha + static_cast<std::uint32_t>(first + i);
    }
    scene.tracer.intersectPacket(packet, hits);
    for (std::size_t i = 0; i < trace::RayPacket::kSize; ++i) {
      if (packet.t_max[i] < 0.0f || ((hits.hit >> i) & 1u) == 0 || ((hits.behind >> i) & 1u) != 0) continue;
      const std::uint32_t point = scene.lookup.point(hits.where(i));
      if (point != scene::kNone)
        row.add(scene.patches.patch_of[point], static_cast<double>(pixels[first + i].form_factor));
    }
  }
}

}  // namespace

FormFactors hemicubeFormFactors(const FormFactorScene& scene, std::uint32_t resolution, std::uint64_t seed,
                                Progress& progress) {
  const Stage stage(progress, "form factors", scene.patches.size());
  const std::vector<HemicubePixel> pixels = hemicube(resolution);
  FormFactors result(scene.patches.size());
  parallelFor(
      scene.patches.size(), kGrain,
      [&](std::size_t begin, std::size_t end) {
        RowBuilder row(scene.patches.size());
        for (std::size_t i = begin; i < end; ++i) {
          solve(scene, pixels, seed, static_cast<std::uint32_t>(i), row);
          result.set(i, row.take(), static_cast<std::uint32_t>(pixels.size()));
        }
      },
      &progress);
  return result;
}

}  // namespace relume::transport
