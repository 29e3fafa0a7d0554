// SPDX-License-Identifier: MIT
// Memory of this process and sizes as people write them.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace relume {

std::uint64_t peakResidentBytes();     ///< 0 where the system does not tell
std::uint64_t currentResidentBytes();  ///< 0 where the system does not tell
/// What this process may use at most: the machine's memory, or less in a container. 0 where the system does
/// not tell.
std::uint64_t machineBytes();

/// "512M", "2GiB", "1500000" to bytes (K, M, G, T are powers of 1024). Throws Error kUsage.
std::uint64_t parseSize(std::string_view text);
/// 1536 to "1.5 KiB".
std::string formatSize(std::uint64_t bytes);

}  // namespace relume
