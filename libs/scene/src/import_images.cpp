// SPDX-License-Identifier: MIT
// Texture files: which are needed, where their bytes are, and their decoding, several at a time.
#include <fmt/format.h>

#include <map>
#include <new>
#include <optional>

#include "import.h"
#include "relume/core/parallel.h"
#include "relume/image/io.h"
#include "uri.h"

namespace relume::scene::gltf {

namespace {

// Beyond what graphics hardware takes; a small file may claim any size.
constexpr std::int64_t kMostPixels = std::int64_t{16384} * 16384;

/// Marks the textures that the materials of some triangle read.
std::vector<bool> neededTextures(const Scene& scene, const ImportOptions& options) {
  std::vector<bool> needed(scene.textures.size());
  const auto need = [&](const TextureRef& ref, bool wanted) {
    if (ref && wanted) needed[ref.texture] = true;
  };
  for (const Mesh& mesh : scene.meshes) {
    const Material& m = scene.materials[mesh.material];
    const bool light = options.textures == TextureUse::kLight;
    const bool see_through = m.alpha_mode != AlphaMode::kOpaque && options.textures != TextureUse::kNone;
    need(m.base_colour_texture, light || see_through);
    need(m.metallic_roughness_texture, light && !m.unlit);
    need(m.emission_texture, light && !m.unlit && m.emission != Vec3(0));
    need(m.normal_texture, options.normal_maps);
    need(m.height_texture, options.normal_maps);
  }
  return needed;
}

std::shared_ptr<const image::Image8> decode(Access& access, std::uint32_t index, const std::string& subject) {
  const std::vector<std::byte> file = imageBytes(access, index);
  if (const auto size = image::textureSize(file))
    if (std::int64_t{size->x} * size->y > kMostPixels)
      throw Error(ErrorCode::kUnsupported, subject, fmt::format("has {} x {} pixels", size->x, size->y));
  return std::make_shared<const image::Image8>(image::decodeTexture(file, subject));
}

}  // namespace

std::vector<std::byte> imageBytes(Access& access, std::uint32_t index) {
  const Value json = access.root()["images"].at(index);
  if (const Value view = json["bufferView"]) {
    const auto bytes = access.viewBytes(view.index(access.root()["bufferViews"].size(), "buffer view"));
    return {bytes.begin(), bytes.end()};
  }
  const Value uri = json["uri"];
  if (!uri) json.fail(ErrorCode::kInvalidReference, "has neither a buffer view nor a URI");
  const std::string text = uri.text("");
  return isDataUri(text) ? decodeDataUri(text, uri.subject())
                         : readRelative(access.folder(), text, json.subject());
}

void importImages(Access& access, const std::vector<TextureSource>& sources, const ImportOptions& options,
                  Scene& scene, Warnings& warnings) {
  struct Slot {
    std::uint32_t image = 0;
    std::string subject;
    std::shared_ptr<const image::Image8> pixels;
    std::optional<Warning> warning;
  };
  std::map<std::uint32_t, std::size_t> slot_of;
  std::vector<Slot> slots;
  const std::vector<bool> needed = neededTextures(scene, options);
  for (std::size_t t = 0; t < needed.size(); ++t) {
    if (!needed[t]) continue;
    if (sources[t].image == kNone) {
      warnings.push_back({access.root()["textures"].at(sources[t].texture).subject(),
                          "has no image that can be read", "white stands in"});
      continue;
    }
    const auto [found, fresh] = slot_of.try_emplace(sources[t].image, slots.size());
    if (!fresh) continue;
    const Value image = access.root()["images"].at(sources[t].image);
    slots.push_back({sources[t].image, image.subject(), nullptr, std::nullopt});
    // Views are decompressed on first use, which must not happen on two threads.
    try {
      if (const Value view = image["bufferView"])
        access.viewBytes(view.index(access.root()["bufferViews"].size(), "buffer view"));
    } catch (const Error& error) {
      slots.back().warning = {image.subject(), error.problem(), "white stands in"};
    }
  }

  parallelFor(slots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (slots[i].warning) continue;
      try {
        slots[i].pixels = decode(access, slots[i].image, slots[i].subject);
      } catch (const Error& error) {
        slots[i].warning = {slots[i].subject, error.problem(), "white stands in"};
      } catch (const std::bad_alloc&) {
        slots[i].warning = {slots[i].subject, "does not fit into memory", "white stands in"};
      }
    }
  });
  for (const Slot& slot : slots)
    if (slot.warning) warnings.push_back(*slot.warning);
  for (std::size_t t = 0; t < needed.size(); ++t)
    if (const auto found = slot_of.find(sources[t].image); needed[t] && found != slot_of.end())
      scene.textures[t].image = slots[found->second].pixels;
}

}  // namespace relume::scene::gltf
