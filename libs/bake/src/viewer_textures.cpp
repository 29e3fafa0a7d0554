// SPDX-License-Identifier: MIT
#include "relume/bake/viewer_textures.h"

#include <algorithm>
#include <cmath>

#include "relume/core/check.h"
#include "relume/image/io.h"

namespace relume::bake {
namespace {

constexpr std::size_t kOutliers = 65536;  // one of so many texels may be clipped,
constexpr float kHeadroom = 4;            // where it is so many times above all others

std::size_t pageTexels(const asset::AtlasTable& atlas) {
  return static_cast<std::size_t>(atlas.width) * static_cast<std::size_t>(atlas.height);
}

const asset::Layer* findKind(const asset::Asset& asset, std::string_view kind) {
  const auto found = std::find_if(asset.layers.begin(), asset.layers.end(),
                                  [&](const asset::Layer& layer) { return layer.kind == kind; });
  return found == asset.layers.end() ? nullptr : &*found;
}

std::vector<std::vector<std::byte>> occlusionPages(const asset::AtlasTable& atlas,
                                                   const asset::Layer& layer) {
  const asset::Plane& plane = layer.planes.front();
  const auto channels = static_cast<std::size_t>(plane.channels);
  const std::size_t page_texels = pageTexels(atlas);
  std::vector<std::vector<std::byte>> pages;
  for (std::uint32_t page = 0; page < atlas.pages; ++page) {
    image::Image grey(atlas.width, atlas.height, 1);
    for (std::size_t i = 0; i < page_texels; ++i) {
      const float* v = plane.values.data() + (page * page_texels + i) * channels;
      grey.data[i] = channels == 3 ? luminance({v[0], v[1], v[2]}) : v[0];
    }
    pages.push_back(image::encodePngData(grey));
  }
  return pages;
}

/// What the brightest value of a page's texture stands for.
float intensityOf(const asset::AtlasTable& atlas, const asset::Plane& plane, std::uint32_t page) {
  const std::size_t page_texels = pageTexels(atlas);
  const auto begin = std::lower_bound(atlas.texel.begin(), atlas.texel.end(), page * page_texels);
  const auto end = std::lower_bound(begin, atlas.texel.end(), (page + 1) * page_texels);
  std::vector<float> brightest;
  for (auto texel = begin; texel != end; ++texel) {
    const float* v = plane.values.data() + std::size_t{*texel} * 3;
    brightest.push_back(std::max({v[0], v[1], v[2]}));
  }
  if (brightest.empty()) return 1;
  const auto outliers = static_cast<std::ptrdiff_t>(brightest.size() / kOutliers);
  std::nth_element(brightest.begin(), brightest.begin() + outliers, brightest.end(), std::greater<>());
  const float rest = brightest[static_cast<std::size_t>(outliers)];
  const float most = *std::max_element(brightest.begin(), brightest.begin() + outliers + 1);
  const float intensity = rest > 0 ? std::min(most, kHeadroom * rest) : most;
  return intensity > 0 ? intensity : 1;
}

/// In [0, 1), even over any few texels that are neighbours: a sequence of low discrepancy in two dimensions,
/// of which the constants are powers of the inverse plastic number.
float ditherThreshold(int x, int y) {
  const double t = 0.7548776662466927 * x + 0.5698402909980532 * y + 0.5;
  return static_cast<float>(t - std::floor(t));
}

}  // namespace

std::vector<scene::gltf::LightmapPage> lightmapPages(const asset::AtlasTable& atlas,
                                                     const asset::Layer& layer) {
  const asset::Plane& plane = layer.planes.front();
  RELUME_CHECK_EQ(plane.channels, 3);
  std::vector<scene::gltf::LightmapPage> pages;
  for (std::uint32_t page = 0; page < atlas.pages; ++page) {
    const float intensity = intensityOf(atlas, plane, page);
    image::Image encoded(atlas.width, atlas.height, 3);
    const float* v = plane.values.data() + page * pageTexels(atlas) * 3;
    for (int y = 0; y < atlas.height; ++y) {
      for (int x = 0; x < atlas.width; ++x, v += 3) {
        // One threshold for all channels: grey stays grey.
        const float threshold = ditherThreshold(x, y);
        for (std::size_t c = 0; c < 3; ++c) {
          const float steps = std::clamp(v[c] / intensity, 0.0f, 1.0f) * 255;
          encoded.at(x, y)[c] = std::min(std::floor(steps + threshold), 255.0f) / 255;
        }
      }
    }
    pages.push_back({.png = image::encodePngData(encoded), .intensity = intensity});
  }
  return pages;
}

void addViewerTextures(const asset::Asset& asset, scene::gltf::BakeOutput& output) {
  if (const asset::Layer* lightmap = findKind(asset, "lightmap");
      lightmap && lightmap->planes.front().channels == 3) {
    output.lightmap = lightmapPages(asset.atlas, *lightmap);
    return;
  }
  const asset::Layer* occlusion = findKind(asset, "ao");
  if (!occlusion) occlusion = findKind(asset, "obscurance");
  if (occlusion) output.occlusion_png = occlusionPages(asset.atlas, *occlusion);
}

}  // namespace relume::bake
