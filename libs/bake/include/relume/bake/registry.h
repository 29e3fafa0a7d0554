// SPDX-License-Identifier: MIT
// The registry of layers. A layer is a row: emitters x transport x receivers x codec, its parameters, and how
// its texels are computed. A new technique is a new row.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/atlas/texels.h"
#include "relume/bake/layer_spec.h"
#include "relume/bake/quality.h"
#include "relume/core/day.h"
#include "relume/core/hash.h"
#include "relume/core/progress.h"
#include "relume/trace/tracer.h"

namespace relume::bake {

struct ParameterSpec {
  enum class Type : std::uint8_t { kLength, kChoice, kFlag, kCount, kShare, kBasis };
  std::string name;
  Type type = Type::kLength;
  std::string default_value;  ///< as a person would write it; "auto" for a length chosen from the scene's
                              ///< size, or for a count or share that follows the quality
  std::vector<std::string> choices;  ///< kChoice; kBasis takes what basis::makeBasis knows
  std::string help;                  ///< one line, with the unit
};

/// The day that a layer of kind `day` is lit by.
struct DayPlan {
  Day day;
  std::string text = "{}";  ///< the same as JSON, which the file keeps (docs/command-line.md, DAY.json)
};

/// What a row may use to compute its texels.
struct LayerContext {
  const trace::Tracer& tracer;
  const atlas::Atlas& atlas;
  const atlas::Texels& texels;
  const asset::AtlasTable& table;  ///< the texels as the file keeps them
  QualitySettings quality;
  std::uint64_t seed = 1;
  DayPlan day = {};
};

/// A computation in which every texel stands alone: its row of floats depends on nothing farther away than
/// `reach`. That is what makes it resumable, and what lets a re-bake touch only texels near a change.
struct TexelSolver {
  int row = 0;                     ///< floats per texel
  float reach = kInfinity;         ///< metres
  Digest key;                      ///< of every setting that the rows depend on besides the scene
  std::uint32_t most_rays = 4096;  ///< for one texel; tells how much work is at stake between two saves
  /// Fills rows, shape [which][row], of the texels (indices of Texels::points) in `which`; returns rays
  /// spent.
  std::function<std::uint64_t(std::span<const std::uint32_t> which, std::span<float> rows, Progress&)> solve;
};

/// Planes over the points of Texels (not yet scattered to pages).
struct PointPlane {
  std::string name;
  int channels = 1;
  bool unit_interval = false;  ///< clamp to [0, 1] after smoothing and stitching
  bool direction = false;      ///< normalise after smoothing and stitching
  bool unorm8 = false;         ///< clamp to [lo, hi] after stitching, and store in 8 bit
  float lo = 0, hi = 1;
  std::vector<float> values;  ///< shape [points][channels]
};
struct PointLayer {
  std::vector<PointPlane> planes;
  std::vector<float> error;          ///< standard error per point
  std::vector<std::uint8_t> valid;   ///< 0: buried in geometry
  std::vector<float> back_share;     ///< share of rays that met back faces; empty: not known
  std::vector<asset::Table> tables;  ///< what the layer keeps besides
};

struct LayerJob {
  TexelSolver solver;
  std::function<PointLayer(std::span<const float> rows)> finish;  ///< rows of all points
};

/// A layer that is no rows of texels, solved whole.
struct WholeLayer {
  /// Planes, tables, samples and error_estimate; parameters that were measured, beside those asked for.
  asset::Layer layer;
  std::uint64_t rays = 0;  ///< spent
};
struct WholeJob {
  Digest key;  ///< of every setting that the layer depends on besides the scene's surfaces
  std::function<WholeLayer(Progress&)> solve;
  std::function<double(Progress&)> forecast;  ///< seconds that solve() will take, about, from a pilot
  /// Of what the layer stands for, as 32-bit floats.
  std::function<std::uint64_t(const asset::Layer&)> raw_bytes;
  /// What the layer does not hold to of what was asked, also where it comes from the cache; empty: it does.
  std::function<Warnings(const asset::Layer&)> warnings = {};
};

struct LayerKind {
  std::string name;
  std::string summary;
  std::string emitters, transport, receivers, codec;
  std::vector<ParameterSpec> parameters;
  // One of the two.
  LayerJob (*prepare)(const LayerContext&, const Parameters&) = nullptr;
  WholeJob (*prepare_whole)(const LayerContext&, const Parameters&) = nullptr;
  bool needs_light = false;       ///< of the scene's own lights and environment
  bool visibility_alone = false;  ///< what surfaces are made of does not matter, but to a correction

  bool has(std::string_view parameter) const;
};

const std::vector<LayerKind>& registry();
/// Throws Error kUsage listing the layers there are.
const LayerKind& find(std::string_view kind);

/// Fills in defaults and checks names, types and ranges. `scene_diagonal`, metres, is what "auto" lengths
/// come from. Throws Error kUsage naming the parameter and what it may be.
Parameters resolve(const LayerKind& kind, const LayerSpec& spec, float scene_diagonal);

/// The distance limit that "auto" stands for: 4 m in scenes of human scale, a share of the size in tiny or
/// huge ones (where the file's unit is hardly the metre).
float autoDistance(float scene_diagonal);

}  // namespace relume::bake
