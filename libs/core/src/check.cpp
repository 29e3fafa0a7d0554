// SPDX-License-Identifier: MIT
#include "relume/core/check.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace relume {
namespace {
thread_local const char* t_kind = nullptr;
thread_local std::uint64_t t_index = 0;
std::string& replayCommand() {
  static std::string command;
  return command;
}
}  // namespace

WorkItem::WorkItem(const char* kind, std::uint64_t index) : outer_kind_(t_kind), outer_index_(t_index) {
  t_kind = kind, t_index = index;
}
WorkItem::~WorkItem() { t_kind = outer_kind_, t_index = outer_index_; }

void setReplayCommand(std::string command) { replayCommand() = std::move(command); }

void checkFailed(const char* file, int line, const char* text, const std::string& values) {
  std::fprintf(stderr, "relume: internal error at %s:%d: %s", file, line, text);
  if (!values.empty()) std::fprintf(stderr, " (values: %s)", values.c_str());
  if (t_kind) std::fprintf(stderr, ", %s %llu", t_kind, static_cast<unsigned long long>(t_index));
  if (!replayCommand().empty()) std::fprintf(stderr, "\n  replay: %s", replayCommand().c_str());
  std::fputc('\n', stderr);
  std::abort();
}

}  // namespace relume
