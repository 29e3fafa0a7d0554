// SPDX-License-Identifier: MIT
#include "relume/codec/keyframes.h"

#include <algorithm>

#include "relume/core/check.h"

namespace relume::codec {
namespace {

/// Middle first, then the quarters, then the eighths: what is most likely to tell is asked first, and is the
/// frame that a split would need.
bool anyVisible(const Interval& keys, const Visible& visible, int depth) {
  for (int level = 1; level <= depth; ++level) {
    const int parts = 1 << level;
    for (int i = 1; i < parts; i += 2)
      if (visible(keys, keys.before + (keys.after - keys.before) * i / parts)) return true;
  }
  return false;
}

void split(const Interval& keys, const Visible& visible, const KeyframeOptions& options,
           std::vector<double>& times) {
  if (keys.after - keys.before < 2 * options.shortest || !anyVisible(keys, visible, options.depth)) return;
  const double middle = keys.before + (keys.after - keys.before) / 2;
  split({keys.before, middle}, visible, options, times);
  times.push_back(middle);
  split({middle, keys.after}, visible, options, times);
}

}  // namespace

std::vector<double> chooseKeyframes(std::span<const double> seeds, const Visible& visible,
                                    const KeyframeOptions& options) {
  RELUME_CHECK(!seeds.empty());
  RELUME_CHECK_LT(0.0, options.shortest);
  std::vector<double> times{seeds[0]};
  for (std::size_t i = 1; i < seeds.size(); ++i) {
    RELUME_CHECK_LT(seeds[i - 1], seeds[i]);
    split({seeds[i - 1], seeds[i]}, visible, options, times);
    times.push_back(seeds[i]);
  }
  return times;
}

KeyPlace placeBetween(std::span<const double> keys, double time) {
  RELUME_CHECK(!keys.empty());
  if (keys.size() == 1 || !(time > keys.front())) return {0, 0};
  if (!(time < keys.back())) return {keys.size() - 2, 1};
  const auto after = std::upper_bound(keys.begin(), keys.end(), time);
  const auto key = static_cast<std::size_t>(after - keys.begin()) - 1;
  return {key, (time - keys[key]) / (keys[key + 1] - keys[key])};
}

}  // namespace relume::codec
