// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <cmath>

#include "framing.h"
#include "relume/core/error.h"
#include "relume/picture/picture.h"

namespace relume::picture {

Viewpoint lookAt(Point eye, Point target, float vertical_fov) {
  const Vec3 way = target - eye;
  const float distance = glm::length(way);
  const Direction forward = distance > 0 ? way / distance : Direction(0, 0, -1);
  const Direction pole = std::abs(forward.y) > 0.9999f ? Direction(0, 0, -1) : Direction(0, 1, 0);
  const Direction right = glm::normalize(glm::cross(forward, pole));
  const Direction up = glm::cross(right, forward);
  Viewpoint view;
  view.world_from_camera = Mat4(Vec4(right, 0), Vec4(up, 0), Vec4(-forward, 0), Vec4(eye, 1));
  view.vertical_fov = vertical_fov;
  return view;
}

Viewpoint frameScene(const trace::Tracer& tracer, float aspect) {
  const Box3 box = boundsToFrame(tracer.scene());
  if (const auto interior = frameInterior(tracer, box, aspect)) return *interior;
  return frameFromOutside(tracer, box, aspect);
}

Viewpoint defaultViewpoint(const trace::Tracer& tracer, int camera, float aspect) {
  const scene::Scene& scene = tracer.scene();
  const int cameras = static_cast<int>(scene.cameras.size());
  if (cameras == 0 && (camera == 0 || camera == -1)) return frameScene(tracer, aspect);
  if (camera < -1 || camera >= cameras)
    throw Error(ErrorCode::kUsage, fmt::format("camera {}", camera),
                fmt::format("{} has {} camera{}", scene.name.empty() ? "the scene" : scene.name, cameras,
                            cameras == 1 ? "" : "s"),
                cameras ? fmt::format("choose one from 0 to {}", cameras - 1)
                        : "leave the camera out, or give an eye and a target");
  const scene::Camera& chosen = scene.cameras[static_cast<std::size_t>(std::max(camera, 0))];
  Viewpoint view;
  view.world_from_camera = chosen.world_from_camera;
  view.vertical_fov = chosen.vertical_fov;
  view.ortho_height = chosen.orthographic ? chosen.ortho_height : 0.0f;
  return view;
}

}  // namespace relume::picture
