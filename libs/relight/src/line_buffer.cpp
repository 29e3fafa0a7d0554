// SPDX-License-Identifier: MIT
#include "line_buffer.h"

#include <cstring>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace relume::relight {
namespace {
constexpr std::align_val_t kPage{std::size_t{2} << 20};
}

LineBuffer::LineBuffer(std::size_t lines) {
  if (lines == 0) return;
  const std::size_t page = static_cast<std::size_t>(kPage);
  const std::size_t bytes = (lines * sizeof(Line) + page - 1) / page * page;
  void* memory = ::operator new(bytes, kPage);
#if defined(__linux__)
  madvise(memory, bytes, MADV_HUGEPAGE);  // advice: where it is refused nothing is lost but speed
#endif
  std::memset(memory, 0, lines * sizeof(Line));
  lines_.reset(static_cast<Line*>(memory));
}

void LineBuffer::Release::operator()(Line* lines) const { ::operator delete(lines, kPage); }

}  // namespace relume::relight
