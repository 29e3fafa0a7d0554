// SPDX-License-Identifier: MIT
#include "relume/core/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

namespace relume {

struct ThreadLimit::Impl {
  explicit Impl(int threads)
      : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {}
  tbb::global_control control;  // in force where it was made: never copied
};

ThreadLimit::ThreadLimit(int threads) : impl_(threads > 0 ? std::make_unique<Impl>(threads) : nullptr) {}
ThreadLimit::~ThreadLimit() = default;

int threadCount() {
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return static_cast<int>(
      std::min<std::size_t>(allowed, static_cast<std::size_t>(tbb::info::default_concurrency())));
}

void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body, Progress* progress) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  tbb::parallel_for(
      std::size_t{0}, chunks,
      [&](std::size_t chunk) {
        if (progress && progress->cancelled()) return;
        const std::size_t begin = chunk * grain, end = std::min(count, begin + grain);
        body(begin, end);
        if (progress) progress->advance(end - begin);
      },
      tbb::auto_partitioner());
  if (progress) progress->throwIfCancelled();
}

}  // namespace relume
