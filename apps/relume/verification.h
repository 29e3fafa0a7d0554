// SPDX-License-Identifier: MIT
// A baked lightmap against path-traced truth, at places all over the surfaces.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/core/progress.h"
#include "relume/scene/scene.h"

namespace relume::app {

struct VerifyOptions {
  std::string layer;             ///< name; "": the first lightmap
  std::uint32_t points = 2000;   ///< places, spread evenly over the baked area
  std::uint32_t samples = 1024;  ///< paths for each, in two independent halves
  std::uint64_t seed = 1;
};

/// Of luminance of the irradiance; errors in shares of the mean true one. All 0 where no light arrives.
struct Agreement {
  std::size_t points = 0;
  double mean_baked = 0, mean_true = 0;
  double bias = 0, bias_error = 0;  ///< (baked - true) / true, and its standard error
  double rmse = 0;                  ///< the truth's own noise taken off
  double rmse_error = 0;            ///< standard error of rmse
  double truth_noise = 0;           ///< RMS standard error of the truth at one place
};
struct ObjectAgreement : Agreement {
  std::string object;
};

struct Verification : Agreement {
  std::string layer;
  std::size_t skipped = 0;    ///< buried texels and places, places
                              ///< that are cut out by alpha or where two surfaces coincide
  double error_estimate = 0;  ///< what the bake says of its own error
  std::uint64_t paths = 0;
  struct Place {
    std::string object;
    Point position{0};
    double baked = 0, truth = 0, truth_error = 0;
  };
  std::vector<Place> worst;              ///< largest difference first, of those that noise does not explain
  std::vector<ObjectAgreement> objects;  ///< in the scene's order
  std::vector<double> differences;  ///< (baked - true) / mean true at each place, the truth's noise in it
};

/// `scene`: the baked file's, lit as it was when it was baked. Reads the layer as a viewer does (bilinear),
/// so what the texels' size costs counts. Throws Error kNoSuchLayer, kMismatch, kInterrupted.
Verification verifyLightmap(const scene::Scene& scene, const asset::Asset& asset,
                            const VerifyOptions& options, Progress& progress);

}  // namespace relume::app
