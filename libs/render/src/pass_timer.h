// SPDX-License-Identifier: MIT
// How long the device takes for each pass, without waiting for it: queries are read a few frames later.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "gl_objects.h"
#include "relume/render/renderer.h"

namespace relume::render {

class PassTimer {
 public:
  /// Takes in what earlier frames have to tell.
  void beginFrame();
  void begin(const char* pass);
  void end() { glEndQuery(GL_TIME_ELAPSED); }
  /// Of the last frame that is known; passes that did not run then are missing.
  const std::vector<PassTime>& times() const { return known_; }

 private:
  static constexpr std::size_t kFrames = 4;
  struct Pass {
    std::string name;
    Handle<DeleteQuery> query;
  };
  struct Recorded {
    std::vector<Pass> passes;
    std::size_t used = 0;
  };
  std::array<Recorded, kFrames> frames_;
  std::size_t now_ = 0;
  std::vector<PassTime> known_;
};

/// A pass lasts as long as its scope.
class TimedPass {
 public:
  TimedPass(PassTimer& timer, const char* name) : timer_(timer) { timer_.begin(name); }
  ~TimedPass() { timer_.end(); }
  TimedPass(const TimedPass&) = delete;
  TimedPass& operator=(const TimedPass&) = delete;

 private:
  PassTimer& timer_;
};

}  // namespace relume::render
