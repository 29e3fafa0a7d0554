// SPDX-License-Identifier: MIT
#include "clustered_pca.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "example_transfer.h"
#include "relume/codec/encode_tiles.h"
#include "relume/codec/pca.h"

namespace relume::codec {
namespace {

// Eight entries over six texels; expected values by a multiple-precision eigensolver.
constexpr std::uint32_t kEntries = 8, kTexels = 6;
constexpr float kTransfer[kEntries][kTexels] = {
    {10, 17, 13, -1, 4, 6}, {4, 21, 11, 10, 25, 3}, {8, 29, 14, 0, 13, 5}, {12, 19, 14, 8, -6, 21},
    {6, 24, 12, 3, 7, 12},  {11, 4, 8, 22, 12, 13}, {9, 9, 9, 11, 12, 10}, {10, 11, 11, 3, 8, 10}};
const double kWholeError[] = {1728.875,
                              920.9896725794661,
                              178.98230408988755,
                              24.720231979031848,
                              6.504580705514375,
                              1.4666752686923348,
                              0};
const double kClusterError[2][5] = {{943.5, 210.7718452630324, 69.7256094110271, 0, 0},
                                    {512.25, 68.24773380059003, 6.590491468556213, 0, 0}};
// I = sum_e I_e T~_e, I_e = (e + 1) / 2, two planes in each cluster.
const double kIrradiance[] = {164.46472228931674, 251.66729821383115, 194.9547682316683,
                              148.73463293767082, 161.54080923320413, 196.82959631405964};

// As rows of texels; two tiles that overlap, which must not count a texel twice.
class PaperExample : public testing::Test {
 protected:
  PaperExample() {
    for (std::uint32_t x = 0; x < kTexels; ++x)
      for (std::uint32_t e = 0; e < kEntries; ++e) matrix_.push_back(kTransfer[e][x]);
    transfer_ = test::transferOf(matrix_, kEntries, 1,
                                 {{0, 4, 8}, {0, 1, 2, 3, 2, 3, 4, 5}, {1, 1, 0.5f, 0.5f, 0.5f, 0.5f, 1, 1}});
  }
  double squaredError(const PcaCluster& pca, const ColumnClusters& clusters, std::size_t c,
                      Eigen::Index planes) const {
    const Matrix given = pca.planes.topRows(1 + planes).transpose() * pca.weights.topRows(1 + planes);
    double sum = 0;
    for (Eigen::Index j = 0; j < given.cols(); ++j)
      for (std::uint32_t x = 0; x < kTexels; ++x)
        sum += std::pow(
            kTransfer[clusters.column[clusters.first[c] + static_cast<std::size_t>(j)]][x] - given(x, j),
            2.0);
    return sum;
  }

  std::vector<float> matrix_;
  Transfer transfer_;
};

TEST_F(PaperExample, OneClusterIsExactToTheOptimalError) {
  const ColumnClusters one = clustersFromLabels(std::vector<std::uint32_t>(kEntries, 0), 1);
  const PcaCluster pca = clusteredPca(transfer_, one, 8, nullptr)[0];
  for (Eigen::Index d = 0; d < pca.planes.rows(); ++d)
    EXPECT_NEAR(squaredError(pca, one, 0, d), kWholeError[d], 1.7e-3) << d;
  EXPECT_EQ(pca.planes.rows(), 1 + 6);
  const auto encoded = encodeClusteredPca(transfer_, one, {}, {.rank = 8});
  for (std::size_t d = 0; d < 7; ++d) EXPECT_NEAR(encoded.optimal_error[0][d], kWholeError[d], 1e-6) << d;
}

TEST_F(PaperExample, ClustersAreExactToTheOptimalError) {
  const ColumnClusters two = clustersFromLabels(std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1}, 2);
  const std::vector<PcaCluster> pca = clusteredPca(transfer_, two, 8, nullptr);
  for (std::size_t c = 0; c < 2; ++c)
    for (Eigen::Index d = 0; d < pca[c].planes.rows(); ++d)
      EXPECT_NEAR(squaredError(pca[c], two, c, d), kClusterError[c][d], 1e-3) << c << ", " << d;
}

TEST_F(PaperExample, IrradianceIsThatOfTheTruncatedMatrix) {
  const ColumnClusters two = clustersFromLabels(std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1}, 2);
  const auto encoded = encodeClusteredPca(transfer_, two, {}, {.rank = 2, .bits = 16});
  encoded.matrix.check();
  EXPECT_EQ(encoded.matrix.tiles(), 1u);
  EXPECT_EQ(encoded.matrix.components(), 6u);
  std::vector<float> light, y(kTexels);
  for (std::uint32_t e = 0; e < kEntries; ++e) light.push_back(0.5f * static_cast<float>(e + 1));
  multiply(encoded.matrix, light, y);
  // 16 bits: a step of planes and weights is 2^-15 of the largest, of which 3 * 8 are added.
  for (std::uint32_t x = 0; x < kTexels; ++x) EXPECT_NEAR(y[x], kIrradiance[x], 0.03) << x;
}

TEST_F(PaperExample, MeanPlaneHasWeightsOfOne) {
  // What a form without its mean would lose: equal light on all entries of a cluster gives n times their
  // mean.
  const auto encoded = encodeClusteredPca(
      transfer_, clustersFromLabels(std::vector<std::uint32_t>(kEntries, 0), 1), {}, {.rank = 0, .bits = 16});
  std::vector<float> y(kTexels);
  multiply(encoded.matrix, std::vector<float>(kEntries, 1.0f), y);
  for (std::uint32_t x = 0; x < kTexels; ++x) {
    float sum = 0;
    for (std::uint32_t e = 0; e < kEntries; ++e) sum += kTransfer[e][x];
    EXPECT_NEAR(y[x], sum, 0.01f);
  }
}

