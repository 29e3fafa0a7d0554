// SPDX-License-Identifier: MIT
#include "block_product.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

constexpr std::size_t kChannels = 3;
constexpr int kHighDigit = 257;
constexpr float kLeastSum =
    1e-30f;  // factors whose largest is below this are 0: their step must be a normal number
constexpr float kMostGain = 1e16f;  // of a whole matrix; times kLargest still a float
// Tiles of more strips are taken by all threads together.
constexpr std::size_t kLargeTile = 128;
constexpr std::size_t kStripsAtOnce = 16;
constexpr std::size_t kTilesAtOnce = 4;
constexpr std::size_t kLineBytes = sizeof(Line);
constexpr std::size_t kSharedAtOnce = 4096;

constexpr std::size_t roundedUp(std::size_t n, std::size_t step) { return (n + step - 1) / step * step; }

// So many of `count` components at a time that all turns are about equal.
constexpr std::size_t weighedTogether(std::size_t count) {
  const std::size_t turns = roundedUp(std::max<std::size_t>(count, 1), kTogether) / kTogether;
  return std::max<std::size_t>((count + turns - 1) / turns, 1);
}

void checkGain(const codec::BlockMatrix& m) {
  double gain = 0;
  for (const float s : m.scale) gain += std::abs(s);
  gain *= (m.bits == 8 ? 127.0 : 32767.0) * std::max<std::uint32_t>(m.columns, 1);
  if (!(gain <= kMostGain))
    throw Error(ErrorCode::kCorruptAsset, "transfer", "its products leave the range of numbers",
                "the file was damaged; bake it again");
}

// The digit of an 8-bit plane: of one, or the high and the low one of two.
int digitOf(int q, std::size_t digit, std::size_t digits) {
  if (digits == 1) return q;
  const int high = (q + (q < 0 ? -kHighDigit / 2 : kHighDigit / 2)) / kHighDigit;
  return digit == 0 ? high : std::clamp(q - kHighDigit * high, -127, 127);
}

}  // namespace

BlockProduct::BlockProduct(const codec::BlockMatrix& m, const ProductKernels& kernels)
    : kernels_(kernels), rows_(m.rows), channels_(m.channels), digits_(m.bits / 8) {
  checkGain(m);
  placeColumns(m);
  placeBlocks(m);
  const std::vector<std::uint32_t> places = placeRows(m);
  if (m.bits == 8)
    copySamples(m, places, m.planes8, m.weights8);
  else
    copySamples(m, places, m.planes16, m.weights16);
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
  std::size_t rows = 0, bytes = 0, factors = 0, steps = 0, lit = 0;
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    Tile tile{};
    tile.lines.begin = bytes / kLineBytes;
    const std::size_t first_block = t * m.clusters();
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const Range components{m.component_first[first_block + c], m.component_first[first_block + c + 1]};
      blocks_.push_back({components, bytes});
      bytes += (components.end - components.begin) * clusters_[c].columns * digits_;
    }
    bytes = roundedUp(bytes, kLineBytes);
    tile.strips = roundedUp(m.tile_first[t + 1] - m.tile_first[t], kStripRows) / kStripRows;
    tile.components = {m.component_first[first_block], m.component_first[first_block + m.clusters()]};
    tile.quads = roundedUp((tile.components.end - tile.components.begin) * digits_, kQuad) / kQuad;
    tile.rows = rows, tile.planes = bytes, tile.factors = factors, tile.steps = steps,
    tile.blocks = first_block, tile.lit = lit;
    const std::size_t groups = roundedUp(tile.quads, kGroupQuads) / kGroupQuads;
    rows += tile.strips * kStripRows, bytes += tile.strips * tile.quads * channels_ * kStripRows * kQuad;
    factors += tile.quads * kChannels * kQuad, steps += groups * kChannels, lit += m.clusters() + groups;
    tile.lines.end = bytes / kLineBytes;
    tiles_.push_back(tile);
  }
  static_assert(kStripRows * kQuad % kLineBytes == 0);
  target_.resize(rows);
  stream_ = LineBuffer(bytes / kLineBytes);
  factors_.resize(factors);
  steps_.resize(steps);
  starts_.resize(steps);
  lit_.resize(lit);
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
                               const std::vector<Q>& planes, const std::vector<Q>& weights) {
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
      const std::size_t together = weighedTogether(components.end - components.begin);
      const std::size_t first = k - (k - components.begin) % together;  // of those that are weighed with k
      const std::size_t count = std::min(together, components.end - first);
      std::byte* out =
          stream() + blocks_[b].weights + (first - components.begin) * clusters_[c].columns * sizeof(Q);
      for (std::size_t j = 0; j < columns; ++j)
        std::memcpy(out + ((j / kLanes * count + k - first) * kLanes + j % kLanes) * sizeof(Q), weight + j,
                    sizeof(Q));
      for (std::size_t channel = 0; channel < channels_; ++channel, plane += place.size())
        for (std::size_t digit = 0; digit < digits_; ++digit) {
          const std::size_t p = (k - tile.components.begin) * digits_ + digit;
          for (std::size_t i = 0; i < place.size(); ++i) {
            const std::size_t strip = place[i] / kStripRows, row = place[i] % kStripRows;
            const std::size_t quad = (strip * tile.quads + p / kQuad) * channels_ + channel;
            stream()[tile.planes + (quad * kStripRows + row) * kQuad + p % kQuad] =
                static_cast<std::byte>(digitOf(plane[i], digit, digits_) + kPlaneZero);
          }
        }
    }
  }
}

