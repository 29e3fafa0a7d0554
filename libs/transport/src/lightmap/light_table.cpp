// SPDX-License-Identifier: MIT
#include "lightmap/light_table.h"

#include <algorithm>
#include <bit>

#include "block_columns.h"
#include "direction_batch.h"
#include "morton.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

/// Where a point of a net of `count` lies along the Morton curve; each has a slot of its own.
std::uint32_t slotOf(float x, float y, std::uint32_t count) {
  const std::uint32_t code = (spreadBits(static_cast<std::uint32_t>(x * 256.0f)) << 1) |
                             spreadBits(static_cast<std::uint32_t>(y * 256.0f));
  return code >> (kCodeBits - static_cast<std::uint32_t>(std::countr_zero(count)));
}

}  // namespace

LightTable::LightTable(std::uint32_t first, std::uint32_t total, std::uint64_t seed, BlockSamples sharing) {
  for (auto* array : {&place_x, &place_y, &choice, &u, &v}) array->resize(std::size_t{total} * kColumns);
  const std::uint32_t place_stream = streamOf(seed, 0, 10), footprint_stream = streamOf(seed, 0, 11),
                      choice_stream = streamOf(seed, 0, 12);
  SquareBatch places;
  forEachChunk(first, total, sharing,
               [&](std::uint32_t begin, std::uint32_t count, std::uint32_t column, std::uint32_t index) {
                 squareBatch(index, count, place_stream, places);
                 for (std::uint32_t i = 0; i < count; ++i) {
                   const std::uint32_t slot = slotOf(places.x[i], places.y[i], count);
                   const std::size_t at = std::size_t{begin + slot} * kColumns + column;
                   place_x[at] = places.x[i], place_y[at] = places.y[i];
                   // In shuffled order, unlike the batch's own, which goes through the bits of all streams
                   // alike.
                   const Vec2 footprint = sobol2(index + slot, footprint_stream);
                   u[at] = footprint.x, v[at] = footprint.y;
                   choice[at] = sobol2(index + slot, choice_stream).x;
                 }
               });
}

}  // namespace relume::transport
