// SPDX-License-Identifier: MIT
#include "light_paths/patch_modes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "light_paths/members.h"
#include "light_paths/typical_light.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Eigen::Index;

constexpr Index kMostModes = 64;    // of a patch
constexpr double kFaintest = 1e-6;  // variance of a mode worth an entry, of that of all light
/// What places do not tell of the light between them, of the variance of light on them.
constexpr double kPlaceNoise = 0.01;

/// Of one patch. E = mean shape + sum_k c_k mode_k on its pieces.
struct Variation {
  std::vector<std::uint32_t> pieces;  // whose light matters
  Eigen::VectorXf variance;           // by mode, falling; of light times weight
  Matrix modes;                       // [pieces][modes], of mean square 1
  Matrix of_lamps;                    // [1 + modes][lamps]
};

class Analysis {
 public:
  Analysis(std::span<const float> weight, const TrainingLight& light, std::span<const float> shape)
      : weight_(weight), light_(light), shape_(shape) {}

  Variation of(std::span<const std::uint32_t> members) const {
    Variation v;
    for (const std::uint32_t piece : members)
      if (weight_[piece] > 0) v.pieces.push_back(piece);
    const auto count = static_cast<Index>(v.pieces.size()), lamps = static_cast<Index>(light_.lamps);
    v.of_lamps = Matrix::Zero(1, lamps);
    if (count == 0 || lamps == 0) return v;
    Eigen::VectorXf root(count), shape(count);  // of weights
    Matrix rest(count, lamps);
    for (Index i = 0; i < count; ++i) {
      const std::uint32_t piece = v.pieces[static_cast<std::size_t>(i)];
      root[i] = std::sqrt(weight_[piece]), shape[i] = shape_[piece];
      rest.row(i) = Eigen::Map<const Eigen::RowVectorXf>(
          light_.on_pieces.data() + static_cast<std::size_t>(piece) * light_.lamps, lamps);
    }
    const float all = root.squaredNorm();
    v.of_lamps.row(0) = root.array().square().matrix().transpose() * rest / all;
    rest -= shape * v.of_lamps.row(0);
    rest = root.asDiagonal() * rest;
    const Index modes = std::min({kMostModes, count, lamps});
    const Matrix left = leftVectors(rest, modes, v.variance);
    v.modes = root.cwiseInverse().asDiagonal() * left * std::sqrt(all);
    v.of_lamps.conservativeResize(1 + modes, lamps);
    v.of_lamps.bottomRows(modes) = left.transpose() * rest / std::sqrt(all);
    return v;
  }

 private:
  /// The first left singular vectors and the squares of the singular values, by whichever side is shorter.
  static Matrix leftVectors(const Matrix& a, Index count, Eigen::VectorXf& variance) {
    const bool tall = a.rows() > a.cols();
    const Eigen::MatrixXf gram =
        tall ? Eigen::MatrixXf(a.transpose() * a) : Eigen::MatrixXf(a * a.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(gram);
    variance = solver.eigenvalues().reverse().head(count).cwiseMax(0.0f);
    Matrix vectors = solver.eigenvectors().rowwise().reverse().leftCols(count);
    if (!tall) return vectors;
    vectors = a * vectors;
    for (Index k = 0; k < count; ++k)
      if (const float length = vectors.col(k).norm(); length > 0) vectors.col(k) /= length;
    return vectors;
  }

  std::span<const float> weight_;
  const TrainingLight& light_;
  std::span<const float> shape_;
};

/// How many modes each patch gets: those of most variance among all.
std::vector<Index> chooseModes(std::span<const Variation> patches, std::size_t entries) {
  struct Mode {
    float variance;
    std::uint32_t patch;
  };
  std::vector<Mode> all;
  double sum = 0;
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    for (const float v : patches[p].variance) all.push_back({v, p}), sum += static_cast<double>(v);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Mode& a, const Mode& b) { return a.variance > b.variance; });
  std::vector<Index> chosen(patches.size(), 0);
  std::size_t left = entries > patches.size() ? entries - patches.size() : 0;
  for (const Mode& mode : all) {
    if (left-- == 0 || !(static_cast<double>(mode.variance) > kFaintest * sum)) break;
    ++chosen[mode.patch];
  }
  return chosen;
}

