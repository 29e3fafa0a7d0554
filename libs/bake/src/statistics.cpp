// SPDX-License-Identifier: MIT
#include "relume/bake/statistics.h"

#include <nlohmann/json.hpp>

namespace relume::bake {

std::string toJson(const Statistics& s) {
  using Json = nlohmann::ordered_json;
  Json out;
  out["stages"] = Json::array();
  for (const StageTime& stage : s.stages)
    out["stages"].push_back({{"name", stage.name}, {"seconds", stage.seconds}});
  out["rays"] = s.rays;
  out["rays_per_second"] = s.rays_per_second;
  out["peak_rss_bytes"] = s.peak_rss_bytes;
  out["triangles"] = s.triangles;
  out["texels"] = s.texels;
  out["invalid_texels"] = s.invalid_texels;
  out["atlas"] = {{"width", s.atlas_width},
                  {"height", s.atlas_height},
                  {"pages", s.atlas_pages},
                  {"coverage", s.atlas.coverage},
                  {"charts", s.atlas.charts},
                  {"texels_per_metre", s.atlas.texels_per_metre},
                  {"overlapping_texels", s.atlas.overlapping_texels},
                  {"mean_stretch", s.atlas.mean_stretch},
                  {"max_stretch", s.atlas.max_stretch}};
  out["layers"] = Json::array();
  for (const LayerStatistics& layer : s.layers) {
    out["layers"].push_back({{"name", layer.name},
                             {"bytes", layer.bytes},
                             {"raw_bytes", layer.raw_bytes},
                             {"samples", layer.samples},
                             {"error_estimate", layer.error_estimate},
                             {"seconds", layer.seconds},
                             {"reused_texels", layer.reused_texels},
                             {"computed_texels", layer.computed_texels}});
    if (!layer.measured.empty()) out["layers"].back()["measured"] = layer.measured;
  }
  return out.dump(2) + "\n";
}

}  // namespace relume::bake
