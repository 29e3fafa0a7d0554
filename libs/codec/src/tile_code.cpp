// SPDX-License-Identifier: MIT
#include "tile_code.h"

#include <algorithm>
#include <cmath>

#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::codec {
namespace {

using Eigen::Index;

constexpr std::size_t kSampledTiles = 32;  // that tell how bright lights are, about
constexpr double kDarkest = 0.1;  // of a light's root mean square in a tile: relative errors count from there
constexpr double kLeast = 1e-12;  // of the mean response of a tile: what is not divided by
constexpr float kNoLight = 1e-30f;  // of all lights, whose sums are 1

Eigen::Map<const Matrix> lightMatrix(const std::vector<float>& lights, std::uint32_t columns) {
  RELUME_CHECK_EQ(lights.size() % columns, std::size_t{0});
  return {lights.data(), signedSize(lights.size() / columns), signedSize(columns)};
}

// 1 / (truth^2 + darkest^2 + floor) of each row (all channels) and light, for products that were blended;
// [height][lights]
Matrix relativeWeights(const Matrix& product, const Eigen::VectorXf& blend, const Eigen::VectorXd& floor,
                       std::size_t channels) {
  const Index rows = product.rows() / signedSize(channels);
  Matrix square = Matrix::Zero(rows, product.cols());
  for (Index c = 0; c < signedSize(channels); ++c) square += product.middleRows(c * rows, rows).cwiseAbs2();
  const Eigen::RowVectorXf dark =
      (kDarkest * kDarkest / static_cast<double>(rows) * square.cast<double>().colwise().sum() +
       floor.transpose())
          .cast<float>();
  for (Index r = 0; r < rows; ++r)
    square.row(r) = (square.row(r) / (blend[r] * blend[r]) + dark).cwiseMax(kNoLight).cwiseInverse();
  return square.replicate(signedSize(channels), 1);
}

}  // namespace

TileCoder::TileCoder(const Transfer& transfer, const ColumnClusters& clusters, const Lights& lights,
                     const TileOptions& options)
    : transfer_(transfer), clusters_(clusters), options_(options), max_(options.bits == 8 ? 127 : 32767) {
  RELUME_CHECK(options.bits == 8 || options.bits == 16);
  training_ = lightMatrix(lights.training, transfer.columns);
  held_out_ = lightMatrix(lights.held_out, transfer.columns);
  RELUME_CHECK_LT(Index{0}, training_.rows());
  // Of equal power, more or less: how bright a light is does not say how often it shines. One that reaches no
  // column, shut in somewhere, says nothing.
  Index lit = 0;
  for (Index l = 0; l < training_.rows(); ++l) {
    const float sum = training_.row(l).sum();
    if (sum > 0) training_.row(lit++) = (training_.row(l) / sum).eval();
  }
  training_.conservativeResize(lit, Eigen::NoChange);
  floor_ = darkness();
}

// From some tiles, so that not all have to be read twice.
Eigen::VectorXd TileCoder::darkness() const {
  const std::size_t tiles = transfer_.tiles.tiles(), step = std::max<std::size_t>(tiles / kSampledTiles, 1);
  std::vector<Eigen::VectorXd> of_tile((tiles + step - 1) / step);
  double rows = 0;
  for (std::size_t i = 0; i < of_tile.size(); ++i)
    rows += static_cast<double>(transfer_.tiles.rows(i * step));
  parallelFor(of_tile.size(), 1, [&](std::size_t i, std::size_t) {
    of_tile[i] =
        (tileRows(transfer_, i * step) * training_.transpose()).colwise().squaredNorm().cast<double>();
  });
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(training_.rows());
  for (const Eigen::VectorXd& tile : of_tile) sum += tile;
  return kRowFloor * kRowFloor / std::max(rows, 1.0) * sum;
}

TileCode TileCoder::code(std::size_t tile, double error) const {
  const WorkItem item("tile", tile);
  TileCode out;
  const std::size_t clusters = clusters_.clusters();
  const Eigen::VectorXf blend = tileBlend(transfer_, tile);
  Matrix rows = tileRows(transfer_, tile);
  rows = blend.asDiagonal() * rows;
  Matrix product = rows * training_.transpose();
  out.truth = rows * held_out_.transpose();

  out.response = product.colwise().squaredNorm().cast<double>();
  const double mean = out.response.size() > 0 ? out.response.mean() : 0;
  out.light_weight = Eigen::VectorXd::Zero(training_.rows());
  if (mean > 0) {
    // A light that gives the tile no more than what counts as darkness weighs no more than that.
    const Eigen::ArrayXd dark =
        blend.squaredNorm() / static_cast<double>(transfer_.channels) * floor_.array();
    out.light_weight = (1 - options_.dark_share) / mean +
                       options_.dark_share / out.response.array().max(dark).max(kLeast * mean);
  }
  const Eigen::VectorXf scale = out.light_weight.cwiseSqrt().cast<float>();
  product = product * scale.asDiagonal();
  const Matrix relative =
      relativeWeights(product, blend, floor_.cwiseProduct(out.light_weight), transfer_.channels);
  const double energy = out.light_weight.dot(out.response), square = rows.squaredNorm();
  out.plain = square > 0 ? options_.plain_share * energy / square : 0;

  BlockOptions options{.max = max_};
  options.tolerance = error * error * energy / static_cast<double>(clusters);
  options.most_rank = signedSize(options_.error > 0 ? options_.most_rank : options_.rank);
  for (std::size_t c = 0; c < clusters; ++c) {
    options.seed = static_cast<std::uint32_t>(tile * clusters + c);
    const Matrix lights = scale.asDiagonal() * columnsOf(training_, clusters_, c);
    out.blocks.push_back(encodeBlock(columnsOf(rows, clusters_, c),
                                     {.lights = lights, .plain = out.plain, .relative = relative}, options));
    out.held_out.push_back(weightsOf(out.blocks.back(), clusters_.columns(c)) *
                           columnsOf(held_out_, clusters_, c).transpose());
  }
  return out;
}

Matrix TileCoder::weightsOf(const BlockCode& code, std::size_t width) const {
  Matrix out(signedSize(code.components()), signedSize(width));
  for (Index i = 0; i < out.size(); ++i) {
    const float w = static_cast<float>(code.weights[static_cast<std::size_t>(i)]) / static_cast<float>(max_);
    out.data()[i] = w * std::abs(w);
  }
  return out;
}

}  // namespace relume::codec
