// SPDX-License-Identifier: MIT
#include "relume/picture/baked_directions.h"

#include <fmt/format.h>

#include "page_texels.h"
#include "relume/core/error.h"

namespace relume::picture {
namespace {

std::string word(const asset::Layer& layer, const char* name, const char* otherwise) {
  const auto found = layer.parameters.find(name);
  if (found == layer.parameters.end()) return otherwise;
  const auto* text = std::get_if<std::string>(&found->second);
  return text ? *text : otherwise;
}

bool keepsMaps(const asset::Layer& layer) { return layer.kind == "directional"; }

std::unique_ptr<basis::Basis> basisOf(const asset::Layer& layer, const asset::DirectionMaps& maps) {
  if (keepsMaps(layer)) return basis::makeDirections(maps.directions);
  const std::string receiver = word(layer, "receiver", "irradiance");
  try {
    return basis::makeBasis(receiver);
  } catch (const Error&) {
    throw Error(ErrorCode::kUnsupported, "layer " + layer.name,
                fmt::format("has the receiver '{}', which is not known here", receiver),
                "use a newer version");
  }
}

}  // namespace

bool isDirectional(const asset::Layer& layer) {
  return keepsMaps(layer) || word(layer, "receiver", "irradiance") != "irradiance";
}

BakedDirections::BakedDirections(const asset::Layer& layer, const asset::AtlasTable& atlas)
    : maps_(keepsMaps(layer) ? asset::directionMapsOf(layer, atlas) : asset::DirectionMaps()),
      basis_(basisOf(layer, maps_)),
      packing_(word(layer, "packing", "half") == "compact" ? basis::Packing::kCompact
                                                           : basis::Packing::kHalf),
      width_(atlas.width),
      height_(atlas.height) {
  if (keepsMaps(layer)) return;
  const auto corrupt = [&](const std::string& what) {
    return Error(ErrorCode::kCorruptAsset, "layer " + layer.name, what, "bake the scene again");
  };
  for (const basis::TexturePlane& plane : basis_->planes(packing_)) {
    const std::string name = basis_->planeName(plane);
    const auto found = std::find_if(layer.planes.begin(), layer.planes.end(),
                                    [&](const asset::Plane& p) { return p.name == name; });
    if (found == layer.planes.end()) throw corrupt(fmt::format("has no plane '{}'", name));
    if (found->channels != plane.channels ||
        found->values.size() != atlas.pageTexels() * static_cast<std::size_t>(plane.channels))
      throw corrupt(fmt::format("plane '{}' has the wrong shape", name));
    planes_.push_back(&*found);
  }
}

bool BakedDirections::fromMaps(const BakedValues& baked, const BakedValues::Place& place,
                               std::span<float> out) const {
  // At the rim of a chart the nearest texel may belong to none.
  std::optional<std::uint32_t> entry;
  for (const Vec2 by : {Vec2(0, 0), Vec2(-0.5f, 0), Vec2(0.5f, 0), Vec2(0, -0.5f), Vec2(0, 0.5f)})
    if (!entry) entry = baked.tableIndex({place.page, place.texel + by});
  if (!entry) return false;
  const std::uint32_t number = baked.table().chart[*entry];
  const asset::DirectionMaps::Chart& chart = maps_.charts[number];
  const Vec2 inside =
      (place.texel - Vec2(chart.x, chart.y)) / glm::max(Vec2(chart.width, chart.height), Vec2(1.0f));
  for (std::size_t i = 0; i < maps_.directions.size(); ++i) {
    const asset::DirectionMaps::Rectangle& r = maps_.at(number, i);
    Vec3 sum(0.0f);
    if (r.width > 0) {
      const Bilinear at =
          bilinearAt(inside * Vec2(r.width, r.height), static_cast<int>(r.width), static_cast<int>(r.height));
      const asset::DirectionMaps::Texture& texture = maps_.textures[i];
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t x = r.x + at.texel[k] % r.width, y = r.y + at.texel[k] / r.width;
        const std::uint8_t* rgb = &texture.rgb[3 * (y * texture.width + x)];
        const Vec3 root = Vec3(rgb[0], rgb[1], rgb[2]) / 255.0f;
        sum += (at.weight[k] * r.most) * root * root;
      }
    }
    for (int c = 0; c < 3; ++c) out[3 * i + static_cast<std::size_t>(c)] = sum[c];
  }
  return true;
}

bool BakedDirections::coefficients(const BakedValues& baked, const BakedValues::Place& place,
                                   std::span<float> out) const {
  if (!maps_.directions.empty()) return fromMaps(baked, place, out);
  const Bilinear at = bilinearAt(place.texel, width_, height_);
  const std::size_t page =
      std::size_t{place.page} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  std::array<float, kMost> stored{};
  std::size_t number = 0;
  for (const asset::Plane* plane : planes_) {
    const auto channels = static_cast<std::size_t>(plane->channels);
    for (std::size_t c = 0; c < channels; ++c, ++number)
      for (std::size_t k = 0; k < 4; ++k)
        stored[number] += at.weight[k] * plane->values[(page + at.texel[k]) * channels + c];
  }
  basis_->unpack(std::span(stored).first(number), packing_, out);
  return true;
}

}  // namespace relume::picture
