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
constexpr float kMostFactor = 32767.0f;
constexpr int kHighDigit = 257;
constexpr float kLeastSum =
    1e-30f;  // factors whose largest is below this are 0: their step must be a normal number
constexpr float kMostGain = 1e16f;  // of a whole matrix; times kLargest still a float
// Tiles of more strips are taken by all threads together.
constexpr std::size_t kLargeTile = 128;
constexpr std::size_t kStripsAtOnce = 16;
constexpr std::size_t kSharedAtOnce = 4096;

constexpr std::size_t roundedUp(std::size_t n, std::size_t step) { return (n + step - 1) / step * step; }

void checkGain(const codec::BlockMatrix& m) {
  double gain = 0;
  for (const float s : m.scale) gain += std::abs(s);
  gain *= (m.bits == 8 ? 127.0 : 32767.0) * std::max<std::uint32_t>(m.columns, 1);
  if (!(gain <= kMostGain))
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
  placeBlocks(m);
  const std::vector<std::uint32_t> places = placeRows(m);
  if (m.bits == 8)
    copySamples(m, places, m.planes8, m.weights8, weights8_);
  else
    copySamples(m, places, m.planes16, m.weights16, weights16_);
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

void BlockProduct::placeBlocks(const codec::BlockMatrix& m) {
  std::size_t rows = 0, samples = 0, factors = 0, steps = 0, weights = 0, lit = 0;
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    const std::size_t first_block = t * m.clusters();
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const Range components{m.component_first[first_block + c], m.component_first[first_block + c + 1]};
      blocks_.push_back({components, weights});
      weights += (components.end - components.begin) * clusters_[c].columns;
    }
    Tile tile{};
    tile.strips = roundedUp(m.tile_first[t + 1] - m.tile_first[t], kStripRows) / kStripRows;
    tile.components = {m.component_first[first_block], m.component_first[first_block + m.clusters()]};
    tile.pairs = roundedUp((tile.components.end - tile.components.begin) * digits_, 2) / 2;
    tile.rows = rows, tile.planes = samples, tile.factors = factors, tile.steps = steps,
    tile.blocks = first_block, tile.lit = lit;
    const std::size_t groups = roundedUp(tile.pairs, kGroupPairs) / kGroupPairs;
    rows += tile.strips * kStripRows, samples += tile.strips * channels_ * tile.pairs * 2 * kStripRows;
    factors += kChannels * tile.pairs * 2, steps += groups * kChannels, lit += m.clusters() + groups;
    tiles_.push_back(tile);
  }
  target_.resize(rows);
  planes_.resize(samples);
  factors_.resize(factors);
  steps_.resize(steps);
  lit_.resize(lit);
  (digits_ == 1 ? weights8_.resize(weights) : weights16_.resize(weights));
  // A weight counts q |q| / max^2.
  const float most = digits_ == 1 ? 127.0f : 32767.0f;
  for (const float s : m.scale) scale_.push_back(s / (most * most));
  sum_.resize(kChannels * scale_.size());
}

// Rows that one tile alone has come first in it: they go straight to y. Returns the place of each of
// m.tile_row in its tile.
std::vector<std::uint32_t> BlockProduct::placeRows(const codec::BlockMatrix& m) {
  std::vector<std::uint32_t> holders(m.rows), next(m.rows);
  for (const std::uint32_t row : m.tile_row) ++holders[row];
  shared_first_.push_back(0);
  for (std::uint32_t row = 0; row < m.rows; ++row) {
    if (holders[row] < 2) continue;
    next[row] = shared_first_.back();  // the place of a shared row in shared_
    shared_row_.push_back(row);
    shared_first_.push_back(shared_first_.back() + holders[row]);
  }
  shared_.resize(shared_first_.back());
  std::vector<std::uint32_t> places(m.tile_row.size());
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    const Range in{m.tile_first[t], m.tile_first[t + 1]};
    std::uint32_t place = 0;
    for (const bool sole : {true, false}) {
      for (std::size_t i = in.begin; i < in.end; ++i) {
        const std::uint32_t row = m.tile_row[i];
        if ((holders[row] < 2) != sole) continue;
        places[i] = place++;
        target_[tiles_[t].rows + places[i]] = sole ? row : next[row]++;
      }
      if (sole) tiles_[t].sole = place;
    }
    tiles_[t].held = place;
  }
  return places;
}

