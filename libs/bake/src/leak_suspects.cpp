// SPDX-License-Identifier: MIT
// A texel stands out when it is far from what the texels about it suggest. Each of the four lines through it
// (along the page's x, y and diagonals) has a say where it has valid texels of the same chart that face about
// the same way (a hem folded into the chart of its cloth differs from it rightly): the value
// ought to lie between those of the two neighbours, or, at the border of a chart, between the next one and
// the value at which the two next ones aim; the nearest value there is the line's suggestion. The median of
// the four is the suggestion, so neither a slope nor the edge of a shadow stands out, while a leak one texel
// wide does, also along a border: the lines across it outvote the one along it. Tolerated are a fifth of the
// larger of the two values (what an eye sees beside each other), a fiftieth of the layer's mean (what it does
// not see in the dark), and six standard errors, for its own noise and that of the suggestion. Limits: a leak
// that is two texels wide and inside a chart suggests itself. Then the other signs remain: leaks come from
// texels that lie partly inside something, so beside invalid ones, or whose rays meet backs.
#include "leak_suspects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "relume/core/check.h"

namespace relume::bake {
namespace {

constexpr float kVisibleShare = 0.2f, kDarkShare = 0.02f, kErrors = 6;
constexpr float kAlike = 0.7f;          // cosine between normals of texels that say something of each other
constexpr float kFewBacks = 1.0f / 16;  // share of rays that met back faces; from a quarter on it is buried

class Neighbourhood {
 public:
  Neighbourhood(const atlas::Texels& texels, std::span<const std::uint32_t> point_of_texel)
      : texels_(texels), point_of_texel_(point_of_texel) {}

  /// The point `dx`, `dy` texels from point i on its page, if it is of the same chart; else kNone.
  std::uint32_t at(std::size_t i, int dx, int dy) const {
    const atlas::SurfacePoint& p = texels_.points[i];
    const auto width = static_cast<std::uint32_t>(texels_.width),
               height = static_cast<std::uint32_t>(texels_.height);
    const int x = static_cast<int>(p.texel % width) + dx, y = static_cast<int>(p.texel / width % height) + dy;
    if (x < 0 || y < 0 || x >= texels_.width || y >= texels_.height) return scene::kNone;
    const std::uint32_t page = p.texel / (width * height);
    const std::uint32_t other = point_of_texel_[(page * height + static_cast<std::uint32_t>(y)) * width +
                                                static_cast<std::uint32_t>(x)];
    return other != scene::kNone && texels_.points[other].chart == p.chart ? other : scene::kNone;
  }
  bool alike(std::size_t i, std::uint32_t other) const {
    return glm::dot(texels_.points[i].shading_normal, texels_.points[other].shading_normal) >= kAlike;
  }

 private:
  const atlas::Texels& texels_;
  std::span<const std::uint32_t> point_of_texel_;
};

constexpr std::array<std::array<int, 2>, 4> kLines = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};

/// What the texels about point i suggest for it; nothing where there are too few to tell.
std::optional<float> suggestion(const Neighbourhood& near, std::span<const float> values,
                                std::span<const std::uint8_t> valid, std::size_t i) {
  const auto value = [&](int dx, int dy) -> std::optional<float> {
    const std::uint32_t p = near.at(i, dx, dy);
    return p != scene::kNone && valid[p] && near.alike(i, p) ? std::optional(values[p]) : std::nullopt;
  };
  float sum = 0, least = kInfinity, most = -kInfinity;
  int count = 0;
  const auto vote = [&](float one, float other) {
    const float v = std::clamp(values[i], std::min(one, other), std::max(one, other));
    sum += v, least = std::min(least, v), most = std::max(most, v), ++count;
  };
  for (const auto& [dx, dy] : kLines) {
    const auto before = value(-dx, -dy), after = value(dx, dy);
    if (before && after) {
      vote(*before, *after);
      continue;
    }
    const auto next = before ? before : after;
    const auto beyond = before ? value(-2 * dx, -2 * dy) : value(2 * dx, 2 * dy);
    if (next && beyond) vote(*next, 2 * *next - *beyond);
  }
  if (count < 3) return std::nullopt;
  return (sum - least - most) / static_cast<float>(count - 2);  // the median of three or four
}

bool besideInvalid(const Neighbourhood& near, std::span<const std::uint8_t> valid, std::size_t i) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const std::uint32_t p = near.at(i, dx, dy);
      if (p != scene::kNone && !valid[p]) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::uint32_t> pointsByTexel(const atlas::Texels& texels) {
  std::vector<std::uint32_t> result(static_cast<std::size_t>(texels.pages) *
                                        static_cast<std::size_t>(texels.width) *
                                        static_cast<std::size_t>(texels.height),
                                    scene::kNone);
  for (std::uint32_t i = 0; i < texels.points.size(); ++i) result[texels.points[i].texel] = i;
  return result;
}

void findSuspects(const atlas::Texels& texels, std::span<const std::uint32_t> point_of_texel,
                  const PointLayer& layer, LayerReport& report) {
  const std::size_t points = texels.points.size();
  RELUME_CHECK_EQ(layer.valid.size(), points);
  const PointPlane& plane = layer.planes.front();
  const auto channels = static_cast<std::size_t>(plane.channels);
  std::vector<float> values(points);
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t c = 0; c < channels; ++c)
      values[i] += plane.values[i * channels + c] / static_cast<float>(channels);

  const Neighbourhood near(texels, point_of_texel);
  const float dark = kDarkShare * static_cast<float>(report.mean_value);
  report.marks.assign(points, 0);
  for (std::size_t i = 0; i < points; ++i) {
    if (!layer.valid[i]) {
      report.marks[i] = kInvalidMark;
      ++report.invalid_texels;
      continue;
    }
    std::uint8_t& signs = report.marks[i];
    if (besideInvalid(near, layer.valid, i)) signs |= kBesideInvalid, ++report.beside_invalid;
    if (!layer.back_share.empty() && layer.back_share[i] > kFewBacks) signs |= kSeesBacks, ++report.see_backs;
    const auto suggested = suggestion(near, values, layer.valid, i);
    if (!suggested) continue;
    const float tolerated = kVisibleShare * std::max(values[i], *suggested) + dark + kErrors * layer.error[i];
    const float difference = std::abs(values[i] - *suggested);
    if (!(difference > tolerated)) continue;
    signs |= kStandsOut, ++report.stand_out;
    const atlas::SurfacePoint& p = texels.points[i];
    report.suspects.push_back({.texel = p.texel,
                               .chart = p.chart,
                               .position = p.position,
                               .value = values[i],
                               .suggested = *suggested,
                               .severity = difference / tolerated,
                               .signs = signs});
  }
  std::stable_sort(report.suspects.begin(), report.suspects.end(),
                   [](const Suspect& a, const Suspect& b) { return a.severity > b.severity; });
  if (report.suspects.size() > kMostSuspects) report.suspects.resize(kMostSuspects);
}

}  // namespace relume::bake
