// SPDX-License-Identifier: MIT
// T_xe = sum over gather rays of x, each with its share s:
//   s rho (d_p where the ray ends on a piece p of e, + r_p G_je of the element j where it ends),
// with rho the reflectance of the texel where the ray ends and G_je the irradiance on element j after one
// reflection or more, per unit irradiance on entry e (ElementLight). d and r are the shapes of typical light
// within entries and elements (typical_light.h). So what light does first, on its way from the entry to the
// exit, is as fine as texels are; elements make only what comes after.
#include "relume/transport/light_paths.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <mutex>
#include <numeric>

#include "direction_batch.h"
#include "light_paths/clusters.h"
#include "light_paths/elements.h"
#include "light_paths/entry_set.h"
#include "light_paths/exit_rays.h"
#include "light_paths/exit_substitutes.h"
#include "light_paths/exit_tiles.h"
#include "light_paths/light_walks.h"
#include "light_paths/places.h"
#include "light_paths/point_exits.h"
#include "light_paths/typical_light.h"
#include "light_paths/vector_row.h"
#include "relume/core/check.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"
#include "relume/core/quantity.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

constexpr std::size_t kPiecesOfElement = 4;
// What a turn of the normal costs in clusters (Clusters).
constexpr float kElementNormalWeight = 1.0f;
// How much less finely that is divided which no light comes to (LightView).
constexpr float kLeastElements = 1.0f / 8, kLeastPieces = 1.0f / 8;
constexpr double kResidual = 1e-4;
constexpr std::uint32_t kFewestExitRays = 16;  // of a texel
constexpr std::uint32_t kPiecePlaces = 4;      // where light on a piece is taken
constexpr std::size_t kExitGrain = 64;

void require(bool good, const char* what, const char* remedy) {
  if (!good) throw Error(ErrorCode::kUsage, "light paths", what, remedy);
}

LightPathOptions checked(const LightPathOptions& o, const atlas::Texels& texels) {
  require(o.entries > 0 && o.entries <= 1u << 16, "entries are not between 1 and 65536", "1024 suit a hall");
  require(o.entry_samples > 0 && o.entry_samples <= 1024, "samples of an entry are not between 1 and 1024",
          "16 are enough for lights that keep away from walls");
  require(o.near >= 0.0f && o.near < kInfinity, "the way that is near is no length", "take half a metre");
  require(o.patch_entries > 0 && o.patch_entries <= 64, "entries of a patch are not between 1 and 64",
          "4 are usual");
  require(o.receivers == Receivers::kTexels || (o.near == 0 && o.transfer == TransferBy::kGathering),
          "short ways and walks are for exits at texels", "take one or the other");
  require(o.probe_spacing > 0 && o.probe_spacing < kInfinity, "the spacing of probes is no length",
          "take a metre");
  require(o.walks > 0 && o.walks <= 1u << 16, "walks of an entry are not between 1 and 65536", "16 do");
  require(o.test_points > 0 && o.test_points <= 1u << 16, "test points are not between 1 and 65536",
          "128 do");
  require(o.elements > 0 && o.elements <= 1u << 16, "elements are not between 1 and 65536", "8192 do");
  require(o.element_rays > 0 && o.exit_rays > 0, "no rays", "ask for some hundreds");
  require(o.exit_rays <= kMaxSequence, "more than 65536 rays of an exit", "1024 do");
  require(o.exit_side >= 1 && o.exit_side <= 64, "exits of no or too many texels",
          "take 1 to 64 along a side");
  require(o.tile_exits > 0 && o.tile_overlap >= 0.0f && o.tile_overlap <= 4.0f, "impossible tiles",
          "128 exits and an overlap of 0.3 are usual");
  if (texels.points.empty())
    throw Error(ErrorCode::kEmptyScene, "light paths", "there are no texels", "bake a static mesh");
  LightPathOptions options = o;
  if (o.placement == EntryPlacement::kShot) options.entry_samples = options.patch_entries = 1;
  return options;
}

