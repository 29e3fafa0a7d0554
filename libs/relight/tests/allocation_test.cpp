// SPDX-License-Identifier: MIT
// An engine calls evaluate every frame: after the first call it may not touch the heap.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "relume/relight/obscurance.h"

namespace {
thread_local std::size_t allocations = 0;
}

// Counting stand-ins for the whole test program; only the calling thread's count is looked at.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace relume::relight {
namespace {

TEST(Obscurance, AllocatesNothingAfterTheFirstCall) {
  asset::Asset a;
  a.atlas.width = a.atlas.height = 64;
  a.atlas.pages = 1;
  for (std::uint32_t t = 0; t < 4096; ++t) a.atlas.texel.push_back(t);
  a.atlas.position.assign(4096, Point(0));
  a.atlas.normal.assign(4096, Normal(0, 1, 0));
  asset::Layer layer;
  layer.planes = {{.name = "value", .values = std::vector<float>(4096, 1.0f)}};
  ObscuranceRelighter relighter(a, layer);
  LightSet lights(20, Light{.position = {0, 1, 0}});
  const VisibilitySource half = [](std::size_t, std::span<float> v) { std::fill(v.begin(), v.end(), 0.5f); };
  for (const VisibilitySource& visibility : {VisibilitySource(), half}) {
    relighter.evaluate(lights, {}, visibility);
    const std::size_t before = allocations;
    lights[7].intensity += 1;
    relighter.evaluate(lights, {}, visibility);
    EXPECT_EQ(allocations, before);
  }
}

}  // namespace
}  // namespace relume::relight
