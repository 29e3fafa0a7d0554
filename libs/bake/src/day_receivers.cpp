// SPDX-License-Identifier: MIT
#include "day_receivers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "relume/core/quantity.h"

namespace relume::bake {
namespace {

using Kind = asset::DayFrames::Receivers;

/// Page and place in texels of a hit, by the charts' own coordinates.
class AtlasPlaces {
 public:
  AtlasPlaces(const scene::Scene& scene, const atlas::Atlas& atlas) {
    use_.assign(scene.instances.size(), nullptr);
    for (const atlas::InstanceUv& uv : atlas.instances) use_[uv.instance] = &uv;
  }
  struct Place {
    bool known = false;
    std::uint32_t page = 0;
    Vec2 texel{0.0f};
  };
  Place of(const scene::Hit& hit) const {
    const atlas::InstanceUv* uv = use_[hit.instance];
    if (!uv || hit.triangle >= uv->triangles.size()) return {};
    const UVec3 t = uv->triangles[hit.triangle];
    return {true, uv->page,
            (1 - hit.b1 - hit.b2) * uv->uv[t.x] + hit.b1 * uv->uv[t.y] + hit.b2 * uv->uv[t.z]};
  }

 private:
  std::vector<const atlas::InstanceUv*> use_;
};

}  // namespace

DayReceivers::DayReceivers(const LayerContext& context, const asset::DayFrames& shape,
                           std::span<const std::uint8_t> valid) {
  if (shape.receivers != Kind::kAtlas) {
    takePixels(context, shape, valid);
    return;
  }
  const atlas::Texels& texels = context.texels;
  width_ = texels.width, height_ = texels.height * static_cast<int>(texels.pages);
  for (std::size_t i = 0; i < texels.points.size(); ++i) {
    pixel_.push_back(texels.points[i].texel);
    albedo_.push_back(valid[i] ? texels.points[i].albedo.rgb : Vec3(0.0f));
  }
}

void DayReceivers::takePixels(const LayerContext& context, const asset::DayFrames& shape,
                              std::span<const std::uint8_t> valid) {
  const atlas::Texels& texels = context.texels;
  const bool cube = shape.receivers == Kind::kCube;
  width_ = static_cast<int>(shape.width), height_ = static_cast<int>(cube ? 6 * shape.width : shape.height);
  const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  pixel_.resize(count), albedo_.assign(count, Vec3(0.0f)), taps_.resize(count);
  std::iota(pixel_.begin(), pixel_.end(), 0u);

  std::vector<std::uint32_t> point_of(
      static_cast<std::size_t>(texels.width) * static_cast<std::size_t>(texels.height) * texels.pages,
      scene::kNone);
  for (std::uint32_t i = 0; i < texels.points.size(); ++i) point_of[texels.points[i].texel] = i;
  const scene::Scene& scene = context.tracer.scene();
  const AtlasPlaces places(scene, context.atlas);
  const Point eye(shape.camera.world_from_camera[3]);
  parallelFor(count, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Direction d = asset::directionOf(shape, i);
      const trace::RayHit hit = context.tracer.intersect({eye, d, kInfinity}, static_cast<std::uint32_t>(i));
      if (!hit) continue;
      const AtlasPlaces::Place place = places.of(hit.where);
      if (!place.known) continue;
      const Vec2 corner = glm::floor(place.texel - 0.5f), share = place.texel - 0.5f - corner;
      Taps& taps = taps_[i];
      float sum = 0;
      for (std::uint32_t k = 0; k < 4; ++k) {
        const float dx = static_cast<float>(k % 2), dy = static_cast<float>(k / 2);
        const int x = std::clamp(static_cast<int>(corner.x + dx), 0, texels.width - 1),
                  y = std::clamp(static_cast<int>(corner.y + dy), 0, texels.height - 1);
        const std::uint32_t point =
            point_of[(std::size_t{place.page} * static_cast<std::size_t>(texels.height) +
                      static_cast<std::size_t>(y)) *
                         static_cast<std::size_t>(texels.width) +
                     static_cast<std::size_t>(x)];
        if (point == scene::kNone || !valid[point]) continue;
        const float weight = (dx > 0 ? share.x : 1 - share.x) * (dy > 0 ? share.y : 1 - share.y);
        taps.point[k] = point, taps.weight[k] = weight, sum += weight;
      }
      if (!(sum > 0)) continue;
      for (float& w : taps.weight) w /= sum;
      albedo_[i] = scene::surfaceAt(scene, hit.where).albedo().rgb;
    }
  });
}

void DayReceivers::gather(std::span<const Vec3> texels, std::span<Vec3> out) const {
  RELUME_CHECK_EQ(out.size(), size());
  if (taps_.empty()) {
    std::copy(texels.begin(), texels.end(), out.begin());
    return;
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = Vec3(0.0f);
    for (std::size_t k = 0; k < 4; ++k) out[i] += taps_[i].weight[k] * texels[taps_[i].point[k]];
  }
}

image::Image DayReceivers::picture(std::span<const Vec3> irradiance, float exposure) const {
  image::Image picture(width_, height_, 3);
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    const Vec3 sent = (exposure * kInvPi) * albedo_[i] * glm::max(irradiance[i], Vec3(0.0f));
    for (std::size_t c = 0; c < 3; ++c)
      picture.data[std::size_t{pixel_[i]} * 3 + c] = sent[static_cast<int>(c)];
  }
  return picture;
}

float DayReceivers::typical(std::span<const Vec3> irradiance) const {
  double sum = 0, mean = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < irradiance.size(); ++i)
    mean += static_cast<double>(kInvPi * luminance(albedo_[i] * irradiance[i]));
  mean /= static_cast<double>(std::max<std::size_t>(irradiance.size(), 1));
  if (!(mean > 0)) return 0;
  constexpr double kBlack = 1e-3;  // of the mean
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    const auto sent = static_cast<double>(kInvPi * luminance(albedo_[i] * irradiance[i]));
    if (sent > kBlack * mean) sum += std::log(sent), ++count;
  }
  return count > 0 ? static_cast<float>(std::exp(sum / static_cast<double>(count))) : 0.0f;
}

}  // namespace relume::bake
