// SPDX-License-Identifier: MIT
// Materials and what they say about textures; the images are decoded elsewhere.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "extensions.h"
#include "import.h"

namespace relume::scene::gltf {

namespace {

Wrap wrapOf(std::uint64_t code) {
  switch (code) {
    case 33071:
      return Wrap::kClamp;
    case 33648:
      return Wrap::kMirror;
    default:
      return Wrap::kRepeat;
  }
}

class MaterialReader {
 public:
  MaterialReader(Access& access, Scene& scene, Warnings& warnings)
      : root_(access.root()), scene_(scene), warnings_(warnings) {}

  Material read(const Value& json);
  std::vector<TextureSource> takeSources() { return std::move(sources_); }

 private:
  TextureRef texture(const Value& info, bool srgb);
  std::uint32_t sourceImage(const Value& texture);

  Value root_;
  Scene& scene_;
  Warnings& warnings_;
  std::vector<TextureSource> sources_;
  std::map<std::tuple<std::uint32_t, bool>, std::uint32_t>
      known_;  // glTF texture and encoding -> scene texture
};

std::uint32_t MaterialReader::sourceImage(const Value& texture) {
  const std::size_t images = root_["images"].size();
  if (const Value webp = texture.extension("EXT_texture_webp")["source"]) return webp.index(images, "image");
  if (const Value source = texture["source"]) return source.index(images, "image");
  return kNone;
}

TextureRef MaterialReader::texture(const Value& info, bool srgb) {
  TextureRef ref;
  if (!info) return ref;
  const Value textures = root_["textures"];
  const std::uint32_t index = info["index"].index(textures.size(), "texture");
  const Value transform = info.extension("KHR_texture_transform");
  ref.offset = transform["offset"].vec2(ref.offset);
  ref.scale = transform["scale"].vec2(ref.scale);
  ref.rotation = transform["rotation"].real(0);
  const std::uint64_t set =
      transform["texCoord"] ? transform["texCoord"].integer() : info["texCoord"].integer(0);
  if (set >= std::tuple_size_v<decltype(Mesh::uv)>)
    warnings_.push_back(
        {info.subject(), fmt::format("uses TEXCOORD_{}, which is not read", set), "TEXCOORD_0 stands in"});
  else
    ref.uv_set = static_cast<std::uint32_t>(set);

  const auto [found, fresh] =
      known_.try_emplace({index, srgb}, static_cast<std::uint32_t>(scene_.textures.size()));
  ref.texture = found->second;
  if (!fresh) return ref;
  const Value json = textures.at(index);
  Texture& out = scene_.textures.emplace_back();
  out.srgb = srgb;
  if (const Value sampler = json["sampler"]) {
    const Value samplers = root_["samplers"];
    const Value wrap = samplers.at(sampler.index(samplers.size(), "sampler"));
    out.wrap_u = wrapOf(wrap["wrapS"].integer(10497));
    out.wrap_v = wrapOf(wrap["wrapT"].integer(10497));
  }
  sources_.push_back({sourceImage(json), index, srgb});
  return ref;
}

Material MaterialReader::read(const Value& json) {
  const auto unit = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
  Material m;
  m.name = json["name"].text("");
  m.group = json.group();
  const Value pbr = json["pbrMetallicRoughness"], old = json.extension("KHR_materials_pbrSpecularGlossiness");
  if (old) {
    // Diffuse light is what is baked, and there diffuse colour and base colour are one.
    warnings_.push_back(
        {old.subject(), "is read as its diffuse part alone", "convert the file to metallic-roughness"});
    m.base_colour = old["diffuseFactor"].vec4(Vec4(1));
    m.base_colour_texture = texture(old["diffuseTexture"], true);
    m.metallic = 0;
    m.roughness = 1 - unit(old["glossinessFactor"].real(1));
  } else {
    m.base_colour = pbr["baseColorFactor"].vec4(Vec4(1));
    m.base_colour_texture = texture(pbr["baseColorTexture"], true);
    m.metallic = unit(pbr["metallicFactor"].real(1));
    m.roughness = unit(pbr["roughnessFactor"].real(1));
    m.metallic_roughness_texture = texture(pbr["metallicRoughnessTexture"], false);
  }
  m.base_colour = glm::clamp(m.base_colour, 0.0f, 1.0f);
  m.normal_texture = texture(json["normalTexture"], false);
  m.normal_scale = json["normalTexture"]["scale"].real(1);

  if (const Value height = json.notes()["height"]) {
    m.height_texture = texture(height, false);
    m.height_scale = height["scale"].real(m.height_scale);
    if (!(m.height_scale > 0 && m.height_scale <= 1))
      height.fail(ErrorCode::kInvalidValue, fmt::format("has a scale of {}", m.height_scale),
                  "it is the depth of the relief as a share of the map's width, above 0 and at most 1");
  }

  const float strength = json.extension("KHR_materials_emissive_strength")["emissiveStrength"].real(1);
  m.emission = glm::max(json["emissiveFactor"].vec3(Vec3(0)), Vec3(0)) * std::max(strength, 0.0f);
  if (!isFinite(m.emission)) json.fail(ErrorCode::kInvalidValue, "its emission is not a finite number");
  m.emission_texture = texture(json["emissiveTexture"], true);

  const std::string mode = json["alphaMode"].text("OPAQUE");
  if (mode == "MASK")
    m.alpha_mode = AlphaMode::kMask;
  else if (mode == "BLEND")
    m.alpha_mode = AlphaMode::kBlend;
  else if (mode != "OPAQUE")
    warnings_.push_back(
        {json["alphaMode"].subject(), fmt::format("is \"{}\"", mode.substr(0, 20)), "OPAQUE stands in"});
  m.alpha_cutoff = json["alphaCutoff"].real(0.5f);
  m.double_sided = json["doubleSided"].boolean(false);
  m.unlit = static_cast<bool>(json.extension("KHR_materials_unlit"));
  m.transmission = unit(json.extension("KHR_materials_transmission")["transmissionFactor"].real(0));
  return m;
}

/// What primitives without a material look like. glTF's default is white metal, which reflects no diffuse
/// light: a level without materials would be black.
Material standardMaterial() {
  Material m;
  m.name = "default";
  m.base_colour = {0.8f, 0.8f, 0.8f, 1.0f};
  m.metallic = 0;
  return m;
}

/// Whether export made this material, to show occlusion where the input had none, and nobody gave it a look
/// since.
bool standsForNone(const Value& material) {
  if (material["pbrMetallicRoughness"]) return false;
  const nlohmann::json* notes = &material.json();
  for (const char* key : {"extras", kNotes, "standsForNone"}) {
    if (!notes->is_object() || !notes->contains(key)) return false;
    notes = &(*notes)[key];
  }
  return true;
}

}  // namespace

std::vector<TextureSource> importMaterials(Access& access, Scene& scene, Warnings& warnings) {
  MaterialReader reader(access, scene, warnings);
  const Value materials = access.root()["materials"];
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Value json = materials.at(i);
    Material& m = scene.materials.emplace_back(reader.read(json));
    if (!standsForNone(json)) continue;
    m.base_colour = standardMaterial().base_colour;
    m.metallic = standardMaterial().metallic;
  }
  scene.materials.push_back(standardMaterial());
  return reader.takeSources();
}

}  // namespace relume::scene::gltf
