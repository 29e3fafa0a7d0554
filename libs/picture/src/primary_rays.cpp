// SPDX-License-Identifier: MIT
#include "relume/picture/primary_rays.h"

#include <cmath>

namespace relume::picture {

PrimaryRays::PrimaryRays(const Viewpoint& viewpoint, int width, int height)
    : eye_(viewpoint.world_from_camera[3]),
      size_(static_cast<float>(width), static_cast<float>(height)),
      orthographic_(viewpoint.ortho_height > 0) {
  // glTF: a camera ignores the scale of its node.
  right_ = glm::normalize(Vec3(viewpoint.world_from_camera[0]));
  up_ = glm::normalize(Vec3(viewpoint.world_from_camera[1]));
  forward_ = -glm::normalize(Vec3(viewpoint.world_from_camera[2]));
  const float half_height =
      orthographic_ ? 0.5f * viewpoint.ortho_height : std::tan(0.5f * viewpoint.vertical_fov);
  half_extent_ = {half_height * size_.x / size_.y, half_height};
}

trace::Ray PrimaryRays::at(Vec2 place) const {
  const Vec2 ndc = {2.0f * place.x / size_.x - 1.0f, 1.0f - 2.0f * place.y / size_.y};
  const Vec3 offset = ndc.x * half_extent_.x * right_ + ndc.y * half_extent_.y * up_;
  if (orthographic_) return {eye_ + offset, forward_};
  return {eye_, glm::normalize(forward_ + offset)};
}

}  // namespace relume::picture
