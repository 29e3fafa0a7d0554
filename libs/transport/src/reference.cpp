// SPDX-License-Identifier: MIT
#include "relume/transport/reference.h"

#include <algorithm>
#include <cmath>

#include "estimation.h"
#include "path_tracer.h"
#include "relume/transport/emitters.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kPixelRuns = 4, kPointRuns = 16;
constexpr int kBlock = 16;  // pixels, both ways: what converges together

/// u in [0, 1) to the tent density 1 - |x| on [-1, 1].
float toTent(float u) { return u < 0.5f ? std::sqrt(2.0f * u) - 1.0f : 1.0f - std::sqrt(2.0f - 2.0f * u); }

trace::TracerOptions stopping(trace::TracerOptions options) {
  options.stop_at_transmission = true;
  return options;
}

}  // namespace

struct Reference::Impl {
  Impl(const scene::Scene& scene, const trace::TracerOptions& options)
      : tracer(scene, stopping(options)), emitters(scene, options.include_dynamic) {}
  trace::Tracer tracer;
  Emitters emitters;
};

Reference::Reference(const scene::Scene& scene, const trace::TracerOptions& options)
    : impl_(std::make_unique<Impl>(scene, options)) {}
Reference::~Reference() = default;
Reference::Reference(Reference&&) noexcept = default;

const trace::Tracer& Reference::tracer() const { return impl_->tracer; }

ReferenceImage Reference::image(int width, int height, const PrimaryRay& primary,
                                const ReferenceOptions& options, Progress& progress) const {
  const auto blocks_x = static_cast<std::size_t>((width + kBlock - 1) / kBlock),
             blocks_y = static_cast<std::size_t>((height + kBlock - 1) / kBlock);
  Estimation::Layout layout;
  layout.items = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  layout.runs = kPixelRuns;
  layout.groups = blocks_x * blocks_y;
  layout.members = [=](std::size_t group, std::vector<std::uint32_t>& items) {
    const int x0 = static_cast<int>(group % blocks_x) * kBlock,
              y0 = static_cast<int>(group / blocks_x) * kBlock;
    for (int y = y0; y < std::min(y0 + kBlock, height); ++y)
      for (int x = x0; x < std::min(x0 + kBlock, width); ++x)
        items.push_back(static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(width) +
                        static_cast<std::uint32_t>(x));
  };
  const auto make = [&]() -> Estimation::Sample {
    auto tracer = std::make_shared<PathTracer>(impl_->tracer, impl_->emitters, options);
    return [tracer, &primary, width](std::uint32_t item, PathSampler& sampler) {
      const Vec2 u = sampler.pair();
      const Vec2 pixel(static_cast<float>(item % static_cast<std::uint32_t>(width)),
                       static_cast<float>(item / static_cast<std::uint32_t>(width)));
      return tracer->radiance(primary(pixel + 0.5f + Vec2(toTent(u.x), toTent(u.y))), sampler);
    };
  };
  const Estimation estimation(layout, options, make, progress);
  ReferenceImage result{image::Image(width, height, 3), image::Image(width, height, 1), estimation.samples()};
  for (std::size_t i = 0; i < layout.items; ++i) {
    const Vec3 mean = estimation.mean(i);
    for (std::size_t c = 0; c < 3; ++c) result.radiance.data[3 * i + c] = mean[static_cast<int>(c)];
    result.error.data[i] = estimation.luminanceError(i);
  }
  return result;
}

ReferenceIrradiance Reference::irradiance(std::span<const Receiver> receivers,
                                          const ReferenceOptions& options, Progress& progress) const {
  Estimation::Layout layout;
  layout.items = layout.groups = receivers.size();
  layout.runs = kPointRuns;
  layout.members = [](std::size_t group, std::vector<std::uint32_t>& items) {
    items.push_back(static_cast<std::uint32_t>(group));
  };
  const auto make = [&]() -> Estimation::Sample {
    auto tracer = std::make_shared<PathTracer>(impl_->tracer, impl_->emitters, options);
    return [tracer, receivers](std::uint32_t item, PathSampler& sampler) {
      return tracer->irradiance(receivers[item], sampler);
    };
  };
  const Estimation estimation(layout, options, make, progress);
  ReferenceIrradiance result;
  result.samples = estimation.samples();
  for (std::size_t i = 0; i < layout.items; ++i) {
    result.value.emplace_back(estimation.mean(i));
    result.error.emplace_back(estimation.error(i));
  }
  return result;
}

}  // namespace relume::transport
