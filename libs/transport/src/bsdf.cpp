// SPDX-License-Identifier: MIT
#include "relume/transport/bsdf.h"
#include "relume/basis/ggx.h"

#include <algorithm>
#include <cmath>

#include "relume/core/sampling.h"

namespace relume::transport {
namespace ggx = basis::ggx;
namespace {

using ggx::kDielectric;
using ggx::kLeastAlpha;

constexpr float kLeastCosine = 1e-4f;

float schlickWeight(float cosine) {
  const float m = 1 - std::clamp(cosine, 0.0f, 1.0f), m2 = m * m;
  return m2 * m2 * m;
}

}  // namespace

Bsdf Bsdf::lambert(Normal shading_normal, Vec3 albedo) {
  Bsdf bsdf(shading_normal);
  bsdf.diffuse_ = albedo;
  return bsdf;
}

Bsdf Bsdf::metallicRoughness(Normal shading_normal, const scene::Surface& surface, float transmission,
                             Direction outgoing) {
  Bsdf bsdf(shading_normal);
  const Vec3 base(surface.base_colour);
  const float metallic = std::clamp(surface.metallic, 0.0f, 1.0f);
  bsdf.outgoing_ = bsdf.frame_.toLocal(outgoing);
  bsdf.outgoing_.z = std::max(bsdf.outgoing_.z, kLeastCosine);
  bsdf.specular_ = true;
  bsdf.alpha_ = std::clamp(surface.roughness * surface.roughness, kLeastAlpha, 1.0f);
  const ggx::Reflected reflected = ggx::reflected(bsdf.outgoing_.z, bsdf.alpha_);
  const auto compensation = [&](Vec3 f0) { return reflected.compensation(f0); };
  const auto albedo = [&](Vec3 f0) { return glm::min(reflected.albedo(f0), Vec3(1.0f)); };
  // Each Fresnel term times its compensation, as F0 + (1 - F0) w, mixed.
  const Vec3 metal = metallic * compensation(base),
             dielectric = (1 - metallic) * compensation(Vec3(kDielectric));
  bsdf.at_normal_ = metal * base + dielectric * kDielectric;
  bsdf.towards_grazing_ = metal * (Vec3(1.0f) - base) + dielectric * (1 - kDielectric);
  const Vec3 specular = metallic * albedo(base) + (1 - metallic) * albedo(Vec3(kDielectric));
  const Vec3 body = (1 - metallic) * (Vec3(1.0f) - albedo(Vec3(kDielectric))) * base;
  bsdf.diffuse_ = body * (1 - transmission);
  bsdf.transmittance_ = body * transmission;
  bsdf.glossy_albedo_ = specular;
  const float s = luminance(specular), d = luminance(bsdf.diffuse_);
  bsdf.choose_specular_ = d > 0 ? std::clamp(s / (s + d), 0.1f, 0.9f) : 1.0f;
  return bsdf;
}

Bsdf Bsdf::glossy() const {
  Bsdf lobes = *this;
  lobes.diffuse_ = Vec3(0.0f), lobes.choose_specular_ = 1.0f;
  return lobes;
}

Vec3 Bsdf::evaluate(Direction incoming) const {
  const Vec3 in = frame_.toLocal(incoming);
  if (!(in.z > 0)) return Vec3(0.0f);
  Vec3 f = diffuse_ * kInvPi;
  if (specular_) {
    const Vec3 h = glm::normalize(in + outgoing_);
    f += (at_normal_ + towards_grazing_ * schlickWeight(glm::dot(h, outgoing_))) *
         (ggx::distribution(h, alpha_) * ggx::visibility(in.z, outgoing_.z, alpha_));
  }
  return f * in.z;
}

float Bsdf::ggxPdf(Vec3 in) const {
  const Vec3 h = glm::normalize(in + outgoing_);
  return ggx::masking(outgoing_.z, alpha_) * ggx::distribution(h, alpha_) / (4 * outgoing_.z);
}

float Bsdf::pdf(Direction incoming) const {
  const Vec3 in = frame_.toLocal(incoming);
  if (!(in.z > 0)) return 0.0f;
  float pdf = (1 - choose_specular_) * in.z * kInvPi;
  if (specular_) pdf += choose_specular_ * ggxPdf(in);
  return pdf;
}

BsdfSample Bsdf::sample(Vec2 u, float lobe) const {
  BsdfSample s;
  if (black()) return s;
  Vec3 in;
  if (lobe < choose_specular_) {
    const Vec3 h = ggx::sampleVisibleNormal(outgoing_, alpha_, u);
    in = 2 * glm::dot(outgoing_, h) * h - outgoing_;
  } else {
    in = squareToCosineHemisphere(u);
  }
  if (!(in.z > 0)) return s;
  s.direction = glm::normalize(frame_.toWorld(in));
  s.pdf = pdf(s.direction);
  if (s.pdf > 0) s.weight = evaluate(s.direction) / s.pdf;
  return s;
}

Normal validShadingNormal(Normal shading, Normal geometric, Direction outgoing) {
  // The mirror image needs to rise above the surface by this cosine: a little, but never more than the view.
  const float least = std::min(0.01f, 0.9f * glm::dot(outgoing, geometric));
  const auto valid = [&](Normal n) {
    const float c = glm::dot(outgoing, n);
    return c > 0 && glm::dot(2 * c * n - outgoing, geometric) >= least;
  };
  if (valid(shading)) return shading;
  float lo = 0.0f, hi = 1.0f;  // share of the geometric normal: too little, enough
  for (int step = 0; step < 10; ++step) {
    const float middle = 0.5f * (lo + hi);
    (valid(glm::normalize(glm::mix(shading, geometric, middle))) ? hi : lo) = middle;
  }
  return glm::normalize(glm::mix(shading, geometric, hi));
}

}  // namespace relume::transport
