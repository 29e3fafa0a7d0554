// SPDX-License-Identifier: MIT
// What stands beside the picture: views, terms, lights, times.
#pragma once
#include <deque>

#include "viewer/stage.h"

namespace relume::app {

struct PanelState {
  bool help = false, panels = true;
  bool screenshot = false, record = false;
  int recorded = 0;            ///< frames
  std::string message;         ///< of what happened last
  std::deque<float> frame_ms;  ///< of the last frames, wall time
};

void drawPanels(Stage& stage, PanelState& state);
/// Handles of lights over the picture: chosen by a click, moved by dragging in the plane that faces the
/// viewer. Whether the mouse belongs to one of them now.
bool drawHandles(Stage& stage, Vec2 size);

}  // namespace relume::app
