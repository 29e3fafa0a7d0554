// SPDX-License-Identifier: MIT
// A hierarchy of emitters by which one is chosen in proportion to a bound on the irradiance that it can give
// to a point: as good with a thousand lights as with ten, and one step per level. Based on:
//   [CK18] Conty Estevez, Kulla. Importance Sampling of Many Lights with Adaptive Tree Splitting. HPG 2018.
// What differs: no splitting (one emitter for each call); a share of a group's squared radius is added to its
// squared distance. Visibility is not known to it.
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
  /// Estimated irradiance from all of them.
  float importance(Point p, Normal n) const { return empty() ? 0.0f : nodes_[0].bounds.importance(p, n); }
  /// u in [0, 1).
  Choice choose(Point p, Normal n, float u) const;
  float probability(Point p, Normal n, std::uint32_t emitter) const;

 private:
  static constexpr std::uint32_t kNoNode = 0xffffffffu;
  struct Node {
    EmitterBounds bounds;
    std::uint32_t parent = kNoNode;
    std::uint32_t second = kNoNode;  ///< the first child follows its parent; kNoNode: a leaf
    std::uint32_t emitter = 0;       ///< of a leaf
  };
  struct Entry {
    EmitterBounds bounds;
    std::uint32_t emitter;
  };
  std::uint32_t build(std::span<Entry> entries, std::uint32_t parent);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_;  ///< by emitter
};

}  // namespace relume::transport
