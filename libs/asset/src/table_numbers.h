// SPDX-License-Identifier: MIT
// Numbers of a layer's tables, or an Error that names the layer.
#pragma once
#include <fmt/format.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/core/error.h"

namespace relume::asset {

[[noreturn]] inline void corrupt(const Layer& layer, const std::string& problem) {
  throw Error(ErrorCode::kCorruptAsset, "layer " + layer.name, problem,
              "the file was damaged; bake it again");
}

/// Of a type and shape; without `rows` any number of them.
template <class T>
const std::vector<T>& numbers(const Layer& layer, const std::string& name, std::size_t channels,
                              std::optional<std::size_t> rows = {}) {
  const Table* table = layer.findTable(name);
  if (!table) corrupt(layer, fmt::format("has no table '{}'", name));
  const auto* values = std::get_if<std::vector<T>>(&table->values);
  if (!values || table->channels != channels || (rows && values->size() != *rows * channels))
    corrupt(layer, fmt::format("table '{}' has the wrong shape", name));
  return *values;
}

}  // namespace relume::asset
