// SPDX-License-Identifier: MIT
// Irradiance of entries of light on the device (multi-scale PRT, section 10), by what each light gives alone:
// a light that only changed its colour is not evaluated anew.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "gl_objects.h"
#include "relume/asset/transfer.h"
#include "relume/core/quantity.h"

namespace relume::render {

class EntryPass {
 public:
  /// `points` with `normals`: single places whose irradiance is wanted too (asset/transfer.h, NearShares).
  /// `columns`: where the product takes an entry's irradiance, its place among the columns; [entries].
  EntryPass(const asset::Entries& entries, std::span<const Point> points, std::span<const Normal> normals,
            std::span<const std::uint32_t> columns);

  /// Room for so many lights; all have to be evaluated anew after it has grown.
  void reserve(std::size_t lights);
  /// What light `index` of the bound buffer of lights (binding 1) gives. Shadow maps are bound.
  void renew(std::size_t index, bool shadows);
  /// Adds up, into `x` at the places of the columns.
  void sum(std::size_t lights, const Buffer& x);

  std::size_t entries() const { return entries_; }
  /// Takes shadow maps.
  const Program& receivedProgram() const { return received_program_; }
  std::size_t reserved() const { return reserved_; }
  /// By group: entries, then points. shape: [groups] of vec4
  const Buffer& irradiance() const { return irradiance_; }
  std::vector<Irradiance> readEntries() const;  ///< waits for the device

 private:
  std::size_t entries_, samples_, patch_points_, points_, groups_, reserved_ = 0;
  Program received_program_, factors_program_, sums_program_;
  Buffer positions_, normals_, mix_of_entry_, mix_, columns_, received_, factors_, irradiance_;
};

}  // namespace relume::render
