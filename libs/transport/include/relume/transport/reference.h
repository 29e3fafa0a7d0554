// SPDX-License-Identifier: MIT
// The truth that everything else is compared with: unbiased path tracing with next-event estimation, multiple
// importance sampling and Russian roulette. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Sections 11.1, 11.2: the rendering
//   equation (11.2), solved by random walks from the eye or from a lit point.
//   [Veach97] Veach. Robust Monte Carlo Methods for Light Transport Simulation. Thesis, 1997. Section 9.2.4:
//   the power heuristic with exponent 2.
// Conventions: docs/concept.md; irradiance is E. A bounce is a reflection between an emitter and the surface
// that is seen or lit: with 0 bounces there is direct light only. Surfaces reflect on both sides; those of
// single-sided materials emit on their front only. Shading normals turn the lobes, but no light passes
// through a surface: directions under its true plane count for nothing. Unlit materials (KHR_materials_unlit)
// are black to light and show their colour to the eye. Thin transmission goes straight on, tinted, also for
// rays to lights. Area lights of a light file (disks, polygons) are seen and block nothing. Limits: no
// refraction, no volumes; caustics of small lights in near mirrors converge slowly, and those of point lights
// in mirrors through transmission are as sharp as alpha = 0.001 lets them be.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relume/core/progress.h"
#include "relume/core/quantity.h"
#include "relume/image/image.h"
#include "relume/scene/scene.h"
#include "relume/trace/tracer.h"

namespace relume::transport {

enum class Estimator : std::uint8_t {
  kMis,        ///< both of the following, combined
  kBsdfOnly,   ///< light is found by chance; point, spot and unsized directional lights never
  kLightOnly,  ///< light is sampled only
};
enum class Materials : std::uint8_t {
  kFull,     ///< metallic-roughness (bsdf.h) with normal maps
  kLambert,  ///< diffuse, albedo = base colour (1 - metallic), no normal maps: the world of lightmaps
};
enum class Part : std::uint8_t {
  kTotal,
  kDirect,    ///< light that comes straight from emitters to the surface seen or lit
  kIndirect,  ///< the rest
};

struct ReferenceOptions {
  static constexpr int kUnlimited = -1;
  std::uint32_t samples = 64;  ///< paths per pixel or point; with a target error the most of them
  /// Stop where the estimated standard error of luminance is below this share of the luminance; 0: never.
  /// Judged over points one by one and over blocks of 16 x 16 pixels (RMS of the error, mean luminance), in
  /// rounds of twice as many samples; what is darker than a tenth of the median counts as that bright.
  /// Stopping early leaves a bias far below the error itself.
  float target_error = 0.0f;
  int max_bounces = kUnlimited;
  std::uint64_t seed = 1;
  Estimator estimator = Estimator::kMis;
  Materials materials = Materials::kFull;
  Part part = Part::kTotal;
  Vec3 background{0.0f};  ///< what the eye sees where there is nothing, if there is no environment
};

/// A place that receives light. Normals: unit, on one side.
struct Receiver {
  Point position{0};
  Normal geometric_normal{0, 0, 1}, shading_normal{0, 0, 1};
};

/// The ray of a place in the picture, in pixels from its upper left corner.
using PrimaryRay = std::function<trace::Ray(Vec2)>;

struct ReferenceImage {
  image::Image radiance;      ///< RGB, tent filter of one pixel's radius
  image::Image error;         ///< one channel: estimated standard error of the luminance
  std::uint64_t samples = 0;  ///< paths traced
};
struct ReferenceIrradiance {
  std::vector<Irradiance> value;
  std::vector<Irradiance> error;  ///< estimated standard error of each channel
  std::uint64_t samples = 0;
};

/// Errors are estimated from independent runs of each pixel (4) and point (16), so they hold for the
/// low-discrepancy samples within the runs; with fewer samples than runs they are 0. Bits do not depend on
/// the number of threads.
class Reference {
 public:
  /// Keeps a reference to `scene`, which must not change. Throws as Tracer.
  explicit Reference(const scene::Scene& scene, const trace::TracerOptions& options = {});
  ~Reference();
  Reference(Reference&&) noexcept;

  /// What its rays are traced by; stops at transmission.
  const trace::Tracer& tracer() const;

  /// Throws Error kInterrupted.
  ReferenceImage image(int width, int height, const PrimaryRay& primary, const ReferenceOptions& options,
                       Progress& progress) const;
  /// Throws Error kInterrupted.
  ReferenceIrradiance irradiance(std::span<const Receiver> receivers, const ReferenceOptions& options,
                                 Progress& progress) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relume::transport
