// SPDX-License-Identifier: MIT
#include "alpha_filter.h"

#include "relume/core/sampling.h"

namespace relume::trace {

bool needsAlphaFilter(const scene::Scene& scene, const scene::Mesh& mesh, Passing passing) {
  const scene::Material& material = scene.materials[mesh.material];
  if (passing == Passing::kAlphaAndTransmission && material.transmission > 0.0f) return true;
  if (material.alpha_mode == scene::AlphaMode::kOpaque) return false;
  return material.base_colour.a < 1.0f || material.base_colour_texture || !mesh.colours.empty();
}

template <Passing kPassing>
void alphaFilter(const RTCFilterFunctionNArguments* arguments) {
  const auto& scene = *static_cast<const scene::Scene*>(arguments->geometryUserPtr);
  const unsigned int n = arguments->N;
  for (unsigned int i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned int referenced = RTCHitN_instID(arguments->hit, n, i, 0);
    const unsigned int instance =
        referenced != RTC_INVALID_GEOMETRY_ID ? referenced : RTCHitN_geomID(arguments->hit, n, i);
    const unsigned int triangle = RTCHitN_primID(arguments->hit, n, i);
    float opacity = scene::opacityAt(
        scene, {instance, triangle, RTCHitN_u(arguments->hit, n, i), RTCHitN_v(arguments->hit, n, i)});
    if constexpr (kPassing == Passing::kAlphaAndTransmission)
      opacity *= 1.0f - scene.materials[scene.meshes[scene.instances[instance].mesh].material].transmission;
    if (opacity >= 1.0f) continue;
    const std::uint32_t seed = RTCRayN_id(arguments->ray, n, i);
    const std::uint32_t bits = hashCombine(hashCombine(seed, instance), triangle);
    const float chance = static_cast<float>(bits >> 8) * 0x1p-24f;  // [0, 1)
    if (chance >= opacity) arguments->valid[i] = 0;
  }
}

template void alphaFilter<Passing::kAlphaAndTransmission>(const RTCFilterFunctionNArguments*);
template void alphaFilter<Passing::kAlpha>(const RTCFilterFunctionNArguments*);

}  // namespace relume::trace
