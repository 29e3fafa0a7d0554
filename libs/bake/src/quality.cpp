// SPDX-License-Identifier: MIT
#include "relume/bake/quality.h"

#include <array>
#include <string>

#include "relume/core/error.h"

namespace relume::bake {
namespace {
struct Row {
  const char* name;
  QualitySettings settings;
};
constexpr std::array<Row, 4> kRows = {{
    {"draft", {.min_samples = 16, .max_samples = 128, .target_error = 0.02f, .filter = true}},
    {"medium", {.min_samples = 32, .max_samples = 512, .target_error = 0.01f, .filter = true}},
    {"high",
     {.min_samples = 64, .max_samples = 1024, .target_error = 0.005f, .filter = false, .cache_samples = 32}},
    {"final",
     {.min_samples = 256, .max_samples = 4096, .target_error = 0.002f, .filter = false, .cache_samples = 64}},
}};
const Row& row(Quality quality) { return kRows[static_cast<std::size_t>(quality)]; }
}  // namespace

const char* name(Quality quality) { return row(quality).name; }
QualitySettings settings(Quality quality) {
  QualitySettings result = row(quality).settings;
  result.quality = quality;
  return result;
}

Quality parseQuality(std::string_view text) {
  for (std::size_t i = 0; i < kRows.size(); ++i)
    if (text == kRows[i].name) return static_cast<Quality>(i);
  throw Error(ErrorCode::kUsage, "--quality " + std::string(text), "is not a quality",
              "use draft, medium, high or final");
}

}  // namespace relume::bake
