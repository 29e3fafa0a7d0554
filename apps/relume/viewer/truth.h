// SPDX-License-Identifier: MIT
// What is seen, path-traced little by little on other threads, and how far the window's picture is from it.
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "relume/core/light.h"
#include "relume/core/progress.h"
#include "relume/image/image.h"
#include "relume/picture/picture.h"
#include "relume/scene/scene.h"
#include "relume/transport/reference.h"

namespace relume::app {

class Truth {
 public:
  /// Keeps a copy of the scene.
  explicit Truth(const scene::Scene& scene);
  ~Truth();
  Truth(const Truth&) = delete;
  Truth& operator=(const Truth&) = delete;

  /// Begins anew where anything differs from what is being traced.
  void want(const picture::Viewpoint& viewpoint, const LightSet& lights, transport::Materials materials,
            IVec2 size);
  /// The mean so far, linear; its number of samples a pixel, 0 at first.
  std::uint32_t picture(image::Image& out) const;

 private:
  struct Wanted {
    picture::Viewpoint viewpoint;
    std::string text;  ///< of viewpoint and lights
    transport::Materials materials = transport::Materials::kFull;
    IVec2 size{0, 0};
  };
  void stop();
  void run();

  scene::Scene scene_;
  Wanted wanted_;
  std::unique_ptr<SilentProgress> progress_;
  std::thread thread_;
  mutable std::mutex mutex_;
  image::Image sum_;
  std::uint32_t samples_ = 0;
};

}  // namespace relume::app
