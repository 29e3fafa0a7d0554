// SPDX-License-Identifier: MIT
// Whole files in, whole files out.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relume {

/// Reads a file. Throws Error kFileNotFound or kFileUnreadable.
std::vector<std::byte> readFile(const std::filesystem::path& path);
std::string readTextFile(const std::filesystem::path& path);

/// Writes beside the target and renames, so the file appears whole or not at all. Throws Error kCannotWrite.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> data);
void writeFileAtomically(const std::filesystem::path& path, std::string_view text);

/// Throws Error kCannotWrite unless a file can be made at `path`: asked before long work, so nothing is baked
/// in vain.
void requireWritable(const std::filesystem::path& path);

}  // namespace relume
