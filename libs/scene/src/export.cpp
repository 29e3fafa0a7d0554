// SPDX-License-Identifier: MIT
#include "export.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "extensions.h"
#include "import.h"
#include "relume/core/check.h"

namespace relume::scene::gltf {

using Json = nlohmann::json;

Output::Output(const Document& document) : doc(document.json()), in(document) {
  Json* views = fieldOf(doc, "bufferViews");
  if (!views) return;
  pieces.resize(views->size());
  for (std::uint32_t v = 0; v < pieces.size(); ++v) {
    pieces[v].input_view = v;
    // Access gives the bytes decompressed.
    for (const char* name : kMeshoptExtensions) eraseExtension((*views)[v], name);
  }
}

std::uint32_t Output::addView(std::vector<std::byte> bytes, Json fields) {
  RELUME_CHECK(!bytes.empty());
  const Digest digest = Hasher().add(std::string_view(fields.dump())).addAll(bytes).digest();
  const auto [found, fresh] = known_views_.try_emplace(digest, static_cast<std::uint32_t>(pieces.size()));
  if (!fresh) return found->second;
  fields["byteLength"] = bytes.size();
  arrayOf(doc, "bufferViews").push_back(std::move(fields));
  pieces.push_back({kNone, std::move(bytes)});
  return found->second;
}

std::uint32_t Output::addAccessor(Json fields, std::vector<std::byte> bytes, std::size_t stride, int target) {
  Json view = {{"target", target}};
  if (stride != 0) view["byteStride"] = stride;
  fields["bufferView"] = addView(std::move(bytes), std::move(view));
  const Digest digest = Hasher().add(std::string_view(fields.dump())).digest();
  Json& accessors = arrayOf(doc, "accessors");
  const auto [found, fresh] =
      known_accessors_.try_emplace(digest, static_cast<std::uint32_t>(accessors.size()));
  if (fresh) accessors.push_back(std::move(fields));
  return found->second;
}

Json& arrayOf(Json& object, const char* key) {
  Json& array = object[key];
  if (array.is_null()) array = Json::array();
  return array;
}

Json* fieldOf(Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::optional<std::uint32_t> asIndex(const Json& value, std::size_t count) {
  if (!value.is_number()) return std::nullopt;
  const double v = value.get<double>();
  if (!(v >= 0 && v < static_cast<double>(count))) return std::nullopt;
  return static_cast<std::uint32_t>(v);
}

Json& notesOf(Json& object) {
  Json& extras = object["extras"];
  // extras may be anything; what is no object is kept beside the notes.
  if (!extras.is_null() && !extras.is_object()) extras = {{"value", std::move(extras)}};
  return extras[kNotes];
}

Json* findNote(Json& object, const char* key) {
  Json* extras = fieldOf(object, "extras");
  Json* notes = extras ? fieldOf(*extras, kNotes) : nullptr;
  return notes ? fieldOf(*notes, key) : nullptr;
}

void eraseNote(Json& object, const char* key) {
  if (!findNote(object, key)) return;
  Json& extras = object["extras"];
  extras[kNotes].erase(key);
  if (extras[kNotes].empty()) extras.erase(kNotes);
  if (extras.empty()) object.erase("extras");
}

void eraseExtension(Json& object, const char* name) {
  Json* extensions = fieldOf(object, "extensions");
  if (!extensions || !extensions->is_object()) return;
  extensions->erase(name);
  if (extensions->empty()) object.erase("extensions");
}

namespace {

std::string_view mimeType(std::span<const std::byte> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()),
                              std::min<std::size_t>(file.size(), 16));
  using namespace std::string_view_literals;
  if (text.starts_with("\x89PNG"sv)) return "image/png";
  if (text.starts_with("\xFF\xD8\xFF"sv)) return "image/jpeg";
  if (text.starts_with("RIFF"sv) && text.substr(8).starts_with("WEBP"sv)) return "image/webp";
  if (text.starts_with("\xABKTX 20"sv)) return "image/ktx2";
  if (text.starts_with("DDS "sv)) return "image/vnd-ms.dds";
  return {};
}

void offsetViews(Json& value, std::uint32_t base) {
  if (value.is_structured())
    for (auto& [key, child] : value.items()) {
      if (key == "bufferView" && child.is_number())
        child = child.get<std::uint32_t>() + base;
      else
        offsetViews(child, base);
    }
}

void addTransfer(Output& out, const BakeOutput& bake) {
  if (bake.transfer.is_null()) return;
  const auto base = static_cast<std::uint32_t>(out.pieces.size());
  for (const auto& bytes : bake.views) {
    RELUME_CHECK(!bytes.empty());
    arrayOf(out.doc, "bufferViews").push_back({{"byteLength", bytes.size()}});
    out.pieces.push_back({kNone, bytes});
  }
  Json transfer = bake.transfer;
  offsetViews(transfer, base);
  out.doc["extensions"][kTransferExtension] = std::move(transfer);
}

bool usesExtension(Json& value, std::string_view name) {
  if (!value.is_structured()) return false;
  for (auto& [key, child] : value.items()) {
    if (key == "extras") continue;
    if (key == "extensions" && child.is_object() && child.contains(std::string(name))) return true;
    if (usesExtension(child, name)) return true;
  }
  return false;
}

/// extensionsUsed and extensionsRequired say what this program took away or brought in; the rest stays as it
/// was.
void declareExtensions(Json& doc) {
  const auto remove = [&](const char* list, std::string_view name) {
    Json* names = fieldOf(doc, list);
    if (!names || !names->is_array()) return;
    std::erase_if(names->get_ref<Json::array_t&>(),
                  [&](const Json& n) { return n.is_string() && n == name; });
    if (names->empty()) doc.erase(list);
  };
  for (const std::string_view name :
       {std::string_view(kDracoExtension), std::string_view(kInstancingExtension),
        std::string_view(kMeshoptExtensions[0]), std::string_view(kMeshoptExtensions[1]),
        std::string_view(kLightmapExtension), std::string_view(kTransferExtension)}) {
    if (usesExtension(doc, name)) continue;
    remove("extensionsUsed", name);
    remove("extensionsRequired", name);
  }
  if (usesExtension(doc, kLightmapExtension)) {
    Json& names = arrayOf(doc, "extensionsUsed");
    if (std::find(names.begin(), names.end(), kLightmapExtension) == names.end())
      names.push_back(kLightmapExtension);
  }
  if (usesExtension(doc, kTransferExtension)) {
    remove("extensionsUsed", kTransferExtension);
    arrayOf(doc, "extensionsUsed").push_back(kTransferExtension);
  }
}

}  // namespace

