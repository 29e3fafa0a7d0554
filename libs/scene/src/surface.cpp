// SPDX-License-Identifier: MIT
// Surface attributes at a hit. Normals go through the cofactor matrix, det(M) M^-T, which exists for
// flattening transforms too and for which cof(M) (a x b) = (M a) x (M b).
#include <cmath>

#include "relume/scene/scene.h"

namespace relume::scene {

namespace {

struct Corners {
  const Mesh& mesh;
  UVec3 index;
  Vec3 weight;

  template <class T>
  T interpolate(const std::vector<T>& values) const {
    return weight.x * values[index.x] + weight.y * values[index.y] + weight.z * values[index.z];
  }
  Vec2 uv(std::uint32_t set) const {
    return set < mesh.uv.size() && !mesh.uv[set].empty() ? interpolate(mesh.uv[set]) : Vec2(0);
  }
};

Corners cornersOf(const Scene& scene, const Hit& hit) {
  const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
  return {mesh, mesh.triangles[hit.triangle], {1.0f - hit.b1 - hit.b2, hit.b1, hit.b2}};
}

Vec4 lookUp(const Scene& scene, const TextureRef& ref, const Corners& at) {
  return scene.textures[ref.texture].sample(ref.apply(at.uv(ref.uv_set)));
}

Vec4 baseColour(const Scene& scene, const Material& material, const Corners& at) {
  Vec4 colour = material.base_colour;
  if (material.base_colour_texture) colour *= lookUp(scene, material.base_colour_texture, at);
  if (!at.mesh.colours.empty()) colour *= at.interpolate(at.mesh.colours);
  return colour;
}

Normal unit(Vec3 v) {
  const float squared = glm::dot(v, v);
  if (squared > 1e-30f && squared < 1e30f) return v / std::sqrt(squared);
  const double length = glm::length(glm::dvec3(v));
  return length > 0 && std::isfinite(length) ? Normal(glm::dvec3(v) / length) : Normal(0);
}

}  // namespace

Point worldPosition(const Scene& scene, const Hit& hit) {
  // Corners first, as the tracer has them: where a node brings far coordinates to the origin, the other order
  // would leave points beside the triangle, by more than rays start off it.
  const Mat4& world_from_local = scene.instances[hit.instance].world_from_local;
  const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
  const UVec3 t = mesh.triangles[hit.triangle];
  const auto corner = [&](std::uint32_t i) {
    return Point(world_from_local * Vec4(mesh.positions[i], 1.0f));
  };
  const Point a = corner(t.x);
  return a + hit.b1 * (corner(t.y) - a) + hit.b2 * (corner(t.z) - a);
}

Normal geometricNormal(const Scene& scene, std::uint32_t instance, std::uint32_t triangle) {
  const Instance& placed = scene.instances[instance];
  const Mesh& mesh = scene.meshes[placed.mesh];
  const UVec3 t = mesh.triangles[triangle];
  const Mat3 m(placed.world_from_local);
  const Vec3 n = glm::cross(m * (mesh.positions[t.y] - mesh.positions[t.x]),
                            m * (mesh.positions[t.z] - mesh.positions[t.x]));
  return unit(glm::determinant(m) < 0 ? -n : n);
}

Normal shadingNormal(const Scene& scene, const Hit& hit) {
  const Normal geometric = geometricNormal(scene, hit.instance, hit.triangle);
  const Corners at = cornersOf(scene, hit);
  if (at.mesh.flat_normals || at.mesh.normals.empty()) return geometric;
  const Mat3 m(scene.instances[hit.instance].world_from_local);
  const Mat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  Normal n = unit(cofactor * at.interpolate(at.mesh.normals));
  if (n == Normal(0)) return geometric;
  if (geometric == Normal(0)) return glm::determinant(m) < 0 ? -n : n;
  return glm::dot(n, geometric) < 0 ? -n : n;
}

namespace {

/// World tangent and handedness of the map at a hit; zero where the texture coordinates span nothing.
Vec4 tangentAt(const Scene& scene, const Hit& hit, const Corners& at, const TextureRef& map) {
  const Mat3 m(scene.instances[hit.instance].world_from_local);
  const float mirror = glm::determinant(m) < 0 ? -1.0f : 1.0f;
  if (!at.mesh.tangents.empty()) {
    const Vec4 t = at.interpolate(at.mesh.tangents);
    return {m * Vec3(t), (t.w < 0 ? -1.0f : 1.0f) * mirror};
  }
  const auto& uv = at.mesh.uv[map.uv_set];
  if (uv.empty()) return Vec4(0);
  const Vec2 a = map.apply(uv[at.index.x]), s = map.apply(uv[at.index.y]) - a,
             t = map.apply(uv[at.index.z]) - a;
  const Point p = at.mesh.positions[at.index.x];
  const Vec3 e1 = m * (at.mesh.positions[at.index.y] - p), e2 = m * (at.mesh.positions[at.index.z] - p);
  const float area = s.x * t.y - t.x * s.y;
  if (!(std::abs(area) > 0)) return Vec4(0);
  // v runs downwards in glTF, so the bitangent, which points to the top of the map, is minus dp/dv; with
  // normal = t x b that makes the handedness the sign of minus the area.
  return {(e1 * t.y - e2 * s.y) / area, (area > 0 ? -1.0f : 1.0f) * mirror};
}

}  // namespace

Normal mappedNormal(const Scene& scene, const Hit& hit) {
  const Normal n = shadingNormal(scene, hit);
  const Corners at = cornersOf(scene, hit);
  const Material& material = scene.materials[at.mesh.material];
  if (!material.normal_texture) return n;
  const Texture& texture = scene.textures[material.normal_texture.texture];
  if (!texture.image) return n;
  const Vec4 tangent = tangentAt(scene, hit, at, material.normal_texture);
  const Vec3 t = unit(Vec3(tangent) - glm::dot(Vec3(tangent), n) * n);
  if (t == Vec3(0)) return n;
  Vec3 local = 2.0f * Vec3(lookUp(scene, material.normal_texture, at)) - 1.0f;
  local.x *= material.normal_scale, local.y *= material.normal_scale;
  const Normal bent = unit(local.x * t + local.y * tangent.w * glm::cross(n, t) + local.z * n);
  const Normal geometric = geometricNormal(scene, hit.instance, hit.triangle);
  return bent == Normal(0) || glm::dot(bent, geometric) <= 0 ? n : bent;
}

Vec2 textureCoordinate(const Scene& scene, const Hit& hit, std::uint32_t set) {
  return cornersOf(scene, hit).uv(set);
}

Surface surfaceAt(const Scene& scene, const Hit& hit) {
  const Corners at = cornersOf(scene, hit);
  const Material& material = scene.materials[at.mesh.material];
  Surface surface;
  surface.base_colour = baseColour(scene, material, at);
  if (material.unlit) {
    surface.metallic = 1;
    return surface;
  }
  surface.metallic = material.metallic;
  surface.roughness = material.roughness;
  if (material.metallic_roughness_texture) {
    const Vec4 texel = lookUp(scene, material.metallic_roughness_texture, at);
    surface.roughness *= texel.g;
    surface.metallic *= texel.b;
  }
  if (material.emission != Vec3(0)) {
    surface.emission = Radiance(material.emission);
    if (material.emission_texture) surface.emission.rgb *= Vec3(lookUp(scene, material.emission_texture, at));
  }
  return surface;
}

float opacityAt(const Scene& scene, const Hit& hit) {
  const Corners at = cornersOf(scene, hit);
  const Material& material = scene.materials[at.mesh.material];
  if (material.alpha_mode == AlphaMode::kOpaque) return 1;
  const float alpha = baseColour(scene, material, at).a;
  return material.alpha_mode == AlphaMode::kMask ? (alpha >= material.alpha_cutoff ? 1.0f : 0.0f)
                                                 : glm::clamp(alpha, 0.0f, 1.0f);
}

Box3 Scene::bounds() const {
  Box3 box;
  for (const Instance& instance : instances) {
    if (instance.dynamic) continue;
    const Mesh& mesh = meshes[instance.mesh];
    for (const UVec3 t : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        box.add(Point(instance.world_from_local * Vec4(mesh.positions[t[k]], 1.0f)));
  }
  return box;
}

std::size_t Scene::triangleCount() const {
  std::size_t count = 0;
  for (const Instance& instance : instances)
    if (!instance.dynamic) count += meshes[instance.mesh].triangles.size();
  return count;
}

}  // namespace relume::scene
