// SPDX-License-Identifier: MIT
#include "extensions.h"

#include <algorithm>
#include <array>

namespace relume::scene::gltf {

namespace {

constexpr std::array<std::string_view, 32> kReadable = {
    // implemented
    "KHR_mesh_quantization", "EXT_meshopt_compression", "KHR_meshopt_compression",
    "KHR_draco_mesh_compression", "EXT_texture_webp", "KHR_texture_transform", "KHR_lights_punctual",
    "KHR_materials_emissive_strength", "KHR_materials_unlit", "KHR_materials_transmission",
    "KHR_materials_pbrSpecularGlossiness", "EXT_mesh_gpu_instancing", "KHR_animation_pointer",
    "KHR_node_visibility", "RELUME_transfer",
    // looks that diffuse light transport leaves out
    "KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion", "KHR_materials_ior", "KHR_materials_iridescence", "KHR_materials_sheen",
    "KHR_materials_specular", "KHR_materials_volume", "KHR_materials_variants", "MOZ_lightmap",
    "EXT_lights_image_based",
    // data about the file
    "KHR_xmp", "KHR_xmp_json_ld", "KHR_node_hoverability", "KHR_node_selectability", "KHR_interactivity"};

// Image formats are readable only when they come with a fallback, but they name images alone, which keep
// their numbers.
constexpr std::array<std::string_view, 4> kOnlyRenumberable = {"KHR_texture_basisu", "EXT_texture_avif",
                                                               "MSFT_texture_dds", "MSFT_lod"};

}  // namespace

bool isReadable(std::string_view extension) {
  return std::ranges::find(kReadable, extension) != kReadable.end();
}

bool isRenumberable(std::string_view extension) {
  if (extension == "KHR_interactivity") return false;  // may point anywhere into the document
  return isReadable(extension) || std::ranges::find(kOnlyRenumberable, extension) != kOnlyRenumberable.end();
}

}  // namespace relume::scene::gltf