Ahead BlockProduct::after(const Tile& tile) const {
  const std::size_t next = static_cast<std::size_t>(&tile - tiles_.data()) + 1;
  const std::size_t end = next < tiles_.size() ? tiles_[next].lines.end : tile.lines.end;
  return {stream() + tile.lines.end * kLineBytes, stream() + end * kLineBytes};
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

void BlockProduct::weigh(const Tile& tile, std::size_t c, Ahead& ahead) {
  const Cluster& cluster = clusters_[c];
  const Block& block = blocks_[tile.blocks + c];
  const std::size_t stride = scale_.size();
  if (cluster.dark) {
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      std::fill(sum_.data() + channel * stride + block.components.begin,
                sum_.data() + channel * stride + block.components.end, 0.0f);
    return;
  }
  Weighing w{x_.data() + cluster.first, x_stride_, cluster.columns, 0, {}, ahead};
  const std::byte* weights = stream() + block.weights;
  const std::size_t together = weighedTogether(block.components.end - block.components.begin);
  for (std::size_t k = block.components.begin; k < block.components.end; k += w.count) {
    w.count = std::min(together, block.components.end - k);
    digits_ == 1 ? kernels_.weigh8(reinterpret_cast<const std::int8_t*>(weights), w)
                 : kernels_.weigh16(reinterpret_cast<const std::int16_t*>(weights), w);
    weights += w.count * cluster.columns * digits_;
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      for (std::size_t i = 0; i < w.count; ++i)
        sum_[channel * stride + k + i] = scale_[k + i] * w.sums[channel][i];
  }
  ahead = w.ahead;
}

// Loops are such that compilers make vector code of them.
void BlockProduct::chooseFactors(Tile& tile) {
  constexpr std::size_t kGroupPlanes = kGroupQuads * kQuad;
  const std::size_t group_components = kGroupPlanes / digits_;
  const float digit = digits_ == 1 ? 1.0f : kHighDigit;
  std::int16_t* factors = factors_.data() + tile.factors;
  for (std::size_t first = tile.components.begin, step = tile.steps; first < tile.components.end;
       first += group_components, factors += kGroupPlanes * kChannels) {
    const std::size_t count = std::min(group_components, tile.components.end - first);
    const std::size_t quads = roundedUp(count * digits_, kQuad) / kQuad;
    for (std::size_t c = 0; c < kChannels; ++c, ++step) {
      const float* sum = sum_.data() + c * scale_.size() + first;
      std::uint32_t largest_bits = 0;  // magnitudes are in the order of their bits
      for (std::size_t k = 0; k < count; ++k)
        largest_bits = std::max(largest_bits, std::bit_cast<std::uint32_t>(std::abs(sum[k])));
      const auto largest = std::bit_cast<float>(largest_bits);
      const bool tells = largest > kLeastSum;
      steps_[step] = tells ? digit * largest / kMostFactor : 0.0f;
      const float inverse = tells ? 1 / steps_[step] : 0.0f;
      const auto nearest = [](float f) {
        return static_cast<std::int16_t>(static_cast<int>(f + std::copysign(0.5f, f)));
      };
      alignas(32) std::int16_t planes[kGroupPlanes];
      if (digits_ == 1) {
        for (std::size_t k = 0; k < count; ++k) planes[k] = nearest(inverse * sum[k]);
      } else {
        for (std::size_t k = 0; k < count; ++k) {
          planes[2 * k] = nearest(digit * (inverse * sum[k]));
          planes[2 * k + 1] = nearest(inverse * sum[k]);
        }
      }
      std::fill(planes + count * digits_, planes + quads * kQuad, std::int16_t{0});
      int total = 0;
      for (std::size_t p = 0; p < quads * kQuad; ++p) total += planes[p];
      starts_[step] = -kPlaneZero * total;
      for (std::size_t q = 0; q < quads; ++q)
        std::memcpy(factors + (q * kChannels + c) * kQuad, planes + q * kQuad, kQuad * sizeof planes[0]);
    }
  }
  kernels_.pack_factors(factors_.data() + tile.factors, tile.quads * kChannels);
}

void BlockProduct::chooseRanges(Tile& tile) {
  tile.lit_count = 0;
  QuadRange* lit = lit_.data() + tile.lit;
  std::size_t taken = 0;  // quads: two clusters may share one
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const Range components = blocks_[tile.blocks + c].components;
    if (clusters_[c].dark || components.begin == components.end) continue;
    const std::size_t end = roundedUp((components.end - tile.components.begin) * digits_, kQuad) / kQuad;
    taken = std::max(taken, (components.begin - tile.components.begin) * digits_ / kQuad);
    while (taken < end) {
      const std::size_t last = std::min(end, (taken / kGroupQuads + 1) * kGroupQuads);
      const bool goes_on =
          tile.lit_count > 0 && lit[tile.lit_count - 1].end == taken && taken % kGroupQuads != 0;
      if (goes_on)
        lit[tile.lit_count - 1].end = last;
      else
        lit[tile.lit_count++] = {taken, last};
      taken = last;
    }
  }
}

