// SPDX-License-Identifier: MIT
#include "block_product.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

constexpr std::size_t kChannels = 3;
// 256 planes: the sum of 256 products of 32767 and 128 stays below 2^31.
constexpr std::size_t kGroupPairs = 128;
constexpr float kMostFactor = 32767.0f;
constexpr int kHighDigit = 257;
constexpr float kLeastSum =
    1e-30f;  // factors whose largest is below this are 0: their step must be a normal number
constexpr float kMostGain = 1e16f;  // of a whole matrix; times kLargest still a float
// Tiles of more strips are taken by all threads together.
constexpr std::size_t kLargeTile = 128;
constexpr std::size_t kStripsAtOnce = 16;
constexpr std::size_t kSharedAtOnce = 4096;

// Values of target_ that are no row of y.
constexpr std::uint32_t kShared = 1u << 31, kPadding = ~0u;

constexpr std::size_t roundedUp(std::size_t n, std::size_t step) { return (n + step - 1) / step * step; }

void checkGain(const codec::BlockMatrix& m) {
  double gain = 0;
  for (const float s : m.scale) gain += std::abs(s);
  gain *= (m.bits == 8 ? 127.0 : 32767.0) * std::max<std::uint32_t>(m.columns, 1);
  if (!(gain <= kMostGain) || m.tile_row.size() >= kShared)
    throw Error(ErrorCode::kCorruptAsset, "transfer", "its products leave the range of numbers",
                "the file was damaged; bake it again");
}

// The digit of an 8-bit plane: of one, or the high and the low one of two.
std::int8_t digitOf(int q, std::size_t digit, std::size_t digits) {
  if (digits == 1) return static_cast<std::int8_t>(q);
  const int high = (q + (q < 0 ? -kHighDigit / 2 : kHighDigit / 2)) / kHighDigit;
  return static_cast<std::int8_t>(digit == 0 ? high : std::clamp(q - kHighDigit * high, -127, 127));
}

}  // namespace

BlockProduct::BlockProduct(const codec::BlockMatrix& m, const ProductKernels& kernels)
    : kernels_(kernels), rows_(m.rows), channels_(m.channels), digits_(m.bits / 8) {
  checkGain(m);
  placeColumns(m);
  placeRows(m);
  placeBlocks(m);
  if (m.bits == 8)
    copySamples(m, m.planes8, m.weights8, weights8_);
  else
    copySamples(m, m.planes16, m.weights16, weights16_);
}

void BlockProduct::placeColumns(const codec::BlockMatrix& m) {
  column_place_.resize(m.columns);
  for (std::size_t c = 0; c < m.clusters(); ++c) {
    const std::size_t begin = m.cluster_first[c], count = m.cluster_first[c + 1] - begin;
    for (std::size_t j = 0; j < count; ++j)
      column_place_[m.cluster_column[begin + j]] = static_cast<std::uint32_t>(x_stride_ + j);
    clusters_.push_back({x_stride_, roundedUp(count, kLanes), true});
    x_stride_ += clusters_.back().columns;
  }
  x_.assign(kChannels * x_stride_, 0.0f);
}

void BlockProduct::placeRows(const codec::BlockMatrix& m) {
  std::vector<std::uint32_t> holders(m.rows);
  for (const std::uint32_t row : m.tile_row) ++holders[row];
  std::vector<std::uint32_t> next(m.rows);  // place of a shared row
  shared_first_.push_back(0);
  for (std::uint32_t row = 0; row < m.rows; ++row) {
    if (holders[row] < 2) continue;
    next[row] = shared_first_.back();
    shared_row_.push_back(row);
    shared_first_.push_back(shared_first_.back() + holders[row]);
  }
  shared_.resize(shared_first_.back());
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    for (std::size_t i = m.tile_first[t]; i < m.tile_first[t + 1]; ++i) {
      const std::uint32_t row = m.tile_row[i];
      target_.push_back(holders[row] < 2 ? row : kShared + next[row]++);
    }
    target_.resize(roundedUp(target_.size(), kStripRows), kPadding);
  }
}

