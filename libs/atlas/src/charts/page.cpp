// SPDX-License-Identifier: MIT
#include "charts/page.h"

#include <algorithm>
#include <bit>

namespace relume::atlas {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};
constexpr int kLayers = 4;
constexpr int kTexelsPerCell = 64;  // a footprint of this many cells, width and height in sum, may use a grid

/// Bits 0, 2, 4, ... closed up into the lower half.
std::uint64_t everySecondBit(std::uint64_t x) {
  x &= 0x5555555555555555ull;
  x = (x | x >> 1) & 0x3333333333333333ull;
  x = (x | x >> 2) & 0x0f0f0f0f0f0f0f0full;
  x = (x | x >> 4) & 0x00ff00ff00ff00ffull;
  x = (x | x >> 8) & 0x0000ffff0000ffffull;
  return (x | x >> 16) & 0x00000000ffffffffull;
}

/// Four classes to the octave.
std::uint32_t sizeClass(int size) {
  const auto n = static_cast<std::uint32_t>(size);
  const int octave = std::bit_width(n) - 1;
  return octave < 2 ? n : static_cast<std::uint32_t>(4 * (octave - 1)) + (n >> (octave - 2) & 3);
}

BitGrid gridOf(const Footprint& footprint, int cell) {
  BitGrid grid((footprint.width + cell - 1) / cell, (footprint.height + cell - 1) / cell);
  for (const Run& run : footprint.runs) {
    grid.setRun(run.row / cell, run.begin / cell, (run.begin + run.length - 1) / cell + 1);
  }
  return grid;
}

}  // namespace

Shape prepareShape(Footprint footprint) {
  Shape shape;
  shape.footprint = std::move(footprint);
  const Footprint& f = shape.footprint;
  // Largest square inside, by the usual recurrence: one more than the least of the three neighbours above and
  // left.
  std::vector<std::int32_t> above(static_cast<std::size_t>(f.width) + 1, 0), here(above.size(), 0);
  std::size_t next = 0;
  for (int y = 0; y < f.height; ++y) {
    std::fill(here.begin(), here.end(), 0);
    for (; next < f.runs.size() && f.runs[next].row == y; ++next) {
      const Run& run = f.runs[next];
      for (int x = run.begin; x < run.begin + run.length; ++x) {
        const auto i = static_cast<std::size_t>(x);
        here[i + 1] = 1 + std::min({here[i], above[i], above[i + 1]});
        if (here[i + 1] > shape.square) {
          shape.square = here[i + 1];
          shape.square_row = y - here[i + 1] + 1;
        }
      }
    }
    std::swap(here, above);
  }
  for (const Run& run : f.runs) {
    for (const std::int32_t v : {run.row, run.begin, run.length}) {
      shape.hash = (shape.hash ^ static_cast<std::uint32_t>(v)) * 0x9e3779b97f4a7c15ull;
      shape.hash ^= shape.hash >> 29;
    }
  }
  // The longest run first, then rows far apart: bit-reversed order.
  const auto count = static_cast<std::uint32_t>(f.runs.size());
  if (count == 0) return shape;
  const auto longer = [](const Run& a, const Run& b) { return a.length < b.length; };
  const auto longest =
      static_cast<std::uint32_t>(std::max_element(f.runs.begin(), f.runs.end(), longer) - f.runs.begin());
  shape.probes.reserve(count);
  shape.probes.push_back(f.runs[longest]);
  const int bits = std::bit_width(count);
  for (std::uint32_t i = 0; i < (1u << bits); ++i) {
    std::uint32_t reversed = 0;
    for (int bit = 0; bit < bits; ++bit) reversed |= (i >> bit & 1) << (bits - 1 - bit);
    if (reversed < count && reversed != longest) shape.probes.push_back(f.runs[reversed]);
  }
  return shape;
}

Occupancy::Occupancy(int width, int height) : width_(width), height_(height), stride_((width + 63) / 64 + 2) {
  for (auto& level : levels_)
    level.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height), 0);
  longest_free_.resize(static_cast<std::size_t>(height));
  square_row_.assign(65, 0);
  for (int y = 0; y < height; ++y) {
    occupyRun(y, width, 64 * stride_);  // beyond the right border
    refresh(y, 0, 64 * stride_);
  }
}

void Occupancy::occupyRun(int y, int begin, int end) {
  std::uint64_t* words = row(0, y);
  while (begin < end) {
    const int stop = std::min(end, (begin | 63) + 1);
    words[begin >> 6] |= kAll >> (64 - (stop - begin)) << (begin & 63);
    begin = stop;
  }
}

