// SPDX-License-Identifier: MIT
#include "relume/bake/registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "day_layer.h"
#include "directional_layer.h"
#include "lightmap_layer.h"
#include "lightpath_layer.h"
#include "occlusion_layers.h"
#include "relume/basis/basis.h"
#include "relume/core/error.h"

namespace relume::bake {
namespace {

using Type = ParameterSpec::Type;

ParameterSpec distance(const char* help) { return {"distance", Type::kLength, "auto", {}, help}; }
const ParameterSpec kTau{"tau",
                         Type::kLength,
                         "auto",
                         {},
                         "metres in which the weight 1-exp(-L/tau) rises; auto: a quarter of distance"};
const ParameterSpec kShape{
    "shape",
    Type::kChoice,
    "exp",
    {"exp", "expcut", "linear", "sqrt"},
    "how the weight rises with distance; exp reaches 1 at the limit, expcut jumps there"};
const ParameterSpec kBent{"bent", Type::kFlag, "false", {}, "also store the bent normal"};
const ParameterSpec kCorrection{"correction",
                                Type::kChoice,
                                "none",
                                {"none", "stewart-langer", "jimenez"},
                                "brighten by interreflection from the surface's own albedo"};

const ParameterSpec kPart{"part", Type::kChoice, "total", {"total", "direct", "indirect"}, "which light"};
const ParameterSpec kBounces{
    "bounces", Type::kCount, "inf", {}, "reflections between a light and a texel; inf: all"};
const ParameterSpec kMaterials{
    "materials",
    Type::kChoice,
    "full",
    {"full", "lambert"},
    "lambert: diffuse reflection alone; full: glossy lobes too, with their energy"};

const ParameterSpec kPacking{"packing",
                             Type::kChoice,
                             "half",
                             {"half", "compact"},
                             "of directional receivers: half floats, or 8 bit beside a scale"};
const ParameterSpec kWindow{"window",
                            Type::kFlag,
                            "false",
                            {},
                            "sh and hbasis: fade high bands out where irradiance would be negative"};

const ParameterSpec kPaths{"paths",
                           Type::kCount,
                           "auto",
                           {},
                           "photon: how many are shot; auto: so many per texel as a quarter of its rays"};
const ParameterSpec kKernel{
    "kernel",
    Type::kChoice,
    "adaptive",
    {"box", "pyramid", "adaptive"},
    "photon: box: each texel for itself; pyramid: of kernelwidth; adaptive: as wide as it "
    "takes to hold 64 paths"};
const ParameterSpec kKernelWidth{
    "kernelwidth", Type::kLength, "1.5", {}, "photon: texels from rim to rim of a pyramid, up to 17"};

std::vector<LayerKind> makeRegistry() {
  return {
      {.name = "ao",
       .summary = "ambient occlusion: the cosine-weighted share of open directions",
       .emitters = "ambient",
       .transport = "visibility",
       .receivers = "texels, scalar",
       .codec = "none",
       .parameters = {distance("metres beyond which nothing occludes; inf: endless"), kBent, kCorrection},
       .prepare = prepareOcclusion,
       .visibility_alone = true},
      {.name = "obscurance",
       .summary = "obscurance: occlusion weighted by distance",
       .emitters = "ambient",
       .transport = "distance-weighted visibility",
       .receivers = "texels, scalar",
       .codec = "none",
       .parameters = {distance("metres at which the weight is 1 and rays end; inf: endless"), kTau, kShape,
                      kBent, kCorrection},
       .prepare = prepareObscurance},
      {.name = "spectral",
       .summary = "spectral obscurance: distance-weighted occlusion with the colour of near surfaces",
       .emitters = "ambient",
       .transport = "distance-weighted visibility, spectral",
       .receivers = "texels, RGB",
       .codec = "none",
       .parameters = {distance("metres that part near (coloured) from far (open) surfaces"), kTau, kShape,
                      kBent},
       .prepare = prepareSpectral},
      {.name = "lightmap",
       .summary = "irradiance from the scene's own lights, direct and reflected",
       .emitters = "the scene's lights, emissive surfaces, environment",
       .transport = "path-traced",
       .receivers = "texels, RGB irradiance or a directional basis",
       .codec = "none",
       .parameters =
           {{"solver",
             Type::kChoice,
             "gather",
             {"gather", "radiosity", "path", "photon"},
             "radiosity: light from patches; path: unbiased random walks, slow, to judge others by; photon: "
             "paths "
             "shot from lamps"},
            {"receiver",
             Type::kBasis,
             "irradiance",
             {},
             "what a texel holds, for normal maps and gloss: irradiance, sh2 to sh4, hbasis4, hbasis6, hl2, "
             "ahd, "
             "dominant, farcry, sg5 to sg9, cube, dice, directions:n"},
            kPacking,
            kWindow,
            kPaths,
            kKernel,
            kKernelWidth,
            kPart,
            kBounces,
            kMaterials,
            {"patch", Type::kCount, "4", {}, "radiosity: texels along a patch, 1 to 64"},
            {"formfactors",
             Type::kChoice,
             "sampled",
             {"sampled", "hemicube"},
             "radiosity: by rays from all over a patch, or by the view from its middle"},
            {"solution",
             Type::kChoice,
             "gathering",
             {"gathering", "progressive"},
             "radiosity: row by row, or shooting the patch with the most light left; both end alike"}},
       .prepare = prepareLightmap,
       .needs_light = true},
      {.name = "directional",
       .summary = "directional light maps: irradiance from each of a set of directions, for gloss",
       .emitters = "the scene's lights, emissive surfaces, environment",
       .transport = "path-traced, or light-traced",
       .receivers = "texels, a set of directions",
       .codec = "packed by direction, 8 bit",
       .parameters = {{"n", Type::kCount, "14", {}, "directions, 6 to 64"},
                      {"solver",
                       Type::kChoice,
                       "gather",
                       {"gather", "photon"},
                       "photon: paths shot from lamps, as published"},
                      {"scale",
                       Type::kLength,
                       "1",
                       {},
                       "texels of a map along a texel of the atlas that faces its direction"},
                      kPaths,
                      kKernel,
                      kKernelWidth,
                      kPart,
                      kBounces,
                      kMaterials},
       .prepare = prepareDirectional,
       .needs_light = true},
      {.name = "lightgroups",
       .summary = "irradiance from each group of the scene's lights: to be dimmed, coloured, switched",
       .emitters = "light groups",
       .transport = "path-traced",
       .receivers = "texels, RGB irradiance",
       .codec = "none",
       .parameters = {kPart,
                      kBounces,
                      kMaterials,
                      {"solver",
                       Type::kChoice,
                       "gather",
                       {"gather", "path"},
                       "path: unbiased random walks, slow, to judge others by"}},
       .prepare = prepareLightGroups,
       .needs_light = true},
      {.name = "lightpath",
       .summary = "light path maps: indirect light of any lamps, to be multiplied at run time",
       .emitters = "irradiance on entries",
       .transport = "radiosity of elements, gathered",
       .receivers = "blocks of texels, RGB irradiance",
       .codec = "low rank by tiles and clusters",
       .parameters =
           {{"count", Type::kCount, "auto", {}, "entries of light; auto: 512, 1024, 2048, 4096 by quality"},
            {"entries",
             Type::kChoice,
             "patches",
             {"patches", "shot"},
             "patches: of all surfaces; shot: points that rays from where lamps may be meet, for comparison"},
            {"samples", Type::kCount, "auto", {}, "points at which lamps light it, for each entry; auto: 16"},
            {"modes",
             Type::kCount,
             "auto",
             {},
             "entries of a patch, on average: its mean light and modes of how it varies; auto: 2"},
            {"places", Type::kCount, "128", {}, "entries=shot: places of lamps that rays are shot from"},
            {"aim",
             Type::kChoice,
             "all",
             {"all", "down", "up"},
             "entries=shot: which way lamps shine from there; down and up cosine-weighted"},
            {"exits",
             Type::kChoice,
             "texels",
             {"texels", "vertices", "probes"},
             "where light leaves: blocks of texels, vertices, or a grid of probes with light from all sides"},
            {"size", Type::kCount, "256", {}, "exits=texels: exits along the side of a page, at most"},
            {"rays", Type::kCount, "auto", {}, "of an exit; auto: 256, 1024, 2048, 4096 by quality"},
            {"spacing", Type::kLength, "auto", {}, "exits=probes: metres between probes"},
            {"transfer",
             Type::kChoice,
             "gather",
             {"gather", "walks"},
             "walks: random light paths from entries, as published: slow and noisy, for comparison"},
            {"walks", Type::kCount, "16", {}, "transfer=walks: paths from an entry"},
            {"short",
             Type::kChoice,
             "keep",
             {"keep", "obscurance"},
             "light whose last way is short: in the transfer, or made from direct light and obscurance at "
             "texels"},
            {"near", Type::kLength, "auto", {}, "short=obscurance: metres below which a way is short"},
            {"codec",
             Type::kChoice,
             "tiles",
             {"tiles", "cpca"},
             "tiles: small and close; cpca: clustered principal components, for comparison"},
            {"error",
             Type::kShare,
             "auto",
             {},
             "what the encoding may add, a share of the light; auto: 0.05, 0.02, 0.01, 0.005 by quality"},
            {"dark",
             Type::kShare,
             "auto",
             {},
             "the same of single exits, for dark ones, 95th percentile; auto: 15 times error"},
            {"clusters", Type::kCount, "auto", {}, "clusters of entries"},
            {"components", Type::kCount, "auto", {}, "of every block, whatever the error"},
            {"bits", Type::kChoice, "8", {"8", "16"}, "of a stored number"},
            kMaterials},
       .prepare_whole = prepareLightPaths},
      {.name = "day",
       .summary =
           "reflected light and skylight through a day (--day DAY.json), at keyframes that the eye needs",
       .emitters = "the sun, the sky and lamps at points in time",
       .transport = "rays traced once, shared by all times",
       .receivers = "texels, or pixels of a camera; RGB irradiance",
       .codec = "keyframes, principal components, quantized",
       .parameters =
           {{"receivers",
             Type::kChoice,
             "atlas",
             {"atlas", "cube", "image"},
             "who receives light: all texels; the faces of a cube about a camera that turns; the pixels of "
             "one "
             "that stands still"},
            {"camera", Type::kCount, "0", {}, "receivers=cube and image: which of the scene's cameras"},
            {"width", Type::kCount, "auto", {}, "receivers=cube and image: pixels; auto: 512 and 800"},
            {"height", Type::kCount, "600", {}, "receivers=image: pixels"},
            {"rays", Type::kCount, "auto", {}, "of a texel; auto: 64, 256, 512, 1024 by quality"},
            {"every",
             Type::kLength,
             "auto",
             {},
             "minutes between frames, all of which are kept; auto: keyframes are chosen"},
            {"shortest", Type::kLength, "1", {}, "minutes below which an interval is not halved"},
            {"metric",
             Type::kChoice,
             "yee",
             {"yee", "flip"},
             "what tells whether an interpolated frame is visibly wrong"},
            {"unseen",
             Type::kShare,
             "auto",
             {},
             "share of the pixels that may differ while pictures pass for equal; auto: 100 in 800 x 600"},
            {"error",
             Type::kChoice,
             "visible",
             {"visible", "none"},
             "how many components are kept: so many that no pixel is visibly wrong; none: all"},
            {"components", Type::kCount, "auto", {}, "so many instead"},
            kMaterials},
       .prepare_whole = prepareDay},
  };
}

asset::Parameter parseValue(const ParameterSpec& spec, const std::string& text, const std::string& subject) {
  switch (spec.type) {
    case Type::kFlag:
      if (text == "true" || text == "yes" || text == "1") return true;
      if (text == "false" || text == "no" || text == "0") return false;
      throw Error(ErrorCode::kUsage, subject, fmt::format("'{}' is not true or false", text));
    case Type::kChoice:
      if (std::find(spec.choices.begin(), spec.choices.end(), text) != spec.choices.end()) return text;
      throw Error(ErrorCode::kUsage, subject, fmt::format("'{}' is not known", text),
                  fmt::format("use one of {}", fmt::join(spec.choices, ", ")));
    case Type::kBasis:
      try {
        return basis::makeBasis(text)->name();
      } catch (const Error& e) {
        throw Error(ErrorCode::kUsage, subject, fmt::format("'{}' {}", text, e.problem()), e.remedy());
      }
    case Type::kLength:
    case Type::kCount:
    case Type::kShare:
      break;
  }
  double value = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = ec == std::errc() && end == text.data() + text.size();
  if (spec.type == Type::kCount) {
    if (!number || !(value >= 0) || (value < kInfinity && value != std::floor(value)))
      throw Error(ErrorCode::kUsage, subject, fmt::format("'{}' is not a count", text),
                  "write a whole number, or inf");
    return value;
  }
  if (spec.type == Type::kShare) {
    if (!number || !(value > 0) || !(value < 1))
      throw Error(ErrorCode::kUsage, subject, fmt::format("'{}' is not a share above 0 and below 1", text),
                  "write for example 0.02");
    return value;
  }
  if (!number || !(value > 0))
    throw Error(ErrorCode::kUsage, subject, fmt::format("'{}' is not a length above zero", text),
                "write metres, for example 2.5, or inf");
  return value;
}

}  // namespace

bool LayerKind::has(std::string_view parameter) const {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const ParameterSpec& p) { return p.name == parameter; });
}

