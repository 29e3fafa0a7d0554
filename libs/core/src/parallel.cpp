// SPDX-License-Identifier: MIT
#include "relume/core/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace relume {
namespace {

#if defined(__SANITIZE_THREAD__)
// The thread sanitizer does not see how TBB's library synchronises and would call every loop a race.
template <class Body>
void forEachChunk(std::size_t chunks, const Body& body) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t chunk = next++; chunk < chunks; chunk = next++) {
      try {
        body(chunk);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = chunks;
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < threadCount(); ++i) threads.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}
#else
template <class Body>
void forEachChunk(std::size_t chunks, const Body& body) {
  tbb::parallel_for(std::size_t{0}, chunks, body, tbb::auto_partitioner());
}
#endif

}  // namespace

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
  forEachChunk(chunks, [&](std::size_t chunk) {
    if (progress && progress->cancelled()) return;
    const std::size_t begin = chunk * grain, end = std::min(count, begin + grain);
    body(begin, end);
    if (progress) progress->advance(end - begin);
  });
  if (progress) progress->throwIfCancelled();
}

}  // namespace relume
