// SPDX-License-Identifier: MIT
#include "viewer/camera_control.h"

#include <algorithm>
#include <cmath>

namespace relume::app {
namespace {

constexpr float kMostPitch = 1.55f;

struct Axes {
  Vec3 right, up, forward;
  explicit Axes(const picture::Viewpoint& v)
      : right(glm::normalize(Vec3(v.world_from_camera[0]))),
        up(glm::normalize(Vec3(v.world_from_camera[1]))),
        forward(-glm::normalize(Vec3(v.world_from_camera[2]))) {}
};

/// Half of the picture's extent at distance 1.
Vec2 halfExtent(const picture::Viewpoint& v, Vec2 size) {
  const float half = std::tan(0.5f * v.vertical_fov);
  return {half * size.x / size.y, half};
}

}  // namespace

CameraControl::CameraControl(const picture::Viewpoint& start, float reach)
    : eye_(start.world_from_camera[3]), reach_(reach), fov_(start.vertical_fov) {
  const Vec3 f = Axes(start).forward;
  yaw_ = std::atan2(f.x, -f.z);
  pitch_ = std::clamp(std::asin(std::clamp(f.y, -1.0f, 1.0f)), -kMostPitch, kMostPitch);
}

Direction CameraControl::forward() const {
  return {std::sin(yaw_) * std::cos(pitch_), std::sin(pitch_), -std::cos(yaw_) * std::cos(pitch_)};
}

void CameraControl::look(float right, float up) {
  yaw_ += right;
  pitch_ = std::clamp(pitch_ + up, -kMostPitch, kMostPitch);
}

void CameraControl::orbit(float right, float up) {
  const Point about = pivot();
  look(right, up);
  eye_ = about - reach_ * forward();
}

void CameraControl::move(Vec3 step) {
  const Axes axes(viewpoint());
  eye_ += step.x * axes.right + step.y * Vec3(0, 1, 0) + step.z * axes.forward;
}

void CameraControl::zoom(float factor) {
  const Point about = pivot();
  reach_ = std::clamp(reach_ * factor, 1e-3f, 1e6f);
  eye_ = about - reach_ * forward();
}

picture::Viewpoint CameraControl::viewpoint() const { return picture::lookAt(eye_, eye_ + forward(), fov_); }

Vec3 project(const picture::Viewpoint& viewpoint, Vec2 size, Point p) {
  const Axes axes(viewpoint);
  const Vec3 d = p - Point(viewpoint.world_from_camera[3]);
  const float z = glm::dot(d, axes.forward);
  const Vec2 ndc = Vec2(glm::dot(d, axes.right), -glm::dot(d, axes.up)) / halfExtent(viewpoint, size) / z;
  return {0.5f * (ndc + 1.0f) * size, z};
}

Point unproject(const picture::Viewpoint& viewpoint, Vec2 size, Vec3 place) {
  const Axes axes(viewpoint);
  const Vec2 ndc = (2.0f * Vec2(place) / size - 1.0f) * halfExtent(viewpoint, size) * place.z;
  return Point(viewpoint.world_from_camera[3]) + ndc.x * axes.right - ndc.y * axes.up +
         place.z * axes.forward;
}

}  // namespace relume::app
