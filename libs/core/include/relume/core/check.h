// SPDX-License-Identifier: MIT
// Our mistakes: a check that prints both values and the current work item, then aborts. Never for input of
// others.
#pragma once
#include <cstdint>
#include <sstream>
#include <string>

namespace relume {

/// While it lives, a failing check on this thread names this work item, e.g. {"texel", 4711}.
class WorkItem {
 public:
  WorkItem(const char* kind, std::uint64_t index);
  ~WorkItem();
  WorkItem(const WorkItem&) = delete;
  WorkItem& operator=(const WorkItem&) = delete;

 private:
  const char* outer_kind_;
  std::uint64_t outer_index_;
};

/// How to run this work again, e.g. the command line; printed by failing checks.
void setReplayCommand(std::string command);

[[noreturn]] void checkFailed(const char* file, int line, const char* text, const std::string& values);

namespace detail {
template <class A, class B>
std::string bothValues(const A& a, const B& b) {
  std::ostringstream out;
  out << a << " and " << b;
  return out.str();
}
}  // namespace detail
}  // namespace relume

#define RELUME_CHECK(condition) \
  ((condition) ? void(0) : ::relume::checkFailed(__FILE__, __LINE__, #condition, ""))
#define RELUME_CHECK_OP(a, op, b) \
  (((a)op(b))                     \
       ? void(0)                  \
       : ::relume::checkFailed(__FILE__, __LINE__, #a " " #op " " #b, ::relume::detail::bothValues(a, b)))
#define RELUME_CHECK_EQ(a, b) RELUME_CHECK_OP(a, ==, b)
#define RELUME_CHECK_LT(a, b) RELUME_CHECK_OP(a, <, b)
#define RELUME_CHECK_LE(a, b) RELUME_CHECK_OP(a, <=, b)
