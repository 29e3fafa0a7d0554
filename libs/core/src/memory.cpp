// SPDX-License-Identifier: MIT
#include "relume/core/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>

#include "relume/core/error.h"

namespace relume {

std::uint64_t peakResidentBytes() {
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

std::uint64_t currentResidentBytes() {
  std::FILE* f = std::fopen("/proc/self/statm", "r");
  if (!f) return 0;
  unsigned long long total = 0, resident = 0;
  const int read = std::fscanf(f, "%llu %llu", &total, &resident);
  std::fclose(f);
  return read == 2 ? resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

std::uint64_t machineBytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  std::uint64_t bytes =
      pages > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : 0;
  if (std::FILE* f = std::fopen("/sys/fs/cgroup/memory.max", "r")) {
    unsigned long long limit = 0;  // the file says "max" where there is none
    if (std::fscanf(f, "%llu", &limit) == 1 && limit > 0 && (bytes == 0 || limit < bytes)) bytes = limit;
    std::fclose(f);
  }
  return bytes;
}

std::uint64_t parseSize(std::string_view text) {
  double value = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string unit(end, text.data() + text.size());
  for (char& c : unit) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  static constexpr std::string_view kUnits = "KMGT";
  double scale = 1;
  bool valid = ec == std::errc() && value >= 0;
  if (!unit.empty() && unit != "B") {
    const auto power = kUnits.find(unit[0]);
    const std::string rest = unit.substr(1);
    valid = valid && power != std::string_view::npos && (rest.empty() || rest == "B" || rest == "IB");
    for (std::size_t i = 0; valid && i <= power; ++i) scale *= 1024;
  }
  if (!valid || value * scale > 9e18)
    throw Error(ErrorCode::kUsage, std::string(text), "is not a size", "write for example 512M or 2G");
  return static_cast<std::uint64_t>(value * scale);
}

std::string formatSize(std::uint64_t bytes) {
  static constexpr std::array kNames = {"B", "KiB", "MiB", "GiB", "TiB"};
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (value >= 1024 && unit + 1 < kNames.size()) value /= 1024, ++unit;
  return unit == 0 ? fmt::format("{} B", bytes) : fmt::format("{:.1f} {}", value, kNames[unit]);
}

}  // namespace relume