std::vector<Box3> boxesOf(const LightPathOptions& options, const atlas::Texels& texels) {
  if (!options.light_boxes.empty()) return options.light_boxes;
  Box3 box;
  for (const atlas::SurfacePoint& p : texels.points) box.add(p.position);
  return {box};
}

}  // namespace

struct LightPaths::Impl {
  Impl(const trace::Tracer& the_tracer, const atlas::Atlas& atlas, const atlas::Texels& the_texels,
       const LightPathOptions& the_options, Progress& progress)
      : tracer(the_tracer),
        texels(the_texels),
        options(checked(the_options, the_texels)),
        boxes(boxesOf(options, texels)),
        lookup(tracer.scene(), atlas, texels),
        exposure(tracer, texels),
        groups(texels),
        reflectance(meanReflectance(tracer.scene(), texels, options.materials)),
        surface{tracer, texels, lookup, exposure},
        sides(surface, groups, std::uint64_t{options.element_rays} * options.elements, options.seed,
              progress),
        exit_patches(makePatches(texels, options.exit_side, sides.buriedPoints())),
        gathered_from(gatheredFrom(exit_patches, sides)),
        directions(firstExitRays(), std::max(firstExitRays(), std::bit_ceil(options.exit_rays)),
                   options.seed + 0x9e3779b97f4a7c15u, BlockSamples::kShared),
        exit_scene{surface,    exit_patches,      sides,        pieces,      elements, reflectance,
                   directions, options.exit_rays, options.seed, options.near} {
    if (options.receivers == Receivers::kTexels) {
      placeExits(progress);
    } else {
      placePoints(atlas, progress);
    }
    placeAll(progress);
    if (options.transfer == TransferBy::kWalks) {
      virtual_lights = walk({surface, sides, reflectance}, entry_set.starts, options.walk_seed, progress);
    } else {
      reflected = std::make_unique<ElementLight>(
          elements, entries().size(),
          [&](std::size_t block, std::span<float> radiosity) { fill(block, radiosity); }, kResidual,
          progress);
    }
    ray_count = sides.rays();
  }

  const Entries& entries() const { return entry_set.entries; }

  std::uint32_t firstExitRays() const {
    const std::uint32_t area = options.exit_side * options.exit_side;
    return std::max(std::bit_ceil((options.exit_rays + area - 1) / area), kFewestExitRays);
  }

  void placeExits(Progress& progress) {
    exits.side = options.exit_side;
    for (const Patch& p : exit_patches.all)
      exits.all.push_back({p.chart, p.page, p.x, p.y, p.centre, p.normal, p.area,
                           sides.buried(exit_patches.members[p.first])});
    exits.of_texel = exit_patches.patch_of;
    exits.buried.assign(sides.buriedPoints().begin(), sides.buriedPoints().end());
    tiles = makeTiles(exits.all, options.tile_exits, options.tile_overlap, options.seed, progress);
  }

  void placePoints(const atlas::Atlas& atlas, Progress& progress) {
    points = options.receivers == Receivers::kVertices
                 ? vertexExits(tracer.scene(), atlas, texels)
                 : probeExits(tracer, tracer.scene().bounds(), options.probe_spacing);
    exits = points.exits;
    const std::uint32_t each = std::max(options.tile_exits / exits.rows_each, 1u);
    tiles = makeTiles(exits.all, each, options.tile_overlap, options.seed, progress);
  }

