// SPDX-License-Identifier: MIT
// Irradiance of entries of light, and of single points beside them, under sets of lights, by what each light
// gives alone.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "light_kernel.h"
#include "relume/asset/transfer.h"
#include "relume/core/light.h"
#include "relume/relight/visibility.h"

namespace relume::relight {

class EntryLights {
 public:
  /// `points`, with `normals`: single places whose irradiance is wanted too.
  explicit EntryLights(const asset::Entries& entries, std::span<const Point> points = {},
                       std::span<const Normal> normals = {});

  /// TransferRelighter::entryIrradiance; visibility is asked of the entries' points, then of the others.
  /// Shape: [entries + points]
  std::span<const Irradiance> evaluate(const LightSet& lights, const VisibilitySource& visibility);
  void forget();

 private:
  /// What a light of unit strength gives each entry: by its points' visibility * E * cos.
  struct Kept {
    Light light;
    bool valid = false, with_visibility = false;
    std::vector<float> factor;
  };

  /// What a light gives points, by mixes of which entries are made, or each of which is wanted.
  struct Received {
    const PreparedLight prepared;
    const float* visibility;  ///< null: all 1
  };
  void renew(Kept& kept, const Light& light, std::size_t index, const VisibilitySource& visibility);
  void mixPatches(const Received& light, float* factor, std::size_t begin, std::size_t end) const;
  void copyPoints(const Received& light, float* factor, std::size_t begin, std::size_t end) const;
  std::size_t receive(const Received& light, std::size_t first, std::size_t last, float* received) const;
  void addUp(const LightSet& lights);

  std::uint32_t samples_;                                ///< points of a patch
  std::vector<std::uint32_t> first_;                     ///< asset::Entries::first
  std::vector<float> mix_;                               ///< asset::Entries::mix
  std::array<std::vector<float>, 3> position_, normal_;  ///< by point
  std::vector<float> visibility_;                        ///< by point
  std::vector<Kept> kept_;
  std::vector<Vec3> strength_;
  std::vector<Irradiance> sum_, result_;
};

}  // namespace relume::relight
