// SPDX-License-Identifier: MIT
#include "reference_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "files.h"
#include "lights.h"
#include "relume/picture/primary_rays.h"
#include "relume/transport/emitters.h"

namespace relume::app {

void lightScene(scene::Scene& scene, const std::string& lights_file, const std::string& ambient) {
  scene.lights = chooseLights(lights_file, scene);
  scene.environment = chooseEnvironment(lights_file);
  if (!ambient.empty()) {
    if (!scene.environment.dark())
      throw Error(ErrorCode::kUsage, "--ambient",
                  fmt::format("stands beside the environment of {}", lights_file), "give one of them");
    scene.environment.radiance = Radiance(parseTriple(ambient, "--ambient", true) * kInvPi);
  } else if (transport::Emitters(scene, true).empty()) {
    print({{scene.name, "has nothing that shines", "it is lit by a white sky; give --lights or --ambient"}});
    scene.environment.radiance = Radiance(1.0f);
  }
}

image::Image referencePicture(const transport::Reference& reference, const picture::Viewpoint& viewpoint,
                              IVec2 size, const transport::ReferenceOptions& options, Progress& progress) {
  const picture::PrimaryRays rays(viewpoint, size.x, size.y);
  transport::ReferenceImage result = reference.image(
      size.x, size.y, [&](Vec2 place) { return rays.at(place); }, options, progress);
  // The median tells of the picture; a mean would tell of its few brightest pixels.
  std::vector<float> relative;
  for (std::size_t i = 0; i < result.error.data.size(); ++i) {
    const float* pixel = result.radiance.data.data() + 3 * i;
    const float brightness = luminance({pixel[0], pixel[1], pixel[2]});
    if (result.error.data[i] > 0 && brightness > 0) relative.push_back(result.error.data[i] / brightness);
  }
  const double spp = static_cast<double>(result.samples) / static_cast<double>(result.error.data.size());
  fmt::print("{:.0f} samples per pixel", spp);
  if (!relative.empty()) {
    const auto middle = relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2);
    std::nth_element(relative.begin(), middle, relative.end());
    const float percent = 100 * *middle;
    fmt::print(", standard error of the median pixel {} %",
               percent >= 10 ? fmt::format("{:.0f}", percent) : fmt::format("{:.2g}", percent));
  }
  fmt::print("\n");
  return std::move(result.radiance);
}

}  // namespace relume::app
