// SPDX-License-Identifier: MIT
// The views. With k = albedo / pi, W the baked value and E the direct irradiance of visible lights:
//   obscurance   L = k I_A W + emission                                              ([IKSZ03] eq. 4)
//   lit          L = k ((I_A + beta sum_j E_j) W + E) + emission                     ([IKSZ03] eq. 5)
//   lightmap     L = k E + emission, E the baked irradiance
//   the same of directional light: E for the normal-mapped normal, and glossy lobes (glossy_surface.h)
//   relit        L = k (E + I') + emission, I' = I (1 - o + o W) + b W E, I the relit indirect irradiance
//                ([LPM] section 10; o and b are PictureOptions' obscurance and bounce); indirect: L = k I'
// where E_j counts every light, turned or hidden or not (eq. 7), and k_A = k_D = k.
// Beyond the paper: metals have no diffuse albedo and would be black, so for display they reflect all light
// as if diffusely: k is base colour / pi everywhere, which is albedo / pi where nothing is metallic. That is
// no more than an approximation for looking at scenes. Unlit materials show their base colour. Surfaces are
// lit on the side from which they are seen. Without a bake W = 1, and in the lit view there is ambient light
// only.
#include "shader.h"

#include <array>
#include <cmath>

#include "glossy_surface.h"
#include "relume/core/check.h"
#include "relume/image/colour.h"

