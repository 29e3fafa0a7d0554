// SPDX-License-Identifier: MIT
// Light path maps: how light that falls on a few entries of a scene's surfaces arrives, after any number of
// reflections, at its exits. For irradiance E_e on entry e the indirect irradiance at exit x is
//   I_x = sum_e T_xe E_e,
// by colour channel; light that arrives at x straight from a light is not in it. Based on:
//   [USKP09] Umenhoffer et al. Multi-scale precomputed radiance transfer. Sections 5 to 7 and 10.
// Differs from it: light enters at patches of surface and not at points, so that T has no spikes and no path
// is too short to count; a patch has entries for its mean light and for modes of how it varies, taken from
// irradiance at fixed places; T comes from radiosity over small elements
// and rays that gather at the exits instead of random walks from the entries. Measured:
// docs/light-paths.md. Entries may also be points that are shot from where lights may be ([USKP09] 7.1): then
// T holds 1 / d(e), d their density, and light on a point counts for the small piece of surface about it.
// Conventions: docs/concept.md. Light leaves surfaces as from ideal diffuse reflectors, on both sides, as in
// lightmap.h. Limits: static surfaces only.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "relume/atlas/atlas.h"
#include "relume/atlas/texels.h"
#include "relume/core/light.h"
#include "relume/core/progress.h"
#include "relume/trace/tracer.h"
#include "relume/transport/light_search.h"
#include "relume/transport/reference.h"

namespace relume::transport {

enum class EntryPlacement : std::uint8_t {
  kPatches,  ///< parts of all surfaces
  kShot,     ///< points where rays from test points end ([USKP09] 7.1)
};

enum class TransferBy : std::uint8_t {
  kGathering,  ///< rays from the exits, radiosity of elements
  kWalks,      ///< random walks from the entries, connected to all exits ([USKP09] 7.2): slow, for comparison
};

enum class Receivers : std::uint8_t {
  kTexels,    ///< exits are blocks of texels
  kVertices,  ///< of static meshes
  kProbes,    ///< a grid in space; irradiance on all sides as spherical harmonics of 9 coefficients
};

struct LightPathOptions {
  std::uint32_t entries = 1024;  ///< about so many; a few more where walls divide patches
  EntryPlacement placement = EntryPlacement::kPatches;
  /// Entries that a patch has on average: its mean light, and modes about it (principal components of the
  /// light of lamps). More of them make patches larger. kShot: always 1.
  std::uint32_t patch_entries = 2;
  /// For each entry, places where irradiance is taken: a patch has patch_entries times so many. kShot: 1.
  std::uint32_t entry_samples = 16;
  std::uint32_t test_points = 128;  ///< of kShot, spread over the space where lights may be
  /// Of kShot: about which way lights shine, cosine-weighted; none: all around.
  std::optional<Direction> aim;
  std::uint32_t elements = 8192;     ///< of radiosity, about so many
  std::uint32_t element_rays = 512;  ///< of an element, at least
  TransferBy transfer = TransferBy::kGathering;
  std::uint32_t walks = 16;     ///< of an entry, of kWalks
  std::uint64_t walk_seed = 1;  ///< other walks from the same entries
  /// Metres: light whose last way to an exit is shorter is not in T ([USKP09] 7.2); nearShares tells of it.
  float near = 0.0f;
  Receivers receivers = Receivers::kTexels;
  float probe_spacing = 1.0f;      ///< metres, of kProbes
  std::uint32_t exit_side = 4;     ///< texels along an exit, which is a block of one chart; 1 to 64
  std::uint32_t exit_rays = 1024;  ///< of an exit, rounded up to 2^k for each of its texels
  std::uint32_t tile_exits = 128;  ///< exits of a tile, on average, without overlap
  float tile_overlap = 0.3f;       ///< exits that a tile shares with its neighbours, as a share of its own
  Materials materials = Materials::kFull;
  std::vector<Box3> light_boxes;  ///< where lights may be; none: rooms, or all free space if there are none
  std::uint64_t seed = 1;
};

/// A place where irradiance is taken.
struct EntrySample {
  Point position{0};       ///< on the surface, world
  Normal normal{0, 0, 1};  ///< shading normal on the lit side, unit
};

/// Light enters at patches. A patch has as many entries as it takes to tell how its light varies: first its
/// mean, then modes, which are below 0 as often as above. Every one is a sum over the patch's samples of mix
/// times the irradiance there.
struct Entries {
  std::uint32_t samples_each = 1;    ///< of a patch
  std::vector<EntrySample> samples;  ///< shape: [patches][samples_each]; equal shares of a patch's light
  std::vector<std::uint32_t> first;  ///< by patch, and one more: its entries
  std::vector<float> mix;            ///< shape: by patch [samples_each][entries of the patch]
  std::vector<float> area;     ///< m^2, by entry: its share of the patch's; of kShot 1 / d(e), in T already
  std::vector<Point> centre;   ///< by entry: mean position, not always on the surface
  std::vector<Normal> normal;  ///< by entry: mean normal, unit
  std::size_t size() const { return first.empty() ? 0 : first.back(); }
  std::size_t patches() const { return first.empty() ? 0 : first.size() - 1; }
  /// One entry for each of so many patches, the mean over its samples.
  void setMeans(std::size_t count) {
    first.resize(count + 1);
    std::iota(first.begin(), first.end(), 0u);
    mix.assign(count * samples_each, 1.0f / static_cast<float>(samples_each));
  }
};

/// A block of texels of one chart that share a value, a vertex or a probe.
struct Exit {
  std::uint32_t chart = 0, page = 0;
  std::uint32_t x = 0, y = 0;  ///< of the block in its page, in blocks
  Point position{0};           ///< in the middle, on the surface
  Normal normal{0, 0, 1};      ///< a probe has none
  float area = 0;              ///< m^2, of what can be seen; of a vertex a third of its triangles
  bool filled = false;         ///< none of it can be seen; it has the light of an exit beside it
};

/// Which vertices a texel lies between, and their weights.
struct TexelVertices {
  std::array<std::uint32_t, 3> exit{};
  Vec3 weight{1, 0, 0};  ///< sum 1
};

/// Places origin + spacing (i, j, k), i < count.x and so on.
struct ProbeGrid {
  Point origin{0};
  float spacing = 1;  ///< metres
  UVec3 count{0};
  /// The exit at (k count.y + j) count.x + i; scene::kNone where bodies are.
  std::vector<std::uint32_t> exit;
};

struct Exits {
  std::uint32_t side = 0;  ///< texels along a block; 0: exits are no blocks, and the next two are empty
  std::vector<Exit> all;   ///< by page, row and column of blocks
  /// Rows of the transfer that an exit has: 1, of a probe 9: irradiance coefficients by basis::sh9, so that
  /// irradiance along n is the sum of row k times sh9(n)[k].
  std::uint32_t rows_each = 1;
  std::vector<TexelVertices> vertices_of_texel;  ///< of kVertices, by index into Texels::points
  ProbeGrid grid;                                ///< of kProbes
  /// By index into Texels::points. Two exits can share a block of a chart, where it goes round an edge.
  std::vector<std::uint32_t> of_texel;
  /// By index into Texels::points: inside other geometry, so its own irradiance is no part of its exit's.
  std::vector<std::uint8_t> buried;
  std::size_t size() const { return all.size(); }
};

/// Groups of exits that lie together in space and face alike, whatever their charts; they overlap, and blend
/// weights of an exit sum to 1 over its tiles. As codec::RowTiles.
struct ExitTiles {
  std::vector<std::uint32_t> first;  ///< shape: [tiles + 1], into row and blend
  std::vector<std::uint32_t> row;    ///< exits, increasing within a tile
  std::vector<float> blend;          ///< in (0, 1]
  std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
};

/// What lights an exit in LightPaths::irradiance.
enum class LitBy : std::uint8_t {
  kEntries,   ///< irradiance taken at the samples of entries, as at run time
  kElements,  ///< irradiance on each small piece of surface by rays of its own: no entries
};

/// Which rays gather in LightPaths::irradiance.
enum class GatherRays : std::uint8_t {
  kSame,   ///< those of rows()
  kOther,  ///< as many others: the difference tells of their noise
};

class LightPaths {
 public:
  /// Places entries and exits and solves what elements send out. Keeps references. Bits do not depend on the
  /// number of threads. Throws Error kUsage for options that make no sense, kEmptyScene where there are no
  /// texels or no room for the test points of kShot, kInterrupted.
  LightPaths(const trace::Tracer& tracer, const atlas::Atlas& atlas, const atlas::Texels& texels,
             const LightPathOptions& options, Progress& progress);
  ~LightPaths();
  LightPaths(LightPaths&&) noexcept;