void embedImages(Output& out) {
  Json* images = fieldOf(out.doc, "images");
  if (!images || !images->is_array()) return;
  for (std::uint32_t i = 0; i < images->size(); ++i) {
    Json& image = (*images)[i];
    if (!fieldOf(image, "uri") || fieldOf(image, "bufferView")) continue;
    std::vector<std::byte> file;
    try {
      file = imageBytes(out.in, i);
    } catch (const Error&) {
      continue;  // import has warned; the name stays for whoever has the file
    }
    const std::string_view mime = mimeType(file);
    if (mime.empty()) continue;
    image.erase("uri");
    image["mimeType"] = mime;
    image["bufferView"] = out.addView(std::move(file));
  }
}

std::vector<std::byte> exportGlb(const Document& document, const Scene& scene, const BakeOutput& bake) {
  try {
    Output out(document);
    removeEarlierBake(out.doc);
    embedImages(out);
    const std::vector<BakedPrimitive> baked = rewriteMeshes(out, scene, bake);
    wireMaterials(out, baked, bake);
    addTransfer(out, bake);
    declareExtensions(out.doc);
    return assemble(out);
  } catch (const Json::exception& error) {
    // Parts of the document that import does not read may be of any type.
    throw Error(ErrorCode::kInvalidValue, document.name(),
                fmt::format("cannot be rewritten: {}", error.what()));
  }
}

}  // namespace relume::scene::gltf