  void placeAll(Progress& progress) {
    const Stage stage(progress, "entries", 1);
    const LightSet test = findLights(tracer, boxes, LightView::kPlaces, {}, options.seed, progress);
    const std::size_t most = kPiecesOfElement * std::max(options.elements, options.entries);
    {
      const Pieces coarse = makePieces(surface, sides, most);
      const LightView view = viewOf(coarse, test, progress);
      pieces = refinedPieces(surface, sides, coarse, view.importance(coarse.all, kLeastPieces), most);
    }
    const LightView view = viewOf(pieces, test, progress);
    const PieceScene scene{surface, sides, pieces, reflectance};
    entry_set = options.placement == EntryPlacement::kShot
                    ? shotEntries(scene, boxes, options, progress)
                    : patchEntries(scene, view, boxes, options, progress);
    placeElements(view, progress);
    first = firstReflection(elements, sides, pieces, reflectance, entry_set.on_pieces, entries().size(),
                            progress);
  }

  std::vector<Place> placesOnPieces(const Pieces& of, std::uint64_t seed) const {
    return placesOn(surface, sides, reflectedShares(sides, of, reflectance), membersOf(of.of_side, of.size()),
                    kPiecePlaces, seed);
  }
  LightView viewOf(const Pieces& of, const LightSet& lights, Progress& progress) const {
    return {tracer, of.size(), placesOnPieces(of, options.seed + 4), lights, progress};
  }

  void placeElements(const LightView& light, Progress& progress) {
    const std::vector<float> importance = light.importance(pieces.all, kLeastElements);
    const Clusters clusters =
        makeLitClusters(tracer, pieces.all, importance, light,
                        {options.elements, kElementNormalWeight, options.seed + 1}, Slivers::kKept, progress);
    const std::vector<float> typical = reflectedLight(sides, pieces, reflectance, light.facing(), progress);
    elements =
        makeElements(sides, pieces, reflectance, clusters.of, clusters.size(),
                     shapeWithin(clusters.of, clusters.size(), areasOf(sides, pieces), typical), progress);
  }