const std::vector<LayerKind>& registry() {
  static const std::vector<LayerKind> rows = makeRegistry();
  return rows;
}

const LayerKind& find(std::string_view kind) {
  std::vector<std::string> names;
  for (const LayerKind& row : registry()) {
    if (row.name == kind) return row;
    names.push_back(row.name);
  }
  throw Error(ErrorCode::kUsage, "--layer " + std::string(kind), "no such layer",
              fmt::format("there are {}", fmt::join(names, ", ")));
}

float autoDistance(float scene_diagonal) {
  constexpr float kSmallest = 2.0f, kLargest = 400.0f;  // metres; outside, the unit is hardly the metre
  return scene_diagonal < kSmallest || scene_diagonal > kLargest ? scene_diagonal / 8
                                                                 : std::min(4.0f, scene_diagonal / 4);
}

Parameters resolve(const LayerKind& kind, const LayerSpec& spec, float scene_diagonal) {
  for (const auto& [key, value] : spec.values) {
    if (!kind.has(key)) {
      std::vector<std::string> names;
      for (const ParameterSpec& p : kind.parameters) names.push_back(p.name);
      throw Error(ErrorCode::kUsage, "--layer " + kind.name, fmt::format("has no parameter '{}'", key),
                  fmt::format("it has {}", fmt::join(names, ", ")));
    }
  }
  Parameters result;
  for (const ParameterSpec& p : kind.parameters) {
    const auto given = spec.values.find(p.name);
    const std::string text = given == spec.values.end() ? p.default_value : given->second;
    if (p.default_value == "auto" && text == "auto") continue;
    result[p.name] = parseValue(p, text, fmt::format("--layer {}:{}", kind.name, p.name));
  }
  // Automatic lengths, in the order in which they depend on one another.
  if (kind.has("distance")) result.emplace("distance", static_cast<double>(autoDistance(scene_diagonal)));
  constexpr double kNearShare = 0.125;  // half a metre in scenes of human scale
  if (kind.has("spacing")) {
    constexpr double kSpacingShare = 0.25;  // a metre in scenes of human scale
    result.emplace("spacing", kSpacingShare * static_cast<double>(autoDistance(scene_diagonal)));
  }
  if (kind.has("near")) {
    result.emplace("near", kNearShare * static_cast<double>(autoDistance(scene_diagonal)));
    if (!(std::get<double>(result["near"]) < kInfinity))
      throw Error(ErrorCode::kUsage, "--layer " + kind.name, "near=inf leaves nothing in the transfer",
                  "use an obscurance layer alone for that");
  }
  if (kind.has("tau")) {
    const double limit = std::get<double>(result["distance"]);
    result.emplace("tau",
                   limit < kInfinity ? limit / 4 : static_cast<double>(autoDistance(scene_diagonal)) / 4);
    const std::string& shape = std::get<std::string>(result["shape"]);
    if (!(limit < kInfinity) && (shape == "linear" || shape == "sqrt"))
      throw Error(ErrorCode::kUsage, "--layer " + kind.name,
                  fmt::format("shape={} needs a finite distance", shape),
                  "give for example distance=4, or use shape=exp");
  }
  if (kind.has("patch")) {
    constexpr double kMostTexels = 64;
    const double patch = std::get<double>(result["patch"]);
    if (!(patch >= 1 && patch <= kMostTexels))
      throw Error(ErrorCode::kUsage, "--layer " + kind.name,
                  fmt::format("patch={} is no size of a patch", patch),
                  fmt::format("use 1 to {} texels, for example patch=4", kMostTexels));
  }
  return result;
}

}  // namespace relume::bake
