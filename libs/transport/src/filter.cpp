// SPDX-License-Identifier: MIT
// Edge-aware smoothing of texel values: a joint bilateral filter. A neighbour's weight is the product of
//   a flat window of 2 radius x 2 radius texels (half weights at its rim),
//   max(0, n_i . n_j)^normal_power, 0 across a crease,
//   a fall-off with its distance from the texel's plane: on a curved chart neighbours bend away, on a stepped
//   one they jump, a fall-off with the difference of the values, measured in their standard errors: what
//   noise explains is mixed.
// A neighbour is used together with its mirror image, and both with the smaller of their weights, so that a
// linear gradient passes unchanged, at the rim of a chart too; a window that renormalises there, or that is
// shifted inside, bends gradients.
// All parts of the weight but the window are the same both ways. So tiles of the page are laid out as dense
// arrays, and for each offset of half a window the weights of all pairs that far apart are made at once, by
// vector code; a texel finds its own pair at its place and its mirror's at the mirror's place.
#include <algorithm>
#include <cmath>

#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "relume/transport/occlusion.h"
#include "texel_rows.h"

namespace relume::transport {
namespace {

constexpr float kCreaseCosine = 0.9f;     // 26 degrees between the normals of neighbouring texels
constexpr float kPlaneTolerance = 0.25f;  // of the distance between the texels
constexpr int kTile = 32;                 // with its arrays, well inside a second-level cache

/// One tile with a rim as wide as the radius. Every array has stride() x stride() elements, row by row.
class TileFilter {
 public:
  TileFilter(const atlas::Texels& texels, const TexelRows& rows, std::span<const float> error,
             std::span<const std::uint8_t> valid, std::size_t channels, const FilterOptions& options)
      : texels_(texels),
        rows_(rows),
        error_(error),
        valid_(valid),
        channels_(channels),
        options_(options),
        stride_(static_cast<std::size_t>(kTile + 2 * options.radius)) {
    const std::size_t cells = stride_ * stride_;
    for (auto* array : {&point_, &chart_, &smooth_}) array->resize(cells);
    for (auto* array :
         {&square_, &px_, &py_, &pz_, &nx_, &ny_, &nz_, &gx_, &gy_, &gz_, &weight_, &total_, &variance_}) {
      array->resize(cells);
    }
    value_.resize(channels * cells), sum_.resize(channels * cells);
  }

  /// Filters texels [x0, x0 + kTile) x [y0, y0 + kTile) of a page; in and out: [points][channels].
  void apply(std::uint32_t page, int x0, int y0, std::span<const float> in, std::span<float> out,
             std::span<float> error_left) {
    if (!load(page, x0, y0, in)) return;
    const int radius = options_.radius;
    for (std::size_t i = 0; i < stride_ * stride_; ++i) total_[i] = 1.0f, variance_[i] = square_[i];
    std::copy(value_.begin(), value_.end(), sum_.begin());
    for (int dy = 0; dy <= radius; ++dy) {
      for (int dx = dy == 0 ? 1 : -radius; dx <= radius; ++dx) {
        weighPairs(dx, dy);
        gather(dx, dy, (dy == radius ? 0.5f : 1.0f) * (dx == radius || dx == -radius ? 0.5f : 1.0f));
      }
    }
    store(out, error_left);
  }

 private:
  std::size_t cells() const { return stride_ * stride_; }
  bool usable(std::size_t i) const { return valid_.empty() || valid_[i] != 0; }

  /// Lays the tile out; false: no point in it.
  bool load(std::uint32_t page, int x0, int y0, std::span<const float> in) {
    const int radius = options_.radius;
    std::fill(point_.begin(), point_.end(), scene::kNone);
    std::fill(smooth_.begin(), smooth_.end(), 0u);
    std::uint32_t kinds = 0;
    bool any = false;
    const auto x_begin = static_cast<std::uint32_t>(std::max(x0 - radius, 0)),
               x_end = static_cast<std::uint32_t>(std::min(x0 + kTile + radius, texels_.width));
    for (int y = std::max(y0 - radius, 0); y < std::min(y0 + kTile + radius, texels_.height); ++y) {
      const std::size_t row =
          std::size_t{page} * static_cast<std::size_t>(texels_.height) + static_cast<std::size_t>(y);
      const auto [begin, end] = rows_.within(row, x_begin, x_end);
      any |= begin < end;
      // Texel 0 of the row, were it in the tile.
      const std::ptrdiff_t base = (y - y0 + radius) * static_cast<std::ptrdiff_t>(stride_) + radius - x0;
      for (std::uint32_t i = begin; i < end; ++i) {
        if (!usable(i)) continue;
        const atlas::SurfacePoint& p = texels_.points[i];
        const auto x = static_cast<std::ptrdiff_t>(p.texel - row * static_cast<std::size_t>(texels_.width));
        const auto at = static_cast<std::size_t>(base + x);
        point_[at] = i, chart_[at] = p.chart, square_[at] = error_[i] * error_[i];
        px_[at] = p.position.x, py_[at] = p.position.y, pz_[at] = p.position.z;
        nx_[at] = p.shading_normal.x, ny_[at] = p.shading_normal.y, nz_[at] = p.shading_normal.z;
        gx_[at] = p.geometric_normal.x, gy_[at] = p.geometric_normal.y, gz_[at] = p.geometric_normal.z;
        for (std::size_t c = 0; c < channels_; ++c) value_[c * cells() + at] = in[i * channels_ + c];
        // On flat walls most neighbours share triangle and normal; equal numbers tell so at once.
        const auto likeNeighbour = [&](std::size_t back) {
          if (at < back || point_[at - back] == scene::kNone) return false;
          const atlas::SurfacePoint& q = texels_.points[point_[at - back]];
          return q.chart == p.chart && q.triangle == p.triangle && q.shading_normal == p.shading_normal;
        };
        smooth_[at] = likeNeighbour(1)         ? smooth_[at - 1]
                      : likeNeighbour(stride_) ? smooth_[at - stride_]
                                               : ++kinds;
      }
    }
    return any;
  }

