// SPDX-License-Identifier: MIT
#include "relume/relight/day_relighter.h"

#include <algorithm>

#include "relume/codec/keyframes.h"
#include "relume/core/error.h"
#include "relume/relight/day_file.h"

namespace relume::relight {
namespace {

Day dayOf(const asset::Layer& layer) {
  const auto text = layer.parameters.find("day");
  if (layer.kind != "day" || text == layer.parameters.end() ||
      !std::holds_alternative<std::string>(text->second))
    throw Error(ErrorCode::kMismatch, "layer " + layer.name, "holds no day", "name a layer of kind day");
  return parseDay(std::get<std::string>(text->second), "layer " + layer.name);
}

}  // namespace

DayRelighter::DayRelighter(const asset::Asset& asset, const asset::Layer& layer)
    : day_(dayOf(layer)), frames_(asset::dayFramesOf(layer, asset.atlas)) {
  gains_.resize(frames_.minutes.size());
  values_.resize(frames_.series.values);
  result_.resize(frames_.size());
}

std::span<const Irradiance> DayRelighter::evaluate(double minutes) {
  const codec::KeyPlace at = codec::placeBetween(frames_.minutes, minutes);
  std::fill(gains_.begin(), gains_.end(), 0.0f);
  const auto share = static_cast<float>(at.share);
  gains_[at.key] = (1 - share) * frames_.gain[at.key];
  if (share > 0) gains_[at.key + 1] = share * frames_.gain[at.key + 1];
  frames_.series.blend(gains_, values_);
  for (std::size_t i = 0; i < result_.size(); ++i)
    for (int c = 0; c < 3; ++c)
      result_[i].rgb[c] = std::max(values_[3 * i + static_cast<std::size_t>(c)], 0.0f);
  return result_;
}

}  // namespace relume::relight
