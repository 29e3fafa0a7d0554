// SPDX-License-Identifier: MIT
// The store with a solver whose rows are known: what is reused, what is computed again, what survives an
// interruption.
#include "texel_store.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "relume/core/error.h"

namespace relume::bake {
namespace {
namespace fs = std::filesystem;

// Texels along the x axis, one metre apart, one below the other on the page; instance 0 holds them all but
// the last ten, which are instance 1.
atlas::Texels line(std::uint32_t count) {
  atlas::Texels texels{.width = 1, .height = static_cast<int>(count), .pages = 1};
  for (std::uint32_t i = 0; i < count; ++i) {
    atlas::SurfacePoint p;
    p.texel = i;
    p.instance = i + 10 < count ? 0 : 1;
    p.position = {static_cast<float>(i), 0, 0};
    p.dp_dx = {0.01f, 0, 0}, p.dp_dy = {0, 0, 0.01f};
    texels.points.push_back(p);
  }
  return texels;
}

Placement placed(std::uint32_t instance, float x, float extent) {
  Placement p{.instance = instance};
  p.world_from_local[3] = {x, 0, 0, 1};
  p.bounds.add(Point(x, 0, 0)), p.bounds.add(Point(x + extent, 0, 0));
  return p;
}

class StoreTest : public testing::Test {
 protected:
  StoreTest() : folder_(fs::temp_directory_path() / ("relume_store_test_" + std::to_string(::getpid()))) {}
  ~StoreTest() override { fs::remove_all(folder_); }

  // Row = {index, what the world looks like from there}; counts what it computes.
  TexelSolver solver(float world, float reach = 3.0f) {
    TexelSolver s;
    s.row = 2;
    s.reach = reach;
    s.key = Hasher().add(std::string_view("test")).add(reach).digest();
    s.solve = [this, world](std::span<const std::uint32_t> which, std::span<float> rows, Progress& progress) {
      for (std::size_t i = 0; i < which.size(); ++i) {
        rows[2 * i] = static_cast<float>(which[i]), rows[2 * i + 1] = world;
        ++computed_;
      }
      if (computed_ >= stop_after_) progress.cancel(), progress.throwIfCancelled();
      return which.size();
    };
    return s;
  }

