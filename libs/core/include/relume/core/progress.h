// SPDX-License-Identifier: MIT
// Progress of long work and its cancellation. Libraries report; the application decides how it looks.
#pragma once
#include <atomic>
#include <cstdint>
#include <string_view>

namespace relume {

/// Told of stages and of items done in them. `advance` may be called from any thread.
class Progress {
 public:
  virtual ~Progress() = default;
  virtual void begin(std::string_view stage, std::uint64_t items) = 0;
  virtual void advance(std::uint64_t items) = 0;
  virtual void end() = 0;

  void cancel() { cancelled_ = true; }  ///< safe in a signal handler
  bool cancelled() const { return cancelled_; }
  /// Throws Error(kInterrupted) when cancelled.
  void throwIfCancelled() const;

 private:
  std::atomic<bool> cancelled_{false};
};

/// Says nothing.
class SilentProgress : public Progress {
 public:
  void begin(std::string_view, std::uint64_t) override {}
  void advance(std::uint64_t) override {}
  void end() override {}
};

/// One stage of work: begins when made, ends when it leaves scope.
class Stage {
 public:
  Stage(Progress& progress, std::string_view name, std::uint64_t items) : progress_(progress) {
    progress_.throwIfCancelled();
    progress_.begin(name, items);
  }
  ~Stage() { progress_.end(); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  void advance(std::uint64_t items = 1) { progress_.advance(items); }

 private:
  Progress& progress_;
};

}  // namespace relume