class TwoRoomPca : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    rooms_ = new test::TwoRooms({.elements = 800, .entries = 128, .rows = 2000});
    lights_ = new Lights{rooms_->light(rooms_->lightPositions(128, 1, 0.5f)),
                         rooms_->light(rooms_->lightPositions(24, 2, 0.5f))};
  }
  static void TearDownTestSuite() {
    delete rooms_;
    delete lights_;
  }
  static Transfer transfer() {
    return test::transferOf(
        rooms_->transfer, 128, 3,
        test::overlappingTiles(rooms_->row_position, rooms_->row_normal, test::kTwoRoomsArea, 64, 0.25f));
  }

  static test::TwoRooms* rooms_;
  static Lights* lights_;
};
test::TwoRooms* TwoRoomPca::rooms_ = nullptr;
Lights* TwoRoomPca::lights_ = nullptr;

TEST_F(TwoRoomPca, AgreesWithThePlainOne) {
  // pca.h on the cluster's columns as data points, all in memory.
  const ColumnClusters clusters = test::clustersOf(*rooms_, 4);
  const std::vector<PcaCluster> given = clusteredPca(transfer(), clusters, 6, nullptr);
  const std::size_t values = rooms_->rows * 3;
  std::vector<float> data;
  for (std::size_t j = clusters.first[1]; j < clusters.first[2]; ++j)
    for (std::size_t i = 0; i < values; ++i) data.push_back(rooms_->transfer[i * 128 + clusters.column[j]]);
  const Pca plain = pca(data, clusters.columns(1), values, {.rank = 6});
  for (Eigen::Index k = 0; k < 6; ++k) {
    EXPECT_NEAR(given[1].variance[k] / plain.variance[static_cast<std::size_t>(k)], 1, 1e-5);
    double dot = 0;  // up to sign
    for (std::size_t r = 0; r < rooms_->rows; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        dot += static_cast<double>(given[1].planes(1 + k, static_cast<Eigen::Index>(c * rooms_->rows + r))) *
               plain.components[static_cast<std::size_t>(k) * values + r * 3 + c];
    EXPECT_NEAR(std::abs(dot), 1, 1e-4) << k;
  }
}

TEST_F(TwoRoomPca, MeetsItsBoundAndTilesTakeFarFewerBytes) {
  std::size_t best = std::numeric_limits<std::size_t>::max();
  for (const std::size_t clusters : {4u, 8u, 16u, 32u}) {
    const auto e = encodeClusteredPca(transfer(), test::clustersOf(*rooms_, clusters), *lights_,
                                      {.rank = 128, .error = 0.05});
    EXPECT_TRUE(e.report.met);
    EXPECT_LE(e.report.error.mean, 0.05);
    best = std::min(best, e.report.bytes);
  }
  const EncodedTiles tiles =
      encodeTiles(transfer(), test::clustersOf(*rooms_, 1), *lights_, {.error = 0.05, .row_error = 0});
  EXPECT_LT(4 * tiles.report.bytes, best);
}

TEST_F(TwoRoomPca, SixteenBitsLeaveTheErrorOfRank) {
  const ColumnClusters clusters = test::clustersOf(*rooms_, 8);
  const auto eight = encodeClusteredPca(transfer(), clusters, *lights_, {.rank = 4});
  const auto sixteen = encodeClusteredPca(transfer(), clusters, *lights_, {.rank = 4, .bits = 16});
  eight.matrix.check();
  sixteen.matrix.check();
  EXPECT_EQ(2 * eight.report.plane_bytes, sixteen.report.plane_bytes);
  EXPECT_NEAR(sixteen.report.error.mean / eight.report.error.mean, 1, 0.05);
}

TEST_F(TwoRoomPca, SameBitsForAnyNumberOfThreads) {
  const ColumnClusters clusters = test::clustersOf(*rooms_, 4);
  const auto many = encodeClusteredPca(transfer(), clusters, *lights_, {.rank = 4});
  const ThreadLimit limit(1);
  const auto one = encodeClusteredPca(transfer(), clusters, *lights_, {.rank = 4});
  EXPECT_EQ(many.matrix.planes8, one.matrix.planes8);
  EXPECT_EQ(many.matrix.weights8, one.matrix.weights8);
}

// Ten planes over 480,000 pixels and 180 frames, against all of them: 94.44 % saved, the mean not counted.
TEST(ClusteredPca, StorageOfDaylightFrames) {
  constexpr double kFrames = 180, kPixels = 480000, kPlanes = 10;
  BlockMatrix m;
  m.rows = 480000;
  m.columns = 180;
  m.planes8.resize(static_cast<std::size_t>(kPlanes * kPixels));
  m.weights8.resize(static_cast<std::size_t>(kPlanes * kFrames));
  const EncodeReport r = sizesOf([&] {
    m.tile_first = {0, 0};
    m.cluster_first = {0, 0};
    return m;
  }());
  EXPECT_NEAR(static_cast<double>(r.plane_bytes + r.weight_bytes) / (kFrames * kPixels), 0.05557638888888889,
              1e-12);
}

}  // namespace
}  // namespace relume::codec
