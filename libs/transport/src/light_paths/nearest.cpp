// SPDX-License-Identifier: MIT
#include "light_paths/nearest.h"

#include <algorithm>
#include <numeric>

namespace relume::transport {
namespace {

constexpr std::uint32_t kLeaf = 8;

}  // namespace

float squaredDistance(const Feature& a, const Feature& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

Nearest::Nearest(std::span<const Feature> places) : places_(places.begin(), places.end()) {
  order_.resize(places_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t Nearest::build(std::uint32_t first, std::uint32_t count) {
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({first, count});
  if (count <= kLeaf) return at;
  const auto part = std::span(order_).subspan(first, count);
  Feature lo = places_[part[0]], hi = lo;
  for (const std::uint32_t i : part)
    for (std::size_t a = 0; a < lo.size(); ++a)
      lo[a] = std::min(lo[a], places_[i][a]), hi[a] = std::max(hi[a], places_[i][a]);
  std::size_t axis = 0;
  for (std::size_t a = 1; a < lo.size(); ++a)
    if (hi[a] - lo[a] > hi[axis] - lo[axis]) axis = a;
  const std::uint32_t half = count / 2;
  std::nth_element(part.begin(), part.begin() + half, part.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(places_[a][axis], a) < std::pair(places_[b][axis], b);
  });
  const float split = places_[part[half]][axis];
  build(first, half);
  const std::uint32_t right = build(first + half, count - half);
  nodes_[at] = {first, 0, right, static_cast<std::uint8_t>(axis), split};
  return at;
}

struct Nearest::Search {
  const Feature& at;
  std::span<Found> found;
  std::size_t count = 0;

  bool reaches(float squared) const { return count < found.size() || squared <= found[count - 1].squared; }
  void add(Found f) {
    if (count == found.size()) {
      if (!(f < found[count - 1])) return;
      --count;
    }
    std::size_t i = count++;
    for (; i > 0 && f < found[i - 1]; --i) found[i] = found[i - 1];
    found[i] = f;
  }
};

void Nearest::visit(std::uint32_t node, Search& search) const {
  const Node& n = nodes_[node];
  if (n.right == 0) {
    for (std::uint32_t i = n.first; i < n.first + n.count; ++i)
      search.add({squaredDistance(places_[order_[i]], search.at), order_[i]});
    return;
  }
  const float beyond = search.at[n.axis] - n.split;
  const std::uint32_t near = beyond < 0 ? node + 1 : n.right, far = beyond < 0 ? n.right : node + 1;
  visit(near, search);
  if (search.reaches(beyond * beyond)) visit(far, search);
}

std::size_t Nearest::find(const Feature& at, std::span<Found> found) const {
  Search search{at, found};
  if (!nodes_.empty() && !found.empty()) visit(0, search);
  return search.count;
}

}  // namespace relume::transport