  const Entries& entries() const;
  const Exits& exits() const;
  const ExitTiles& tiles() const;
  /// Metres: side of a square of an entry's mean area, where lights shine. Lights that keep so far away from
  /// surfaces are what entries are made for.
  float spacing() const;
  std::uint64_t bytes() const;  ///< of memory held, about
  std::uint64_t rays() const;   ///< traced while solving

  /// The transfer to the exits of a tile, not blended. out: shape [exits of tile][rows_each][3 channels]
  /// [entries].
  /// From many threads at once; the same bits every time.
  void rows(std::size_t tile, std::span<float> out) const;

  /// By index into Texels::points, RGB: the cosine-weighted share of directions in which a surface is nearer
  /// than options.near, times the reflectance of that surface: what T leaves out of light that is the same
  /// all around. By as many rays of each texel as an exit has, at most 256; seen from what an exit sees.
  std::vector<Vec3> nearShares(Progress& progress) const;

  /// White point and spot lights of intensity 1 in free space, in `light_boxes` where there are any;
  /// otherwise in rooms, or in the open where there are no rooms. Fewer than `count`, perhaps none, where
  /// such places are hard to find.
  LightSet lights(std::uint32_t count, const LightPlaces& places, std::uint64_t seed,
                  Progress& progress) const;
  /// Irradiance on entries with shadow rays, of lights as if their colour were 1. Shape: [lights][entries].
  std::vector<float> entryIrradiance(std::span<const Light> lights, Progress& progress) const;

  /// Indirect irradiance at exits, colours of lights included, by the same gather rays as rows(): what parts
  /// the error of entries from that of all else. Shape: [lights][exits * rows_each].
  std::vector<Irradiance> irradiance(std::span<const Light> lights, LitBy by, Progress& progress) const {
    std::vector<std::uint32_t> all(exits().size());
    std::iota(all.begin(), all.end(), 0u);
    return irradiance(lights, by, all, GatherRays::kSame, progress);
  }
  /// The same at some exits: shape [lights][which.size() * rows_each].
  std::vector<Irradiance> irradiance(std::span<const Light> lights, LitBy by,
                                     std::span<const std::uint32_t> which, GatherRays rays,
                                     Progress& progress) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relume::transport
