// SPDX-License-Identifier: MIT
// Left singular vectors of [lights product | plain share of the block] span the best planes. Each in turn
// then gives its weights by projecting what is left of the block, the weights are rounded, the plane that
// suits the rounded weights best is found by least squares, rounded too, and what both give is taken away. So
// a component mends errors of rounding made before it, and rounding costs little more than that of the last
// ones.
#include "block_encoder.h"

#include <algorithm>
#include <cmath>

namespace relume::codec {
namespace {

std::span<float> spanOf(Eigen::VectorXf& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

float largest(std::span<const float> values) {
  float out = 0;
  for (const float v : values) out = std::max(out, std::abs(v));
  return out;
}

}  // namespace

float roundWeights(std::span<const float> values, int max, std::span<std::int16_t> out) {
  const float scale = largest(values);
  const double to = scale > 0 ? static_cast<double>(max) * max / scale : 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double square = std::abs(values[i]) * to;  // q^2 before rounding
    auto q = static_cast<int>(std::sqrt(square));
    if (q < max && square > 0.5 * (static_cast<double>(q) * q + static_cast<double>(q + 1) * (q + 1))) ++q;
    out[i] = static_cast<std::int16_t>(values[i] < 0 ? -q : q);
  }
  return scale;
}

float roundPlane(std::span<const float> values, int max, std::span<std::int16_t> out) {
  const float scale = largest(values) / static_cast<float>(max);
  const float to = scale > 0 ? 1 / scale : 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    out[i] = static_cast<std::int16_t>(std::clamp(static_cast<int>(std::lround(values[i] * to)), -max, max));
  return scale;
}

BlockCode encodeBlock(Matrix block, const BlockLights& given, const BlockOptions& options) {
  const Eigen::Index height = block.rows(), width = block.cols(), lights = given.lights.rows();
  const auto plain = static_cast<float>(given.plain);
  Matrix seen(height, lights + width);  // products with the lights, then the plain share
  seen.leftCols(lights) = block * given.lights.transpose();
  seen.rightCols(width) = std::sqrt(plain) * block;
  const Range space =
      range(seen, {.tolerance = options.tolerance, .most_rank = options.most_rank, .seed = options.seed});
  Matrix product = seen.leftCols(lights);
  seen.resize(0, 0);

  BlockCode out;
  const auto note = [&](Eigen::Index k) {
    for (Eigen::Index l = 0; l < lights; ++l) out.left.push_back(0);
    const std::size_t base = out.left.size() - static_cast<std::size_t>(lights);
    for (Eigen::Index r = 0; r < height; ++r)
      for (Eigen::Index l = 0; l < lights; ++l)
        out.left[base + static_cast<std::size_t>(l)] += product(r, l) * product(r, l);
    out.left.push_back(block.squaredNorm());
    out.left.push_back(product.cwiseAbs2().cwiseProduct(given.relative).sum());
    double unrounded = space.left;
    for (Eigen::Index j = k; j < space.basis.rows(); ++j) unrounded += space.variance[j];
    out.unrounded_left.push_back(unrounded);
  };
  note(0);

  Eigen::VectorXf weights(width), plane(height);
  std::vector<std::int16_t> rounded_weights(static_cast<std::size_t>(width)),
      rounded_plane(static_cast<std::size_t>(height));
  const auto max = static_cast<float>(options.max);
  for (Eigen::Index k = 0; k < space.basis.rows(); ++k) {
    if (options.tolerance > 0 && out.unrounded_left.back() <= options.tolerance) break;
    weights = block.transpose() * space.basis.row(k).transpose();
    roundWeights(spanOf(weights), options.max, rounded_weights);
    for (Eigen::Index j = 0; j < width; ++j) {
      const float w = static_cast<float>(rounded_weights[static_cast<std::size_t>(j)]) / max;
      weights[j] = w * std::abs(w);
    }
    const Eigen::VectorXf response = given.lights * weights;
    const float square = response.squaredNorm() + plain * weights.squaredNorm();
    if (!(square > 0)) break;
    plane = (product * response + plain * (block * weights)) / square;
    const float scale = roundPlane(spanOf(plane), options.max, rounded_plane);
    if (!(scale > 0)) break;
    for (Eigen::Index r = 0; r < height; ++r)
      plane[r] = scale * static_cast<float>(rounded_plane[static_cast<std::size_t>(r)]);
    block.noalias() -= plane * weights.transpose();
    product.noalias() -= plane * response.transpose();
    out.scale.push_back(scale);
    out.planes.insert(out.planes.end(), rounded_plane.begin(), rounded_plane.end());
    out.weights.insert(out.weights.end(), rounded_weights.begin(), rounded_weights.end());
    note(k + 1);
  }
  return out;
}

}  // namespace relume::codec
