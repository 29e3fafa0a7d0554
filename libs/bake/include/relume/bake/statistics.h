// SPDX-License-Identifier: MIT
// What a bake did, in numbers.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "relume/atlas/atlas.h"

namespace relume::bake {

struct StageTime {
  std::string name;
  double seconds = 0;
};

struct LayerStatistics {
  std::string name;
  std::uint64_t bytes = 0;      ///< stored
  std::uint64_t raw_bytes = 0;  ///< as 32-bit floats
  std::uint64_t samples = 0;    ///< rays
  double error_estimate = 0;  ///< RMS over texels of the estimated standard error, relative to the RMS value
  double seconds = 0;         ///< tracing
  std::size_t reused_texels = 0, computed_texels = 0;
  std::map<std::string, double> measured;  ///< what else its kind tells
};

struct Statistics {
  std::vector<StageTime> stages;
  std::uint64_t rays = 0;
  double rays_per_second = 0;
  std::uint64_t peak_rss_bytes = 0;
  std::size_t triangles = 0;
  std::size_t texels = 0;          ///< covered
  std::size_t invalid_texels = 0;  ///< buried in geometry, filled from neighbours
  int atlas_width = 0, atlas_height = 0;
  std::uint32_t atlas_pages = 0;
  atlas::AtlasStatistics atlas;
  std::vector<LayerStatistics> layers;
};

/// The JSON of --stats (docs/command-line.md).
std::string toJson(const Statistics& statistics);

}  // namespace relume::bake
