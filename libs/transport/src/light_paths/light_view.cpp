// SPDX-License-Identifier: MIT
#include "light_paths/light_view.h"

#include <algorithm>
#include <cmath>

#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

constexpr float kFullShare = 0.15f;
constexpr std::size_t kFewest = 4;  // places that must be seen to compare by them
constexpr float kAlikeShare = 0.5f, kApartShare = 0.1f;

}  // namespace

LightView::LightView(const trace::Tracer& tracer, std::size_t pieces, std::span<const Place> places,
                     std::span<const Light> lights, Progress& progress)
    : seen_(pieces), facing_(pieces, 0.0f) {
  const std::size_t count = std::min(lights.size(), kPlaces),
                    each = places.size() / std::max<std::size_t>(pieces, 1);
  parallelFor(pieces, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        const Place& place = places[i * each + k % each];
        const Point start = trace::offsetOrigin(place.position, place.geometric_normal);
        const Vec3 way = lights[k].position - start;
        const float length = glm::length(way), cosine = glm::dot(way, place.shading_normal) / length;
        if (!(cosine > 0) || !(glm::dot(way, place.geometric_normal) > 0) ||
            tracer.occluded({start, way / length, length},
                            hashCombine(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k))))
          continue;
        seen_[i].set(k);
        facing_[i] += cosine;
      }
    }
  });
  progress.throwIfCancelled();
}

std::vector<float> LightView::importance(std::span<const Piece> pieces, float least) const {
  double sum = 0, square = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto e = static_cast<double>(facing_[i]), area = static_cast<double>(pieces[i].area);
    sum += area * e, square += area * e * e;
  }
  std::vector<float> result(pieces.size(), 1.0f);
  if (!(square > 0)) return result;
  const auto full = kFullShare * static_cast<float>(square / sum);
  for (std::size_t i = 0; i < pieces.size(); ++i) result[i] = std::clamp(facing_[i] / full, least, 1.0f);
  return result;
}

LightView::Likeness LightView::compare(std::size_t a, std::size_t b) const {
  const auto [few, many] = std::minmax({seen_[a].count(), seen_[b].count()});
  if (many == 0) return Likeness::kAlike;
  if (few < kFewest) return few == 0 && many >= kFewest ? Likeness::kApart : Likeness::kUnknown;
  const float both = static_cast<float>((seen_[a] & seen_[b]).count()) / static_cast<float>(few);
  return both >= kAlikeShare ? Likeness::kAlike : both <= kApartShare ? Likeness::kApart : Likeness::kUnknown;
}

}  // namespace relume::transport