void BlockProduct::placeBlocks(const codec::BlockMatrix& m) {
  std::size_t rows = 0, samples = 0, factors = 0, steps = 0, components = 0, weights = 0, lit = 0;
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    const std::size_t strips = roundedUp(m.tile_first[t + 1] - m.tile_first[t], kStripRows) / kStripRows;
    const std::size_t first_block = blocks_.size();
    std::size_t planes = 0;
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const std::size_t b = t * m.clusters() + c;
      const std::size_t count = m.component_first[b + 1] - m.component_first[b];
      const std::size_t padded = roundedUp(count, kTogether);
      blocks_.push_back({padded, components, {planes, planes + count * digits_}, weights});
      scale_.insert(scale_.end(), m.scale.begin() + m.component_first[b],
                    m.scale.begin() + m.component_first[b + 1]);
      scale_.resize(components + padded, 0.0f);
      components += padded, planes += count * digits_, weights += padded * clusters_[c].columns;
    }
    const std::size_t pairs = roundedUp(planes, 2) / 2;
    const std::size_t groups = roundedUp(pairs, kGroupPairs) / kGroupPairs;
    tiles_.push_back({strips, pairs, rows, samples, factors, steps, first_block, lit, 0});
    rows += strips * kStripRows, samples += strips * channels_ * pairs * 2 * kStripRows;
    factors += kChannels * pairs * 2, steps += groups * kChannels, lit += m.clusters();
  }
  // A weight counts q |q| / max^2.
  const float most = m.bits == 8 ? 127.0f : 32767.0f;
  for (float& s : scale_) s /= most * most;
  sum_.resize(kChannels * components);
  planes_.resize(std::max<std::size_t>(samples, 1));  // an address even where nothing is read
  factors_.resize(factors);
  steps_.resize(steps);
  lit_.resize(lit);
}

template <class Q>
void BlockProduct::copySamples(const codec::BlockMatrix& m, const std::vector<Q>& planes,
                               const std::vector<Q>& weights, std::vector<Q>& weights_out) {
  sample_bytes_ = (planes.size() + weights.size()) * sizeof(Q);
  weights_out.resize(
      blocks_.empty() ? 0 : blocks_.back().weights + blocks_.back().components * clusters_.back().columns);
  const Q* plane = planes.data();
  const Q* weight = weights.data();
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    const Tile& tile = tiles_[t];
    const std::size_t rows = m.tile_first[t + 1] - m.tile_first[t];
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const std::size_t b = t * m.clusters() + c;
      const std::size_t count = m.component_first[b + 1] - m.component_first[b];
      const std::size_t columns = m.cluster_first[c + 1] - m.cluster_first[c];
      const Block& block = blocks_[b];
      for (std::size_t k = 0; k < count; ++k, weight += columns) {
        Q* out = weights_out.data() + block.weights + k / kTogether * kTogether * clusters_[c].columns;
        for (std::size_t j = 0; j < columns; ++j)
          out[(j / kLanes * kTogether + k % kTogether) * kLanes + j % kLanes] = weight[j];
        for (std::size_t channel = 0; channel < channels_; ++channel, plane += rows)
          for (std::size_t digit = 0; digit < digits_; ++digit) {
            const std::size_t p = block.planes.begin + k * digits_ + digit;
            for (std::size_t i = 0; i < rows; ++i) {
              const std::size_t strip = i / kStripRows;
              const std::size_t at =
                  ((strip * channels_ + channel) * tile.pairs + p / 2) * kStripRows + i % kStripRows;
              planes_[tile.planes + 2 * at + p % 2] = digitOf(plane[i], digit, digits_);
            }
          }
      }
    }
  }
}

