// SPDX-License-Identifier: MIT
#include "layered_tracer.h"

#include <algorithm>
#include <array>

#include "relume/core/check.h"
#include "relume/core/sampling.h"

namespace relume::picture {
namespace {

// Surfaces so opaque that what is behind them does not show in 8 bits are solid: exporters mark whole scenes
// BLEND.
constexpr float kSolidOpacity = 1.0f - 1.0f / 512.0f;
// A solid surface in the very plane of a decal is seen when another seed lets the ray through the decal; only
// when that many do not is the ray sent on behind both. Misses it with weight a^8 (1 - a) <= 0.043.
constexpr int kSeedsBeforeStep = 8;
// Decals that lie in a solid surface's plane, or behind it by rounding, belong in front.
constexpr float kCoplanar = 1e-5f;

bool mayBeTranslucent(const scene::Scene& scene, const scene::Mesh& mesh) {
  const scene::Material& material = scene.materials[mesh.material];
  if (mesh.triangles.empty()) return false;
  if (material.alpha_mode != scene::AlphaMode::kBlend) return false;
  if (material.base_colour.a < kSolidOpacity || !mesh.colours.empty()) return true;
  if (!material.base_colour_texture) return false;
  const auto& image = scene.textures[material.base_colour_texture.texture].image;
  return image && (image->channels == 2 || image->channels == 4);
}

/// Where a ray goes on behind a surface.
Point behind(const scene::Scene& scene, const scene::Hit& hit, Direction direction) {
  Normal n = scene::geometricNormal(scene, hit.instance, hit.triangle);
  if (glm::dot(n, direction) < 0) n = -n;
  return trace::offsetOrigin(scene::worldPosition(scene, hit), n);
}

}  // namespace

struct LayeredTracer::BlendScene {
  scene::Scene scene;                            ///< the translucent part, as if opaque
  std::vector<std::uint32_t> instance_of_whole;  ///< instance of `scene` -> instance of the whole scene
  std::unique_ptr<trace::Tracer> tracer;
};

LayeredTracer::LayeredTracer(const trace::Tracer& tracer) : tracer_(tracer) {
  const scene::Scene& whole = tracer.scene();
  blend_instance_.assign(whole.instances.size(), 0);
  auto part = std::make_unique<BlendScene>();
  std::vector<std::uint32_t> part_mesh(whole.meshes.size(), scene::kNone);
  for (std::size_t i = 0; i < whole.instances.size(); ++i) {
    const scene::Instance& instance = whole.instances[i];
    const scene::Mesh& mesh = whole.meshes[instance.mesh];
    if (instance.dynamic || !mayBeTranslucent(whole, mesh)) continue;
    blend_instance_[i] = 1;
    std::uint32_t& m = part_mesh[instance.mesh];
    if (m == scene::kNone) {
      m = static_cast<std::uint32_t>(part->scene.meshes.size());
      scene::Mesh& copy = part->scene.meshes.emplace_back();
      copy.positions = mesh.positions;
      copy.normals = mesh.normals;
      copy.triangles = mesh.triangles;
    }
    part->scene.instances.push_back(instance);
    part->scene.instances.back().mesh = m;
    part->instance_of_whole.push_back(static_cast<std::uint32_t>(i));
  }
  if (part->scene.instances.empty()) return;
  part->scene.materials.emplace_back();
  part->tracer = std::make_unique<trace::Tracer>(part->scene);
  blend_ = std::move(part);
}

LayeredTracer::~LayeredTracer() = default;

bool LayeredTracer::isTranslucent(const trace::RayHit& hit) const {
  return hit && blend_instance_[hit.where.instance] && scene::opacityAt(scene(), hit.where) < kSolidOpacity;
}

trace::RayHit LayeredTracer::firstSolid(const trace::Ray& ray, std::uint32_t seed, trace::RayHit hit) const {
  trace::Ray rest = ray;
  float travelled = 0;
  for (int layer = 0; layer < kMaxLayers; ++layer) {
    for (int i = 0; i < kSeedsBeforeStep && isTranslucent(hit); ++i) {
      seed = hashCombine(seed, 0x6c61796du);
      hit = tracer_.intersect(rest, seed);
    }
    if (!isTranslucent(hit)) {
      hit.t += travelled;
      return hit;
    }
    rest.origin = behind(scene(), hit.where, ray.direction);
    travelled += hit.t;
    rest.t_max = ray.t_max - travelled;
    if (rest.t_max <= 0) break;
    hit = tracer_.intersect(rest, seed);
  }
  return {};
}

void LayeredTracer::firstSolid(std::span<const trace::Ray> rays, std::span<const std::uint32_t> seeds,
                               std::span<trace::RayHit> hits) const {
  RELUME_CHECK_EQ(rays.size(), hits.size());
  tracer_.intersectPacket(rays, seeds, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].t_max < 0)
      hits[i] = {};
    else if (blend_ && isTranslucent(hits[i]))
      hits[i] = firstSolid(rays[i], seeds[i], hits[i]);
  }
}

void LayeredTracer::translucent(const trace::Ray& ray, float t_end, std::vector<Translucent>& layers) const {
  if (!blend_) return;
  trace::Ray rest = ray;
  const float t_stop = t_end * (1.0f + kCoplanar);
  float travelled = 0;
  for (int layer = 0; layer < kMaxLayers; ++layer) {
    rest.t_max = t_stop - travelled;
    if (rest.t_max <= 0) return;
    const trace::RayHit hit = blend_->tracer->intersect(rest);
    if (!hit) return;
    scene::Hit where = hit.where;
    where.instance = blend_->instance_of_whole[where.instance];
    travelled += hit.t;
    const float opacity = scene::opacityAt(scene(), where);
    if (opacity >= kSolidOpacity) return;
    if (opacity > 0) layers.push_back({where, travelled, opacity});
    rest.origin = behind(scene(), where, ray.direction);
  }
}

void LayeredTracer::transmittance(std::span<const trace::Ray> rays, std::span<const std::uint32_t> seeds,
                                  std::span<float> transmittances) const {
  RELUME_CHECK_EQ(rays.size(), transmittances.size());
  RELUME_CHECK_LE(rays.size(), trace::Tracer::kPacket);
  if (!blend_) {
    std::array<bool, trace::Tracer::kPacket> occluded{};
    tracer_.occludedPacket(rays, seeds, std::span(occluded).first(rays.size()));
    for (std::size_t i = 0; i < rays.size(); ++i)
      transmittances[i] = rays[i].t_max < 0 || occluded[i] ? 0.0f : 1.0f;
    return;
  }
  std::array<trace::RayHit, trace::Tracer::kPacket> hits;
  firstSolid(rays, seeds, std::span(hits).first(rays.size()));
  std::vector<Translucent> layers;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    transmittances[i] = rays[i].t_max < 0 || hits[i] ? 0.0f : 1.0f;
    if (transmittances[i] == 0) continue;
    layers.clear();
    translucent(rays[i], rays[i].t_max, layers);
    for (const Translucent& layer : layers) transmittances[i] *= 1.0f - layer.opacity;
  }
}

}  // namespace relume::picture
