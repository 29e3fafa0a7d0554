// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "light_paths/entry_set.h"
#include "light_paths/patch_modes.h"
#include "light_paths/typical_light.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

constexpr float kNormalWeight = 1.0f;  // what a turn of the normal costs (Clusters)
constexpr float kLeastImportance = 1.0f / 32;
constexpr std::uint32_t kPiecePlaces = 4;  // where light on a piece is taken, one for each lamp in turn
constexpr std::uint32_t kLamps = 256;
constexpr std::uint32_t kFewestLamps = 32;  // that tell how light varies
/// Spacings that training lamps keep from surfaces. Nearer ones would have all modes for themselves.
constexpr float kLampDistance = 0.75f;
/// What even light counts for among them, lamps: that of skies and large areas is more like it than like
/// theirs.
constexpr float kEvenLamps = 8;

/// Training lamps, each so strong that all surfaces together have as much of it, and last even light.
class Training {
 public:
  Training(const PieceScene& scene, LightSet lamps, std::span<const float> side_weight,
           std::span<const float> piece_weight, std::uint64_t seed, Progress& progress)
      : scene_(scene), lamps_(std::move(lamps)), light_{lamps_.size() + 1, {}} {
    const std::size_t pieces = scene.pieces.size();
    const std::vector<Place> places = placesOn(scene.surface, scene.sides, side_weight,
                                               membersOf(scene.pieces.of_side, pieces), kPiecePlaces, seed);
    light_.on_pieces = lightOn(places, kPiecePlaces, pieces, progress);
    std::vector<double> flux(light_.lamps, 0.0);
    for (std::size_t p = 0; p < pieces; ++p)
      for (std::size_t l = 0; l < light_.lamps; ++l)
        flux[l] += static_cast<double>(piece_weight[p]) *
                   static_cast<double>(light_.on_pieces[p * light_.lamps + l]);
    for (const double f : flux) strength_.push_back(f > 0 ? static_cast<float>(1 / f) : 0.0f);
    strength_.back() *= std::sqrt(kEvenLamps);  // squares count
    scale(light_.on_pieces);
  }
  const TrainingLight& light() const { return light_; }
  /// shape: [places][lamps]
  std::vector<float> at(std::span<const Place> places, Progress& progress) const {
    std::vector<float> e = lightOn(places, 1, places.size(), progress);
    scale(e);
    return e;
  }

 private:
  /// A place for each group and lamp.
  std::vector<float> lightOn(std::span<const Place> places, std::size_t each, std::size_t groups,
                             Progress& progress) const {
    std::vector<float> e(groups * light_.lamps, 1.0f);
    const Stage stage(progress, "training lamps", groups);
    parallelFor(
        groups, 64,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t g = begin; g < end; ++g)
            for (std::size_t l = 0; l < lamps_.size(); ++l)
              e[g * light_.lamps + l] =
                  lightAt(scene_.surface.tracer, places[g * each + l % each], lamps_[l],
                          hashCombine(static_cast<std::uint32_t>(g), static_cast<std::uint32_t>(l)))
                      .rgb.x;
        },
        &progress);
    return e;
  }
  void scale(std::vector<float>& e) const {
    for (std::size_t i = 0; i < e.size(); ++i) e[i] *= strength_[i % strength_.size()];
  }

  const PieceScene& scene_;
  LightSet lamps_;
  std::vector<float> strength_;
  TrainingLight light_;
};

float spacingOf(const Pieces& pieces, std::span<const float> importance, std::size_t entries) {
  double important = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    important += static_cast<double>(pieces.all[i].area * importance[i]);
  return static_cast<float>(std::sqrt(important / static_cast<double>(std::max<std::size_t>(entries, 1))));
}