namespace relume::picture {
namespace {

constexpr Vec3 kWithoutBake{1.0f, 0.0f, 1.0f};
constexpr Vec3 kInvalid{1.0f, 0.0f, 0.0f};
constexpr Vec3 kValid{0.5f};
constexpr Vec3 kNoChart{0.2f};

/// Shades labels as if by a lamp at the viewer, so that shapes stay readable; 1 where the surface faces the
/// viewer.
float headlight(Normal n, Direction to_viewer) { return 0.4f + 0.6f * std::abs(glm::dot(n, to_viewer)); }

Vec3 asColour(Normal n) { return 0.5f * (n + Vec3(1.0f)); }

/// Texels alternate in brightness and blocks of 8 x 8 in hue, so that the grid reads from near and far.
Vec3 checker(Vec2 texel) {
  const auto parity = [](Vec2 p) {
    const Vec2 cell = glm::floor(p);
    return std::fmod(std::abs(cell.x + cell.y), 2.0f) >= 1.0f;
  };
  const Vec3 hue = parity(texel / 8.0f) ? Vec3(1.0f, 0.75f, 0.4f) : Vec3(0.4f, 0.75f, 1.0f);
  return hue * (parity(texel) ? 1.0f : 0.45f);
}

/// Lifts dark values so that the grid can be seen in corners too.
Vec3 lifted(Vec3 value) { return 0.2f + 0.8f * value; }

}  // namespace

Vec3 Shader::lit(const ShadingPoint& point, const Receiver& receiver, Irradiance direct) const {
  const scene::Scene& scene = tracer_.scene();
  const scene::Surface surface = scene::surfaceAt(scene, point.where);
  const Vec3 base = Vec3(surface.base_colour);
  const scene::Instance& instance = scene.instances[point.where.instance];
  if (scene.materials[scene.meshes[instance.mesh].material].unlit) return base + surface.emission.rgb;

  Irradiance ambient = options_.ambient;
  const auto place = baked_.locate(point.where);
  if (options_.view == View::kLightmap) {
    if (directions_ && place)
      return lightFromAllSides(point, receiver, surface, *place) + surface.emission.rgb;
    direct = place ? Irradiance(baked_.value(*place)) : ambient;
    ambient = Irradiance(0.0f);
  } else if (options_.view == View::kRelit || options_.view == View::kIndirect) {
    const bool lamps = options_.view == View::kRelit;
    ambient += place ? Irradiance(baked_.value(*place)) : Irradiance(0.0f);
    if (place) {
      const Vec3 w = baked_.obscurance(*place);
      ambient = Irradiance(ambient.rgb * glm::mix(Vec3(1), w, options_.obscurance) +
                           options_.bounce * w * direct.rgb);
    }
    if (!lamps) return reflected(Albedo(base), ambient).rgb;
  } else if (place) {
    if (options_.view == View::kLit)
      ambient += options_.beta * unoccludedIrradiance(options_.lights, receiver.position);
    ambient = Irradiance(ambient.rgb * baked_.value(*place));
  } else {
    direct = Irradiance(0.0f);
  }
  return (reflected(Albedo(base), ambient + direct) + surface.emission).rgb;
}

Vec3 Shader::lightFromAllSides(const ShadingPoint& point, const Receiver& receiver,
                               const scene::Surface& surface, const BakedValues::Place& place) const {
  std::array<float, BakedDirections::kMost> numbers;
  const basis::Basis& basis = directions_->basis();
  const auto coefficients = std::span(numbers).first(basis.coefficients());
  if (!directions_->coefficients(baked_, place, coefficients))
    return reflected(Albedo(Vec3(surface.base_colour)), Irradiance(baked_.value(place))).rgb;
  const scene::Scene& scene = tracer_.scene();
  const Normal own = scene::shadingNormal(scene, point.where);
  const basis::Receiver at(own);
  Normal normal = scene::mappedNormal(scene, point.where);
  // Light is known on the side that the normal points to; seen from behind it is shown likewise.
  const Direction to_viewer =
      glm::dot(receiver.shading, own) < 0 ? glm::reflect(point.to_viewer, own) : point.to_viewer;
  if (glm::dot(normal, to_viewer) <= 0) normal = own;
  if (options_.gloss == Gloss::kNone)
    return reflected(Albedo(Vec3(surface.base_colour)), basis.irradiance(at, coefficients, normal)).rgb;
  return reflectedLight(basis, at, coefficients, surface, normal, to_viewer, options_.gloss);
}

Vec3 Shader::data(const ShadingPoint& point, const Receiver& receiver) const {
  const scene::Scene& scene = tracer_.scene();
  const auto place = baked_.locate(point.where);
  switch (options_.view) {
    case View::kAlbedo: {
      return scene::surfaceAt(scene, point.where).albedo().rgb;
    }
    case View::kNormal:
      return asColour(scene::shadingNormal(scene, point.where));
    case View::kOcclusion:
      return place ? baked_.value(*place) : Vec3(1.0f);
    case View::kBentNormal: {
      const Normal n = scene::shadingNormal(scene, point.where);
      return asColour(place ? baked_.bentNormal(*place, n) : n);
    }
    case View::kTexels:
      if (!place) return kWithoutBake * headlight(receiver.shading, point.to_viewer);
      return lifted(baked_.value(*place)) * checker(place->texel);
    case View::kCharts: {
      const auto entry = place ? baked_.tableIndex(*place) : std::nullopt;
      const Vec3 colour = entry ? image::labelColour(baked_.table().chart[*entry]) : kNoChart;
      return colour * headlight(receiver.shading, point.to_viewer);
    }
    case View::kValidity: {
      const auto entry = place ? baked_.tableIndex(*place) : std::nullopt;
      const Vec3 colour = !entry ? kWithoutBake : baked_.table().valid[*entry] ? kValid : kInvalid;
      return colour * headlight(receiver.shading, point.to_viewer);
    }
    case View::kObscurance:
    case View::kLit:
    case View::kLightmap:
    case View::kRelit:
    case View::kIndirect:
      break;
  }
  RELUME_CHECK(false);
  return {};
}

void Shader::shade(std::span<const ShadingPoint> points, std::span<Vec3> colours) const {
  constexpr std::size_t kPacket = trace::Tracer::kPacket;
  RELUME_CHECK_EQ(points.size(), colours.size());
  RELUME_CHECK_LE(points.size(), kPacket);
  const scene::Scene& scene = tracer_.scene();
  const bool lamps = options_.view == View::kLit || options_.view == View::kRelit ||
                     (options_.view == View::kIndirect && options_.bounce > 0);
  std::array<Receiver, kPacket> receivers;
  std::array<Irradiance, kPacket> direct;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ShadingPoint& p = points[i];
    Receiver& r = receivers[i];
    r.position = scene::worldPosition(scene, p.where);
    r.geometric = scene::geometricNormal(scene, p.where.instance, p.where.triangle);
    r.shading = scene::shadingNormal(scene, p.where);
    if (glm::dot(r.geometric, p.to_viewer) < 0) r.geometric = -r.geometric, r.shading = -r.shading;
    r.shadow_origin = lamps ? shadowOrigin(scene, p.where, r.position, r.geometric) : r.position;
    r.pixel = p.pixel;
    r.sample = p.sample;
  }
  if (lamps)
    directIrradiance(tracer_, options_.lights, std::span(receivers).first(points.size()),
                     std::span(direct).first(points.size()));
  const bool lights = lamps || options_.view == View::kObscurance || options_.view == View::kLightmap ||
                      options_.view == View::kIndirect;
  for (std::size_t i = 0; i < points.size(); ++i)
    colours[i] = lights ? lit(points[i], receivers[i], direct[i]) : data(points[i], receivers[i]);
}

}  // namespace relume::picture
