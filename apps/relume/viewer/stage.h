// SPDX-License-Identifier: MIT
// What a viewer shows: a file with its renderer, and how it is lit and looked at.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files.h"
#include "relume/picture/picture.h"
#include "relume/render/renderer.h"
#include "relume/trace/tracer.h"
#include "viewer/camera_control.h"
#include "viewer/truth.h"
#include "viewer/viewer.h"

namespace relume::app {

/// A view by name, and what it needs of the bake.
struct StageView {
  const char* name;
  picture::View view;
};

class Stage {
 public:
  /// A context must be current. Throws Error.
  Stage(const ViewerOptions& options, const std::filesystem::path& file);

  /// Only those that this file has something to show for.
  const std::vector<StageView>& views() const { return views_; }
  std::size_t view() const { return view_; }
  void choose(std::size_t view);

  /// Draws into the bound framebuffer's lower left corner.
  void draw(IVec2 size, bool present = true);
  void addLight();

  render::FrameSettings frame;
  CameraControl camera;
  bool auto_exposure = true;
  float exposure = 0;
  bool fxaa = true;
  int selected = -1;            ///< light, or none
  bool has_relief = false;      ///< some material has a height map
  bool has_obscurance = false;  ///< the bake has W for frame.obscurance_gain and .bounce_gain

  /// Things that can be carried about: how far from where they were put.
  std::vector<Vec3> object_moved;
  Point objectCentre(std::size_t object) const { return object_centre_[object] + object_moved[object]; }
  bool has_probes = false;

  /// Patches that light enters by: where, and a colour by the cluster of their first entry. Empty without a
  /// lightpath.
  struct Entry {
    Point position{0};
    Normal normal{0, 1, 0};
    Vec3 colour{1};
  };
  const std::vector<Entry>& entries() const { return entries_; }
  /// Whether the eye sees a place of what stands still.
  bool sees(Point p, Normal n) const;

  bool compare_with_truth = false;
  Truth& truth();

  const std::vector<render::PassTime>& times() const { return times_; }
  const std::string& caption() const { return caption_; }
  image::Image screenshot() const;  ///< as displayed, without panels

 private:
  void showView();

  void readEntries(const asset::Layer& layer);

  std::vector<Entry> entries_;
  std::unique_ptr<trace::Tracer> tracer_;
  std::unique_ptr<Truth> truth_;
  std::vector<Point> object_centre_;
  std::string caption_;
  std::unique_ptr<Opened> opened_;
  std::vector<StageView> views_;
  std::size_t view_ = 0;
  std::string layer_;
  std::unique_ptr<render::Renderer> renderer_;
  std::vector<render::PassTime> times_;
};

}  // namespace relume::app