  /// Weights, but for the window, of all pairs (p, p + (dx, dy)) of which either may lie inside the tile.
  void weighPairs(int dx, int dy) {
    const int radius = options_.radius;
    const auto from = static_cast<std::size_t>(radius - std::max(dx, 0)),
               to = static_cast<std::size_t>(radius + kTile - std::min(dx, 0));
    for (auto y = static_cast<std::size_t>(radius - dy); y < static_cast<std::size_t>(radius + kTile); ++y)
      weighRow(y * stride_ + from, to - from, dy * static_cast<std::ptrdiff_t>(stride_) + dx);
  }

  void weighRow(std::size_t first, std::size_t count, std::ptrdiff_t apart) {
    const std::size_t other = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(first) + apart);
    float* weight = &weight_[first];
    likeness(first, other, count, weight);
    const std::uint32_t *a = &smooth_[first], *b = &smooth_[other];
    std::uint32_t unlike = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const bool both = (a[i] != 0) & (b[i] != 0);
      weight[i] = both ? weight[i] : 0.0f;
      unlike |= both ? a[i] ^ b[i] : 0u;
    }
    if (unlike != 0) geometry(first, other, count, weight);
  }

  void likeness(std::size_t first, std::size_t other, std::size_t count, float* weight) const {
    for (std::size_t i = 0; i < count; ++i) weight[i] = 0.0f;
    const std::size_t guides = options_.guides > 0 ? static_cast<std::size_t>(options_.guides) : channels_;
    for (std::size_t c = 0; c < guides; ++c) {
      const float *a = &value_[c * cells() + first], *b = &value_[c * cells() + other];
      for (std::size_t i = 0; i < count; ++i) weight[i] += (a[i] - b[i]) * (a[i] - b[i]);
    }
    const float scale = options_.error_scale * options_.error_scale * static_cast<float>(guides);
    const float *a = &square_[first], *b = &square_[other];
    for (std::size_t i = 0; i < count; ++i) {
      const float allowed = scale * (a[i] + b[i]), rest = 1.0f - weight[i] / allowed;
      weight[i] = rest > 0.0f ? rest : 0.0f;  // no error allows nothing: 0 / 0 too
    }
  }

  void geometry(std::size_t first, std::size_t other, std::size_t count, float* weight) {
    lean_.resize(count), cosine_.resize(count);
    const auto dot = [](float ax, float ay, float az, float bx, float by, float bz) {
      return ax * bx + ay * by + az * bz;
    };
    const float *px = &px_[first], *py = &py_[first], *pz = &pz_[first], *qx = &px_[other], *qy = &py_[other],
                *qz = &pz_[other];
    const float *nx = &nx_[first], *ny = &ny_[first], *nz = &nz_[first], *mx = &nx_[other], *my = &ny_[other],
                *mz = &nz_[other];
    const float *gx = &gx_[first], *gy = &gy_[first], *gz = &gz_[first], *hx = &gx_[other], *hy = &gy_[other],
                *hz = &gz_[other];
    float *lean = lean_.data(), *cosine = cosine_.data();
    for (std::size_t i = 0; i < count; ++i) {
      const float shading = dot(nx[i], ny[i], nz[i], mx[i], my[i], mz[i]);
      const float true_cosine = dot(gx[i], gy[i], gz[i], hx[i], hy[i], hz[i]);
      const float x = qx[i] - px[i], y = qy[i] - py[i], z = qz[i] - pz[i];
      const float apart2 = x * x + y * y + z * z;
      const float off_p = dot(x, y, z, gx[i], gy[i], gz[i]), off_q = dot(x, y, z, hx[i], hy[i], hz[i]);
      const float off2 = std::max(off_p * off_p, off_q * off_q);
      const float rest = 1.0f - off2 / std::max(kPlaneTolerance * kPlaneTolerance * apart2, 1e-30f);
      const float least = std::min(shading, true_cosine);
      lean[i] = least < kCreaseCosine ? 0.0f : std::max(rest, 0.0f);
      cosine[i] = std::min(shading, 1.0f);
    }
    for (int exponent = options_.normal_power; exponent > 0; exponent >>= 1) {
      if (exponent & 1)
        for (std::size_t i = 0; i < count; ++i) lean[i] *= cosine[i];
      for (std::size_t i = 0; i < count; ++i) cosine[i] *= cosine[i];
    }
    const std::uint32_t *a = &smooth_[first], *b = &smooth_[other], *chart = &chart_[first],
                        *other_chart = &chart_[other];
    for (std::size_t i = 0; i < count; ++i) {
      const float bent = chart[i] == other_chart[i] ? lean[i] : 0.0f;
      weight[i] *= a[i] == b[i] ? 1.0f : bent;
    }
  }

