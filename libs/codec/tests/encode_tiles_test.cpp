// SPDX-License-Identifier: MIT
#include "relume/codec/encode_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "example_transfer.h"
#include "relume/core/error.h"

namespace relume::codec {
namespace {

using test::TwoRooms;

constexpr float kLightDistance = 0.5f;  // to surfaces, metres

class TwoRoomTiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    rooms_ = new TwoRooms({.elements = 1000, .entries = 192, .rows = 3000});
    lights_ = new Lights{rooms_->light(rooms_->lightPositions(128, 1, kLightDistance)),
                         rooms_->light(rooms_->lightPositions(24, 2, kLightDistance))};
  }
  static void TearDownTestSuite() {
    delete rooms_;
    delete lights_;
  }

  static Transfer transfer(float band = 0.25f) {
    return test::transferOf(
        rooms_->transfer, 192, 3,
        test::overlappingTiles(rooms_->row_position, rooms_->row_normal, test::kTwoRoomsArea, 64, band));
  }

  static TwoRooms* rooms_;
  static Lights* lights_;
};
TwoRooms* TwoRoomTiles::rooms_ = nullptr;
Lights* TwoRoomTiles::lights_ = nullptr;

TEST_F(TwoRoomTiles, MeetBoundsWithoutWaste) {
  const Transfer t = transfer();
  std::size_t before = 0;
  for (const double error : {0.1, 0.05, 0.02}) {
    const EncodedTiles e =
        encodeTiles(t, test::clustersOf(*rooms_, 2), *lights_, {.error = error, .row_error = 5 * error});
    e.matrix.check();
    EXPECT_TRUE(e.report.met);
    EXPECT_LE(e.report.error.mean, error);
    EXPECT_LE(e.report.error.row_p95, 5 * error);
    // One of the two bounds is what stopped it.
    EXPECT_TRUE(e.report.error.mean > 0.9 * error || e.report.error.row_p95 > 0.9 * 5 * error);
    EXPECT_GT(e.matrix.bytes(), before);
    before = e.matrix.bytes();
  }
}

TEST_F(TwoRoomTiles, ReportTellsTheTruth) {
  const Transfer t = transfer();
  const EncodedTiles e = encodeTiles(t, test::clustersOf(*rooms_, 3), *lights_, {.error = 0.03});
  const EncodeError m = measure(e.matrix, lights_->held_out, products(t, lights_->held_out));
  EXPECT_NEAR(m.mean, e.report.error.mean, 1e-5);
  EXPECT_NEAR(m.worst, e.report.error.worst, 1e-5);
  EXPECT_NEAR(m.row_p95, e.report.error.row_p95, 1e-4);
  EXPECT_EQ(e.report.bytes, e.matrix.bytes());
  EXPECT_EQ(e.report.plane_bytes + e.report.weight_bytes + e.report.index_bytes, e.report.bytes);
  std::size_t blocks = 0, components = 0;
  for (std::size_t k = 0; k < e.report.rank_count.size(); ++k) {
    blocks += e.report.rank_count[k];
    components += k * e.report.rank_count[k];
  }
  EXPECT_EQ(blocks, e.matrix.tiles() * e.matrix.clusters());
  EXPECT_EQ(components, e.matrix.components());
  EXPECT_LT(e.report.rounding_share, 0.1);
}

TEST_F(TwoRoomTiles, MeasureMultipliesAsThePlainProductDoes) {
  const Transfer t = transfer();
  const ColumnClusters clusters = test::clustersOf(*rooms_, 3);
  for (const std::uint32_t bits : {8u, 16u}) {
    const EncodedTiles e = encodeTiles(t, clusters, *lights_, {.error = 0, .rank = 3, .bits = bits});
    std::vector<float> y(std::size_t{24} * t.rows * 3);
    for (std::size_t l = 0; l < 24; ++l) {
      std::vector<float> in;
      for (std::size_t j = 0; j < 192; ++j) in.insert(in.end(), 3, lights_->held_out[l * 192 + j]);
      multiply(e.matrix, in, std::span(y).subspan(l * t.rows * 3, std::size_t{3} * t.rows));
    }
    EXPECT_LT(measure(e.matrix, lights_->held_out, y).worst, 1e-5);
  }
}

