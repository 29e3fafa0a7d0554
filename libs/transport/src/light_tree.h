// SPDX-License-Identifier: MIT
// A hierarchy of emitters by which one is chosen in proportion to a bound on the irradiance that it can give
// to a point: as good with a thousand lights as with ten, and one step per level. Based on:
//   [CK18] Conty Estevez, Kulla. Importance Sampling of Many Lights with Adaptive Tree Splitting. HPG 2018.
// What differs: eight groups to a node, weighed by vector code; no splitting (one emitter for each call); a
// share of a group's squared radius is added to its squared distance. Visibility is not known to it.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/core/vec.h"

namespace relume::transport {

/// What is known of one emitter or of a group: where it is, where to it shines, how strongly.
struct EmitterBounds {
  Box3 box;
  Direction axis{0, 0, 1};
  float cos_spread = 1.0f;    ///< normals lie within this angle of the axis ([CK18] theta_o)
  float cos_emission = 0.0f;  ///< light leaves within this angle of a normal (theta_e)
  bool two_sided = false;
  float intensity = 0.0f;  ///< greatest luminous intensity: I, or L A

  /// An estimate of the irradiance at p, 0 where there can be none; n: the receiver's side, or zero for a
  /// receiver that sees all around.
  float importance(Point p, Normal n) const;
  friend EmitterBounds merged(const EmitterBounds& a, const EmitterBounds& b);
};

class LightTree {
 public:
  struct Choice {
    std::uint32_t emitter = 0;
    float probability = 0;  ///< 0: nothing can shine here
  };

  /// Emitters of no intensity are never chosen.
  explicit LightTree(std::span<const EmitterBounds> emitters);

  bool empty() const { return nodes_.empty(); }
  /// u in [0, 1).
  Choice choose(Point p, Normal n, float u) const;
  float probability(Point p, Normal n, std::uint32_t emitter) const;

 private:
  static constexpr std::uint32_t kNoNode = 0xffffffffu, kLeafBit = 0x80000000u;
  static constexpr std::size_t kWidth = 8;
  /// Lanes that are not used have no intensity.
  struct alignas(32) Node {
    float cx[kWidth]{}, cy[kWidth]{}, cz[kWidth]{};  ///< centre of the bounds
    float radius2[kWidth]{};                         ///< squared, of their sphere
    float ax[kWidth]{}, ay[kWidth]{}, az[kWidth]{};  ///< axis
    float cos_spread[kWidth]{}, sin_spread[kWidth]{}, cos_emission[kWidth]{}, intensity[kWidth]{};
    std::uint32_t two_sided[kWidth]{};  ///< all bits or none
    std::uint32_t child[kWidth]{};      ///< a node, or with kLeafBit an emitter
    std::uint32_t parent = kNoNode, slot = 0;

    void set(std::size_t lane, const EmitterBounds& bounds, std::uint32_t the_child);
    /// EmitterBounds::importance of each child.
    void importances(Point p, Normal n, float* result) const;
  };
  struct Leaf {
    std::uint32_t node = kNoNode, slot = 0;
  };

  std::vector<Node> nodes_;
  std::vector<Leaf> leaf_of_;  ///< by emitter
};

}  // namespace relume::transport
