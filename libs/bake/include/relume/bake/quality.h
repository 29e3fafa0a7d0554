// SPDX-License-Identifier: MIT
// Presets: a quality is an error to reach, with bounds on the work.
#pragma once
#include <cstdint>
#include <string_view>

namespace relume::bake {

enum class Quality : std::uint8_t { kDraft, kMedium, kHigh, kFinal };
const char* name(Quality quality);
/// Throws Error kUsage.
Quality parseQuality(std::string_view name);

struct QualitySettings {
  Quality quality = Quality::kMedium;
  std::uint32_t min_samples = 0, max_samples = 0;  ///< rays per texel, powers of two
  float target_error = 0;            ///< standard error at which a texel is finished, of a value in [0, 1]
  bool filter = false;               ///< edge-aware smoothing in texel space
  std::uint32_t cache_samples = 16;  ///< rays per texel that light is handed on along before it is gathered

  /// So many rays as a person asked for, no more and no less.
  bool exact() const { return target_error == 0; }
};

/// draft: a look within seconds; medium: the default, no visible noise; high: for delivery; final: no
/// smoothing anywhere, the stated error is sampling error alone.
QualitySettings settings(Quality quality);

}  // namespace relume::bake
