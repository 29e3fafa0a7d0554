// SPDX-License-Identifier: MIT
#include "relume/basis/glossy.h"

#include <algorithm>
#include <cmath>

#include "relume/basis/ggx.h"
#include "relume/core/frame.h"

namespace relume::basis {
namespace {

constexpr float kLeastRoughness = 0.04f, kLeastCosine = 0.05f;
constexpr float kMostSharpness = 1e4f;

Gaussian normalized(Direction axis, float sharpness) {
  Gaussian g{axis, std::min(sharpness, kMostSharpness), 1.0f};
  g.amplitude = 1.0f / integral(g);
  return g;
}

}  // namespace

GlossyLobe GlossyLobe::ggx(Normal normal, Direction outgoing, float roughness, Vec3 f0) {
  GlossyLobe lobe;
  lobe.kind_ = Kind::kGgx, lobe.normal_ = normal, lobe.outgoing_ = outgoing, lobe.f0_ = f0;
  roughness = std::clamp(roughness, kLeastRoughness, 1.0f);
  lobe.width_ = roughness * roughness;
  const float cosine = std::max(glm::dot(normal, outgoing), kLeastCosine);
  const ggx::Reflected reflected = ggx::reflected(cosine, lobe.width_);
  lobe.scale_ = reflected.compensation(f0), lobe.albedo_ = reflected.albedo(f0);
  lobe.shape_ =
      normalized(glm::reflect(-outgoing, normal), 2.0f / (lobe.width_ * lobe.width_) / (4.0f * cosine));
  return lobe;
}

GlossyLobe GlossyLobe::phong(Normal normal, Direction outgoing, float exponent, Vec3 specular) {
  GlossyLobe lobe;
  lobe.kind_ = Kind::kPhong, lobe.normal_ = normal, lobe.outgoing_ = outgoing, lobe.f0_ = specular;
  lobe.width_ = exponent, lobe.albedo_ = specular;
  lobe.shape_ = normalized(glm::reflect(-outgoing, normal), std::max(exponent, 0.1f));
  return lobe;
}

GlossyLobe GlossyLobe::widened(float sharpness) const {
  if (kind_ == Kind::kPhong) return phong(normal_, outgoing_, width_ * sharpness / (width_ + sharpness), f0_);
  // As in ggx(): of a lobe that does not lean.
  const float own = 0.5f / (width_ * width_), wide = own * sharpness / (own + sharpness);
  return ggx(normal_, outgoing_, std::sqrt(std::min(std::sqrt(0.5f / wide), 1.0f)), f0_);
}

float GlossyLobe::shareAbove(Normal n) const {
  // The normal distribution, by the logistic one: right at both ends, a narrow lobe and an even one.
  const float x = glm::dot(shape_.axis, n) * std::sqrt(shape_.sharpness);
  return 1.0f / (1.0f + std::exp(-1.702f * x));
}

Vec3 GlossyLobe::evaluate(Direction incoming) const {
  const float n_l = glm::dot(normal_, incoming);
  if (!(n_l > 0)) return Vec3(0.0f);
  if (kind_ == Kind::kPhong) {
    const float c = std::max(glm::dot(shape_.axis, incoming), 0.0f);
    return f0_ * ((width_ + 2) / (2 * kPi) * std::pow(c, width_) * n_l);
  }
  const float n_v = std::max(glm::dot(normal_, outgoing_), kLeastCosine);
  const Vec3 sum = incoming + outgoing_;
  const float length = glm::length(sum);
  if (!(length > 0)) return Vec3(0.0f);
  const Vec3 h = sum / length;
  const Frame frame = Frame::about(normal_);
  const float v_h = std::clamp(glm::dot(outgoing_, h), 0.0f, 1.0f);
  const Vec3 fresnel = f0_ + (1.0f - f0_) * std::pow(1 - v_h, 5.0f);
  return scale_ * fresnel *
         (ggx::distribution(frame.toLocal(h), width_) * ggx::visibility(n_l, n_v, width_) * n_l);
}

}  // namespace relume::basis