template <class Q>
void BlockProduct::copySamples(const codec::BlockMatrix& m, std::span<const std::uint32_t> places,
                               const std::vector<Q>& planes, const std::vector<Q>& weights,
                               std::vector<Q>& weights_out) {
  sample_bytes_ = (planes.size() + weights.size()) * sizeof(Q);
  const Q* plane = planes.data();
  const Q* weight = weights.data();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::size_t t = b / m.clusters(), c = b % m.clusters();
    const Tile& tile = tiles_[t];
    const Range components = blocks_[b].components;
    const std::size_t columns = m.cluster_first[c + 1] - m.cluster_first[c];
    const auto place = places.subspan(m.tile_first[t], m.tile_first[t + 1] - m.tile_first[t]);
    for (std::size_t k = components.begin; k < components.end; ++k, weight += columns) {
      const std::size_t first = k - (k - components.begin) % kTogether;  // of those that are weighed with k
      const std::size_t count = std::min(kTogether, components.end - first);
      Q* out = weights_out.data() + blocks_[b].weights + (first - components.begin) * clusters_[c].columns;
      for (std::size_t j = 0; j < columns; ++j)
        out[(j / kLanes * count + k - first) * kLanes + j % kLanes] = weight[j];
      for (std::size_t channel = 0; channel < channels_; ++channel, plane += place.size())
        for (std::size_t digit = 0; digit < digits_; ++digit) {
          const std::size_t p = (k - tile.components.begin) * digits_ + digit;
          for (std::size_t i = 0; i < place.size(); ++i) {
            const std::size_t strip = place[i] / kStripRows, row = place[i] % kStripRows;
            const std::size_t at = ((strip * tile.pairs + p / 2) * channels_ + channel) * kStripRows + row;
            planes_[tile.planes + 2 * at + p % 2] = digitOf(plane[i], digit, digits_);
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
  if (cluster.dark) {
    std::fill(sum_.data() + kChannels * block.components.begin,
              sum_.data() + kChannels * block.components.end, 0.0f);
    return;
  }
  Weighing w{x_.data() + cluster.first, x_stride_, cluster.columns, 0, {}};
  std::size_t at = block.weights;
  for (std::size_t k = block.components.begin; k < block.components.end; k += w.count) {
    w.count = std::min(kTogether, block.components.end - k);
    digits_ == 1 ? kernels_.weigh8(weights8_.data() + at, w) : kernels_.weigh16(weights16_.data() + at, w);
    at += w.count * cluster.columns;
    for (std::size_t i = 0; i < w.count; ++i)
      for (std::size_t channel = 0; channel < kChannels; ++channel)
        sum_[kChannels * (k + i) + channel] = scale_[k + i] * w.sums[channel][i];
  }
}

void BlockProduct::chooseFactors(Tile& tile) {
  const std::size_t group_components = 2 * kGroupPairs / digits_;
  float* steps = steps_.data() + tile.steps;
  for (std::size_t first = tile.components.begin; first < tile.components.end;
       first += group_components, steps += kChannels) {
    const std::size_t last = std::min(first + group_components, tile.components.end);
    float largest[kChannels] = {}, inverse[kChannels];
    for (std::size_t k = first; k < last; ++k)
      for (std::size_t c = 0; c < kChannels; ++c)
        largest[c] = std::max(largest[c], std::abs(sum_[kChannels * k + c]));
    const float digit = digits_ == 1 ? 1.0f : kHighDigit;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const bool tells = largest[c] > kLeastSum;
      steps[c] = tells ? digit * largest[c] / kMostFactor : 0.0f;
      inverse[c] = tells ? 1 / steps[c] : 0.0f;
    }
    const auto factorOf = [](float s) {
      const float f = std::clamp(s, -kMostFactor, kMostFactor);
      return static_cast<std::int16_t>(f + (f < 0 ? -0.5f : 0.5f));
    };
    std::int16_t* factors = factors_.data() + tile.factors;
    for (std::size_t k = first; k < last; ++k)
      for (std::size_t c = 0; c < kChannels; ++c) {
        const std::size_t p = k - tile.components.begin;
        const float s = inverse[c] * sum_[kChannels * k + c];
        if (digits_ == 1) {
          factors[(p / 2 * kChannels + c) * 2 + p % 2] = factorOf(s);
        } else {
          factors[(p * kChannels + c) * 2] = factorOf(digit * s);
          factors[(p * kChannels + c) * 2 + 1] = factorOf(s);
        }
      }
  }

  tile.lit_count = 0;
  PairRange* lit = lit_.data() + tile.lit;
  std::size_t taken = 0;  // pairs: two clusters may share one
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const Range components = blocks_[tile.blocks + c].components;
    if (clusters_[c].dark || components.begin == components.end) continue;
    const std::size_t end = ((components.end - tile.components.begin) * digits_ + 1) / 2;
    taken = std::max(taken, (components.begin - tile.components.begin) * digits_ / 2);
    while (taken < end) {
      const std::size_t last = std::min(end, (taken / kGroupPairs + 1) * kGroupPairs);
      const bool goes_on =
          tile.lit_count > 0 && lit[tile.lit_count - 1].end == taken && taken % kGroupPairs != 0;
      if (goes_on)
        lit[tile.lit_count - 1].end = last;
      else
        lit[tile.lit_count++] = {taken, last};
      taken = last;
    }
  }
}

void BlockProduct::addStrips(const Tile& tile, std::size_t first, std::size_t last, std::span<Irradiance> y) {
  const std::size_t strip_bytes = tile.pairs * channels_ * 2 * kStripRows;
  StripPlanes strip{planes_.data() + tile.planes + first * strip_bytes, factors_.data() + tile.factors,
                    steps_.data() + tile.steps, lit_.data() + tile.lit, tile.lit_count};
  const std::uint32_t* target = target_.data() + tile.rows + first * kStripRows;
  for (std::size_t s = first; s < last; ++s, strip.planes += strip_bytes, target += kStripRows) {
    alignas(64) float rows[kStripRows][4];
    (channels_ == 1 ? kernels_.add_shared_strip : kernels_.add_strip)(strip, rows);
    const std::size_t row = s * kStripRows, count = std::min(kStripRows, tile.held - row);
    const std::size_t sole = std::clamp(tile.sole, row, row + count) - row;
    for (std::size_t i = 0; i < sole; ++i) y[target[i]] = Irradiance({rows[i][0], rows[i][1], rows[i][2]});
    for (std::size_t i = sole; i < count; ++i)
      shared_[target[i]] = Irradiance({rows[i][0], rows[i][1], rows[i][2]});
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
