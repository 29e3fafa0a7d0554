// SPDX-License-Identifier: MIT
// Golden images: a picture is compared with a stored one by FLIP, so that a change of what one sees fails and
// a change of the last bits does not.
//
//   EXPECT_TRUE(golden::matches(picture, folder / "hall-lit.png", {.mean = 0.005, .p99 = 0.05}));
//
// On failure the picture, the reference, the FLIP map and a page with them side by side lie in a folder of
// their own under RELUME_TEST_OUT (without it: test-out in the working folder). RELUME_UPDATE_GOLDEN=1 stores
// the picture as the new reference instead; look at it before it is committed.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "relume/core/error.h"
#include "relume/core/file.h"
#include "relume/image/colour.h"
#include "relume/image/io.h"
#include "relume/image/metrics.h"

namespace relume::golden {

/// FLIP, from 0 (equal) to 1. One just notices a mean of a few hundredths.
struct Tolerance {
  double mean = 0.005;  ///< over pixels
  double p99 = 0.05;    ///< the 99th percentile: a difference in a small place
};

inline bool updating() {
  const char* value = std::getenv("RELUME_UPDATE_GOLDEN");
  return value && std::string(value) == "1";
}

inline std::filesystem::path outputFolder() {
  const char* value = std::getenv("RELUME_TEST_OUT");
  return value && *value ? std::filesystem::path(value) : std::filesystem::current_path() / "test-out";
}

namespace detail {

/// What is left of a picture in a PNG file. Without this the rounding alone counts as a FLIP of up to 0.015
/// in flat colours.
inline image::Image roundedTo8Bits(image::Image picture) {
  for (float& value : picture.data)
    value =
        image::srgbToLinear(std::round(image::linearToSrgb(std::clamp(value, 0.0f, 1.0f)) * 255.0f) / 255.0f);
  return picture;
}

inline std::string failurePage(const std::string& title, const std::string& verdict, bool compared) {
  const auto figure = [](const char* file, const char* caption) {
    return std::string("<figure><img src=\"") + file + "\"><figcaption>" + caption +
           "</figcaption></figure>\n";
  };
  std::string page =
      "<!DOCTYPE html>\n<meta charset=\"utf-8\">\n<title>" + title +
      "</title>\n<style>body{font:16px sans-serif;margin:2em}figure{display:inline-block;margin:0 1em 1em 0}"
      "img{width:30vw;image-rendering:pixelated;display:block}</style>\n<h1>" +
      title + "</h1>\n<p>" + verdict + "</p>\n" + figure("picture.png", "picture");
  if (compared) page += figure("reference.png", "reference") + figure("flip.png", "FLIP, dark 0 to bright 1");
  return page;
}

inline testing::AssertionResult fail(const image::Image& picture, const std::filesystem::path& reference_file,
                                     const std::string& problem, const image::Image* reference,
                                     const image::Difference* difference) {
  const std::filesystem::path folder = outputFolder() / reference_file.stem();
  std::filesystem::create_directories(folder);
  image::writeImage(folder / "picture.png", picture);
  image::writeExr(folder / "picture.exr", picture);
  if (reference) image::writeImage(folder / "reference.png", *reference);
  if (difference) image::writeImage(folder / "flip.png", image::falseColour(difference->map, 0.0f, 1.0f));
  const std::filesystem::path page = folder / "index.html";
  writeFileAtomically(page,
                      failurePage(reference_file.filename().string(), problem, reference && difference));
  return testing::AssertionFailure() << reference_file.filename().string() << ": " << problem << "; see "
                                     << page.string() << "; RELUME_UPDATE_GOLDEN=1 accepts the picture";
}

}  // namespace detail

/// `picture`: linear, 3 channels; values are compared as a display shows them, clamped to [0, 1].
inline testing::AssertionResult matches(const image::Image& picture,
                                        const std::filesystem::path& reference_file,
                                        const Tolerance& tolerance) {
  if (updating()) {
    std::filesystem::create_directories(reference_file.parent_path());
    image::writeImage(reference_file, picture);
    return testing::AssertionSuccess() << reference_file.string() << " was stored";
  }
  if (!std::filesystem::exists(reference_file))
    return detail::fail(picture, reference_file, "there is no reference", nullptr, nullptr);
  const image::Image reference = image::readImage(reference_file);
  if (reference.width != picture.width || reference.height != picture.height) {
    std::ostringstream problem;
    problem << "the picture has " << picture.width << " x " << picture.height << " pixels, the reference "
            << reference.width << " x " << reference.height;
    return detail::fail(picture, reference_file, problem.str(), &reference, nullptr);
  }
  const bool rounded = reference_file.extension() == ".png";
  const image::Difference difference =
      image::flip(rounded ? detail::roundedTo8Bits(picture) : picture, reference);
  if (difference.mean <= tolerance.mean && difference.p99 <= tolerance.p99)
    return testing::AssertionSuccess();
  std::ostringstream problem;
  problem << "FLIP mean " << difference.mean << " (allowed " << tolerance.mean << "), 99th percentile "
          << difference.p99 << " (allowed " << tolerance.p99 << ")";
  return detail::fail(picture, reference_file, problem.str(), &reference, &difference);
}

}  // namespace relume::golden
