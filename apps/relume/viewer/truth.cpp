// SPDX-License-Identifier: MIT
#include "viewer/truth.h"

#include "recorded_path.h"
#include "relume/core/error.h"
#include "relume/picture/primary_rays.h"

namespace relume::app {
namespace {

constexpr std::uint32_t kRound = 4, kMost = 4096;  // samples a pixel

}  // namespace

Truth::Truth(const scene::Scene& scene) : scene_(scene) {}

Truth::~Truth() { stop(); }

void Truth::stop() {
  if (progress_) progress_->cancel();
  if (thread_.joinable()) thread_.join();
}

void Truth::want(const picture::Viewpoint& viewpoint, const LightSet& lights, transport::Materials materials,
                 IVec2 size) {
  std::string text = toJson({{viewpoint, lights, {}}});
  if (size == wanted_.size && materials == wanted_.materials && text == wanted_.text) return;
  stop();
  wanted_ = {viewpoint, std::move(text), materials, size};
  scene_.lights = lights;
  sum_ = image::Image(size.x, size.y, 3);
  samples_ = 0;
  progress_ = std::make_unique<SilentProgress>();
  thread_ = std::thread([this] { run(); });
}

void Truth::run() {
  try {
    const transport::Reference reference(scene_, {.isa = "", .include_dynamic = true});
    const picture::PrimaryRays rays(wanted_.viewpoint, wanted_.size.x, wanted_.size.y);
    for (std::uint32_t round = 0; round * kRound < kMost && !progress_->cancelled(); ++round) {
      transport::ReferenceOptions how;
      how.samples = kRound;
      how.seed = 1 + round;
      how.materials = wanted_.materials;
      const transport::ReferenceImage one = reference.image(
          wanted_.size.x, wanted_.size.y, [&](Vec2 place) { return rays.at(place); }, how, *progress_);
      const std::scoped_lock lock(mutex_);
      for (std::size_t i = 0; i < sum_.data.size(); ++i)
        sum_.data[i] += static_cast<float>(kRound) * one.radiance.data[i];
      samples_ += kRound;
    }
  } catch (const Error&) {
    // Cancelled; what there is stays.
  }
}

std::uint32_t Truth::picture(image::Image& out) const {
  const std::scoped_lock lock(mutex_);
  if (samples_ == 0) return 0;
  out = sum_;
  for (float& v : out.data) v /= static_cast<float>(samples_);
  return samples_;
}

}  // namespace relume::app
