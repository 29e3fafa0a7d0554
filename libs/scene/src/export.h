// SPDX-License-Identifier: MIT
// The steps of export. The output starts as a copy of the document's JSON; each step changes one thing of it.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "access.h"
#include "extensions.h"
#include "relume/core/hash.h"
#include "relume/scene/gltf.h"

namespace relume::scene::gltf {

/// The file being made: JSON, and where the bytes of each of its buffer views come from.
class Output {
 public:
  explicit Output(const Document& document);

  nlohmann::json doc;
  Access in;  ///< the document

  struct Piece {
    std::uint32_t input_view = kNone;  ///< a view of the document, or
    std::vector<std::byte> bytes;      ///< new bytes
  };
  std::vector<Piece> pieces;  ///< of each buffer view

  /// Appends a view, or finds one that was added with the same fields and bytes.
  std::uint32_t addView(std::vector<std::byte> bytes, nlohmann::json fields = nlohmann::json::object());
  /// Appends an accessor with a view of its own; `fields` has type, componentType...; deduplicated like
  /// views. target: 34962 vertices, 34963 indices. A stride of 0 means without gaps.
  std::uint32_t addAccessor(nlohmann::json fields, std::vector<std::byte> bytes, std::size_t stride,
                            int target);

 private:
  std::map<Digest, std::uint32_t> known_views_, known_accessors_;
};

/// The array `key` of an object, made empty where it is missing.
nlohmann::json& arrayOf(nlohmann::json& object, const char* key);
/// A field of an object, or null where there is none or it is no object.
nlohmann::json* fieldOf(nlohmann::json& object, const char* key);
/// An index as JSON writes it; nothing when it is no number below `count`.
std::optional<std::uint32_t> asIndex(const nlohmann::json& value, std::size_t count);
/// extras.relume of an object, made where it is missing.
nlohmann::json& notesOf(nlohmann::json& object);
/// extras.relume[key], or null.
nlohmann::json* findNote(nlohmann::json& object, const char* key);
/// Removes extras.relume[key], and what that leaves empty.
void eraseNote(nlohmann::json& object, const char* key);
/// Removes extensions[name], and what that leaves empty.
void eraseExtension(nlohmann::json& object, const char* name);

/// Calls visit(holder) for each object of a primitive whose field "material" may name a material.
template <class Visit>
void visitMaterialUsers(nlohmann::json& primitive, Visit visit) {
  visit(primitive);
  nlohmann::json* extensions = fieldOf(primitive, "extensions");
  nlohmann::json* variants = extensions ? fieldOf(*extensions, "KHR_materials_variants") : nullptr;
  nlohmann::json* mappings = variants ? fieldOf(*variants, "mappings") : nullptr;
  if (mappings && mappings->is_array())
    for (nlohmann::json& mapping : *mappings) visit(mapping);
}

/// Calls visit(primitive, mesh, index) for each primitive of the JSON.
template <class Visit>
void visitPrimitives(nlohmann::json& doc, Visit visit) {
  nlohmann::json* meshes = fieldOf(doc, "meshes");
  if (!meshes || !meshes->is_array()) return;
  for (std::uint32_t m = 0; m < meshes->size(); ++m)
    if (nlohmann::json* primitives = fieldOf((*meshes)[m], "primitives");
        primitives && primitives->is_array())
      for (std::uint32_t p = 0; p < primitives->size(); ++p) visit((*primitives)[p], m, p);
}

/// Takes an earlier bake out of the JSON: the extension, TEXCOORD_1, occlusion textures, copied materials.
void removeEarlierBake(nlohmann::json& doc);

/// Images by URI become buffer views.
void embedImages(Output& out);

/// A primitive of the output that is baked.
struct BakedPrimitive {
  std::uint32_t mesh = 0, primitive = 0;  ///< of the output
  std::uint32_t page = 0;
  std::uint32_t moved_set = 0;  ///< where the former TEXCOORD_1 went, because materials use it; 0: nowhere
};

/// Gives every baked node a mesh of its own, with TEXCOORD_1 and vertices split as the bake says.
std::vector<BakedPrimitive> rewriteMeshes(Output& out, const Scene& scene, const BakeOutput& bake);

/// Occlusion textures, and the materials that use them.
void wireMaterials(Output& out, const std::vector<BakedPrimitive>& baked, const BakeOutput& bake);

/// Calls visit(key, info) with every texture reference (textureInfo) of a material, known by its field
/// "index".
template <class Visit>
void visitTextureInfos(nlohmann::json& value, Visit visit) {
  if (!value.is_object()) return;
  for (auto& [key, child] : value.items()) {
    if (key == "extras" || !child.is_object()) continue;
    if (child.contains("index"))
      visit(key, child);
    else
      visitTextureInfos(child, visit);
  }
}
/// The TEXCOORD set a textureInfo reads, KHR_texture_transform considered; the second form changes it.
std::uint64_t texCoordOf(nlohmann::json& info);
void setTexCoord(nlohmann::json& info, std::uint32_t set);

/// Drops what nothing refers to any more, numbers what is left anew, and joins everything into one binary.
std::vector<std::byte> assemble(Output& out);

}  // namespace relume::scene::gltf