  /// What falls on elements after one reflection, of light on entries.
  void fill(std::size_t block, std::span<float> irradiance) const {
    const std::size_t begin = block * ElementLight::kBlock, end = begin + ElementLight::kBlock;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const std::span<const Weight> row = first.of(i);
      float* of_element = irradiance.data() + i * ElementLight::kRow;
      for (auto w =
               std::partition_point(row.begin(), row.end(), [&](const Weight& x) { return x.index < begin; });
           w != row.end() && w->index < end; ++w)
        for (int c = 0; c < 3; ++c)
          of_element[static_cast<std::size_t>(c) * ElementLight::kBlock + w->index - begin] += w->value[c];
    }
  }

  /// What exits see, one thread's.
  struct Look {
    Look(const Impl& impl, const ExitScene& scene)
        : of(impl), views(impl.exits.rows_each), blocks(scene), points(scene, impl.points) {}
    void at(std::size_t exit) {
      if (of.options.receivers == Receivers::kTexels) {
        blocks.look(of.gathered_from[exit], views[0]);
      } else {
        points.look(exit, views);
      }
    }
    const Impl& of;
    std::vector<ExitView> views;  // by row
    ExitRays blocks;
    PointRays points;
  };

  void rows(std::size_t tile, std::span<float> out) const {
    const auto of =
        std::span(tiles.row).subspan(tiles.first[tile], tiles.first[tile + 1] - tiles.first[tile]);
    const std::size_t columns = entries().size();
    const std::size_t each = exits.rows_each, rows = of.size() * each;
    RELUME_CHECK_EQ(out.size(), rows * 3 * columns);
    std::fill(out.begin(), out.end(), 0.0f);
    if (options.transfer == TransferBy::kWalks) {
      for (std::size_t r = 0; r < of.size(); ++r)
        connect(surface, virtual_lights, exit_patches, gathered_from[of[r]], options.near, options.walk_seed,
                columns, out.subspan(r * 3 * columns, 3 * columns));
      return;
    }
    Look look(*this, exit_scene);
    std::vector<Weight> weights;
    std::vector<std::size_t> begins(1, 0);
    for (std::size_t r = 0; r < rows; ++r) {
      if (r % each == 0) look.at(of[r / each]);
      const ExitView& view = look.views[r % each];
      float* row = out.data() + r * 3 * columns;
      for (const Weight& w : view.direct)
        for (const EntryShare& s : entry_set.on_pieces.of(w.index))
          for (std::size_t c = 0; c < 3; ++c)
            row[c * columns + s.entry] += s.value * w.value[static_cast<int>(c)];
      weights.insert(weights.end(), view.reflected.begin(), view.reflected.end());
      begins.push_back(weights.size());
    }
    for (std::size_t block = 0; block < reflected->blocks(); ++block) {
      const std::size_t begin = block * ElementLight::kBlock,
                        count = std::min(ElementLight::kBlock, columns - begin);
      for (std::size_t r = 0; r < rows; ++r) {
        const std::array<float, ElementLight::kRow> sum =
            gather(*reflected, block, std::span(weights).subspan(begins[r], begins[r + 1] - begins[r]));
        float* row = out.data() + r * 3 * columns + begin;
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t k = 0; k < count; ++k) row[c * columns + k] += sum[c * ElementLight::kBlock + k];
      }
    }
  }

  static std::array<float, ElementLight::kRow> gather(const ElementLight& of, std::size_t block,
                                                      std::span<const Weight> weights) {
    constexpr std::size_t kBlock = ElementLight::kBlock;
    std::array<VectorRow<kBlock>, 3> row;
    for (auto& channel : row) channel.clear();
    for (const Weight& w : weights) {
      const float* from = of.of(block, w.index);
      row[0].add(w.value.x, from), row[1].add(w.value.y, from + kBlock),
          row[2].add(w.value.z, from + 2 * kBlock);
    }
    std::array<float, ElementLight::kRow> sum;
    for (std::size_t c = 0; c < 3; ++c) row[c].store(sum.data() + c * kBlock);
    return sum;
  }

  std::vector<Vec3> nearShares(Progress& progress) const {
    constexpr std::uint32_t kMost = 256;
    const std::uint32_t each = std::min(std::bit_ceil(options.exit_rays), kMost);
    const SampleTable samples(each, each, options.seed + 3, BlockSamples::kShared);
    std::vector<Vec3> share(texels.points.size(), Vec3(0.0f));
    const Stage stage(progress, "short ways", groups.tiles());
    parallelFor(
        groups.tiles(), 1,
        [&](std::size_t begin, std::size_t end) {
          SideRays rays(surface, samples, options.seed + 3, Alignment::kTurnedByBlock);
          for (std::size_t tile = begin; tile < end; ++tile)
            groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
              rays.trace(group, Side::kFront, each,
                         [&](std::uint32_t texel, std::uint32_t, const SideRays::End& end_of_ray) {
                           const std::uint32_t side = sides.answering(end_of_ray.surface);
                           if (side == scene::kNone || !(end_of_ray.distance < options.near)) return;
                           share[group[texel]] +=
                               reflectance.value[sides.point(side)] / static_cast<float>(each);
                         });
            });
        },
        &progress);
    // Inside bodies everything is near; what others see of such a texel is filled from one beside it.
    for (std::uint32_t i = 0; i < share.size(); ++i)
      if (sides.buried(i)) {
        const std::uint32_t other = sides.answering(i);
        share[i] = other == scene::kNone || sides.buried(other) ? Vec3(0.0f) : share[sides.point(other)];
      }
    return share;
  }

  /// Of lights, means over `each` places of every group. Shape: [lights][groups]
  std::vector<Vec3> lightOn(std::span<const Light> lights, std::span<const Place> places, std::uint32_t each,
                            Progress& progress) const {
    const std::size_t count = places.size() / each;
    std::vector<Vec3> result(lights.size() * count);
    const Stage stage(progress, "direct light", result.size());
    parallelFor(
        result.size(), 64,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            const std::size_t group = i % count;
            Vec3 sum(0.0f);
            for (std::uint32_t k = 0; k < each; ++k)
              sum += lightAt(tracer, places[group * each + k], lights[i / count],
                             hashCombine(static_cast<std::uint32_t>(group), k))
                         .rgb;
            result[i] = sum / static_cast<float>(each);
          }
        },
        &progress);
    return result;
  }

  /// shape: [lights][entries]
  std::vector<Vec3> lightOnEntries(std::span<const Light> lights, Progress& progress) const {
    const Entries& e = entries();
    const std::vector<Vec3> on_places = lightOn(lights, entry_set.places, 1, progress);
    std::vector<Vec3> result(lights.size() * e.size(), Vec3(0.0f));
    for (std::size_t l = 0; l < lights.size(); ++l)
      for (std::size_t p = 0, place = 0; p < e.patches(); ++p) {
        const std::size_t modes = e.first[p + 1] - e.first[p];
        const float* mix = e.mix.data() + std::size_t{e.samples_each} * e.first[p];
        Vec3* of_patch = result.data() + l * e.size() + e.first[p];
        for (std::size_t k = 0; k < e.samples_each; ++k, ++place)
          for (std::size_t m = 0; m < modes; ++m)
            of_patch[m] += mix[k * modes + m] * on_places[l * entry_set.places.size() + place];
      }
    return result;
  }

  std::vector<Irradiance> irradiance(std::span<const Light> lights, LitBy by,
                                     std::span<const std::uint32_t> which, GatherRays rays,
                                     Progress& progress) const {
    std::vector<Vec3> on_piece;  // [lights][pieces]
    if (by == LitBy::kEntries) {
      const std::vector<Vec3> on_entry = lightOnEntries(lights, progress);
      on_piece.assign(lights.size() * pieces.size(), Vec3(0.0f));
      for (std::size_t l = 0; l < lights.size(); ++l)
        for (std::size_t p = 0; p < pieces.size(); ++p)
          for (const EntryShare& s : entry_set.on_pieces.of(p))
            on_piece[l * pieces.size() + p] += s.value * on_entry[l * entries().size() + s.entry];
    } else {
      const std::vector<Place> places = placesOnPieces(pieces, options.seed + 2);
      on_piece = lightOn(lights, places, kPiecePlaces, progress);
    }
    std::vector<std::uint32_t> itself(pieces.size());
    std::iota(itself.begin(), itself.end(), 0u);
    const FirstReflection of_pieces = firstReflection(
        elements, sides, pieces, reflectance,
        PieceEntries::ofPatches(itself, std::vector<float>(pieces.size(), 1.0f)), pieces.size(), progress);
    const ElementLight of_lights(
        elements, lights.size(),
        [&](std::size_t block, std::span<float> irradiance) {
          const std::size_t begin = block * ElementLight::kBlock,
                            end = std::min(begin + ElementLight::kBlock, lights.size());
          for (std::size_t i = 0; i < elements.size(); ++i)
            for (const Weight& w : of_pieces.of(i))
              for (std::size_t l = begin; l < end; ++l) {
                const Vec3 e = w.value * on_piece[l * pieces.size() + w.index];
                float* at = irradiance.data() + i * ElementLight::kRow + (l - begin);
                for (int c = 0; c < 3; ++c) at[static_cast<std::size_t>(c) * ElementLight::kBlock] += e[c];
              }
        },
        kResidual, progress);
    const std::size_t each = exits.rows_each, rows = which.size() * each;
    ExitScene scene = exit_scene;
    if (rays == GatherRays::kOther) scene.seed += 0x6f74686572u;
    std::vector<Irradiance> result(lights.size() * rows);
    const Stage stage(progress, "exits", which.size());
    parallelFor(
        which.size(), kExitGrain,
        [&](std::size_t begin, std::size_t end) {
          Look look(*this, scene);
          for (std::size_t x = begin * each; x < end * each; ++x) {
            if (x % each == 0) look.at(which[x / each]);
            const ExitView& view = look.views[x % each];
            for (std::size_t block = 0; block < of_lights.blocks(); ++block) {
              const auto sum = gather(of_lights, block, view.reflected);
              const std::size_t begins = block * ElementLight::kBlock;
              for (std::size_t l = begins; l < std::min(begins + ElementLight::kBlock, lights.size()); ++l) {
                Vec3 e(sum[l - begins], sum[ElementLight::kBlock + l - begins],
                       sum[2 * ElementLight::kBlock + l - begins]);
                for (const Weight& w : view.direct) e += w.value * on_piece[l * pieces.size() + w.index];
                result[l * rows + x] = Irradiance(e);
              }
            }
          }
        },
        &progress);
    return result;
  }

  const trace::Tracer& tracer;
  const atlas::Texels& texels;
  const LightPathOptions options;
  const std::vector<Box3> boxes;
  const TexelLookup lookup;
  const Exposure exposure;
  const TexelGroups groups;
  const MeanReflectance reflectance;
  const SurfaceScene surface;
  const Sides sides;
  Pieces pieces;
  const Patches exit_patches;
  const std::vector<std::uint32_t> gathered_from;  // by exit
  const SampleTable directions;
  EntrySet entry_set;
  Exits exits;
  PointExits points;  // of exits that are no blocks
  ExitTiles tiles;
  Elements elements;
  FirstReflection first;
  std::unique_ptr<ElementLight> reflected;  // of kGathering
  std::vector<VirtualLight> virtual_lights;
  const ExitScene exit_scene;
  std::uint64_t ray_count = 0;
};

