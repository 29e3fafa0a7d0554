// SPDX-License-Identifier: MIT
// Each tile is read once: its blocks are brought into more components than will be kept, and what every
// component takes off the error of each training light is noted. Then one threshold of gain per byte for all
// blocks is found by bisection on the held-out lights, and a second one, of relative errors of rows, for dark
// rows.
#include "relume/codec/encode_tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "tile_code.h"

namespace relume::codec {
namespace {

using Eigen::Index;

constexpr double kFirstMargin = 0.35;  // blocks are coded until this share of the error asked for is left ...
constexpr double kLessMargin = 0.35;   // ... and where that was too much, until this share of that
constexpr int kAttempts = 3;
constexpr int kBisections = 18;

// Kept components of each block.
using Kept = std::vector<std::size_t>;

// What each component of each block takes off an error, per byte.
using Gains = std::vector<std::vector<double>>;

class Encoder {
 public:
  Encoder(const Transfer& transfer, const ColumnClusters& clusters, const Lights& lights,
          const TileOptions& options)
      : transfer_(transfer),
        clusters_(clusters),
        options_(options),
        coder_(transfer, clusters, lights, options) {}

  EncodedTiles encode(Progress* progress) {
    double margin = kFirstMargin;
    std::optional<Kept> kept;
    std::size_t overall = 0;  // bytes that `error` alone takes
    for (int attempt = 0; attempt < kAttempts && !kept; ++attempt, margin *= kLessMargin) {
      codeTiles(margin * options_.error, progress);
      kept = options_.error > 0 ? chooseOverall() : all();
      if (!kept || options_.error <= 0) continue;
      overall = bytesOf(*kept);
      if (options_.row_error > 0) kept = chooseForRows(*kept, overall);
    }
    if (!kept) kept = all();
    EncodedTiles out;
    out.matrix = assemble(*kept);
    out.report = report(*kept, out.matrix);
    if (overall > 0) out.report.row_bytes = bytesOf(*kept) - overall;
    return out;
  }

 private:
  std::size_t blocks() const { return tiles_.size() * clusters_.clusters(); }
  const TileCode& tileOf(std::size_t b) const { return tiles_[b / clusters_.clusters()]; }
  const BlockCode& block(std::size_t b) const { return tileOf(b).blocks[b % clusters_.clusters()]; }
  std::size_t height(std::size_t b) const {
    return transfer_.channels * transfer_.tiles.rows(b / clusters_.clusters());
  }
  std::size_t width(std::size_t b) const { return clusters_.columns(b % clusters_.clusters()); }
  std::size_t componentBytes(std::size_t b) const {
    return (height(b) + width(b)) * (options_.bits / 8) + sizeof(float);
  }
  std::size_t bytesOf(const Kept& kept) const {
    std::size_t bytes = 0;
    for (std::size_t b = 0; b < blocks(); ++b) bytes += kept[b] * componentBytes(b);
    return bytes;
  }
  // shape: [components + 1][training lights + 2]
  Eigen::Map<const Matrix> left(std::size_t b) const {
    return {block(b).left.data(), signedSize(block(b).components() + 1), coder_.trainingLights() + 2};
  }

  void codeTiles(double error, Progress* progress) {
    tiles_.assign(transfer_.tiles.tiles(), {});
    parallelFor(
        tiles_.size(), 1, [&](std::size_t t, std::size_t) { tiles_[t] = coder_.code(t, error); }, progress);
    std::vector<Matrix> truth;
    for (TileCode& tile : tiles_) truth.push_back(std::move(tile.truth));
    truth_ = addTiles(transfer_, truth);
    findGains();
  }

  void findGains() {
    const Index lights = coder_.trainingLights();
    Eigen::VectorXd total = Eigen::VectorXd::Zero(lights);
    for (const TileCode& tile : tiles_) total += tile.response;
    gain_.assign(blocks(), {});
    relative_gain_.assign(blocks(), {});
    for (std::size_t b = 0; b < blocks(); ++b) {
      const TileCode& tile = tileOf(b);
      // Squared errors relative to all the light that each light gives; the plain share beside them as in the
      // block.
      const Eigen::VectorXd overall =
          (tile.light_weight.array() > 0).select((tile.light_weight.array() * total.array()).inverse(), 0);
      const Eigen::VectorXd light = tile.light_weight.cwiseProduct(tile.response);
      const double plain = light.sum() > 0 ? tile.plain * overall.dot(light) / light.sum() : 0;
      const auto bytes = static_cast<double>(componentBytes(b));
      for (Index k = 0; k < signedSize(block(b).components()); ++k) {
        const Eigen::VectorXd taken = (left(b).row(k) - left(b).row(k + 1)).cast<double>();
        gain_[b].push_back((taken.head(lights).dot(overall) + plain * taken[lights]) / bytes);
        relative_gain_[b].push_back(taken[lights + 1] / bytes);
      }
    }
  }

  Kept all() const {
    Kept out;
    for (std::size_t b = 0; b < blocks(); ++b) out.push_back(block(b).components());
    return out;
  }

  // Components up to the last one whose gain reaches the threshold, and not fewer than `least`.
  static Kept above(const Gains& gains, double threshold, const Kept& least) {
    Kept out;
    for (std::size_t b = 0; b < gains.size(); ++b) {
      std::size_t kept = gains[b].size();
      while (kept > least[b] && gains[b][kept - 1] < threshold) --kept;
      out.push_back(kept);
    }
    return out;
  }

