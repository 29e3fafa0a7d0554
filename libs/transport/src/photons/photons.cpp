// SPDX-License-Identifier: MIT
#include "relume/transport/photons.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "lightmap/texel_lookup.h"
#include "photons/photon_kernel.h"
#include "photons/photon_map.h"
#include "photons/photon_sampler.h"
#include "photons/photon_source.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "relume/transport/bsdf.h"

namespace relume::transport {
namespace {

constexpr double kUnitsOfPath = 1 << 20;
constexpr std::size_t kGrain = 4096;    // paths
constexpr float kMostSurvival = 0.98f;  // so that a path ends even between perfect mirrors
constexpr float kLeastCosine = 0.02f;   // of an arrival, for bases that divide by it
constexpr float kMostTurn = 8.0f;       // of the factor that shading normals ask for

/// KHR_lights_punctual's window.
float windowAt(float distance, float range) {
  if (!(range < kInfinity)) return 1.0f;
  const float q = distance / range;
  return std::clamp(1.0f - q * q * q * q, 0.0f, 1.0f);
}

/// Where a path lands.
struct Landing {
  scene::Hit hit;
  Direction to_source;  ///< back along the path
  Normal geometric;     ///< on the side of that
  Normal shading;       ///< likewise, with the normal map where materials are full
  bool behind = false;  ///< that is the back of the surface
  Point position;
};

class PhotonWalk {
 public:
  PhotonWalk(const trace::Tracer& tracer, const TexelLookup& lookup, const atlas::Texels& texels,
             const PhotonOptions& options, PhotonMap& map)
      : tracer_(tracer),
        scene_(tracer.scene()),
        lookup_(lookup),
        texels_(texels),
        options_(options),
        map_(map),
        sampler_(options.seed),
        sums_(map.sums()) {}

  void shoot(const PhotonSource& source, std::uint64_t path) {
    sampler_.begin(path);
    const Vec2 choice = sampler_.pair(), place = sampler_.pair(), direction = sampler_.pair();
    Photon photon = source.emit(choice, place, direction);
    // The source's power is the unit's power times all paths.
    const double units = kUnitsOfPath / source.power();
    Flux flux;
    for (int c = 0; c < 3; ++c)
      flux[static_cast<std::size_t>(c)] = std::llround(static_cast<double>(photon.power[c]) * units);
    balance_.shot += flux;
    const std::uint32_t alpha_seed = sampler_.bits();
    for (int bounce = 0;; ++bounce) {
      const trace::RayHit hit =
          tracer_.intersect(photon.ray, alpha_seed + static_cast<std::uint32_t>(bounce));
      ++rays_;
      if (!hit) {
        balance_.escaped += flux;
        return;
      }
      if (photon.range < kInfinity) {
        const Flux left = scaled(flux, Vec3(windowAt(hit.t, photon.range)));
        balance_.faded += flux - left;
        flux = left, photon.range = kInfinity;
      }
      balance_.landed += flux;
      const Landing landing = landingAt(hit, photon.ray.direction);
      deposit(landing, flux, bounce);
      if (options_.max_bounces >= 0 && bounce >= options_.max_bounces) return;
      const Vec3 weight = reflect(landing, photon.ray);
      const float survival = std::min(std::max({weight.x, weight.y, weight.z}), kMostSurvival);
      if (!(survival > 0) || !(sampler_.number() < survival)) return;
      flux = scaled(flux, weight / survival);
      if (flux == Flux{}) return;
      balance_.reflected += flux;
    }
  }

  const PhotonBalance& balance() const { return balance_; }
  std::uint64_t rays() const { return rays_; }

 private:
  Landing landingAt(const trace::RayHit& hit, Direction along) const {
    Landing at;
    at.hit = hit.where, at.to_source = -along;
    at.position = scene::worldPosition(scene_, hit.where);
    at.geometric = scene::geometricNormal(scene_, hit.where.instance, hit.where.triangle);
    at.shading = scene::shadingNormal(scene_, hit.where);
    at.behind = glm::dot(at.geometric, along) > 0;
    if (at.behind) at.geometric = -at.geometric, at.shading = -at.shading;
    return at;
  }

  /// A lightmap's irradiance is that on the smooth surface: of what arrives at an angle to the true one it
  /// takes the share of the cosines ([Veach97] 5.3.2).
  void deposit(const Landing& at, Flux flux, int bounce) {
    const bool counts = options_.part == Part::kTotal || (options_.part == Part::kDirect) == (bounce == 0);
    const std::uint32_t point = counts && !at.behind ? lookup_.point(at.hit) : scene::kNone;
    if (point == scene::kNone) {
      balance_.elsewhere += flux;
      return;
    }
    float cosine = glm::dot(at.geometric, at.to_source);
    if (at.shading != at.geometric) {
      const float smooth = std::max(glm::dot(at.shading, at.to_source), 0.0f);
      flux = scaled(flux, Vec3(std::min(smooth / std::max(cosine, 1e-6f), kMostTurn)));
      cosine = smooth;
    }
    map_.add(point, flux);
    balance_.deposited += flux;
    if (!options_.receiver || !(cosine > 0)) return;
    std::fill(sums_.begin(), sums_.end(), 0.0);
    const Vec3 e(static_cast<float>(flux[0]), static_cast<float>(flux[1]), static_cast<float>(flux[2]));
    options_.receiver->add(basis::Receiver(texels_.points[point].shading_normal),
                           {at.to_source, Irradiance(e), std::max(cosine, kLeastCosine)}, sums_);
    map_.addDirectional(point, sums_);
  }

