// SPDX-License-Identifier: MIT
// The only importer and exporter of glTF. The document keeps the JSON whole, so that everything a file says
// survives, known here or not; import makes plain scene data out of it; export adds the bake.
#pragma once
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relume/core/error.h"
#include "relume/scene/scene.h"

namespace relume::scene::gltf {

/// A glTF file in memory: JSON and resolved buffers (GLB chunk, data URIs, external files; meshopt-compressed
/// views are decompressed on first use). Every index and range is checked where it is used.
class Document {
 public:
  /// Throws Error: kFileNotFound, kNotGltf, kTruncated, kInvalidJson, kUnsupported (a required extension, a
  /// version)...
  static Document read(const std::filesystem::path& path);
  /// From memory; external URIs are looked for in `folder` (none may be read when it is empty).
  static Document parse(std::span<const std::byte> file, const std::string& name,
                        const std::filesystem::path& folder);

  const nlohmann::json& json() const { return json_; }
  const std::string& name() const { return name_; }

 private:
  friend class Access;  // src/: bounds-checked views and accessors
  struct Container;
  static Document fromContainer(Container container, const std::string& name,
                                const std::filesystem::path& folder);

  nlohmann::json json_;
  std::string name_;
  std::filesystem::path folder_;
  /// Bytes of each glTF buffer; nothing where the file gives none (the fallback of compressed views).
  std::vector<std::optional<std::vector<std::byte>>> buffers_;
  std::size_t input_bytes_ = 0;  ///< of the file and its buffers: what sizes in it are judged by
};

/// Which texture files import decodes. Those left out read as white.
enum class TextureUse : std::uint8_t {
  kNone,
  kOpacity,  ///< base colours of MASK and BLEND materials: what rays need
  kLight,    ///< also what reflects and emits: base colour, metallic-roughness, emission
};

struct ImportOptions {
  TextureUse textures = TextureUse::kLight;
  bool normal_maps = false;  ///< also decode normal textures and height maps, and read tangents
};

/// Scene data of the document's default scene (its first where none is named, all root nodes where there is
/// none). What is unusable but dispensable (a missing texture, a triangle with a NaN) is left out with a
/// warning; what makes the file meaningless throws Error naming file and place; a scene without a triangle
/// throws kEmptyScene. A primitive without material gets the last material: white dielectric of albedo 0.8,
/// since glTF's own default, white metal, reflects no diffuse light.
Scene import(const Document& document, Warnings& warnings, const ImportOptions& options = {});

/// The bake of one instance primitive: how its vertices are split and where they lie in the atlas.
/// Instances that share a mesh and a split share vertex data in the output; each has its own TEXCOORD_1.
struct AtlasUse {
  std::uint32_t instance = 0;                ///< index into Scene::instances
  std::uint32_t page = 0;                    ///< atlas page, i.e. which occlusion texture
  std::vector<std::uint32_t> source_vertex;  ///< new vertex -> vertex of Scene mesh
  std::vector<UVec3> triangles;              ///< of new vertices; same order as Mesh::triangles
  std::vector<Vec2> uv;                      ///< TEXCOORD_1 of each new vertex, in [0, 1]
};

/// A page of irradiance for viewers: E = intensity * texel.
struct LightmapPage {
  std::vector<std::byte> png;  ///< RGB, linear
  float intensity = 1;         ///< W/m^2
};

struct BakeOutput {
  std::vector<AtlasUse> uses;
  /// PNG files, one per page, wired as occlusionTexture on TEXCOORD_1 of the materials used there; empty:
  /// leave materials.
  std::vector<std::vector<std::byte>> occlusion_png;
  /// One per page, wired as MOZ_lightmap on TEXCOORD_1 of the materials used there, but for unlit ones;
  /// empty: leave materials.
  std::vector<LightmapPage> lightmap;
  /// Root extension RELUME_transfer: its JSON, in which {"bufferView": k} counts in `views`; null: none.
  nlohmann::json transfer;
  std::vector<std::vector<std::byte>> views;
};

/// The document as a .glb that carries the bake. Every baked primitive gets extensions.RELUME_transfer =
/// {"page": n}. Deterministic bytes. An earlier bake in the document (extension, planes, its occlusion
/// textures) is replaced.
std::vector<std::byte> exportGlb(const Document& document, const Scene& scene, const BakeOutput& bake);

}  // namespace relume::scene::gltf