TEST_F(TwoRoomTiles, ProductsAreThoseOfTheMatrix) {
  const Transfer t = transfer();
  std::vector<float> unit(192);
  unit[17] = 1;
  const std::vector<float> y = products(t, unit);
  for (std::size_t i = 0; i < y.size(); ++i)
    EXPECT_NEAR(y[i], rooms_->transfer[i * 192 + 17], 1e-6f + 1e-5f * rooms_->transfer[i * 192 + 17]);
}

TEST_F(TwoRoomTiles, DarkRowsHaveTheirOwnBound) {
  const Transfer t = transfer();
  const ColumnClusters c = test::clustersOf(*rooms_, 2);
  const EncodedTiles bright = encodeTiles(t, c, *lights_, {.error = 0.05, .row_error = 0});
  const EncodedTiles dark =
      encodeTiles(t, c, *lights_, {.error = 0.05, .row_error = 0.6 * bright.report.error.row_p95});
  EXPECT_LE(dark.report.error.row_p95, 0.6 * bright.report.error.row_p95);
  EXPECT_GT(dark.matrix.bytes(), bright.matrix.bytes());
}

TEST_F(TwoRoomTiles, DarkRowsCostNoMoreThanAllowed) {
  const Transfer t = transfer();
  const ColumnClusters c = test::clustersOf(*rooms_, 2);
  const TileOptions bright_only{.error = 0.05, .row_error = 0};
  TileOptions out_of_reach{.error = 0.05, .row_error = 1e-3, .row_bytes = 0.2};
  const EncodeReport bright = encodeTiles(t, c, *lights_, bright_only).report;
  const EncodeReport dark = encodeTiles(t, c, *lights_, out_of_reach).report;
  EXPECT_EQ(bright.row_bytes, 0u);
  EXPECT_FALSE(dark.met);
  EXPECT_LE(dark.error.mean, 0.05);
  EXPECT_LT(dark.error.row_p95, bright.error.row_p95);
  EXPECT_GT(dark.row_bytes, 0u);
  EXPECT_NEAR(static_cast<double>(dark.bytes) / static_cast<double>(bright.bytes), 1.2, 0.05);
  EXPECT_EQ(dark.bytes - dark.row_bytes, bright.bytes);
}

TEST_F(TwoRoomTiles, SmallerThanOneTile) {
  // The point of tiles: at equal error, one tile of all rows takes far more.
  RowTiles one{{0, static_cast<std::uint32_t>(rooms_->rows)}, {}, std::vector<float>(rooms_->rows, 1.0f)};
  for (std::uint32_t r = 0; r < rooms_->rows; ++r) one.row.push_back(r);
  const TileOptions options{.error = 0.03, .row_error = 0};
  const ColumnClusters c = test::clustersOf(*rooms_, 1);
  const EncodedTiles whole =
      encodeTiles(test::transferOf(rooms_->transfer, 192, 3, one), c, *lights_, options);
  const EncodedTiles tiles = encodeTiles(transfer(), c, *lights_, options);
  EXPECT_LT(2 * tiles.matrix.bytes(), whole.matrix.bytes());
}

TEST_F(TwoRoomTiles, NoSeams) {
  // Steps of the error between neighbours, p99, across where one tile ends against inside. Disjoint tiles
  // show them (the second half makes sure that the measure can tell), overlapping ones do not.
  const std::vector<float> x = rooms_->light(rooms_->lightPositions(10, 3, kLightDistance));
  const auto ratio = [&](float band) {
    const Transfer t = transfer(band);
    const EncodedTiles e =
        encodeTiles(t, test::clustersOf(*rooms_, 2), *lights_, {.error = 0.05, .row_error = 0});
    std::vector<std::size_t> main_tile(t.rows);
    std::vector<float> most(t.rows);
    for (std::size_t tile = 0; tile < t.tiles.tiles(); ++tile)
      for (std::size_t i = t.tiles.first[tile]; i < t.tiles.first[tile + 1]; ++i)
        if (t.tiles.blend[i] > most[t.tiles.row[i]]) {
          most[t.tiles.row[i]] = t.tiles.blend[i];
          main_tile[t.tiles.row[i]] = tile;
        }
    const std::vector<float> truth = products(t, x);
    std::vector<float> error = truth;
    for (std::size_t l = 0; l < 10; ++l) {
      std::vector<float> in, y(t.rows * 3);
      for (std::size_t j = 0; j < 192; ++j) in.insert(in.end(), 3, x[l * 192 + j]);
      multiply(e.matrix, in, y);
      for (std::size_t i = 0; i < y.size(); ++i) error[l * y.size() + i] -= y[i];
    }
    const float near = 1.35f * std::sqrt(test::kTwoRoomsArea / static_cast<float>(t.rows));
    std::vector<float> inside, across;
    for (std::size_t a = 0; a < t.rows; ++a)
      for (std::size_t b = a + 1; b < t.rows; ++b)
        if (glm::distance(rooms_->row_position[a], rooms_->row_position[b]) < near &&
            glm::dot(rooms_->row_normal[a], rooms_->row_normal[b]) > 0.99f)
          for (std::size_t i = 0; i < 30; ++i)
            (main_tile[a] == main_tile[b] ? inside : across)
                .push_back(std::abs(error[(i / 3 * t.rows + a) * 3 + i % 3] -
                                    error[(i / 3 * t.rows + b) * 3 + i % 3]));
    const auto p99 = [](std::vector<float>& v) {
      const auto at = v.begin() + static_cast<std::ptrdiff_t>(v.size() * 99 / 100);
      std::nth_element(v.begin(), at, v.end());
      return *at;
    };
    return p99(across) / p99(inside);
  };
  EXPECT_LT(ratio(0.25f), 1.3f);
  EXPECT_GT(ratio(0), 1.8f);
}

