// SPDX-License-Identifier: MIT
// Times the stages of a bake.
#pragma once
#include <chrono>
#include <string>
#include <utility>

#include "relume/bake/statistics.h"

namespace relume::bake {

class Stopwatch {
 public:
  explicit Stopwatch(Statistics& statistics) : statistics_(statistics) {}
  /// Ends the running stage and books it; returns its seconds.
  double lap(std::string name) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    statistics_.stages.push_back({std::move(name), seconds});
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Statistics& statistics_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace relume::bake