void BlockProduct::addStrips(const Tile& tile, std::size_t first, std::size_t last, std::span<Irradiance> y,
                             Ahead ahead) {
  const std::size_t strip_bytes = tile.quads * channels_ * kStripRows * kQuad;
  StripPlanes strip{reinterpret_cast<const std::uint8_t*>(stream()) + tile.planes + first * strip_bytes,
                    factors_.data() + tile.factors,
                    steps_.data() + tile.steps,
                    starts_.data() + tile.steps,
                    lit_.data() + tile.lit,
                    tile.lit_count,
                    ahead};
  const AddStripFunction add = channels_ == 1 ? kernels_.add_shared_strip : kernels_.add_strip;
  const std::uint32_t* target = target_.data() + tile.rows + first * kStripRows;
  for (std::size_t s = first; s < last; ++s, strip.planes += strip_bytes, target += kStripRows) {
    alignas(64) float rows[kStripRows + 1][kChannels];  // one more for kernels that write four numbers
    add(strip, rows);
    const std::size_t row = s * kStripRows, count = std::min(kStripRows, tile.held - row);
    const std::size_t sole = std::clamp(tile.sole, row, row + count) - row;
    static_assert(sizeof(Irradiance) == sizeof rows[0] && std::is_trivially_copyable_v<Irradiance>);
    for (std::size_t i = 0; i < sole; ++i) std::memcpy(&y[target[i]], rows[i], sizeof rows[i]);
    for (std::size_t i = sole; i < count; ++i) std::memcpy(&shared_[target[i]], rows[i], sizeof rows[i]);
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
  parallelFor(tiles_.size(), kTilesAtOnce, [&job](std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin) {
      Tile& tile = job.self.tiles_[begin];
      if (tile.strips > kLargeTile) continue;
      Ahead ahead = job.self.after(tile);
      for (std::size_t c = 0; c < job.self.clusters_.size(); ++c) job.self.weigh(tile, c, ahead);
      job.self.chooseFactors(tile);
      job.self.chooseRanges(tile);
      job.self.addStrips(tile, 0, tile.strips, job.y, ahead);
    }
  });
  for (Tile& tile : tiles_) {
    if (tile.strips <= kLargeTile) continue;
    job.large = &tile;
    parallelFor(clusters_.size(), 1, [&job](std::size_t begin, std::size_t end) {
      Ahead none;
      for (; begin < end; ++begin) job.self.weigh(*job.large, begin, none);
    });
    chooseFactors(tile);
    chooseRanges(tile);
    parallelFor(tile.strips, kStripsAtOnce, [&job](std::size_t begin, std::size_t end) {
      job.self.addStrips(*job.large, begin, end, job.y, {});
    });
  }
  parallelFor(shared_row_.size(), kSharedAtOnce, [&job](std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin) {
      const std::size_t first = job.self.shared_first_[begin], last = job.self.shared_first_[begin + 1];
      Irradiance sum = job.self.shared_[first] + job.self.shared_[first + 1];
      for (std::size_t i = first + 2; i < last; ++i) sum += job.self.shared_[i];
      job.y[job.self.shared_row_[begin]] = sum;
    }
  });
}

}  // namespace relume::relight