  /// Where the path goes on, and the share of its flux that goes there, over its probability; 0: nowhere.
  Vec3 reflect(const Landing& at, trace::Ray& next) {
    const scene::Material& material =
        scene_.materials[scene_.meshes[scene_.instances[at.hit.instance].mesh].material];
    if (material.unlit || at.geometric == Normal(0)) return Vec3(0.0f);
    const Vec2 u = sampler_.pair();
    const scene::Surface surface = scene::surfaceAt(scene_, at.hit);
    Vec3 weight;
    if (options_.materials == Materials::kLambert) {
      const Bsdf bsdf = Bsdf::lambert(at.shading, surface.albedo().rgb * (1 - material.transmission));
      const BsdfSample sample = bsdf.sample(u, 0.5f);
      next.direction = sample.direction;
      weight = sample.pdf > 0 ? sample.weight * turn(at, at.shading, next.direction) : Vec3(0.0f);
    } else {
      Normal mapped = at.shading;
      if (material.normal_texture) {
        mapped = scene::mappedNormal(scene_, at.hit);
        if (at.behind) mapped = -mapped;
      }
      const Normal seen = validShadingNormal(mapped, at.geometric, at.to_source);
      const BsdfSample sample = Bsdf::metallicRoughness(seen, surface, material.transmission, at.to_source)
                                    .sample(u, sampler_.number());
      next.direction = sample.direction;
      if (!(sample.pdf > 0) || !(glm::dot(sample.direction, at.geometric) > 0)) return Vec3(0.0f);
      // The same pair of directions as the eye would have it: light from the source, seen along the path.
      const Normal shown = validShadingNormal(mapped, at.geometric, sample.direction);
      const Bsdf bsdf = Bsdf::metallicRoughness(shown, surface, material.transmission, sample.direction);
      const float arrives = glm::dot(shown, at.to_source);
      if (!(arrives > 0)) return Vec3(0.0f);
      weight = bsdf.evaluate(at.to_source) * (glm::dot(shown, sample.direction) / (arrives * sample.pdf)) *
               turn(at, shown, sample.direction);
    }
    if (!(glm::dot(next.direction, at.geometric) > 0)) return Vec3(0.0f);
    next.origin = trace::offsetOrigin(at.position, at.geometric), next.t_max = kInfinity;
    return weight;
  }

  /// [Veach97] (5.19): what a shading normal does to light that is traced away from its source.
  static float turn(const Landing& at, Normal shading, Direction out) {
    if (shading == at.geometric) return 1.0f;
    const float below = glm::dot(at.geometric, at.to_source) * glm::dot(shading, out);
    const float above = glm::dot(shading, at.to_source) * glm::dot(at.geometric, out);
    return below > 0 ? std::clamp(above / below, 0.0f, kMostTurn) : 0.0f;
  }

  const trace::Tracer& tracer_;
  const scene::Scene& scene_;
  const TexelLookup& lookup_;
  const atlas::Texels& texels_;
  const PhotonOptions& options_;
  PhotonMap& map_;
  PhotonSampler sampler_;
  std::vector<double> sums_;
  PhotonBalance balance_;
  std::uint64_t rays_ = 0;
};

}  // namespace

PhotonResult tracePhotons(const trace::Tracer& tracer, const atlas::Atlas& atlas, const atlas::Texels& texels,
                          const PhotonOptions& options, Progress& progress) {
  RELUME_CHECK(options.paths > 0);
  const PhotonSource source(tracer.scene());
  const TexelLookup lookup(tracer.scene(), atlas, texels);
  PhotonMap map(texels.points.size(), options.receiver ? options.receiver->sums() : 0);
  PhotonResult result;
  PhotonBalance& balance = result.balance;
  balance.unit = source.power() / static_cast<double>(options.paths) / kUnitsOfPath;
  std::mutex mutex;
  if (source.power() > 0)
    parallelFor(
        options.paths, kGrain,
        [&](std::size_t begin, std::size_t end) {
          PhotonWalk walk(tracer, lookup, texels, options, map);
          for (std::size_t path = begin; path < end; ++path) walk.shoot(source, path);
          const PhotonBalance& own = walk.balance();
          const std::lock_guard lock(mutex);  // whole numbers: any order is the same
          balance.shot += own.shot, balance.reflected += own.reflected, balance.landed += own.landed;
          balance.escaped += own.escaped, balance.faded += own.faded;
          balance.deposited += own.deposited, balance.elsewhere += own.elsewhere;
          result.rays += walk.rays();
        },
        &progress);
  estimateDensity(map, balance.unit, texels, lookup, options.kernel, result);
  for (std::size_t i = 0; i < texels.points.size(); ++i)
    result.flux.insert(result.flux.end(), map.flux(i).begin(), map.flux(i).end());
  return result;
}

}  // namespace relume::transport
