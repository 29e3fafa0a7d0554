// SPDX-License-Identifier: MIT
// Which glTF extensions are known here, and in what sense; the names of our own additions.
#pragma once
#include <string_view>

namespace relume::scene::gltf {

/// The key under `extras` where this program notes what it must know to undo a bake, and where authors mark
/// nodes.
inline constexpr const char* kNotes = "relume";

inline constexpr const char* kTransferExtension = "RELUME_transfer";
inline constexpr const char* kLightmapExtension = "MOZ_lightmap";
inline constexpr const char* kUnlitExtension = "KHR_materials_unlit";
inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";
inline constexpr const char* kInstancingExtension = "EXT_mesh_gpu_instancing";
/// The two names of one compression.
inline constexpr const char* kMeshoptExtensions[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

/// A file that requires it can be read: it is implemented, or what it adds does not change how light travels
/// here.
bool isReadable(std::string_view extension);

/// It is known to refer to accessors and buffer views only where export looks for such references, so both
/// may be renumbered.
bool isRenumberable(std::string_view extension);

}  // namespace relume::scene::gltf