/// By patch: of its sides those that belong to it.
Members sidesOf(const PieceScene& scene, const Clusters& patches) {
  std::vector<std::uint32_t> of_side(scene.sides.size(), scene::kNone);
  for (std::size_t side = 0; side < of_side.size(); ++side)
    if (const std::uint32_t piece = scene.pieces.of_side[side]; piece != scene::kNone)
      of_side[side] = patches.of[piece];
  return membersOf(of_side, patches.size());
}

void describe(const PieceScene& scene, const Clusters& patches, EntrySet& set) {
  Entries& entries = set.entries;
  for (const Place& p : set.places) entries.samples.push_back({p.position, p.shading_normal});
  std::vector<float> area(patches.size(), 0.0f);
  for (std::size_t i = 0; i < scene.pieces.size(); ++i)
    if (patches.of[i] != scene::kNone) area[patches.of[i]] += scene.pieces.all[i].area;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Feature& c = patches.centre[p];
    const Vec3 n(c[3], c[4], c[5]);
    const auto modes = entries.first[p + 1] - entries.first[p];
    for (std::uint32_t k = 0; k < modes; ++k) {
      entries.area.push_back(area[p] / static_cast<float>(modes));
      entries.centre.emplace_back(c[0], c[1], c[2]);
      entries.normal.push_back(glm::length(n) > 0 ? glm::normalize(n) : Normal(0, 0, 1));
    }
  }
}

}  // namespace

EntrySet patchEntries(const PieceScene& scene, const LightView& light, std::span<const Box3> boxes,
                      const LightPathOptions& options, Progress& progress) {
  const Pieces& pieces = scene.pieces;
  const std::vector<float> importance = light.importance(pieces.all, kLeastImportance);
  EntrySet set;
  set.spacing = spacingOf(pieces, importance, options.entries);
  LightSet lamps;
  if (options.patch_entries > 1)
    lamps = findLights(scene.surface.tracer, boxes, kLamps, {.nearest = kLampDistance * set.spacing},
                       options.seed + 7, progress);
  // Where lamps find no room to tell how light varies, patches have their means alone.
  if (lamps.size() < kFewestLamps) lamps.clear();
  const std::uint32_t each = lamps.empty() ? 1 : options.patch_entries;
  const Clusters patches = makeLitClusters(
      scene.surface.tracer, pieces.all, importance, light,
      {std::max(options.entries / each, 1u), kNormalWeight, options.seed}, Slivers::kLeftOutIfDark, progress);
  const std::vector<float> side_weight = reflectedShares(scene.sides, pieces, scene.reflectance);
  std::vector<float> weight(pieces.size(), 0.0f);
  for (std::size_t side = 0; side < scene.sides.size(); ++side)
    if (pieces.of_side[side] != scene::kNone) weight[pieces.of_side[side]] += side_weight[side];

  const Members members = sidesOf(scene, patches);
  const std::uint32_t samples = options.entry_samples * each;
  set.places = placesOn(scene.surface, scene.sides, side_weight, members, samples, options.seed);
  set.entries.samples_each = samples;
  if (lamps.empty()) {
    set.on_pieces =
        PieceEntries::ofPatches(patches.of, shapeWithin(patches.of, patches.size(), weight, light.facing()));
    set.entries.setMeans(patches.size());
  } else {
    const Training training(scene, std::move(lamps), side_weight, weight, options.seed + 8, progress);
    PatchModes modes =
        modesOf(patches.of, patches.size(), weight, training.light(), options.entries, progress);
    set.entries.mix =
        mixOf(modes, training.at(set.places, progress), training.light().lamps, samples, progress);
    set.entries.first = std::move(modes.first);
    set.on_pieces = PieceEntries(pieces.size(), std::move(modes.shares));
  }
  describe(scene, patches, set);
  set.spacing = spacingOf(pieces, importance, set.entries.size());
  if (options.transfer == TransferBy::kWalks)
    set.starts = startsOnPatches(scene.surface, scene.sides, {pieces, set.on_pieces, set.entries.first},
                                 members, options.walks, options.walk_seed);
  return set;
}

}  // namespace relume::transport