TEST_F(TwoRoomTiles, NothingFlickersAsALightMoves) {
  // Through the door, 0.2 m a frame, from one cluster of entries to another: what the error changes by is a
  // small part of what the truth changes by.
  std::vector<Vec3> path;
  for (int i = 0; i < 70; ++i) path.push_back({1.0f + 0.2f * static_cast<float>(i), 1.4f, 3.0f});
  const std::vector<float> x = rooms_->light(path);
  const Transfer t = transfer();
  const EncodedTiles e = encodeTiles(t, test::clustersOf(*rooms_, 3), *lights_, {.error = 0.05});
  const std::vector<float> truth = products(t, x);
  std::vector<float> y(truth.size());
  const std::size_t size = std::size_t{3} * t.rows;
  for (std::size_t l = 0; l < path.size(); ++l) {
    std::vector<float> in;
    for (std::size_t j = 0; j < 192; ++j) in.insert(in.end(), 3, x[l * 192 + j]);
    multiply(e.matrix, in, std::span(y).subspan(l * size, size));
  }
  double sum = 0, worst = 0;
  for (std::size_t l = 1; l < path.size(); ++l) {
    double of_error = 0, of_truth = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const double now = truth[l * size + i], before = truth[(l - 1) * size + i];
      of_error += std::pow((y[l * size + i] - now) - (y[(l - 1) * size + i] - before), 2.0);
      of_truth += std::pow(now - before, 2.0);
    }
    sum += std::sqrt(of_error / of_truth) / static_cast<double>(path.size() - 1);
    worst = std::max(worst, std::sqrt(of_error / of_truth));
  }
  EXPECT_LT(sum, 0.2);
  EXPECT_LT(worst, 0.4);
}

TEST_F(TwoRoomTiles, FixedRankIsWhatWasAskedFor) {
  const EncodedTiles e =
      encodeTiles(transfer(), test::clustersOf(*rooms_, 2), *lights_, {.error = 0, .rank = 5});
  ASSERT_EQ(e.report.rank_count.size(), 6u);
  EXPECT_EQ(e.report.rank_count[5], e.matrix.tiles() * 2);
}

TEST_F(TwoRoomTiles, SixteenBitsTakeTwiceTheBytes) {
  TileOptions options{.error = 0, .rank = 5};
  const EncodedTiles eight = encodeTiles(transfer(), test::clustersOf(*rooms_, 2), *lights_, options);
  options.bits = 16;
  const EncodedTiles sixteen = encodeTiles(transfer(), test::clustersOf(*rooms_, 2), *lights_, options);
  sixteen.matrix.check();
  EXPECT_EQ(sixteen.report.plane_bytes, 2 * eight.report.plane_bytes);
  EXPECT_LT(sixteen.report.error.mean, 1.02 * eight.report.error.mean);
  EXPECT_LT(sixteen.report.rounding_share, 1e-3);
}

TEST_F(TwoRoomTiles, AsksForATileAgainRatherThanGivingUp) {
  // A bound so small beside the other that the first candidates cannot do.
  Transfer t = transfer();
  std::atomic<std::size_t> calls = 0;
  t.source = [&calls, source = t.source](std::size_t tile, std::span<float> out) {
    ++calls;
    source(tile, out);
  };
  const EncodedTiles e = encodeTiles(t, test::clustersOf(*rooms_, 2), *lights_,
                                     {.error = 0.2, .row_error = 0.1, .most_rank = 96});
  EXPECT_TRUE(e.report.met);
  EXPECT_GT(calls, t.tiles.tiles());
  const EncodedTiles hopeless =
      encodeTiles(t, test::clustersOf(*rooms_, 2), *lights_, {.error = 0.01, .most_rank = 2});
  EXPECT_FALSE(hopeless.report.met);
}

