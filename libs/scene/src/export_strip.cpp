// SPDX-License-Identifier: MIT
// Undoes what export did to a document, so that a bake can be baked again without growing. What was changed
// is known by notes in `extras`; whatever other tools did to the file since stays.
#include <algorithm>

#include "export.h"
#include "extensions.h"

namespace relume::scene::gltf {

using Json = nlohmann::json;

namespace {

void stripPrimitive(Json& primitive) {
  Json* extensions = fieldOf(primitive, "extensions");
  if (!extensions || !fieldOf(*extensions, kTransferExtension)) return;
  eraseExtension(primitive, kTransferExtension);
  Json* attributes = fieldOf(primitive, "attributes");
  if (!attributes || !attributes->is_object() || !attributes->contains("TEXCOORD_1") ||
      attributes->contains("TEXCOORD_2"))
    return;
  // TEXCOORD_0 had to exist for TEXCOORD_1 to be legal, and was made to be the same.
  if (attributes->contains("TEXCOORD_0") && (*attributes)["TEXCOORD_0"] == (*attributes)["TEXCOORD_1"])
    attributes->erase("TEXCOORD_0");
  attributes->erase("TEXCOORD_1");
}

void restoreOcclusion(Json& material) {
  Json* original = findNote(material, "occlusionTexture");
  if (!original) return;
  if (original->is_null())
    material.erase("occlusionTexture");
  else
    material["occlusionTexture"] = *original;
  eraseNote(material, "occlusionTexture");
}

void restoreLightmap(Json& material) {
  Json* original = findNote(material, kLightmapExtension);
  if (!original) return;
  if (original->is_null())
    eraseExtension(material, kLightmapExtension);
  else
    material["extensions"][kLightmapExtension] = *original;
  eraseNote(material, kLightmapExtension);
}

void stripMaterials(Json& doc) {
  Json* found = fieldOf(doc, "materials");
  if (!found || !found->is_array()) return;
  Json& materials = *found;
  const std::size_t count = materials.size();
  // What a copy's users go back to: its original where that is still the same, or no material at all.
  std::vector<std::optional<std::uint32_t>> original(count);
  std::vector<bool> stands_for_none(count), gone(count);
  for (std::size_t m = 0; m < count; ++m) {
    Json& material = materials[m];
    restoreOcclusion(material);
    restoreLightmap(material);
    if (const Json* copied = findNote(material, "copyOf")) original[m] = asIndex(*copied, count);
    stands_for_none[m] = findNote(material, "standsForNone") != nullptr;
    eraseNote(material, "copyOf");
    eraseNote(material, "standsForNone");
  }
  for (std::size_t m = 0; m < count; ++m) {
    if (original[m] && (*original[m] == m || materials[*original[m]] != materials[m])) original[m].reset();
    gone[m] = stands_for_none[m] || original[m].has_value();
  }
  const auto send_back = [&](Json& user) {
    Json* reference = fieldOf(user, "material");
    const auto m = reference ? asIndex(*reference, count) : std::nullopt;
    if (!m || !gone[*m]) return;
    if (original[*m] && !gone[*original[*m]])
      *reference = *original[*m];
    else if (stands_for_none[*m])
      user.erase("material");
    else
      gone[*m] = false;
  };
  visitPrimitives(
      doc, [&](Json& primitive, std::uint32_t, std::uint32_t) { visitMaterialUsers(primitive, send_back); });
  while (!materials.empty() && gone[materials.size() - 1]) materials.erase(materials.size() - 1);
  if (materials.empty()) doc.erase("materials");
}

}  // namespace

void removeEarlierBake(Json& doc) {
  eraseExtension(doc, kTransferExtension);
  visitPrimitives(doc, [](Json& primitive, std::uint32_t, std::uint32_t) { stripPrimitive(primitive); });
  stripMaterials(doc);
}

}  // namespace relume::scene::gltf
