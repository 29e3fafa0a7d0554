// SPDX-License-Identifier: MIT
// Textures of the bake: occlusion, and irradiance as MOZ_lightmap. A material that is used on one page alone
// is changed where it stands; for further pages, and beside users that are not baked, it is copied. What was
// there before is noted in extras.relume.
#include <algorithm>
#include <compare>
#include <map>

#include "export.h"
#include "relume/core/check.h"

namespace relume::scene::gltf {

using Json = nlohmann::json;

std::uint64_t texCoordOf(Json& info) {
  const auto set = [](Json* object) -> std::optional<std::uint64_t> {
    Json* field = object ? fieldOf(*object, "texCoord") : nullptr;
    return field && field->is_number_unsigned() ? std::optional(field->get<std::uint64_t>()) : std::nullopt;
  };
  Json* extensions = fieldOf(info, "extensions");
  const auto overriding = set(extensions ? fieldOf(*extensions, "KHR_texture_transform") : nullptr);
  return overriding ? *overriding : set(&info).value_or(0);
}

void setTexCoord(Json& info, std::uint32_t set) {
  info["texCoord"] = set;
  Json* extensions = fieldOf(info, "extensions");
  Json* transform = extensions ? fieldOf(*extensions, "KHR_texture_transform") : nullptr;
  if (transform && fieldOf(*transform, "texCoord")) (*transform)["texCoord"] = set;
}

namespace {

constexpr const char* kPageNotes[] = {"occlusionPage", "lightmapPage"};

bool isSlot(Json& element) {
  return std::ranges::any_of(kPageNotes,
                             [&](const char* note) { return findNote(element, note) != nullptr; });
}

/// The element of doc[list] for the n-th page texture of the bake: one that an earlier bake left, whatever it
/// held, or a new one.
std::uint32_t slotOf(Json& doc, const char* list, std::uint32_t n) {
  Json& array = arrayOf(doc, list);
  for (std::uint32_t i = 0; i < array.size(); ++i)
    if (isSlot(array[i]) && n-- == 0) return i;
  array.push_back(Json::object());
  return static_cast<std::uint32_t>(array.size() - 1);
}

void dropSpareSlots(Json& doc, const char* list, std::size_t needed) {
  Json* array = fieldOf(doc, list);
  if (!array || !array->is_array()) return;
  std::size_t slots = 0;
  for (Json& element : *array) slots += isSlot(element);
  for (; slots > needed && !array->empty() && isSlot(array->back()); --slots) array->erase(array->size() - 1);
  if (array->empty()) doc.erase(list);
}

/// The textures that the bake adds, page by page.
struct PageTextures {
  std::vector<std::uint32_t> occlusion, lightmap;
};

class TextureWriter {
 public:
  explicit TextureWriter(Output& out) : out_(out) {}

  /// Returns the index of the texture.
  std::uint32_t add(const char* note, const char* what, std::uint32_t page,
                    const std::vector<std::byte>& png) {
    constexpr int kLinear = 9729, kLinearMipmapLinear = 9987, kClamp = 33071;
    const std::uint32_t image = slotOf(out_.doc, "images", next_),
                        texture = slotOf(out_.doc, "textures", next_);
    ++next_;
    const std::uint32_t sampler = slotOf(out_.doc, "samplers", 0);
    const std::uint32_t view = out_.addView(png);
    const Json extras = {{kNotes, {{note, page}}}};
    const std::string name = what + std::string(" ") + std::to_string(page);
    out_.doc["images"][image] = {
        {"name", name}, {"bufferView", view}, {"mimeType", "image/png"}, {"extras", extras}};
    out_.doc["textures"][texture] = {
        {"name", name}, {"source", image}, {"sampler", sampler}, {"extras", extras}};
    out_.doc["samplers"][sampler] = {{"magFilter", kLinear},
                                     {"minFilter", kLinearMipmapLinear},
                                     {"wrapS", kClamp},
                                     {"wrapT", kClamp},
                                     {"extras", {{kNotes, {{kPageNotes[0], 0}}}}}};
    return texture;
  }

 private:
  Output& out_;
  std::uint32_t next_ = 0;
};

PageTextures addTextures(Output& out, const BakeOutput& bake) {
  const std::size_t count = bake.occlusion_png.size() + bake.lightmap.size();
  dropSpareSlots(out.doc, "textures", count);
  dropSpareSlots(out.doc, "images", count);
  dropSpareSlots(out.doc, "samplers", count > 0 ? 1 : 0);
  TextureWriter writer(out);
  PageTextures textures;
  for (std::uint32_t p = 0; p < bake.occlusion_png.size(); ++p)
    textures.occlusion.push_back(writer.add(kPageNotes[0], "occlusion", p, bake.occlusion_png[p]));
  for (std::uint32_t p = 0; p < bake.lightmap.size(); ++p)
    textures.lightmap.push_back(writer.add(kPageNotes[1], "lightmap", p, bake.lightmap[p].png));
  return textures;
}

/// How a use of a material differs from the material as it was.
struct Change {
  std::uint32_t page = kNone;   ///< whose textures it shows; kNone: its own
  std::uint32_t moved_set = 0;  ///< where what read TEXCOORD_1 reads now
  auto operator<=>(const Change&) const = default;
  bool none() const { return page == kNone && moved_set == 0; }
};

class Materials {
 public:
  Materials(Output& out, const BakeOutput& bake)
      : doc_(out.doc), bake_(bake), textures_(addTextures(out, bake)) {
    if (Json* materials = fieldOf(doc_, "materials")) originals_ = *materials;
  }

