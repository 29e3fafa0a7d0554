// SPDX-License-Identifier: MIT
#include "light_kernel.h"

#include <algorithm>
#include <cmath>

namespace relume::relight {
namespace {

constexpr float kNearest2 =
    1e-12f;  // m^2; nearer than a micrometre a light counts for nothing: 1 / r^2 stays finite

// incident[i]: irradiance facing the light, per unit strength; cosine[i]: at the receiver.
struct Factors {
  alignas(64) float incident[kBlock];
  alignas(64) float cosine[kBlock];
};

void directionalFactors(const PreparedLight& l, const TexelBlock& t, Factors& out) {
  for (std::size_t i = 0; i < t.count; ++i) {
    const float c =
        -(t.normal[0][i] * l.direction.x + t.normal[1][i] * l.direction.y + t.normal[2][i] * l.direction.z);
    out.incident[i] = 1.0f;
    out.cosine[i] = c > 0 ? c : 0.0f;
  }
}

template <Light::Kind kKind>
void localFactors(const PreparedLight& l, const TexelBlock& t, Factors& out) {
  for (std::size_t i = 0; i < t.count; ++i) {
    const float x = l.position.x - t.position[0][i], y = l.position.y - t.position[1][i],
                z = l.position.z - t.position[2][i];
    const float r2 = x * x + y * y + z * z;
    const bool apart = r2 > kNearest2;
    const float inverse_r2 = 1.0f / (apart ? r2 : 1.0f);
    const float inverse_r = std::sqrt(inverse_r2);
    const float cos_texel = (t.normal[0][i] * x + t.normal[1][i] * y + t.normal[2][i] * z) * inverse_r;
    const float cos_light = -(l.direction.x * x + l.direction.y * y + l.direction.z * z) * inverse_r;
    float incident;
    if constexpr (kKind == Light::Kind::kArea) {
      const float behind = -l.back * cos_light;
      const float facing = cos_light > behind ? cos_light : behind;
      incident = l.area * facing / (r2 + l.area * kInvPi);
    } else {
      const float q2 = r2 * l.inverse_range2;
      const float window = 1.0f - q2 * q2;
      incident = (window > 0 ? window : 0.0f) * inverse_r2;
      if constexpr (kKind == Light::Kind::kSpot) {
        float s = (cos_light - l.cos_outer) * l.inverse_cone;
        s = s > 0 ? s : 0.0f;
        s = s < 1 ? s : 1.0f;
        incident *= s * s;
      }
    }
    out.incident[i] = apart ? incident : 0.0f;
    out.cosine[i] = cos_texel > 0 ? cos_texel : 0.0f;
  }
}

}  // namespace

PreparedLight::PreparedLight(const Light& light)
    : kind(light.kind),
      strength(light.colour * light.intensity),
      position(light.position),
      direction(light.direction),
      inverse_range2(light.range < kInfinity ? 1 / (light.range * light.range) : 0.0f),
      cos_outer(std::cos(light.outer_cone)),
      inverse_cone(1 / std::max(0.001f, std::cos(light.inner_cone) - std::cos(light.outer_cone))),
      area(light.area),
      back(light.two_sided ? 1.0f : 0.0f) {}

namespace {

void factorsOf(const PreparedLight& light, const TexelBlock& texels, Factors& f) {
  switch (light.kind) {
    case Light::Kind::kPoint:
      return localFactors<Light::Kind::kPoint>(light, texels, f);
    case Light::Kind::kSpot:
      return localFactors<Light::Kind::kSpot>(light, texels, f);
    case Light::Kind::kArea:
      return localFactors<Light::Kind::kArea>(light, texels, f);
    case Light::Kind::kDirectional:
      return directionalFactors(light, texels, f);
  }
}

// received may be f.cosine.
void multiplyFactors(const TexelBlock& texels, const Factors& f, float* received) {
  for (std::size_t i = 0; i < texels.count; ++i) received[i] = f.cosine[i] * f.incident[i];
  if (texels.visibility)
    for (std::size_t i = 0; i < texels.count; ++i) received[i] *= texels.visibility[i];
}

}  // namespace

void receivedFactors(const PreparedLight& light, const TexelBlock& texels, float* received) {
  Factors f;
  factorsOf(light, texels, f);
  multiplyFactors(texels, f, received);
}

void addLight(const PreparedLight& light, const TexelBlock& texels, LightSums& sums) {
  Factors f;
  factorsOf(light, texels, f);
  multiplyFactors(texels, f, f.cosine);
  for (int c = 0; c < 3; ++c) {
    const float s = light.strength[c];
    for (std::size_t i = 0; i < texels.count; ++i) {
      sums.direct[c][i] += s * f.cosine[i];
      sums.incident[c][i] += s * f.incident[i];
    }
  }
}

}  // namespace relume::relight
