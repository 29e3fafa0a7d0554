// SPDX-License-Identifier: MIT
#include "heap.h"

#include <cstddef>  // tells of the C library

#if defined(__GLIBC__)
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#endif

namespace relume::app {

void prepareHeap() {
#if defined(__GLIBC__)
  constexpr int kRoom = 256 << 20, kLarge = 32 << 20;
  mallopt(M_MMAP_THRESHOLD, kLarge);  // above it, memory goes back to the system at once
  mallopt(M_TRIM_THRESHOLD, kRoom);
  mallopt(M_TOP_PAD, kRoom);
  void* volatile room = std::malloc(kLarge / 2);  // volatile: or the compiler leaves the pair out
  std::free(room);
  mallopt(M_TOP_PAD, kLarge);
  constexpr std::uintptr_t kPage = 2u << 20;
  const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0)) & ~(kPage - 1);
  const std::uintptr_t begin = end - (kRoom - 2 * kPage);
  // Advice: where the system has no large pages nothing changes.
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

}  // namespace relume::app
