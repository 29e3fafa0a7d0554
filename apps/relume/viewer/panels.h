// SPDX-License-Identifier: MIT
// What stands beside the picture: views, terms, lights, times.
#pragma once
#include <deque>

#include "recorded_path.h"
#include "viewer/stage.h"
#include "viewer/truth_window.h"

namespace relume::app {

struct PanelState {
  bool help = false, panels = true;
  bool screenshot = false, record = false;
  std::vector<PathFrame> recorded;  ///< since R
  bool entries = false;
  std::deque<std::vector<render::PassTime>> pass_times;  ///< of the last frames
  TruthWindow truth;
  std::string message;         ///< of what happened last
  std::deque<float> frame_ms;  ///< of the last frames, wall time
};

/// Entries of light over the picture, those that the eye sees, coloured by cluster.
void drawEntries(const Stage& stage, Vec2 size);
void drawPanels(Stage& stage, PanelState& state);
/// Handles of lights over the picture: chosen by a click, moved by dragging in the plane that faces the
/// viewer. Whether the mouse belongs to one of them now.
bool drawHandles(Stage& stage, Vec2 size);

}  // namespace relume::app