void Occupancy::takeFrom(const Occupancy& finer, int first, int last, int begin, int end) {
  const int first_word = begin >> 6, last_word = (end - 1) >> 6;
  for (int y = first; y <= last; ++y) {
    std::uint64_t* words = row(0, y);
    for (int w = first_word; w <= last_word; ++w) {
      for (int half = 0; half < 2; ++half) {
        if (2 * w + half >= finer.stride_) continue;
        std::uint64_t any = 0;
        for (int k = 2 * y; k <= std::min(2 * y + 1, finer.height_ - 1); ++k)
          any |= finer.row(0, k)[2 * w + half];
        words[w] |= everySecondBit(any | any >> 1) << (32 * half);
      }
    }
    refresh(y, 64 * first_word, 64 * (last_word + 1));
  }
}

void Occupancy::refresh(int y, int begin, int end) {
  // Level k looks 2^k cells to the right: bits up to that far on the left change too.
  const int first = std::max(0, begin - 64) >> 6, last = std::min(stride_ - 1, (end - 1) >> 6);
  for (int level = 1; level < kLevels; ++level) {
    const int shift = 1 << (level - 1);
    const std::uint64_t* from = row(level - 1, y);
    std::uint64_t* to = row(level, y);
    for (int w = first; w <= last; ++w) {
      const std::uint64_t right = w + 1 < stride_ ? from[w + 1] : kAll;
      to[w] = from[w] | from[w] >> shift | right << (64 - shift);
    }
  }
  const std::uint64_t* words = row(0, y);
  int longest = 0, run = 0;
  for (int w = 0; w < stride_; ++w) {
    const std::uint64_t word = words[w];
    if (word == 0) {
      run += 64;
      continue;
    }
    longest = std::max(longest, run + std::countr_zero(word));
    run = std::countl_zero(word);
    // Gaps inside a word; only worth a look while they could be the longest.
    if (longest < 62) {
      int length = 0;
      for (std::uint64_t gap = ~word; gap != 0; gap &= gap << 1) ++length;
      longest = std::max(longest, length);
    }
  }
  longest_free_[static_cast<std::size_t>(y)] = std::max(longest, run);
}

std::uint64_t Occupancy::fetch(int level, int y, int x) const {
  const std::uint64_t* words = row(level, y);
  const int word = x >> 6, bit = x & 63;
  return bit == 0 ? words[word] : words[word] >> bit | words[word + 1] << (64 - bit);
}

std::uint64_t Occupancy::runBlocked(int y, int x, int length) const {
  if (length >= 64) {
    std::uint64_t blocked = fetch(6, y, x + length - 64);
    for (int i = 0; i + 64 <= length && blocked != kAll; i += 64) blocked |= fetch(6, y, x + i);
    return blocked;
  }
  const int level = std::bit_width(static_cast<unsigned>(length)) - 1;
  return fetch(level, y, x) | fetch(level, y, x + length - (1 << level));
}

std::uint64_t Occupancy::blocked(const Shape& shape, int x, int y) const {
  std::uint64_t blocked = 0;
  for (const Run& run : shape.probes) {
    blocked |= runBlocked(y + run.row, x + run.begin, run.length);
    if (blocked == kAll) break;
  }
  return blocked;
}

int Occupancy::firstSquareRow(int side) {
  std::int32_t& known = square_row_[static_cast<std::size_t>(side)];
  for (int s = 1; s < side; ++s) known = std::max(known, square_row_[static_cast<std::size_t>(s)]);
  for (; known + side <= height_; ++known) {
    bool possible = true;
    for (int r = 0; r < side && possible; ++r)
      possible = longest_free_[static_cast<std::size_t>(known + r)] >= side;
    if (!possible) continue;
    for (int x = 0; x + side <= width_; x += 64) {
      std::uint64_t b = 0;
      for (int r = 0; r < side && b != kAll; ++r) b |= runBlocked(known + r, x, side);
      if (b != kAll) return known;
    }
  }
  return known;
}

