// SPDX-License-Identifier: MIT
// How different two images are. All take linear RGB (or grey) images of equal size and throw Error kMismatch
// otherwise, and kInvalidValue for a pixel that is not finite. An alpha channel counts for nothing.
#pragma once
#include "relume/image/image.h"

namespace relume::image {

struct Difference {
  double mean = 0;  ///< the metric's own mean (unit: see each metric)
  double p95 = 0, p99 = 0, max = 0;
  Image map;  ///< per pixel, one channel
};

/// Root mean square over channels and pixels; relative = rmse / rms of the reference. `mask`, one channel,
/// selects pixels > 0.5.
struct Rmse {
  double rmse = 0, relative = 0, bias = 0;  ///< bias: mean(test - reference) / mean(reference)
  double p99 = 0, max = 0;                  ///< absolute error per pixel
  Image map;                                ///< absolute error per pixel, mean over channels
};
Rmse rmse(const Image& test, const Image& reference, const Image* mask = nullptr);

/// LDR-FLIP in [0, 1] (Andersson et al., FLIP: A Difference Evaluator for Alternating Images, HPG 2020), of
/// the two images as shown on an sRGB display. 67 pixels per degree is the paper's viewing distance (0.7 m,
/// 0.7 m wide 4k monitor).
Difference flip(const Image& test, const Image& reference, double pixels_per_degree = 67.0);

/// Yee's perceptual metric (Yee, Pattanaik, Greenberg 2001; Yee, Newman 2004, as in perceptualdiff): a pixel
/// is visible when its luminance or colour difference exceeds the threshold raised by adaptation, contrast
/// sensitivity and masking.
struct YeeOptions {
  double field_of_view_deg = 45.0;
  double luminance_white = 100.0;  ///< cd m^-2 of a white pixel
  double colour_factor = 1.0;
};
struct Yee {
  std::size_t visible_pixels = 0;
  Image map;  ///< 1 where the difference is visible
};
Yee yee(const Image& test, const Image& reference, const YeeOptions& options = {});

}  // namespace relume::image
