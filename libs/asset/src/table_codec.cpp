// SPDX-License-Identifier: MIT
#include "table_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "relume/core/check.h"
#include "relume/core/error.h"

namespace relume::asset {
namespace {

// In the order of TableValues.
constexpr std::array<const char*, std::variant_size_v<TableValues>> kStorages{"int8",   "uint8",  "int16",
                                                                              "uint16", "uint32", "float32"};

/// Calls read with an empty vector of the type that alternative `storage` holds.
template <std::size_t kStorage = 0, class Read>
TableValues readAs(std::size_t storage, const Read& read) {
  if constexpr (kStorage + 1 < kStorages.size())
    if (storage != kStorage) return readAs<kStorage + 1>(storage, read);
  return read(std::variant_alternative_t<kStorage, TableValues>());
}

// The first number that is not finite, or the size.
template <class T>
std::size_t firstInfinite(const std::vector<T>& values) {
  if constexpr (std::is_floating_point_v<T>)
    return static_cast<std::size_t>(
        std::find_if_not(values.begin(), values.end(), [](T v) { return std::isfinite(v); }) -
        values.begin());
  return values.size();
}

}  // namespace

Json encodeTable(const Layer& layer, const Table& table, ArrayWriter& writer) {
  RELUME_CHECK_LT(0u, table.channels);
  return std::visit(
      [&](const auto& values) {
        RELUME_CHECK_EQ(values.size() % table.channels, 0u);
        const std::size_t bad = firstInfinite(values);
        if (bad < values.size())
          throw Error(ErrorCode::kInvalidValue, fmt::format("layer {}, table {}", layer.name, table.name),
                      fmt::format("holds {} at index {}", values[bad], bad));
        return writer.writeSmallest(table.name.c_str(), kStorages[table.values.index()], values,
                                    table.channels);
      },
      table.values);
}

Table decodeTable(const JsonNode& node, ArrayReader& reader) {
  const ArrayInfo info = ArrayReader::info(node);
  const auto storage = static_cast<std::size_t>(std::find(kStorages.begin(), kStorages.end(), info.storage) -
                                                kStorages.begin());
  if (storage == kStorages.size()) node.fail(fmt::format("names the unknown storage {}", info.storage));
  return {info.name, info.channels, readAs(storage, [&]<class T>(std::vector<T>) -> TableValues {
            std::vector<T> values = reader.read<T>(node);
            if (firstInfinite(values) < values.size()) node.fail("holds a number that is not finite");
            return values;
          })};
}

}  // namespace relume::asset