void BlockProduct::gather(std::span<const Irradiance> x) {
  for (std::size_t j = 0; j < x.size(); ++j)
    for (std::size_t c = 0; c < kChannels; ++c)
      x_[c * x_stride_ + column_place_[j]] = x[j].rgb[static_cast<int>(c)];
  for (Cluster& cluster : clusters_) {
    cluster.dark = true;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const float* first = x_.data() + c * x_stride_ + cluster.first;
      cluster.dark =
          cluster.dark && std::all_of(first, first + cluster.columns, [](float v) { return v == 0; });
    }
  }
}

void BlockProduct::weigh(const Tile& tile, std::size_t c) {
  const Cluster& cluster = clusters_[c];
  const Block& block = blocks_[tile.blocks + c];
  float* sums = sum_.data() + kChannels * block.first;
  if (cluster.dark) {
    std::fill(sums, sums + kChannels * block.components, 0.0f);
    return;
  }
  const float* x = x_.data() + cluster.first;
  // Whoever weighs a tile adds its planes next, which are about three times the bytes.
  const std::int8_t* ahead =
      planes_.data() + tile.planes + block.planes.begin * tile.strips * channels_ * kStripRows;
  for (std::size_t k = 0; k < block.components; k += kTogether) {
    float together[kChannels * kTogether];
    const std::size_t at = block.weights + k * cluster.columns;
    if (digits_ == 1)
      kernels_.weigh8(weights8_.data() + at, x, x_stride_, cluster.columns, together, ahead);
    else
      kernels_.weigh16(weights16_.data() + at, x, x_stride_, cluster.columns, together, ahead);
    ahead += cluster.columns * 64 / kLanes;
    for (std::size_t i = 0; i < kTogether; ++i)
      for (std::size_t channel = 0; channel < kChannels; ++channel)
        sums[kChannels * (k + i) + channel] = scale_[block.first + k + i] * together[channel * kTogether + i];
  }
}

void BlockProduct::chooseFactors(Tile& tile) {
  std::int16_t* factors = factors_.data() + tile.factors;
  std::fill(factors, factors + kChannels * tile.pairs * 2, std::int16_t{0});
  // First the largest of each group and channel, then all in its units.
  const std::size_t groups = roundedUp(tile.pairs, kGroupPairs) / kGroupPairs;
  float* steps = steps_.data() + tile.steps;
  std::fill(steps, steps + groups * kChannels, 0.0f);
  const auto forEachPlane = [&](const auto& visit) {
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      if (clusters_[c].dark) continue;
      const Block& block = blocks_[tile.blocks + c];
      for (std::size_t p = block.planes.begin; p < block.planes.end; ++p) {
        const std::size_t k = (p - block.planes.begin) / digits_;
        const float digit = digits_ == 2 && (p - block.planes.begin) % 2 == 0 ? kHighDigit : 1.0f;
        const float* s = sum_.data() + kChannels * (block.first + k);
        for (std::size_t channel = 0; channel < kChannels; ++channel)
          visit(p, channel, digit * s[channel], steps[p / (2 * kGroupPairs) * kChannels + channel]);
      }
    }
  };
  forEachPlane([](std::size_t, std::size_t, float s, float& step) { step = std::max(step, std::abs(s)); });
  for (std::size_t i = 0; i < groups * kChannels; ++i)
    steps[i] = steps[i] > kLeastSum ? steps[i] / kMostFactor : 0.0f;
  forEachPlane([&](std::size_t p, std::size_t channel, float s, float step) {
    if (!(step > 0)) return;
    const float f = std::clamp(s / step, -kMostFactor, kMostFactor);
    factors[channel * tile.pairs * 2 + p] = static_cast<std::int16_t>(f + (f < 0 ? -0.5f : 0.5f));
  });

  tile.lit_count = 0;
  Range* lit = lit_.data() + tile.lit;
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const Range planes = blocks_[tile.blocks + c].planes;
    if (clusters_[c].dark || planes.begin == planes.end) continue;
    const Range pairs{planes.begin / 2, (planes.end + 1) / 2};
    if (tile.lit_count > 0 && lit[tile.lit_count - 1].end >= pairs.begin)
      lit[tile.lit_count - 1].end = pairs.end;
    else
      lit[tile.lit_count++] = pairs;
  }
}

