// SPDX-License-Identifier: MIT
#include "pass_timer.h"

namespace relume::render {

void PassTimer::beginFrame() {
  now_ = (now_ + 1) % kFrames;
  Recorded& oldest = frames_[now_];
  if (oldest.used) {
    known_.clear();
    for (std::size_t i = 0; i < oldest.used; ++i) {
      GLuint64 nanoseconds = 0;
      glGetQueryObjectui64v(oldest.passes[i].query.name(), GL_QUERY_RESULT, &nanoseconds);
      known_.push_back({oldest.passes[i].name, 1e-9 * static_cast<double>(nanoseconds)});
    }
  }
  oldest.used = 0;
}

void PassTimer::begin(const char* pass) {
  Recorded& frame = frames_[now_];
  if (frame.used == frame.passes.size()) {
    GLuint name = 0;
    glCreateQueries(GL_TIME_ELAPSED, 1, &name);
    frame.passes.push_back({"", Handle<DeleteQuery>(name)});
  }
  Pass& p = frame.passes[frame.used++];
  p.name = pass;
  glBeginQuery(GL_TIME_ELAPSED, p.query.name());
}

}  // namespace relume::render