  /// First pass: which changes each material is used with, in order of appearance.
  void meet(std::optional<std::uint32_t> material, Change change) {
    if (!material) return;
    auto& changes = changes_[*material];
    if (std::find(changes.begin(), changes.end(), change) == changes.end()) changes.push_back(change);
  }
  /// Second pass: the material to use; nothing: none, as before.
  std::optional<std::uint32_t> place(std::optional<std::uint32_t> material, Change change);

 private:
  void apply(Json& material, Change change);
  void applyLightmap(Json& material, std::uint32_t page);

  Json& doc_;
  const BakeOutput& bake_;
  Json originals_ = Json::array();  ///< materials before any change
  PageTextures textures_;
  std::map<std::uint32_t, std::vector<Change>> changes_;
  std::map<std::pair<std::optional<std::uint32_t>, Change>, std::uint32_t> placed_;
};

void Materials::apply(Json& material, Change change) {
  if (change.moved_set != 0)
    visitTextureInfos(material, [&](const std::string&, Json& info) {
      if (texCoordOf(info) == 1) setTexCoord(info, change.moved_set);
    });
  if (change.page == kNone) return;
  if (!textures_.lightmap.empty()) applyLightmap(material, change.page);
  if (textures_.occlusion.empty()) return;
  Json* original = fieldOf(material, "occlusionTexture");
  Json kept = original ? *original : Json();
  notesOf(material)["occlusionTexture"] = std::move(kept);
  material["occlusionTexture"] = {{"index", textures_.occlusion[change.page]}, {"texCoord", 1}};
}

void Materials::applyLightmap(Json& material, std::uint32_t page) {
  Json* extensions = fieldOf(material, "extensions");
  // An unlit surface reflects no light; viewers would multiply its colour with the lightmap.
  if (extensions && fieldOf(*extensions, kUnlitExtension)) return;
  Json* original = extensions ? fieldOf(*extensions, kLightmapExtension) : nullptr;
  Json kept = original ? *original : Json();
  notesOf(material)[kLightmapExtension] = std::move(kept);
  material["extensions"][kLightmapExtension] = {
      {"index", textures_.lightmap[page]}, {"texCoord", 1}, {"intensity", bake_.lightmap[page].intensity}};
}

std::optional<std::uint32_t> Materials::place(std::optional<std::uint32_t> material, Change change) {
  if (change.none()) return material;
  if (const auto found = placed_.find({material, change}); found != placed_.end()) return found->second;
  Json& materials = arrayOf(doc_, "materials");
  const auto fresh = static_cast<std::uint32_t>(materials.size());
  std::uint32_t target = fresh;
  if (!material) {
    materials.push_back(Json::object());
    notesOf(materials.back())["standsForNone"] = true;
  } else {
    // The material itself changes when nobody uses it unchanged; the first of several changes has it.
    const auto& changes = changes_[*material];
    const bool unchanged_use =
        std::any_of(changes.begin(), changes.end(), [](const Change& c) { return c.none(); });
    if (!unchanged_use && change == changes.front()) {
      target = *material;
    } else {
      Json copy = originals_[*material];
      notesOf(copy)["copyOf"] = *material;
      materials.push_back(std::move(copy));
    }
  }
  apply(materials[target], change);
  placed_[{material, change}] = target;
  return target;
}

}  // namespace

void wireMaterials(Output& out, const std::vector<BakedPrimitive>& baked, const BakeOutput& bake) {
  Materials materials(out, bake);
  const bool textured = !bake.occlusion_png.empty() || !bake.lightmap.empty();
  std::map<std::pair<std::uint32_t, std::uint32_t>, Change> changes;
  for (const BakedPrimitive& b : baked)
    changes[{b.mesh, b.primitive}] = {textured ? b.page : kNone, b.moved_set};
  const auto changeOf = [&](std::uint32_t mesh, std::uint32_t primitive) {
    const auto found = changes.find({mesh, primitive});
    return found == changes.end() ? Change{} : found->second;
  };
  const Json* list = fieldOf(out.doc, "materials");
  const std::size_t count = list ? list->size() : 0;
  const auto materialOf = [&](Json& user) {
    Json* reference = fieldOf(user, "material");
    return reference ? asIndex(*reference, count) : std::nullopt;
  };
  visitPrimitives(out.doc, [&](Json& primitive, std::uint32_t m, std::uint32_t p) {
    visitMaterialUsers(primitive, [&](Json& user) { materials.meet(materialOf(user), changeOf(m, p)); });
  });
  visitPrimitives(out.doc, [&](Json& primitive, std::uint32_t m, std::uint32_t p) {
    visitMaterialUsers(primitive, [&](Json& user) {
      if (const auto placed = materials.place(materialOf(user), changeOf(m, p))) user["material"] = *placed;
    });
  });
}

}  // namespace relume::scene::gltf
