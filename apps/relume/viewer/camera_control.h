// SPDX-License-Identifier: MIT
// A camera that a person moves: about a point, or on foot.
#pragma once
#include "relume/core/vec.h"
#include "relume/picture/picture.h"

namespace relume::app {

class CameraControl {
 public:
  /// `reach`: about how far away what is looked at stands, metres.
  CameraControl(const picture::Viewpoint& start, float reach);

  /// Turns about the point that is looked at; radians to the right and upwards.
  void orbit(float right, float up);
  /// Turns the head.
  void look(float right, float up);
  /// Metres along what the camera sees as right, up and forward.
  void move(Vec3 step);
  /// Nearer to the point that is looked at, by a factor below 1, or away from it.
  void zoom(float factor);

  picture::Viewpoint viewpoint() const;
  Point eye() const { return eye_; }
  Point pivot() const { return eye_ + reach_ * forward(); }
  Direction forward() const;
  float reach() const { return reach_; }

 private:
  Point eye_;
  float yaw_, pitch_;  // radians; yaw 0 looks along -z, pitch above the horizon
  float reach_, fov_;
};

/// Where a point of the world is in a picture, pixels from its upper left corner; z: its distance along the
/// view, negative behind the eye.
Vec3 project(const picture::Viewpoint& viewpoint, Vec2 size, Point p);
/// The point at that place of the picture and that distance along the view.
Point unproject(const picture::Viewpoint& viewpoint, Vec2 size, Vec3 place);

}  // namespace relume::app
