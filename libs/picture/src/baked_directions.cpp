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

std::unique_ptr<basis::Basis> basisOf(const asset::Layer& layer) {
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
  return word(layer, "receiver", "irradiance") != "irradiance";
}

BakedDirections::BakedDirections(const asset::Layer& layer, const asset::AtlasTable& atlas)
    : basis_(basisOf(layer)),
      packing_(word(layer, "packing", "half") == "compact" ? basis::Packing::kCompact
                                                           : basis::Packing::kHalf),
      width_(atlas.width),
      height_(atlas.height) {
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

void BakedDirections::coefficients(const BakedValues::Place& place, std::span<float> out) const {
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
}

}  // namespace relume::picture