std::optional<IVec2> Occupancy::find(const Shape& shape, int last_row, bool hasty) {
  const Footprint& f = shape.footprint;
  if (f.width > width_ || f.runs.empty()) return std::nullopt;
  const int last = std::min(last_row + 1, height_) - f.height;
  std::int32_t& known = shape_row_[shape.hash];
  int first = std::max(known, firstSquareRow(std::min(shape.square, 64)) - shape.square_row);
  std::int32_t* last_found = nullptr;
  if (hasty) {
    last_found = &size_row_[64 * sizeClass(f.width) + sizeClass(f.height)];
    first = std::max(first, *last_found - f.height / 2);
  }
  const std::size_t quick = std::min<std::size_t>(shape.probes.size(), 4);
  for (int y = first; y <= last; ++y) {
    bool possible = true;
    for (std::size_t i = 0; i < quick && possible; ++i) {
      possible = longest_free_[static_cast<std::size_t>(y + shape.probes[i].row)] >= shape.probes[i].length;
    }
    if (!possible) continue;
    for (int x = 0; x + f.width <= width_; x += 64) {
      std::uint64_t b = blocked(shape, x, y);
      const int room = width_ - f.width - x;  // last position that stays inside
      if (room < 63) b |= kAll << (room + 1);
      if (b == kAll) continue;
      known = y;
      if (last_found) *last_found = y;
      return IVec2(x + std::countr_one(b), y);
    }
  }
  known = std::max(first, last + 1);
  return std::nullopt;
}

Page::Page(int width, int height, int gutter, Search search)
    : width_(width), height_(height), gutter_(gutter), hasty_(search == Search::kHasty) {
  layers_.emplace_back(width, height);
  // Half a gutter along the border, so that a sampler that repeats the page mixes nothing.
  const int edge = gutter / 2;
  Occupancy& fine = layers_[0];
  for (int y = 0; y < height; ++y) {
    if (y < edge || y >= height - edge) {
      fine.occupyRun(y, 0, width);
    } else {
      fine.occupyRun(y, 0, edge);
      fine.occupyRun(y, width - edge, width);
    }
    fine.refresh(y, 0, width);
  }
  for (int layer = 1; layer < kLayers && search != Search::kEverywhere; ++layer) {
    const Occupancy& finer = layers_.back();
    Occupancy coarser((finer.width() + 1) / 2, (finer.height() + 1) / 2);
    coarser.takeFrom(finer, 0, coarser.height() - 1, 0, coarser.width());
    layers_.push_back(std::move(coarser));
  }
}

std::optional<Page::Place> Page::find(const Footprint& footprint) {
  std::size_t layer = 0;
  while (layer + 1 < layers_.size() && footprint.width + footprint.height >= kTexelsPerCell << (layer + 1))
    ++layer;
  const int cell = 1 << layer;
  std::optional<Place> best;
  BitGrid grid = gridOf(footprint, 1);
  for (int turns = 0; turns < (hasty_ ? 2 : 4); ++turns) {
    if (turns > 0) grid = quarterTurn(grid);
    const Shape shape =
        prepareShape(layer == 0 ? footprintOf(grid) : footprintOf(gridOf(footprintOf(grid), cell)));
    // Only a place with a higher bottom than the best so far is of interest.
    const int last_row = best ? (best->bottom + cell - 1) / cell - 2 : height_;
    const std::optional<IVec2> at = layers_[layer].find(shape, last_row, hasty_);
    if (!at) continue;
    const int bottom = at->y * cell + grid.height();
    if (!best || bottom < best->bottom) best = Place{*at * cell, turns, bottom};
  }
  return best;
}

void Page::occupy(const Footprint& footprint, const Place& place) {
  BitGrid grid = gridOf(footprint, 1);
  for (int turns = 0; turns < place.turns; ++turns) grid = quarterTurn(grid);
  const Footprint turned = footprintOf(grid);
  const IVec2 at = place.corner;
  int lo = width_, hi = 0;
  const int first = std::max(0, at.y - gutter_), last = std::min(height_, at.y + turned.height + gutter_) - 1;
  for (const Run& run : turned.runs) {
    const int begin = std::max(0, at.x + run.begin - gutter_);
    const int end = std::min(width_, at.x + run.begin + run.length + gutter_);
    lo = std::min(lo, begin), hi = std::max(hi, end);
    const int top = std::max(first, at.y + run.row - gutter_),
              bottom = std::min(last, at.y + run.row + gutter_);
    for (int y = top; y <= bottom; ++y) layers_[0].occupyRun(y, begin, end);
  }
  for (int y = first; y <= last; ++y) layers_[0].refresh(y, lo, hi);
  for (std::size_t layer = 1; layer < layers_.size(); ++layer) {
    layers_[layer].takeFrom(layers_[layer - 1], first >> layer, last >> layer, lo >> layer,
                            ((hi - 1) >> layer) + 1);
  }
}

}  // namespace relume::atlas
