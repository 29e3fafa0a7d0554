// SPDX-License-Identifier: MIT
#include "range.h"

#include <gtest/gtest.h>

#include <random>

namespace relume::codec {
namespace {

// A matrix with the given singular values.
Matrix withSingularValues(Eigen::Index rows, Eigen::Index columns, const Eigen::VectorXd& s) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const auto orthonormal = [&](Eigen::Index n) {
    Eigen::MatrixXd m = Eigen::MatrixXd::NullaryExpr(n, s.size(), [&] { return normal(random); });
    return Eigen::MatrixXd(Eigen::HouseholderQR<Eigen::MatrixXd>(m).householderQ() *
                           Eigen::MatrixXd::Identity(n, s.size()));
  };
  const Eigen::MatrixXd u = orthonormal(rows), v = orthonormal(columns);
  return (u * s.asDiagonal() * v.transpose()).cast<float>();
}

Eigen::VectorXd falling(Eigen::Index n, double by) {
  return Eigen::VectorXd::NullaryExpr(n,
                                      [by](Eigen::Index i) { return std::pow(by, static_cast<double>(i)); });
}

TEST(Range, FindsSingularValuesAndWhatIsLeft) {
  const Eigen::VectorXd s = falling(60, 0.8);
  const Range r = range(withSingularValues(200, 90, s), {.most_rank = 20});
  ASSERT_EQ(r.basis.rows(), 20);
  for (Eigen::Index k = 0; k < 15; ++k) EXPECT_NEAR(r.variance[k] / (s[k] * s[k]), 1, 2e-3) << k;
  EXPECT_LT((r.basis * r.basis.transpose() - Matrix::Identity(20, 20)).norm(), 1e-5);
  // The best 20 leave sum_{k >= 20} s_k^2 (Eckart and Young).
  EXPECT_NEAR(r.left / s.tail(40).squaredNorm(), 1, 0.05);
}

TEST(Range, ProjectionIsNearTheBestPossible) {
  // Slowly falling singular values, for which random products without power iterations are poor.
  const Eigen::VectorXd s = falling(100, 0.97);
  const Matrix a = withSingularValues(300, 100, s);
  for (const Eigen::Index rank : {1, 5, 16, 17, 33}) {
    const Range r = range(a, {.most_rank = rank});
    const double left = (a - r.basis.transpose() * (r.basis * a)).cast<double>().squaredNorm();
    EXPECT_NEAR(left, r.left, 1e-4 * a.squaredNorm());
    EXPECT_LT(left, 1.06 * s.tail(100 - rank).squaredNorm()) << rank;
  }
}

TEST(Range, StopsAtTheTolerance) {
  const Eigen::VectorXd s = falling(60, 0.7);
  const Matrix a = withSingularValues(100, 80, s);
  const Range r = range(a, {.tolerance = 1e-3, .most_rank = 60});
  EXPECT_LE(r.left, 1e-3);
  EXPECT_EQ(r.basis.rows(), 16);  // 10 would do; steps are of 16
  EXPECT_EQ(range(a, {.tolerance = 1e9, .most_rank = 60}).basis.rows(), 0);
}

TEST(Range, OfLowRankAndOfNothing) {
  const Range r = range(withSingularValues(70, 50, falling(3, 0.5)), {.most_rank = 50});
  EXPECT_LE(r.basis.rows(), 16);
  EXPECT_NEAR(r.left, 0, 1e-6);
  EXPECT_EQ(range(Matrix::Zero(20, 10), {}).basis.rows(), 0);
  EXPECT_EQ(range(Matrix(0, 10), {}).basis.rows(), 0);
}

}  // namespace
}  // namespace relume::codec
