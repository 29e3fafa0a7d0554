// SPDX-License-Identifier: MIT
#include "lightmap/texel_lookup.h"

#include <gtest/gtest.h>

#include "lightmap/substitutes.h"
#include "made_rooms.h"
#include "relume/atlas/atlas.h"
#include "relume/core/sampling.h"
#include "relume/trace/tracer.h"

namespace relume::transport {
namespace {

struct Room {
  explicit Room(int page_size) : scene(made::colouredRoom(true)) {
    Warnings warnings;
    SilentProgress silent;
    atlas = atlas::buildAtlas(scene, {.page_size = page_size}, warnings, silent);
    texels = atlas::rasterize(scene, atlas, silent);
  }
  scene::Scene scene;
  atlas::Atlas atlas;
  atlas::Texels texels;
};

TEST(TexelLookup, EveryPlaceOfEverySurfaceHasItsTexel) {
  const Room room(64);
  const TexelLookup lookup(room.scene, room.atlas, room.texels);
  int places = 0;
  trace::HitPacket packet{};
  packet.hit = 0x7fff;  // all but the last lane
  LaneTexels texels;
  for (std::uint32_t instance = 0; instance < room.scene.instances.size(); ++instance) {
    const scene::Mesh& mesh = room.scene.meshes[room.scene.instances[instance].mesh];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::uint32_t i = 0; i < 200; ++i, ++places) {
        Vec2 u = sobol2(i, t);
        if (u.x + u.y > 1.0f) u = 1.0f - u;
        const scene::Hit hit{instance, t, u.x, u.y};
        const std::uint32_t point = lookup.point(hit);
        ASSERT_NE(point, scene::kNone);
        const std::uint32_t lane = i % 16;
        packet.instance[lane] = hit.instance, packet.triangle[lane] = t;
        packet.b1[lane] = u.x, packet.b2[lane] = u.y;
        lookup.texels(packet, texels);
        EXPECT_EQ(lookup.pointOf(texels[lane]), lane == 15 ? scene::kNone : point);
        const atlas::SurfacePoint& p = room.texels.points[point];
        EXPECT_EQ(p.instance, instance);
        // The texel's own place is at most a diagonal away.
        EXPECT_LT(glm::length(p.position - scene::worldPosition(room.scene, hit)),
                  1.01f * (glm::length(p.dp_dx) + glm::length(p.dp_dy)));
      }
    }
  }
  EXPECT_GT(places, 4000);
}

TEST(Substitutes, BuriedTexelsAreAnsweredByNeighboursOfTheirChart) {
  atlas::Texels grid = made::texelGrid(12, 4, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (atlas::SurfacePoint& p : grid.points) p.chart = p.texel % 12 < 6 ? 0 : 1;
  std::vector<std::uint8_t> buried(grid.points.size(), 0);
  EXPECT_EQ(substitutes(grid, buried)[17], 17u);
  // The left chart is buried but for its first column: three rings are answered, the rest answers for itself,
  // and nothing comes from the other chart.
  for (const atlas::SurfacePoint& p : grid.points) buried[p.texel] = p.texel % 12 >= 1 && p.texel % 12 < 6;
  const std::vector<std::uint32_t> answer = substitutes(grid, buried);
  for (std::uint32_t y = 0; y < 4; ++y) {
    for (std::uint32_t x = 1; x <= 3; ++x) {
      EXPECT_EQ(answer[12 * y + x] % 12, 0u);
    }
    for (std::uint32_t x = 4; x <= 6; ++x) {
      EXPECT_EQ(answer[12 * y + x], 12 * y + x);
    }
  }
}

}  // namespace
}  // namespace relume::transport
