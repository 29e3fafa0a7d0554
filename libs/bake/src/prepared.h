// SPDX-License-Identifier: MIT
// The stages before any ray, shared by the bake and its preflight.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/bake/bake.h"
#include "relume/bake/registry.h"
#include "stopwatch.h"

namespace relume::bake {

struct PreparedLayer {
  std::string name;  ///< "ao"; a second one of a kind is "ao.2"
  const LayerKind* kind = nullptr;
  Parameters parameters;
};

struct Prepared {
  scene::Scene scene;
  atlas::Atlas atlas;
  atlas::Texels texels;
  bool materials = true;  ///< the texels know their albedo and emission
  std::unique_ptr<trace::Tracer> tracer;
  Digest structure;
  QualitySettings quality;
  std::vector<PreparedLayer> layers;
};

/// Imports, checks, makes the atlas, its texels and the acceleration structure. Throws as `bake` does.
/// On the heap: the tracer refers to the scene.
std::unique_ptr<Prepared> prepare(const scene::gltf::Document& document, const BakeOptions& options,
                                  Statistics& statistics, Stopwatch& stopwatch, Warnings& warnings,
                                  Progress& progress);

/// The texels as the file keeps them, all valid.
asset::AtlasTable tableOf(const Prepared& prepared);

/// Peak memory that the rest of the bake is expected to need, bytes, beyond what is in use now.
std::uint64_t forecastBytes(const Prepared& prepared);

/// Throws Error kOutOfMemory when this process uses more than `limit` bytes (0: no limit).
void obeyMemoryLimit(std::uint64_t limit);

}  // namespace relume::bake