  fs::path folder_;
  std::size_t computed_ = 0, stop_after_ = ~std::size_t{0};
  SilentProgress progress_;
};

TEST_F(StoreTest, ComputesOnceAndReuses) {
  const atlas::Texels texels = line(100);
  const auto s = solver(1);
  const std::vector<Placement> now = {placed(0, 0, 90), placed(1, 90, 10)};
  TexelStore first(folder_, {1, 2}, s, texels, now);
  EXPECT_EQ(first.reused(), 0u);
  EXPECT_EQ(first.complete(s, progress_), 100u);
  TexelStore second(folder_, {1, 2}, s, texels, now);
  EXPECT_EQ(second.reused(), 100u);
  EXPECT_TRUE(second.staleBecause().empty());
  EXPECT_EQ(second.complete(s, progress_), 0u);
  EXPECT_EQ(second.rows()[2 * 57], 57.0f);
  TexelStore other_geometry(folder_, {1, 3}, s, texels, now);
  EXPECT_EQ(other_geometry.reused(), 0u);
  const auto further = solver(1, 4.0f);
  EXPECT_EQ(TexelStore(folder_, {1, 2}, further, texels, now).reused(), 0u);
}

// An object that spans one metre moves from x = 50 to x = 20: texels within 3 m of either place are computed
// again, and its own.
TEST_F(StoreTest, AMoveTouchesWhatIsWithinReachOfBothPlaces) {
  const atlas::Texels texels = line(100);
  const auto before = solver(1), after = solver(2);
  TexelStore(folder_, {1, 2}, before, texels, {placed(0, 0, 90), placed(1, 50, 1)})
      .complete(before, progress_);
  TexelStore moved(folder_, {1, 2}, after, texels, {placed(0, 0, 90), placed(1, 20, 1)});
  moved.complete(after, progress_);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const bool own = i >= 90, near_old = i >= 47 && i <= 54, near_new = i >= 17 && i <= 24;
    EXPECT_EQ(moved.rows()[2 * i + 1], own || near_old || near_new ? 2.0f : 1.0f) << i;
  }
  EXPECT_NE(moved.staleBecause().find("1 object moved"), std::string::npos);
}

TEST_F(StoreTest, AnInterruptionKeepsWhatIsDone) {
  const atlas::Texels texels = line(100000);
  const std::vector<Placement> now = {placed(0, 0, 1)};
  auto s = solver(1);
  stop_after_ = 40000;  // in the third block: two are kept
  TexelStore interrupted(folder_, {1, 2}, s, texels, now);
  EXPECT_THROW(interrupted.complete(s, progress_), Error);
  stop_after_ = ~std::size_t{0};
  SilentProgress fresh;
  TexelStore resumed(folder_, {1, 2}, s, texels, now);
  EXPECT_GT(resumed.reused(), 0u);
  EXPECT_LT(resumed.reused(), 100000u);
  EXPECT_EQ(resumed.complete(s, fresh), 100000u - resumed.reused());
  for (std::uint32_t i = 0; i < 100000; ++i) ASSERT_EQ(resumed.rows()[2 * i], static_cast<float>(i));
}

// Solvers work on neighbouring rows at once: a band of 16 rows is never asked for in two pieces.
TEST_F(StoreTest, BandsOfRowsStayTogether) {
  atlas::Texels texels{.width = 1000, .height = 100, .pages = 2};
  for (std::uint32_t i = 0; i < 200000; ++i)
    if (i % 7 != 3) texels.points.push_back({.texel = i, .instance = 0});
  std::vector<int> asked(2 * 7, 0);
  TexelSolver s = solver(1);
  s.solve = [&](std::span<const std::uint32_t> which, std::span<float>, Progress&) {
    std::vector<bool> here(asked.size());
    for (const std::uint32_t i : which) {
      const std::uint32_t row = texels.points[i].texel / 1000;
      here[row / 100 * 7 + row % 100 / 16] = true;
    }
    for (std::size_t band = 0; band < here.size(); ++band) asked[band] += here[band];
    return which.size();
  };
  TexelStore("", {1, 2}, s, texels, {placed(0, 0, 1)}).complete(s, progress_);
  EXPECT_EQ(asked, std::vector<int>(14, 1));
}

TEST_F(StoreTest, ADamagedEntryIsAsGoodAsNone) {
  const atlas::Texels texels = line(50);
  const auto s = solver(1);
  const std::vector<Placement> now = {placed(0, 0, 1)};
  TexelStore(folder_, {1, 2}, s, texels, now).complete(s, progress_);
  const fs::path entry = fs::directory_iterator(folder_)->path();
  const auto size = fs::file_size(entry);
  for (const std::uintmax_t cut : {std::uintmax_t{0}, std::uintmax_t{7}, size / 2, size - 1}) {
    fs::resize_file(entry, cut);
    EXPECT_EQ(TexelStore(folder_, {1, 2}, s, texels, now).reused(), 0u) << "cut at " << cut;
    TexelStore(folder_, {1, 2}, s, texels, now).complete(s, progress_);
  }
  std::fstream(entry, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(static_cast<std::streamoff>(size / 2))
      .put('\x7f');
  EXPECT_EQ(TexelStore(folder_, {1, 2}, s, texels, now).reused(), 0u);
}

TEST_F(StoreTest, TrimmingKeepsTheLastUsed) {
  fs::create_directories(folder_);
  for (int i = 0; i < 5; ++i) {
    const fs::path path = folder_ / (std::to_string(i) + ".texels");
    std::ofstream(path) << std::string(1000, 'x');
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(10 - i));
  }
  std::ofstream(folder_ / "other.txt") << "mine";
  trimStore(folder_, 2500);
  EXPECT_FALSE(fs::exists(folder_ / "2.texels"));
  EXPECT_TRUE(fs::exists(folder_ / "3.texels"));
  EXPECT_TRUE(fs::exists(folder_ / "4.texels"));
  EXPECT_TRUE(fs::exists(folder_ / "other.txt"));
}

}  // namespace
}  // namespace relume::bake
