// SPDX-License-Identifier: MIT
// The panel that shows path-traced truth and the difference from it.
#pragma once
#include <cstdint>

#include "viewer/stage.h"

namespace relume::app {

class TruthWindow {
 public:
  TruthWindow() = default;
  ~TruthWindow();
  TruthWindow(const TruthWindow&) = delete;
  TruthWindow& operator=(const TruthWindow&) = delete;
  void draw(Stage& stage);

 private:
  void renew(Stage& stage, const image::Image& truth);

  unsigned truth_texture_ = 0, difference_texture_ = 0;
  std::uint32_t samples_ = 0;  ///< of what is shown
  double flip_ = 0;
};

}  // namespace relume::app