TEST_F(TwoRoomTiles, SameBitsForAnyNumberOfThreads) {
  const TileOptions options{.error = 0.05};
  const EncodedTiles many = encodeTiles(transfer(), test::clustersOf(*rooms_, 2), *lights_, options);
  const ThreadLimit limit(1);
  const EncodedTiles one = encodeTiles(transfer(), test::clustersOf(*rooms_, 2), *lights_, options);
  EXPECT_EQ(many.matrix.planes8, one.matrix.planes8);
  EXPECT_EQ(many.matrix.weights8, one.matrix.weights8);
  EXPECT_EQ(many.matrix.scale, one.matrix.scale);
}

TEST_F(TwoRoomTiles, StopsWhenCancelled) {
  SilentProgress progress;
  progress.cancel();
  try {
    encodeTiles(transfer(), test::clustersOf(*rooms_, 2), *lights_, {}, &progress);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kInterrupted);
  }
}

TEST_F(TwoRoomTiles, LightsThatReachNothingCountForNothing) {
  const TileOptions options{.error = 0.05};
  Lights lights = *lights_;
  lights.training.insert(lights.training.begin() + 192, 192, 0.0f);
  lights.held_out.insert(lights.held_out.begin(), 192, 0.0f);
  const EncodedTiles some = encodeTiles(transfer(), test::clustersOf(*rooms_, 2), lights, options);
  const EncodedTiles plain = encodeTiles(transfer(), test::clustersOf(*rooms_, 2), *lights_, options);
  EXPECT_TRUE(some.report.met);
  EXPECT_EQ(some.matrix.planes8, plain.matrix.planes8);
}

TEST(EncodeTiles, DarkMatrixTakesNoComponents) {
  const std::vector<float> zeros(20 * 8);
  RowTiles tiles{{0, 10, 20}, {}, std::vector<float>(20, 1.0f)};
  for (std::uint32_t r = 0; r < 20; ++r) tiles.row.push_back(r);
  const Lights lights{std::vector<float>(5 * 8, 1.0f), std::vector<float>(2 * 8, 1.0f)};
  const EncodedTiles e = encodeTiles(test::transferOf(zeros, 8, 1, tiles),
                                     clustersFromLabels(std::vector<std::uint32_t>(8, 0), 1), lights);
  e.matrix.check();
  EXPECT_EQ(e.matrix.components(), 0u);
  EXPECT_TRUE(e.report.met);
}

TEST(EncodeTiles, ClustersFromLabelsPartColumns) {
  const ColumnClusters c = clustersFromLabels(std::vector<std::uint32_t>{1, 0, 3, 1, 0}, 4);
  EXPECT_EQ(c.first, (std::vector<std::uint32_t>{0, 2, 4, 4, 5}));
  EXPECT_EQ(c.column, (std::vector<std::uint32_t>{1, 4, 0, 3, 2}));
}

TEST(EncodeTiles, ErrorsByHand) {
  // Two lights, two rows, one channel: errors 0.1 of 1 and 1 of 10; 0.3 of 3 and 0 of 4.
  const EncodeError e =
      measureProducts(std::vector<float>{1.1f, 11, 3.3f, 4}, std::vector<float>{1, 10, 3, 4}, 2, 1);
  EXPECT_NEAR(e.worst, 0.1, 1e-6);
  EXPECT_NEAR(e.mean, (0.1 + 0.06) / 2, 1e-6);
  EXPECT_NEAR(e.row_p95, 0.1, 1e-6);
}

TEST(EncodeTiles, RowsWithoutLightAreJudgedByWhatCountsAsDarkness) {
  // Two rows, one at 2, one at 1e-6: a root mean square of sqrt(2), so darkness ends at 0.01 sqrt(2).
  const EncodeError e = measureProducts(std::vector<float>{2, 0.001f}, std::vector<float>{2, 1e-6f}, 2, 1);
  EXPECT_NEAR(e.row_p95, 0.001 / (kRowFloor * std::sqrt(2.0)), 1e-4);
}

}  // namespace
}  // namespace relume::codec
