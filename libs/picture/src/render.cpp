// SPDX-License-Identifier: MIT
// The picture: for each pixel the mean over samples of what its primary rays see, weighted by a tent of one
// pixel's radius. The tent is sampled, not splatted: Owen-scrambled Sobol points are warped to the tent's
// density, so pixels are independent of each other and of the order in which they are done. All pixels share
// the points, as in hardware multisampling: an edge gets even steps, where points of its own for each pixel
// would fray it. Lamps have points of their own for each pixel. Rays of 4 x 4 pixels go as one packet.
// Translucent surfaces are composited front to back over what the ray sees behind them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "layered_tracer.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"
#include "relume/picture/baked_values.h"
#include "relume/picture/picture.h"
#include "relume/picture/primary_rays.h"
#include "shader.h"

namespace relume::picture {
namespace {

constexpr int kBlock = 4;  // pixels, both ways: one packet
constexpr int kTile = 32;  // pixels, both ways: one work item
static_assert(kBlock * kBlock == static_cast<int>(trace::Tracer::kPacket));
constexpr std::uint32_t kPlaceStream = 0x9e3779b9u;
constexpr std::uint32_t kAlphaDimension = 0xa19ba;
// What a stack of translucent surfaces leaves of the light behind it is dropped below this share.
constexpr float kNegligible = 1.0f / 1024.0f;

/// u in [0, 1) to the tent density 1 - |x| on [-1, 1].
float toTent(float u) { return u < 0.5f ? std::sqrt(2.0f * u) - 1.0f : 1.0f - std::sqrt(2.0f - 2.0f * u); }

/// Places of a pixel's samples about its centre. Their mean is the centre, so that few samples do not shift
/// the picture and a single one is the centre.
std::vector<Vec2> tentOffsets(int samples) {
  std::vector<Vec2> offsets;
  Vec2 sum(0.0f);
  for (int s = 0; s < samples; ++s) {
    const Vec2 u = sobol2(static_cast<std::uint32_t>(s), kPlaceStream);
    offsets.emplace_back(toTent(u.x), toTent(u.y));
    sum += offsets.back();
  }
  for (Vec2& offset : offsets) offset -= sum / static_cast<float>(samples);
  return offsets;
}

class BlockRenderer {
 public:
  BlockRenderer(const LayeredTracer& tracer, const Shader& shader, const PrimaryRays& primary,
                std::span<const Vec2> offsets, const PictureOptions& options)
      : tracer_(tracer), shader_(shader), primary_(primary), offsets_(offsets), options_(options) {}

  void render(int x0, int y0, image::Image& picture) {
    std::array<Vec3, kPacket> sum{};
    std::array<std::uint32_t, kPacket> alpha_stream;
    for (std::size_t i = 0; i < kPacket; ++i) {
      pixel_[i] = static_cast<std::uint32_t>(yOf(y0, i)) * static_cast<std::uint32_t>(options_.width) +
                  static_cast<std::uint32_t>(xOf(x0, i));
      alpha_stream[i] = streamOf(0, pixel_[i], kAlphaDimension);
    }
    for (int s = 0; s < options_.samples; ++s) {
      const auto sample = static_cast<std::uint32_t>(s);
      const Vec2 offset = offsets_[sample];
      for (std::size_t i = 0; i < kPacket; ++i) {
        rays_[i] = primary_.at(Vec2(xOf(x0, i), yOf(y0, i)) + 0.5f + offset);
        if (!inside(xOf(x0, i), yOf(y0, i))) rays_[i].t_max = -1.0f;
        seeds_[i] = hashCombine(alpha_stream[i], sample);
      }
      tracer_.firstSolid(rays_, seeds_, hits_);
      shadeSolids(sample);
      for (std::size_t i = 0; i < kPacket; ++i)
        if (rays_[i].t_max >= 0) sum[i] += throughLayers(i, sample);
    }
    for (std::size_t i = 0; i < kPacket; ++i)
      if (inside(xOf(x0, i), yOf(y0, i)))
        picture.setRgb(xOf(x0, i), yOf(y0, i), sum[i] / static_cast<float>(options_.samples));
  }

 private:
  static constexpr std::size_t kPacket = trace::Tracer::kPacket;
  static int xOf(int x0, std::size_t i) { return x0 + static_cast<int>(i) % kBlock; }
  static int yOf(int y0, std::size_t i) { return y0 + static_cast<int>(i) / kBlock; }
  bool inside(int x, int y) const { return x < options_.width && y < options_.height; }

