// SPDX-License-Identifier: MIT
#include "console_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace relume::app {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kInterval = std::chrono::milliseconds(100);

double secondsSince(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

std::string duration(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

// Keeps the outermost stage (libraries may begin stages inside a stage) and tells of it at most ten times a
// second.
class ConsoleProgress : public Progress {
 public:
  void begin(std::string_view stage, std::uint64_t items) override {
    const std::lock_guard lock(mutex_);
    if (depth_++ > 0) return;
    stage_ = stage, items_ = items, done_ = 0, started_ = Clock::now(), told_ = {};
    tell(0);
  }
  void advance(std::uint64_t items) override {
    const std::uint64_t done = done_.fetch_add(items) + items;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || Clock::now() - told_ < kInterval || items_ == 0) return;
    tell(std::min(1.0, static_cast<double>(done) / static_cast<double>(items_)));
  }
  void end() override {
    const std::lock_guard lock(mutex_);
    if (--depth_ > 0) return;
    tell(1);
    finish();
  }

 protected:
  virtual void show(const std::string& stage, double fraction, double elapsed, double left) = 0;
  virtual void finish() {}

 private:
  void tell(double fraction) {
    told_ = Clock::now();
    const double elapsed = secondsSince(started_);
    show(stage_, fraction, elapsed, fraction > 0 ? elapsed * (1 - fraction) / fraction : -1);
  }

  std::mutex mutex_;
  std::string stage_;
  std::uint64_t items_ = 0;
  std::atomic<std::uint64_t> done_{0};
  int depth_ = 0;
  Clock::time_point started_, told_;
};

class LineProgress : public ConsoleProgress {
 protected:
  void show(const std::string& stage, double fraction, double elapsed, double left) override {
    constexpr int kWidth = 24;
    const int filled = static_cast<int>(fraction * kWidth);
    const std::string remaining = left >= 0.5 && elapsed > 1 ? fmt::format(", {} left", duration(left)) : "";
    fmt::print(stderr, "\r\033[K  {:<24} [{}{}] {:3.0f} %  {}{}", stage,
               std::string(static_cast<std::size_t>(filled), '#'),
               std::string(static_cast<std::size_t>(kWidth - filled), '.'), fraction * 100, duration(elapsed),
               remaining);
    std::fflush(stderr);
  }
  void finish() override {
    fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
  }
};

class JsonProgress : public ConsoleProgress {
 protected:
  void show(const std::string& stage, double fraction, double elapsed, double left) override {
    nlohmann::ordered_json line{{"stage", stage}, {"fraction", fraction}, {"elapsed_s", elapsed}};
    if (left >= 0) line["left_s"] = left;
    fmt::print(stderr, "{}\n", line.dump());
    std::fflush(stderr);
  }
};

}  // namespace

std::unique_ptr<Progress> makeConsoleProgress(const std::string& mode) {
  if (mode == "json") return std::make_unique<JsonProgress>();
  if (mode == "auto" && ::isatty(STDERR_FILENO)) return std::make_unique<LineProgress>();
  return std::make_unique<SilentProgress>();
}

}  // namespace relume::app
