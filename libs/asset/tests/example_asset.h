// SPDX-License-Identifier: MIT
// A small bake with every kind of plane, for tests.
#pragma once
#include <cmath>

#include "relume/asset/asset.h"

namespace relume::asset {

/// 2 pages of 8 x 4, a third of it covered. The golden file of format version 1 holds this: do not change it.
inline Asset exampleAsset() {
  Asset a;
  a.generator = "relume test";
  a.input_hash = "0123456789abcdef0123456789abcdef";
  a.atlas.width = 8;
  a.atlas.height = 4;
  a.atlas.pages = 2;
  for (std::uint32_t t = 0; t < 64; t += 3) {
    const auto x = static_cast<float>(t % 8), y = static_cast<float>(t / 8);
    a.atlas.texel.push_back(t);
    a.atlas.position.push_back({x * 0.25f - 1, y * 0.5f, 3 - x * y});
    a.atlas.normal.push_back(glm::normalize(Vec3(x - 3.5f, y - 2, 4 - x)));
    a.atlas.albedo.push_back({x / 8, y / 8, 0.5f});
    a.atlas.valid.push_back(t % 2 == 0);
    a.atlas.chart.push_back(t / 16);
  }
  const auto plane = [](const char* name, int channels, Storage storage, float lo, float hi) {
    Plane p{name, channels, storage, lo, hi, {}};
    for (int i = 0; i < 64 * channels; ++i) {
      const float t = 0.5f + 0.5f * std::sin(0.1f * static_cast<float>(i));
      p.values.push_back(storage == Storage::kUint32 ? std::floor(t * 1000) : lo + t * (hi - lo));
    }
    return p;
  };
  Layer w;
  w.name = "obscurance";
  w.kind = "obscurance";
  w.emitters = "ambient";
  w.transport = "obscurance";
  w.receivers = "texels";
  w.codec = "none";
  w.parameters = {
      {"tau", 1.0}, {"distance", HUGE_VAL}, {"family", std::string("exp_norm")}, {"corrected", false}};
  w.planes = {plane("value", 1, Storage::kFloat16, 0, 1)};
  w.error_estimate = 0.0125;
  w.samples = 256;
  Layer every;
  every.name = "every";
  every.kind = "test";
  every.planes = {plane("a", 3, Storage::kFloat32, -100, 1000), plane("b", 1, Storage::kUnorm8, -1, 1),
                  plane("c", 2, Storage::kUnorm16, 0.25f, 4), plane("d", 1, Storage::kUint32, 0, 0)};
  a.layers = {w, every};
  return a;
}

}  // namespace relume::asset