  /// Adds to each texel the two that lie (dx, dy) away from it on either side.
  void gather(int dx, int dy, float window) {
    const std::ptrdiff_t apart = dy * static_cast<std::ptrdiff_t>(stride_) + dx;
    const auto radius = static_cast<std::size_t>(options_.radius);
    for (std::size_t y = radius; y < radius + kTile; ++y) {
      const std::size_t first = y * stride_ + radius;
      const std::size_t ahead = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(first) + apart),
                        behind = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(first) - apart);
      const float *own = &weight_[first], *mirror = &weight_[behind];
      float pair[kTile];
      for (std::size_t i = 0; i < kTile; ++i) pair[i] = window * std::min(own[i], mirror[i]);
      for (std::size_t c = 0; c < channels_; ++c) {
        const float *a = &value_[c * cells() + ahead], *b = &value_[c * cells() + behind];
        float* sum = &sum_[c * cells() + first];
        for (std::size_t i = 0; i < kTile; ++i) sum[i] += pair[i] * (a[i] + b[i]);
      }
      const float *a = &square_[ahead], *b = &square_[behind];
      float *total = &total_[first], *variance = &variance_[first];
      for (std::size_t i = 0; i < kTile; ++i) {
        total[i] += 2.0f * pair[i];
        variance[i] += pair[i] * pair[i] * (a[i] + b[i]);
      }
    }
  }

  void store(std::span<float> out, std::span<float> error_left) const {
    const auto radius = static_cast<std::size_t>(options_.radius);
    for (std::size_t y = radius; y < radius + kTile; ++y) {
      for (std::size_t at = y * stride_ + radius; at < y * stride_ + radius + kTile; ++at) {
        const std::uint32_t i = point_[at];
        if (i == scene::kNone) continue;
        for (std::size_t c = 0; c < channels_; ++c)
          out[i * channels_ + c] = sum_[c * cells() + at] / total_[at];
        if (!error_left.empty()) error_left[i] = std::sqrt(variance_[at]) / total_[at];
      }
    }
  }

  const atlas::Texels& texels_;
  const TexelRows& rows_;
  const std::span<const float> error_;
  const std::span<const std::uint8_t> valid_;
  const std::size_t channels_;
  const FilterOptions options_;
  const std::size_t stride_;
  std::vector<std::uint32_t> point_, chart_;  // scene::kNone: no texel that takes part
  std::vector<std::uint32_t> smooth_;         // equal: one chart, triangle and normal; 0: no texel
  std::vector<float> square_;                 // of the standard error
  std::vector<float> px_, py_, pz_, nx_, ny_, nz_, gx_, gy_, gz_;  // position, shading and geometric normal
  std::vector<float> value_, sum_;                                 // [channels][cells]
  std::vector<float> weight_, total_, variance_;
  std::vector<float> lean_, cosine_;
};

}  // namespace

void filterTexels(const atlas::Texels& texels, std::span<const float> error,
                  std::span<const std::uint8_t> valid, int channels, std::span<float> values,
                  std::span<float> error_left, const FilterOptions& options) {
  const std::size_t points = texels.points.size();
  RELUME_CHECK(channels > 0 && options.radius > 0 && options.normal_power >= 0);
  RELUME_CHECK(options.guides >= 0 && options.guides <= channels);
  RELUME_CHECK_EQ(values.size(), points * static_cast<std::size_t>(channels));
  RELUME_CHECK_EQ(error.size(), points);
  RELUME_CHECK(valid.empty() || valid.size() == points);
  RELUME_CHECK(error_left.empty() || error_left.size() == points);
  const std::vector<float> in(values.begin(), values.end());
  if (!error_left.empty()) std::copy(error.begin(), error.end(), error_left.begin());
  const TexelRows rows(texels);
  const auto tiles_x = static_cast<std::size_t>((texels.width + kTile - 1) / kTile),
             tiles_y = static_cast<std::size_t>((texels.height + kTile - 1) / kTile);
  parallelFor(texels.pages * tiles_y, 1, [&](std::size_t begin, std::size_t end) {
    TileFilter filter(texels, rows, error, valid, static_cast<std::size_t>(channels), options);
    for (std::size_t band = begin; band < end; ++band)
      for (std::size_t x = 0; x < tiles_x; ++x)
        filter.apply(static_cast<std::uint32_t>(band / tiles_y), static_cast<int>(x) * kTile,
                     static_cast<int>(band % tiles_y) * kTile, in, values, error_left);
  });
}

}  // namespace relume::transport