  void shadeSolids(std::uint32_t sample) {
    std::array<ShadingPoint, kPacket> points;
    std::array<std::size_t, kPacket> ray_of;
    std::array<Vec3, kPacket> colours;
    std::size_t count = 0;
    for (std::size_t i = 0; i < kPacket; ++i) {
      solid_[i] = options_.environment.dark() ? options_.background
                                              : options_.environment.from(rays_[i].direction).rgb;
      if (!hits_[i]) continue;
      points[count] = {hits_[i].where, -rays_[i].direction, pixel_[i], sample};
      ray_of[count++] = i;
    }
    shader_.shade(std::span(points).first(count), std::span(colours).first(count));
    for (std::size_t k = 0; k < count; ++k) solid_[ray_of[k]] = colours[k];
  }

  Vec3 throughLayers(std::size_t i, std::uint32_t sample) {
    layers_.clear();
    tracer_.translucent(rays_[i], hits_[i].t, layers_);
    if (layers_.empty()) return solid_[i];
    std::array<ShadingPoint, LayeredTracer::kMaxLayers> points;
    std::array<Vec3, LayeredTracer::kMaxLayers> colours;
    for (std::size_t k = 0; k < layers_.size(); ++k)
      points[k] = {layers_[k].where, -rays_[i].direction, pixel_[i], sample};
    shader_.shade(std::span(points).first(layers_.size()), std::span(colours).first(layers_.size()));
    Vec3 seen(0.0f);
    float passes = 1.0f;
    for (std::size_t k = 0; k < layers_.size() && passes > kNegligible; ++k) {
      seen += passes * layers_[k].opacity * colours[k];
      passes *= 1.0f - layers_[k].opacity;
    }
    return seen + passes * solid_[i];
  }

  const LayeredTracer& tracer_;
  const Shader& shader_;
  const PrimaryRays& primary_;
  std::span<const Vec2> offsets_;
  const PictureOptions& options_;
  std::array<trace::Ray, kPacket> rays_;
  std::array<std::uint32_t, kPacket> pixel_{}, seeds_{};
  std::array<trace::RayHit, kPacket> hits_;
  std::array<Vec3, kPacket> solid_{};
  std::vector<Translucent> layers_;
};
static_assert(LayeredTracer::kMaxLayers <= static_cast<int>(trace::Tracer::kPacket));

void requireRange(const char* what, int value, int lo, int hi) {
  if (value < lo || value > hi)
    throw Error(ErrorCode::kUsage, what, fmt::format("is {}", value),
                fmt::format("choose one from {} to {}", lo, hi));
}

}  // namespace

const char* name(View view) {
  switch (view) {
    case View::kObscurance:
      return "obscurance";
    case View::kOcclusion:
      return "occlusion";
    case View::kLit:
      return "lit";
    case View::kLightmap:
      return "lightmap";
    case View::kRelit:
      return "relit";
    case View::kIndirect:
      return "indirect";
    case View::kAlbedo:
      return "albedo";
    case View::kNormal:
      return "normal";
    case View::kBentNormal:
      return "bent-normal";
    case View::kTexels:
      return "texels";
    case View::kCharts:
      return "charts";
    case View::kValidity:
      return "validity";
  }
  return "unknown";
}

bool weightsByObscurance(const PictureOptions& options) {
  return (options.view == View::kRelit || options.view == View::kIndirect) &&
         (options.obscurance > 0 || options.bounce > 0);
}

image::Image render(const trace::Tracer& tracer, const asset::Asset* asset, const Viewpoint& viewpoint,
                    const PictureOptions& options, Progress& progress) {
  requireRange("picture width", options.width, 1, 1 << 15);
  requireRange("picture height", options.height, 1, 1 << 15);
  requireRange("samples per pixel", options.samples, 1, 1 << 16);
  BakedValues baked(tracer.scene(), asset, options.view, options.layer);
  if (asset && weightsByObscurance(options))
    baked.useObscurance(obscurancePlane(*asset, options.obscurance_layer));
  const LayeredTracer layered(tracer);
  const Shader shader(layered, baked, options);
  const PrimaryRays primary(viewpoint, options.width, options.height);
  const std::vector<Vec2> offsets = tentOffsets(options.samples);
  image::Image picture(options.width, options.height, 3);

  const auto tilesAlong = [](int pixels) { return static_cast<std::size_t>((pixels + kTile - 1) / kTile); };
  const std::size_t tiles_x = tilesAlong(options.width), tiles = tiles_x * tilesAlong(options.height);
  Stage stage(progress, "render", tiles);
  parallelFor(
      tiles, 1,
      [&](std::size_t begin, std::size_t end) {
        BlockRenderer blocks(layered, shader, primary, offsets, options);
        for (std::size_t tile = begin; tile < end; ++tile) {
          const int left = static_cast<int>(tile % tiles_x) * kTile,
                    top = static_cast<int>(tile / tiles_x) * kTile;
          for (int y = top; y < std::min(top + kTile, options.height); y += kBlock)
            for (int x = left; x < std::min(left + kTile, options.width); x += kBlock)
              blocks.render(x, y, picture);
        }
      },
      &progress);
  return picture;
}

}  // namespace relume::picture
