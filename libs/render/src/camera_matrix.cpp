// SPDX-License-Identifier: MIT
#include "camera_matrix.h"

#include <algorithm>
#include <cmath>

namespace relume::render {

Mat4 clipFromWorld(const Camera& camera, const Box3& scene, float aspect, Vec2 offset) {
  // glTF: a camera ignores the scale of its node.
  const Vec3 right = glm::normalize(Vec3(camera.world_from_camera[0])),
             up = glm::normalize(Vec3(camera.world_from_camera[1])),
             back = glm::normalize(Vec3(camera.world_from_camera[2]));
  const Point eye(camera.world_from_camera[3]);
  const Mat4 view = glm::transpose(Mat4(Vec4(right, -glm::dot(right, eye)), Vec4(up, -glm::dot(up, eye)),
                                        Vec4(back, -glm::dot(back, eye)), Vec4(0, 0, 0, 1)));
  const float reach = scene.diagonal() + scene.distance(eye) + 1.0f;
  Mat4 projection(0.0f);
  if (camera.ortho_height > 0) {
    const float half = 0.5f * camera.ortho_height;
    projection[0][0] = 1 / (half * aspect), projection[1][1] = 1 / half;
    // z from 0 (near, depth 1) to -2 reach (depth 0).
    projection[2][2] = 1 / (2 * reach), projection[3][2] = 1;
    projection[3][0] = offset.x, projection[3][1] = offset.y, projection[3][3] = 1;
  } else {
    const float near = std::clamp(1e-4f * scene.diagonal(), 1e-4f, 0.01f);
    const float f = 1 / std::tan(0.5f * camera.vertical_fov);
    projection[0][0] = f / aspect, projection[1][1] = f;
    projection[2][0] = -offset.x, projection[2][1] = -offset.y, projection[2][3] = -1;
    projection[3][2] = near;
  }
  return projection * view;
}

}  // namespace relume::render
