// SPDX-License-Identifier: MIT
// Parallel loops. A body writes only to slots of its own item and sums are formed afterwards in item order,
// so results do not depend on the number of threads.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>

#include "relume/core/progress.h"

namespace relume {

/// Limits the number of worker threads while it lives; 0 means all cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

int threadCount();

/// Calls body(begin, end) for disjoint ranges that cover [0, count), each at most `grain` items and starting
/// at a multiple of it. Stops early and throws Error(kInterrupted) when `progress` is cancelled; advances it
/// by the items done. An exception of a body is passed on.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body, Progress* progress = nullptr);

}  // namespace relume
