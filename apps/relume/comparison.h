// SPDX-License-Identifier: MIT
// Something baked beside its truth: what a report of `relume verify` shows, whatever was compared. Each kind
// of comparison fills one in; the report knows no kinds.
#pragma once
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

#include "relume/image/image.h"

namespace relume::app {

/// A picture of the bake and the same one by path tracing; linear RGB of one size.
struct ComparedView {
  std::string name;     ///< in file names
  std::string caption;  ///< what is seen
  image::Image baked;
  image::Image truth, other_truth;  ///< two independent ones: their difference tells how noisy they are
  Vec3 background{0.0f};            ///< of pixels in which there is nothing; black leaves means alone
};

struct Comparison {
  std::string id, title;
  std::string summary;  ///< what was compared and how, HTML

  struct Figure {
    std::string value, label, colour;  ///< colour: good, watch, bad or none
  };
  std::vector<Figure> figures;

  struct Finding {
    std::string html, colour;
  };
  std::vector<Finding> findings;  ///< what deserves a look

  /// Cells are HTML; columns from `first_number` on are numbers.
  struct Table {
    std::string title, text;
    std::vector<std::string> head;
    std::size_t first_number = 1;
    std::vector<std::vector<std::string>> rows;
    std::size_t shown = 15;  ///< rows that are not folded away
  };
  std::vector<Table> tables;
  std::string plots;  ///< HTML between figures and tables

  std::vector<ComparedView> views;
  nlohmann::ordered_json numbers;  ///< for report.json
};

}  // namespace relume::app
