// SPDX-License-Identifier: MIT
// Float images. Row 0 is the top row (glTF's v = 0); channels are interleaved; colour is linear unless a name
// says srgb.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "relume/core/vec.h"

namespace relume::image {

/// shape: [height][width][channels]
struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;

  Image() = default;
  Image(int w, int h, int c, float value = 0.0f)
      : width(w),
        height(h),
        channels(c),
        data(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c), value) {
  }

  bool empty() const { return data.empty(); }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t index(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
  float* at(int x, int y) { return data.data() + index(x, y); }
  const float* at(int x, int y) const { return data.data() + index(x, y); }
  Vec3 rgb(int x, int y) const {
    const float* p = at(x, y);
    return channels >= 3 ? Vec3(p[0], p[1], p[2]) : Vec3(p[0]);
  }
  void setRgb(int x, int y, Vec3 v) {
    float* p = at(x, y);
    p[0] = v.x;
    if (channels >= 3) p[1] = v.y, p[2] = v.z;
  }
};

/// 8-bit pixels as stored in texture files; not linearised. shape: [height][width][channels]
struct Image8 {
  int width = 0, height = 0, channels = 0;
  std::vector<unsigned char> data;
};

float srgbToLinear(float s);
float linearToSrgb(float l);

}  // namespace relume::image
