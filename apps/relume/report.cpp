// SPDX-License-Identifier: MIT
#include "report.h"

#include <nlohmann/json.hpp>

#include "relume/core/file.h"
#include "report_page.h"
#include "report_pictures.h"

namespace relume::app {
namespace {

using Json = nlohmann::ordered_json;

std::string jsonOf(const ReportFacts& facts, const bake::BakeResult& result) {
  Json out{{"generator", result.asset.generator},
           {"input", facts.input},
           {"output", facts.output},
           {"output_bytes", result.glb.size()},
           {"input_hash", result.asset.input_hash},
           {"command", facts.command},
           {"typed", facts.typed}};
  out["warnings"] = Json::array();
  for (const Warning& w : result.warnings) out["warnings"].push_back(w.text());
  out["statistics"] = Json::parse(bake::toJson(result.statistics));
  const Json report = Json::parse(bake::toJson(result.report));
  for (const auto& [key, value] : report.items()) out[key] = value;
  return out.dump(1) + "\n";
}

}  // namespace

void writeReport(const std::filesystem::path& folder, const ReportFacts& facts,
                 const bake::BakeResult& result, Progress& progress) {
  const std::vector<ReportPicture> scene = drawScene(folder, facts.output, progress);
  std::vector<LayerPictures> layers;
  for (std::size_t i = 0; i < result.report.layers.size(); ++i) {
    progress.throwIfCancelled();
    layers.push_back(drawPages(folder, result.asset, i, result.report.layers[i]));
  }
  writeFileAtomically(folder / "report.html", reportPage(facts, result, scene, layers));
  writeFileAtomically(folder / "report.json", jsonOf(facts, result));
}

}  // namespace relume::app
