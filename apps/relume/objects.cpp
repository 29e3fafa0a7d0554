// SPDX-License-Identifier: MIT
#include "objects.h"

#include <charconv>

#include <glm/gtc/matrix_transform.hpp>

#include "files.h"
#include "relume/scene/merge.h"
#include "relume/transport/occlusion_volume.h"

namespace relume::app {
namespace {

/// Three to five numbers after the last '@'.
std::vector<float> numbersOf(const std::string& text, std::size_t begin) {
  std::vector<float> values;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    float v = 0;
    const auto [stop, ec] = std::from_chars(text.data() + begin, text.data() + end, v);
    if (ec != std::errc() || stop != text.data() + end || !(std::abs(v) < kInfinity)) return {};
    values.push_back(v);
    begin = end + 1;
  }
  return values;
}

}  // namespace

Group addObject(scene::Scene& scene, const std::string& text) {
  const std::size_t at = text.rfind('@');
  const std::vector<float> v = at == std::string::npos ? std::vector<float>() : numbersOf(text, at + 1);
  if (v.size() < 3 || v.size() > 5 || (v.size() == 5 && !(v[4] > 0)))
    throw Error(ErrorCode::kUsage, "--object " + text, "does not say what stands where",
                "write FILE.glb@x,y,z, in metres, or FILE.glb@x,y,z,turn,scale, turn in degrees");
  Mat4 place = glm::translate(Mat4(1), Vec3(v[0], v[1], v[2]));
  if (v.size() > 3) place = glm::rotate(place, glm::radians(v[3]), Vec3(0, 1, 0));
  if (v.size() > 4) place = glm::scale(place, Vec3(v[4]));
  const auto opened = open(text.substr(0, at), {.normal_maps = true});
  return scene::addObject(scene, opened->scene, place);
}

render::Object objectOf(const scene::Scene& scene, const Group& group) {
  scene::Scene alone;
  alone.meshes = scene.meshes, alone.materials = scene.materials, alone.textures = scene.textures;
  for (const std::uint32_t i : group) alone.instances.push_back(scene.instances[i]);
  const trace::Tracer tracer(alone, {.isa = "", .include_dynamic = true});
  const transport::OcclusionVolume volume = transport::occlusionVolume(tracer, scene::boundsOf(scene, group));
  return {.instances = group, .occlusion = {.box = volume.box, .side = volume.side, .cells = volume.cells}};
}

}  // namespace relume::app
