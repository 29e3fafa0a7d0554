// SPDX-License-Identifier: MIT
// URIs as glTF uses them: data URIs and relative paths.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "relume/core/error.h"

namespace relume::scene::gltf {

bool isDataUri(std::string_view uri);

/// The bytes of a data URI, base64 or percent-encoded. Throws Error kInvalidValue with `subject`.
std::vector<std::byte> decodeDataUri(std::string_view uri, const std::string& subject);

/// The bytes of the file that a relative URI names, looked for in `folder`. Absolute paths and URIs with a
/// scheme are refused (kInvalidReference), as is everything when `folder` is empty. Throws Error
/// kFileNotFound, kFileUnreadable with `subject`.
std::vector<std::byte> readRelative(const std::filesystem::path& folder, std::string_view uri,
                                    const std::string& subject);

/// The relative path that a URI means: percent-decoded. Throws as readRelative.
std::filesystem::path relativePath(std::string_view uri, const std::string& subject);

}  // namespace relume::scene::gltf
