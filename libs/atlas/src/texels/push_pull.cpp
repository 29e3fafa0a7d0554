// SPDX-License-Identifier: MIT
// Push-pull: each level halves the one below by the mean of its known pixels; on the way back holes take the
// bilinear interpolation of the level above. One pass over 4/3 of the pixels, whatever the size of the holes.
// Based on:
//   [GGSC96] Gortler, Grzeszczuk, Szeliski, Cohen. The Lumigraph. 1996. Section 3.4. Weights here are 0 or 1.
#include "texels/push_pull.h"

#include <algorithm>
#include <vector>

#include "relume/core/parallel.h"

namespace relume::atlas {
namespace {

constexpr std::size_t kGrainPixels = 1 << 15;

struct Level {
  int width = 0, height = 0;
  std::span<float> values;
  std::span<const std::uint8_t> known;
  std::vector<float> own_values;
  std::vector<std::uint8_t> own_known;
};

std::size_t grainRows(int width) {
  return std::max<std::size_t>(kGrainPixels / static_cast<std::size_t>(width), 1);
}

Level halved(const Level& fine, std::size_t channels) {
  Level coarse;
  coarse.width = (fine.width + 1) / 2, coarse.height = (fine.height + 1) / 2;
  const std::size_t width = static_cast<std::size_t>(coarse.width),
                    fine_width = static_cast<std::size_t>(fine.width);
  const std::size_t pixels = width * static_cast<std::size_t>(coarse.height);
  coarse.own_values.assign(pixels * channels, 0.0f);
  coarse.own_known.assign(pixels, 0);
  parallelFor(static_cast<std::size_t>(coarse.height), grainRows(coarse.width),
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t y = begin; y < end; ++y) {
                  for (std::size_t x = 0; x < width; ++x) {
                    float* sum = coarse.own_values.data() + (y * width + x) * channels;
                    int count = 0;
                    for (std::size_t fy = 2 * y;
                         fy < std::min<std::size_t>(2 * y + 2, static_cast<std::size_t>(fine.height)); ++fy) {
                      for (std::size_t fx = 2 * x; fx < std::min(2 * x + 2, fine_width); ++fx) {
                        const std::size_t from = fy * fine_width + fx;
                        if (!fine.known[from]) continue;
                        ++count;
                        for (std::size_t c = 0; c < channels; ++c) sum[c] += fine.values[from * channels + c];
                      }
                    }
                    if (count == 0) continue;
                    for (std::size_t c = 0; c < channels; ++c) sum[c] /= static_cast<float>(count);
                    coarse.own_known[y * width + x] = 1;
                  }
                }
              });
  coarse.values = coarse.own_values;
  coarse.known = coarse.own_known;
  return coarse;
}

void fillFrom(const Level& coarse, Level& fine, std::size_t channels) {
  const int width = fine.width;
  parallelFor(
      static_cast<std::size_t>(fine.height), grainRows(width), [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
          // The two rows and columns of the coarse level about the pixel's centre weigh 3/4 and 1/4.
          const int y_near = y / 2, y_far = std::clamp(y_near + (y % 2 ? 1 : -1), 0, coarse.height - 1);
          for (int x = 0; x < width; ++x) {
            const std::size_t at =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            if (fine.known[at]) continue;
            const int x_near = x / 2, x_far = std::clamp(x_near + (x % 2 ? 1 : -1), 0, coarse.width - 1);
            const auto row = [&](int cy, int cx) {
              return coarse.values.data() +
                     (static_cast<std::size_t>(cy) * static_cast<std::size_t>(coarse.width) +
                      static_cast<std::size_t>(cx)) *
                         channels;
            };
            const float *nn = row(y_near, x_near), *nf = row(y_near, x_far), *fn = row(y_far, x_near),
                        *ff = row(y_far, x_far);
            for (std::size_t c = 0; c < channels; ++c) {
              fine.values[at * channels + c] = 0.5625f * nn[c] + 0.1875f * (nf[c] + fn[c]) + 0.0625f * ff[c];
            }
          }
        }
      });
}

}  // namespace

void pushPull(int width, int height, int channels, std::span<float> values,
              std::span<const std::uint8_t> known) {
  const std::size_t stride = static_cast<std::size_t>(channels);
  if (std::find(known.begin(), known.end(), std::uint8_t{1}) == known.end()) return;
  std::vector<Level> levels(1);
  levels[0].width = width, levels[0].height = height;
  levels[0].values = values, levels[0].known = known;
  // Up to the first level that is known everywhere; the top, one pixel, always is.
  while (std::find(levels.back().known.begin(), levels.back().known.end(), std::uint8_t{0}) !=
         levels.back().known.end()) {
    levels.push_back(halved(levels.back(), stride));
  }
  for (std::size_t i = levels.size() - 1; i-- > 0;) {
    fillFrom(levels[i + 1], levels[i], stride);
    levels.pop_back();
  }
}

}  // namespace relume::atlas
