// SPDX-License-Identifier: MIT
// A scene as plain data: what the baker and the renderers see. World units are metres, +Y up.
// Made by relume/scene/gltf.h from a glTF document, or by hand in tests.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relume/core/light.h"
#include "relume/core/quantity.h"
#include "relume/core/vec.h"
#include "relume/image/image.h"
#include "relume/scene/environment.h"

namespace relume::scene {

inline constexpr std::uint32_t kNone = 0xffffffffu;

/// One glTF primitive as an indexed triangle list, in mesh space.
struct Mesh {
  std::string name;  ///< "mesh name" or "mesh name[primitive]"
  std::uint32_t gltf_mesh = kNone, gltf_primitive = kNone;

  std::vector<Point> positions;
  std::vector<Normal> normals;  ///< per vertex; made from the faces where the file has none
  std::vector<Vec4> tangents;   ///< per vertex or empty; w is the handedness
  /// TEXCOORD_0, TEXCOORD_1...; each per vertex or empty. Sets beyond 1 are read where the material's
  /// textures use them.
  std::array<std::vector<Vec2>, 4> uv;
  std::vector<Vec4> colours;         ///< COLOR_0, linear, per vertex or empty
  std::vector<UVec3> triangles;      ///< indices into the vertices; valid, but may be degenerate
  std::uint32_t material = 0;        ///< index into Scene::materials
  bool flat_normals = false;         ///< normals were missing: each triangle shades with its face normal
  std::uint32_t atlas_page = kNone;  ///< page of an earlier bake that TEXCOORD_1 refers to; kNone: not baked
  /// Which element of the glTF accessors each vertex is, where vertices that no triangle uses were left out;
  /// empty: the same.
  std::vector<std::uint32_t> gltf_vertex;
};

enum class Wrap : std::uint8_t { kRepeat, kClamp, kMirror };

/// A decoded 8-bit image; look-ups are bilinear and wrap as the sampler says.
struct Texture {
  std::shared_ptr<const image::Image8>
      image;  ///< null when it could not be read (a warning was given): reads as white
  bool srgb = false;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;

  /// Linear RGBA at uv.
  Vec4 sample(Vec2 uv) const;
};

/// A material's use of a texture.
struct TextureRef {
  std::uint32_t texture = kNone;
  std::uint32_t uv_set = 0;
  Vec2 offset{0.0f}, scale{1.0f};  ///< KHR_texture_transform
  float rotation = 0.0f;           ///< radians
  explicit operator bool() const { return texture != kNone; }
  Vec2 apply(Vec2 uv) const;  ///< the texture coordinate after the transform
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

struct Material {
  std::string name;
  std::string group;  ///< of lights, for what emits; empty: its name
  Vec4 base_colour{1.0f};
  TextureRef base_colour_texture;
  float metallic = 1.0f, roughness = 1.0f;
  TextureRef metallic_roughness_texture;
  TextureRef normal_texture;
  float normal_scale = 1.0f;
  /// Relief (extras.relume.height): heights in the first channel, 1 on top, where the mesh is; 0 is
  /// height_scale below it, a share of the map's width along u. Shown by OpenGL alone; rays meet the mesh.
  TextureRef height_texture;
  float height_scale = 0.05f;
  Vec3 emission{0.0f};  ///< emissiveFactor * emissiveStrength, radiance
  TextureRef emission_texture;
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;         ///< KHR_materials_unlit: neither reflects nor emits light
  float transmission = 0.0f;  ///< KHR_materials_transmission
};

struct Camera {
  std::string name;
  Mat4 world_from_camera{1.0f};  ///< looks along -z, +y up
  float vertical_fov = 0.8f;     ///< radians; ignored when orthographic
  bool orthographic = false;
  float ortho_height = 2.0f;  ///< metres
};

/// A mesh placed in the world by a node.
struct Instance {
  std::string name;            ///< the node's name or "node N"
  std::uint32_t mesh = 0;      ///< index into Scene::meshes
  std::uint32_t node = kNone;  ///< glTF node
  std::uint32_t copy =
      kNone;  ///< which of the node's EXT_mesh_gpu_instancing copies; kNone: the node has none
  Mat4 world_from_local{1.0f};
  bool dynamic = false;  ///< animated, skinned, morphed or marked: kept, not baked, casts no baked shadow
};

struct Scene {
  std::string name;  ///< file name, for messages
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Material> materials;  ///< last: glTF's default material
  std::vector<Texture> textures;
  std::vector<Light> lights;
  std::vector<Box3> light_boxes;  ///< where lights may be, as the author says; empty: nobody said
  Environment environment;        ///< glTF has none: dark until somebody sets it
  std::vector<Camera> cameras;

  Box3 bounds() const;                ///< of static instances, world
  std::size_t triangleCount() const;  ///< of static instances
};

/// Surface attributes at barycentrics (b1, b2) of a triangle of an instance: weights of the vertices are
/// (1-b1-b2, b1, b2).
struct Hit {
  std::uint32_t instance = kNone, triangle = 0;
  float b1 = 0, b2 = 0;
};
Point worldPosition(const Scene& scene, const Hit& hit);
/// By winding, world space; zero where the triangle is degenerate. A mirroring transform keeps the outside
/// outside.
Normal geometricNormal(const Scene& scene, std::uint32_t instance, std::uint32_t triangle);
/// Interpolated vertex normal, world, on the geometric normal's side.
Normal shadingNormal(const Scene& scene, const Hit& hit);
/// The shading normal bent by the material's normal map, world, on the geometric normal's side; without a
/// map, or without texture coordinates that span the surface, the shading normal. Tangents are the mesh's, or
/// made from the map's texture coordinates.
Normal mappedNormal(const Scene& scene, const Hit& hit);
Vec2 textureCoordinate(const Scene& scene, const Hit& hit, std::uint32_t set);

/// What a surface is made of at one point. An unlit surface reports metallic 1 and no emission, so that its
/// albedo is 0 while its colour can still be shown.
struct Surface {
  Vec4 base_colour{1.0f};  ///< factor * texture * vertex colour, linear
  float metallic = 1, roughness = 1;
  Radiance emission;
  /// Diffuse albedo: baseColor * (1 - metallic); 0 for unlit.
  Albedo albedo() const { return Albedo(Vec3(base_colour) * (1.0f - metallic)); }
};
Surface surfaceAt(const Scene& scene, const Hit& hit);
/// Opacity in [0, 1] that rays see: 1 for OPAQUE, 0 or 1 for MASK, alpha for BLEND; transmission is not
/// opacity.
float opacityAt(const Scene& scene, const Hit& hit);

}  // namespace relume::scene
