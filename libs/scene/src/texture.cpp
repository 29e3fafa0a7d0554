// SPDX-License-Identifier: MIT
// Texture look-ups: bilinear, texel centres at (i + 1/2) / size, row 0 at v = 0.
#include <array>
#include <cmath>

#include "relume/scene/scene.h"

namespace relume::scene {

namespace {

std::array<float, 256> makeTable(bool srgb) {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const float v = static_cast<float>(i) / 255.0f;
    table[static_cast<std::size_t>(i)] = srgb ? image::srgbToLinear(v) : v;
  }
  return table;
}

/// Where a coordinate falls: two neighbouring texels and the weight of the second.
struct Tap {
  int lo, hi;
  float t;
};

int wrapped(int i, int size, Wrap wrap) {
  if (wrap == Wrap::kClamp) return i < 0 ? 0 : i >= size ? size - 1 : i;
  if (wrap == Wrap::kRepeat) return i < 0 ? i + size : i >= size ? i - size : i;
  // Mirrored: texels 0..size-1 and back; i lies in [-1, 2 size].
  if (i < 0) i = -1 - i;
  if (i >= 2 * size) i -= 2 * size;
  return i < size ? i : 2 * size - 1 - i;
}

Tap tapOf(float u, int size, Wrap wrap) {
  if (!std::isfinite(u)) u = 0;
  if (wrap == Wrap::kRepeat)
    u -= std::floor(u);
  else if (wrap == Wrap::kMirror)
    u -= 2 * std::floor(u * 0.5f);
  else
    u = glm::clamp(u, 0.0f, 1.0f);
  const float x = u * static_cast<float>(size) - 0.5f;
  const float floor = std::floor(x);
  const int i = static_cast<int>(floor);
  return {wrapped(i, size, wrap), wrapped(i + 1, size, wrap), x - floor};
}

}  // namespace

Vec4 Texture::sample(Vec2 uv) const {
  if (!image || image->data.empty()) return Vec4(1);
  static const std::array<float, 256> kSrgb = makeTable(true), kLinear = makeTable(false);
  const auto& colour = srgb ? kSrgb : kLinear;
  const image::Image8& im = *image;
  const Tap x = tapOf(uv.x, im.width, wrap_u), y = tapOf(uv.y, im.height, wrap_v);
  const auto channels = static_cast<std::size_t>(im.channels);
  const auto texel = [&](int i, int j) {
    const unsigned char* p =
        im.data.data() +
        (static_cast<std::size_t>(j) * static_cast<std::size_t>(im.width) + static_cast<std::size_t>(i)) *
            channels;
    switch (channels) {
      case 1:
        return Vec4(Vec3(colour[p[0]]), 1);
      case 2:
        return Vec4(Vec3(colour[p[0]]), kLinear[p[1]]);
      case 3:
        return Vec4(colour[p[0]], colour[p[1]], colour[p[2]], 1);
      default:
        return Vec4(colour[p[0]], colour[p[1]], colour[p[2]], kLinear[p[3]]);
    }
  };
  return glm::mix(glm::mix(texel(x.lo, y.lo), texel(x.hi, y.lo), x.t),
                  glm::mix(texel(x.lo, y.hi), texel(x.hi, y.hi), x.t), y.t);
}

// KHR_texture_transform: offset + rotation * scale * uv. The rotation is counter-clockwise as seen with v
// downwards, which is the sign that viewers agree on; the matrix printed in the extension's text has the
// other (glTF issue 1563).
Vec2 TextureRef::apply(Vec2 uv) const {
  uv *= scale;
  if (rotation != 0) {
    const float c = std::cos(rotation), s = std::sin(rotation);
    uv = {c * uv.x + s * uv.y, -s * uv.x + c * uv.y};
  }
  return uv + offset;
}

}  // namespace relume::scene
