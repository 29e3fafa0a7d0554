// SPDX-License-Identifier: MIT
// An engine calls evaluate every frame: after the first call it may not touch the heap.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "made_bake.h"
#include "relume/relight/group_relighter.h"
#include "relume/relight/obscurance.h"
#include "relume/relight/transfer_relighter.h"

namespace {
thread_local std::size_t allocations = 0;
}

// Counting stand-ins for the whole test program; only the calling thread's count is looked at. Not inline, or
// GCC takes malloc and delete for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

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

// Lights that move, are dimmed, leave and return.
TEST(TransferRelighter, AllocatesNothingAfterTheFirstCall) {
  const asset::Asset bake = madeBake({.rows = 3000, .columns = 200, .tiles = 5, .clusters = 3});
  const asset::Asset one_tile =
      madeBake({.rows = 5000, .columns = 200, .bits = 16, .tiles = 1, .clusters = 3, .overlap = 0});
  const VisibilitySource half = [](std::size_t, std::span<float> v) { std::fill(v.begin(), v.end(), 0.5f); };
  for (const asset::Asset* a : {&bake, &one_tile}) {
    TransferRelighter relighter(*a, a->layers[0]);
    const LightSet all(20, Light{.position = {0, 1, 0}});
    relighter.evaluate(all, half);
    LightSet lights = all;
    const LightSet some(all.begin(), all.begin() + 5);
    const std::size_t before = allocations;
    for (int frame = 0; frame < 5; ++frame) {
      lights[7].intensity += 1, lights[3].position.x += 0.1f;
      relighter.evaluate(lights, half);
      relighter.evaluate(some, half);
      relighter.evaluate(lights);
      relighter.forgetVisibility();
    }
    EXPECT_EQ(allocations, before);
  }
}

TEST(GroupRelighter, AllocatesNothing) {
  asset::Asset a;
  a.atlas.width = a.atlas.height = 64;
  a.atlas.pages = 1;
  for (std::uint32_t t = 0; t < 4096; ++t) a.atlas.texel.push_back(t);
  const asset::Plane plane{.name = "a", .channels = 3, .values = std::vector<float>(3 * 4096, 1.0f)};
  GroupRelighter relighter(a, {.kind = "lightgroups", .planes = {plane, plane}});
  const std::vector<Vec3> gains(2, Vec3(0.5f));
  relighter.evaluate(gains);  // the first loop of a process wakes its threads
  const std::size_t before = allocations;
  relighter.evaluate(gains);
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace relume::relight
