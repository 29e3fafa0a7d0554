// SPDX-License-Identifier: MIT
// Occlusion textures of the bake. A material that is used on one page alone is changed where it stands; for
// further pages, and beside users that are not baked, it is copied. What was there before is noted in
// extras.relume.
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

/// The element of doc[list] that carries occlusion page `page`: one that an earlier bake left, or a new one.
std::uint32_t slotOf(Json& doc, const char* list, std::uint32_t page) {
  Json& array = arrayOf(doc, list);
  std::uint32_t left = page;
  for (std::uint32_t i = 0; i < array.size(); ++i)
    if (findNote(array[i], "occlusionPage") && left-- == 0) return i;
  array.push_back(Json::object());
  return static_cast<std::uint32_t>(array.size() - 1);
}

void dropSpareSlots(Json& doc, const char* list, std::size_t pages) {
  Json* array = fieldOf(doc, list);
  if (!array || !array->is_array()) return;
  std::size_t marked = 0;
  for (Json& element : *array) marked += findNote(element, "occlusionPage") != nullptr;
  for (; marked > pages && !array->empty() && findNote(array->back(), "occlusionPage"); --marked)
    array->erase(array->size() - 1);
  if (array->empty()) doc.erase(list);
}

/// Makes the textures of all pages. Returns their indices.
std::vector<std::uint32_t> addTextures(Output& out, const std::vector<std::vector<std::byte>>& pages) {
  constexpr int kLinear = 9729, kLinearMipmapLinear = 9987, kClamp = 33071;
  std::vector<std::uint32_t> textures;
  for (std::uint32_t p = 0; p < pages.size(); ++p) {
    const std::uint32_t image = slotOf(out.doc, "images", p), texture = slotOf(out.doc, "textures", p);
    const std::uint32_t sampler = slotOf(out.doc, "samplers", 0);
    const std::uint32_t view = out.addView(pages[p]);
    const Json note = {{kNotes, {{"occlusionPage", p}}}};
    const std::string name = "occlusion " + std::to_string(p);
    out.doc["images"][image] = {
        {"name", name}, {"bufferView", view}, {"mimeType", "image/png"}, {"extras", note}};
    out.doc["textures"][texture] = {
        {"name", name}, {"source", image}, {"sampler", sampler}, {"extras", note}};
    out.doc["samplers"][sampler] = {{"magFilter", kLinear},
                                    {"minFilter", kLinearMipmapLinear},
                                    {"wrapS", kClamp},
                                    {"wrapT", kClamp},
                                    {"extras", {{kNotes, {{"occlusionPage", 0}}}}}};
    textures.push_back(texture);
  }
  return textures;
}

/// How a use of a material differs from the material as it was.
struct Change {
  std::uint32_t page = kNone;   ///< whose occlusion it shows; kNone: its own
  std::uint32_t moved_set = 0;  ///< where what read TEXCOORD_1 reads now
  auto operator<=>(const Change&) const = default;
  bool none() const { return page == kNone && moved_set == 0; }
};

class Materials {
 public:
  Materials(Output& out, std::vector<std::uint32_t> textures)
      : doc_(out.doc), textures_(std::move(textures)) {
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

  Json& doc_;
  Json originals_ = Json::array();  ///< materials before any change
  std::vector<std::uint32_t> textures_;
  std::map<std::uint32_t, std::vector<Change>> changes_;
  std::map<std::pair<std::optional<std::uint32_t>, Change>, std::uint32_t> placed_;
};

void Materials::apply(Json& material, Change change) {
  if (change.moved_set != 0)
    visitTextureInfos(material, [&](const std::string&, Json& info) {
      if (texCoordOf(info) == 1) setTexCoord(info, change.moved_set);
    });
  if (change.page == kNone) return;
  Json* original = fieldOf(material, "occlusionTexture");
  Json kept = original ? *original : Json();
  notesOf(material)["occlusionTexture"] = std::move(kept);
  material["occlusionTexture"] = {{"index", textures_[change.page]}, {"texCoord", 1}};
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
  for (const char* list : {"images", "textures"}) dropSpareSlots(out.doc, list, bake.occlusion_png.size());
  dropSpareSlots(out.doc, "samplers", bake.occlusion_png.empty() ? 0 : 1);
  Materials materials(out, addTextures(out, bake.occlusion_png));

  std::map<std::pair<std::uint32_t, std::uint32_t>, Change> changes;
  for (const BakedPrimitive& b : baked)
    changes[{b.mesh, b.primitive}] = {bake.occlusion_png.empty() ? kNone : b.page, b.moved_set};
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