void BlockProduct::addStrips(const Tile& tile, std::size_t first, std::size_t last, std::span<Irradiance> y) {
  const std::int16_t* factors = factors_.data() + tile.factors;
  const float* steps = steps_.data() + tile.steps;
  for (std::size_t strip = first; strip < last; ++strip) {
    float values[kChannels][kStripRows] = {};
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      const std::size_t plane_channel = channels_ == 1 ? 0 : channel;
      const std::int8_t* planes =
          planes_.data() + tile.planes + (strip * channels_ + plane_channel) * tile.pairs * 2 * kStripRows;
      std::int32_t sums[kStripRows] = {};
      std::size_t group = 0;
      const auto closeGroup = [&] {
        const float step = steps[group * kChannels + channel];
        for (std::size_t i = 0; i < kStripRows; ++i) {
          values[channel][i] += step * static_cast<float>(sums[i]);
          sums[i] = 0;
        }
      };
      for (std::size_t r = 0; r < tile.lit_count; ++r) {
        for (Range pairs = lit_[tile.lit + r]; pairs.begin < pairs.end;) {
          if (group != pairs.begin / kGroupPairs) closeGroup();
          group = pairs.begin / kGroupPairs;
          const std::size_t end = std::min(pairs.end, (group + 1) * kGroupPairs);
          kernels_.add_pairs(planes + pairs.begin * 2 * kStripRows,
                             factors + (channel * tile.pairs + pairs.begin) * 2, end - pairs.begin, sums);
          pairs.begin = end;
        }
      }
      if (tile.lit_count > 0) closeGroup();
    }
    const std::uint32_t* target = target_.data() + tile.rows + strip * kStripRows;
    for (std::size_t i = 0; i < kStripRows; ++i) {
      if (target[i] == kPadding) break;
      (target[i] < kShared ? y[target[i]] : shared_[target[i] - kShared]) =
          Irradiance({values[0][i], values[1][i], values[2][i]});
    }
  }
}

void BlockProduct::multiply(std::span<const Irradiance> x, std::span<Irradiance> y) {
  gather(x);
  // The bodies of the loops capture one reference: a std::function of that size does not allocate.
  struct Job {
    BlockProduct& self;
    std::span<Irradiance> y;
    Tile* large = nullptr;
  } job{*this, y};
  parallelFor(tiles_.size(), 1, [&job](std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin) {
      Tile& tile = job.self.tiles_[begin];
      if (tile.strips > kLargeTile) continue;
      for (std::size_t c = 0; c < job.self.clusters_.size(); ++c) job.self.weigh(tile, c);
      job.self.chooseFactors(tile);
      job.self.addStrips(tile, 0, tile.strips, job.y);
    }
  });
  for (Tile& tile : tiles_) {
    if (tile.strips <= kLargeTile) continue;
    job.large = &tile;
    parallelFor(clusters_.size(), 1, [&job](std::size_t begin, std::size_t end) {
      for (; begin < end; ++begin) job.self.weigh(*job.large, begin);
    });
    chooseFactors(tile);
    parallelFor(tile.strips, kStripsAtOnce, [&job](std::size_t begin, std::size_t end) {
      job.self.addStrips(*job.large, begin, end, job.y);
    });
  }
  parallelFor(shared_row_.size(), kSharedAtOnce, [&job](std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin) {
      Irradiance sum;
      for (std::size_t i = job.self.shared_first_[begin]; i < job.self.shared_first_[begin + 1]; ++i)
        sum += job.self.shared_[i];
      job.y[job.self.shared_row_[begin]] = sum;
    }
  });
}

}  // namespace relume::relight