  // The components above the highest threshold that is good enough; none where all components are not.
  template <class Good>
  std::optional<Kept> bisect(const Gains& gains, const Kept& least, const Good& good) const {
    if (good(least)) return least;
    Kept best = all();
    if (!good(best)) return std::nullopt;
    double lo = std::numeric_limits<double>::max(), hi = 0;
    for (const std::vector<double>& block : gains)
      for (const double g : block)
        if (g > 0) lo = std::min(lo, g), hi = std::max(hi, g);
    for (int i = 0; i < kBisections && lo < hi; ++i) {
      const double middle = std::sqrt(lo) * std::sqrt(hi);
      Kept kept = above(gains, middle, least);
      if (good(kept)) {
        best = std::move(kept);
        lo = middle;
      } else {
        hi = middle;
      }
    }
    return best;
  }

  bool goodOverall(const EncodeError& e) const { return e.mean <= options_.error; }
  bool goodForRows(const EncodeError& e) const {
    return options_.row_error <= 0 || e.row_p95 <= options_.row_error;
  }

  std::optional<Kept> chooseOverall() const {
    return bisect(gain_, Kept(blocks(), 0), [&](const Kept& kept) { return goodOverall(measureKept(kept)); });
  }
  std::optional<Kept> chooseForRows(const Kept& least, std::size_t least_bytes) const {
    const double most = (1 + options_.row_bytes) * static_cast<double>(least_bytes);
    return bisect(relative_gain_, least, [&](const Kept& kept) {
      return static_cast<double>(bytesOf(kept)) >= most || goodForRows(measureKept(kept));
    });
  }

  EncodeError measureKept(const Kept& kept) const {
    std::vector<Matrix> given(tiles_.size());
    const std::size_t clusters = clusters_.clusters();
    parallelFor(tiles_.size(), 1, [&](std::size_t t, std::size_t) {
      given[t] = Matrix::Zero(signedSize(height(t * clusters)), coder_.heldOutLights());
      for (std::size_t c = 0; c < clusters; ++c) {
        const BlockCode& code = tiles_[t].blocks[c];
        const Index k = signedSize(kept[t * clusters + c]);
        using Planes = Eigen::Matrix<std::int16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        const Eigen::Map<const Planes> planes(code.planes.data(), k, given[t].rows());
        const Eigen::Map<const Eigen::VectorXf> scale(code.scale.data(), k);
        given[t].noalias() +=
            planes.cast<float>().transpose() * (scale.asDiagonal() * tiles_[t].held_out[c].topRows(k));
      }
    });
    return measureProducts(addTiles(transfer_, given), truth_, transfer_.rows, transfer_.channels);
  }

  BlockMatrix assemble(const Kept& kept) const {
    BlockMatrix out;
    out.rows = transfer_.rows;
    out.columns = transfer_.columns;
    out.channels = transfer_.channels;
    out.bits = options_.bits;
    out.tile_first = transfer_.tiles.first;
    out.tile_row = transfer_.tiles.row;
    out.cluster_first = clusters_.first;
    out.cluster_column = clusters_.column;
    out.component_first = {0};
    const auto append = [&](auto& eight, auto& sixteen, const std::vector<std::int16_t>& from,
                            std::size_t count) {
      const auto end = from.begin() + static_cast<std::ptrdiff_t>(count);
      if (options_.bits == 8)
        std::transform(from.begin(), end, std::back_inserter(eight),
                       [](std::int16_t q) { return static_cast<std::int8_t>(q); });
      else
        sixteen.insert(sixteen.end(), from.begin(), end);
    };
    for (std::size_t b = 0; b < blocks(); ++b) {
      const BlockCode& code = block(b);
      out.scale.insert(out.scale.end(), code.scale.begin(),
                       code.scale.begin() + static_cast<std::ptrdiff_t>(kept[b]));
      append(out.planes8, out.planes16, code.planes, kept[b] * height(b));
      append(out.weights8, out.weights16, code.weights, kept[b] * width(b));
      out.component_first.push_back(static_cast<std::uint32_t>(out.scale.size()));
    }
    return out;
  }

  EncodeReport report(const Kept& kept, const BlockMatrix& m) const {
    EncodeReport out = sizesOf(m);
    out.error = measureKept(kept);
    out.met = options_.error <= 0 || (goodOverall(out.error) && goodForRows(out.error));
    double rounded = 0, unrounded = 0;
    for (std::size_t b = 0; b < blocks(); ++b) {
      const Index lights = coder_.trainingLights();
      const auto rest = left(b).row(signedSize(kept[b])).cast<double>();
      rounded += rest.head(lights).sum() + tileOf(b).plain * rest[lights];
      unrounded += block(b).unrounded_left[kept[b]];
    }
    out.rounding_share = rounded > 0 ? std::max(0.0, 1 - unrounded / rounded) : 0;
    return out;
  }

  const Transfer& transfer_;
  const ColumnClusters& clusters_;
  TileOptions options_;
  TileCoder coder_;
  std::vector<TileCode> tiles_;
  std::vector<float> truth_;    // shape: [held-out lights][rows][channels]
  Gains gain_, relative_gain_;  // of errors overall, and of errors of rows relative to them
};

}  // namespace

EncodedTiles encodeTiles(const Transfer& transfer, const ColumnClusters& clusters, const Lights& lights,
                         const TileOptions& options, Progress* progress) {
  return Encoder(transfer, clusters, lights, options).encode(progress);
}

}  // namespace relume::codec
