// SPDX-License-Identifier: MIT
// The nearest of many places that have a normal too: a k-d tree.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace relume::transport {

/// Position in metres and normal times a length.
using Feature = std::array<float, 6>;
float squaredDistance(const Feature& a, const Feature& b);

class Nearest {
 public:
  struct Found {
    float squared = 0;  ///< distance
    std::uint32_t index = 0;
    auto operator<=>(const Found&) const = default;
  };

  /// Copies the places.
  explicit Nearest(std::span<const Feature> places);

  /// The nearest ones by increasing distance, of equals the lower index first; as many as `found` holds or as
  /// there are. Returns how many.
  std::size_t find(const Feature& at, std::span<Found> found) const;

 private:
  struct Node {
    std::uint32_t first = 0, count = 0;  ///< of a leaf, into order_
    std::uint32_t right = 0;             ///< child; the left one follows its parent
    std::uint8_t axis = 0;
    float split = 0;
  };
  struct Search;
  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  void visit(std::uint32_t node, Search& search) const;

  std::vector<Feature> places_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace relume::transport
