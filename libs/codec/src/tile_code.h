// SPDX-License-Identifier: MIT
// One tile of a transfer matrix in more components than will be kept, with what each is worth.
#pragma once
#include <vector>

#include "block_encoder.h"
#include "relume/codec/encode_tiles.h"
#include "tile_rows.h"

namespace relume::codec {

struct TileCode {
  std::vector<BlockCode> blocks;  // of each cluster
  std::vector<Matrix>
      held_out;              // of each cluster, weights times lights; shape: [components][held-out lights]
  Matrix truth;              // what the held-out lights give; shape: [channels * rows][held-out lights]
  Eigen::VectorXd response;  // squared norm of what each training light gives
  Eigen::VectorXd light_weight;  // by which squared errors of the training lights were weighed
  double plain = 0;              // the same of the block itself
};

class TileCoder {
 public:
  TileCoder(const Transfer& transfer, const ColumnClusters& clusters, const Lights& lights,
            const TileOptions& options);

  /// Components until `error` of the tile's own light is left, or as many as the options ask for where it is
  /// 0. Safe from several threads.
  TileCode code(std::size_t tile, double error) const;

  Eigen::Index trainingLights() const { return training_.rows(); }
  Eigen::Index heldOutLights() const { return held_out_.rows(); }
  int max() const { return max_; }  ///< largest sample

 private:
  Eigen::VectorXd darkness() const;
  Matrix weightsOf(const BlockCode& code, std::size_t width) const;

  const Transfer& transfer_;
  const ColumnClusters& clusters_;
  TileOptions options_;
  int max_;
  Matrix training_, held_out_;  // shape: [lights][columns]; training lights sum to 1
  Eigen::VectorXd floor_;       // of each training light: squared product of a row that counts as dark
};

}  // namespace relume::codec