LightPaths::LightPaths(const trace::Tracer& tracer, const atlas::Atlas& atlas, const atlas::Texels& texels,
                       const LightPathOptions& options, Progress& progress)
    : impl_(std::make_unique<Impl>(tracer, atlas, texels, options, progress)) {}
LightPaths::~LightPaths() = default;
LightPaths::LightPaths(LightPaths&&) noexcept = default;

const Entries& LightPaths::entries() const { return impl_->entry_set.entries; }
const Exits& LightPaths::exits() const { return impl_->exits; }
const ExitTiles& LightPaths::tiles() const { return impl_->tiles; }
float LightPaths::spacing() const { return impl_->entry_set.spacing; }
std::uint64_t LightPaths::bytes() const {
  const Impl& i = *impl_;
  return (i.reflected ? i.reflected->bytes() : i.virtual_lights.size() * sizeof(VirtualLight)) +
         i.sides.size() * (std::uint64_t{i.sides.raysEach()} * sizeof(SideOfTexel) + 12);
}
std::uint64_t LightPaths::rays() const { return impl_->ray_count; }

void LightPaths::rows(std::size_t tile, std::span<float> out) const { impl_->rows(tile, out); }

std::vector<Vec3> LightPaths::nearShares(Progress& progress) const { return impl_->nearShares(progress); }

LightSet LightPaths::lights(std::uint32_t count, const LightPlaces& places, std::uint64_t seed,
                            Progress& progress) const {
  return findLights(impl_->tracer, impl_->boxes, count, places, seed, progress);
}

std::vector<float> LightPaths::entryIrradiance(std::span<const Light> lights, Progress& progress) const {
  LightSet white(lights.begin(), lights.end());
  for (Light& light : white) light.colour = Vec3(1.0f);
  const std::vector<Vec3> all = impl_->lightOnEntries(white, progress);
  std::vector<float> result;
  result.reserve(all.size());
  for (const Vec3& e : all) result.push_back(e.x);
  return result;
}

std::vector<Irradiance> LightPaths::irradiance(std::span<const Light> lights, LitBy by,
                                               std::span<const std::uint32_t> which, GatherRays rays,
                                               Progress& progress) const {
  return impl_->irradiance(lights, by, which, rays, progress);
}

}  // namespace relume::transport