std::vector<float> meanOf(const TrainingLight& light, std::size_t pieces) {
  std::vector<float> mean(pieces, 0.0f);
  for (std::size_t p = 0; p < pieces; ++p)
    for (std::size_t l = 0; l < light.lamps; ++l) mean[p] += light.on_pieces[p * light.lamps + l];
  return mean;
}

}  // namespace

PatchModes modesOf(std::span<const std::uint32_t> patch_of_piece, std::size_t patches,
                   std::span<const float> weight, const TrainingLight& light, std::size_t entries,
                   Progress& progress) {
  const std::vector<float> shape =
      shapeWithin(patch_of_piece, patches, weight, meanOf(light, patch_of_piece.size()));
  const Members members = membersOf(patch_of_piece, patches);
  const Analysis analysis(weight, light, shape);
  std::vector<Variation> variations(patches);
  parallelFor(patches, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) variations[p] = analysis.of(members.of(p));
  });
  progress.throwIfCancelled();
  const std::vector<Index> chosen = chooseModes(variations, entries);
  PatchModes result;
  result.first.push_back(0);
  for (std::size_t p = 0; p < patches; ++p) {
    const Variation& v = variations[p];
    const std::uint32_t mean = result.first.back();
    for (const std::uint32_t piece : members.of(p)) result.shares.push_back({piece, mean, shape[piece]});
    for (Index k = 0; k < chosen[p]; ++k)
      for (std::size_t i = 0; i < v.pieces.size(); ++i)
        result.shares.push_back(
            {v.pieces[i], mean + 1 + static_cast<std::uint32_t>(k), v.modes(static_cast<Index>(i), k)});
    for (Index k = 0; k <= chosen[p]; ++k)
      result.of_lamps.insert(result.of_lamps.end(), v.of_lamps.row(k).begin(), v.of_lamps.row(k).end());
    result.first.push_back(mean + 1 + static_cast<std::uint32_t>(chosen[p]));
  }
  return result;
}

std::vector<float> mixOf(const PatchModes& modes, std::span<const float> on_places, std::size_t lamps,
                         std::size_t places, Progress& progress) {
  const auto rows = static_cast<Index>(places), columns = static_cast<Index>(lamps);
  const std::size_t patches = modes.first.size() - 1;
  std::vector<float> mix(places * modes.first.back());
  using Given = Eigen::Map<const Matrix>;
  parallelFor(patches, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t first = modes.first[p];
      const auto entries = static_cast<Index>(modes.first[p + 1] - first);
      const Eigen::MatrixXd e = Given(on_places.data() + p * places * lamps, rows, columns).cast<double>();
      Eigen::MatrixXd wanted = Given(modes.of_lamps.data() + first * lamps, entries, columns).cast<double>();
      wanted.row(0) -= e.colwise().mean();  // what the mean over places misses
      const double noise = kPlaceNoise * e.squaredNorm() / static_cast<double>(rows);
      Eigen::Map<Matrix> out(mix.data() + places * first, rows, entries);
      out.setZero();
      if (noise > 0) {
        // wanted e' (e e' + noise)^-1, by whichever side is shorter
        Eigen::MatrixXd gram =
            rows > columns ? Eigen::MatrixXd(e.transpose() * e) : Eigen::MatrixXd(e * e.transpose());
        gram.diagonal().array() += noise;
        const auto solver = gram.ldlt();
        if (rows > columns) {
          out = (e * solver.solve(wanted.transpose())).cast<float>();
        } else {
          out = solver.solve(e * wanted.transpose()).cast<float>();
        }
      }
      out.col(0).array() += 1.0f / static_cast<float>(places);
    }
  });
  progress.throwIfCancelled();
  return mix;
}

}  // namespace relume::transport
