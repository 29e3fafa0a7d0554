// SPDX-License-Identifier: MIT
// What commands do alike with files, cameras and colours.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "relume/asset/asset.h"
#include "relume/core/error.h"
#include "relume/core/vec.h"
#include "relume/scene/gltf.h"

namespace relume::app {

/// Prints warnings to stderr, one a line; those that say the same of several things share it.
void print(const Warnings& warnings);

/// A scene, and its bake where the file carries one.
struct Opened {
  scene::Scene scene;
  std::optional<asset::Asset> asset;
};
/// Prints warnings. A file without a bake is fine; a damaged bake is not.
std::unique_ptr<Opened> open(const std::filesystem::path& path,
                             const scene::gltf::ImportOptions& options = {});

/// "1,0.5,2" or "1.5" (all three alike). Throws Error kUsage naming the option.
Vec3 parseTriple(const std::string& text, const std::string& option, bool one_is_enough);
/// "960x540". Throws Error kUsage naming the option.
IVec2 parseExtent(const std::string& text, const std::string& option);

/// Makes a folder where there is none. Throws Error kCannotWrite unless files can be made in it.
void makeFolder(const std::filesystem::path& path);

/// "scene.glb" to "scene" + ending, beside it.
std::filesystem::path beside(const std::filesystem::path& input, const std::string& ending);

}  // namespace relume::app
