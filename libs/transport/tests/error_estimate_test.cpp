// SPDX-License-Identifier: MIT
// The reported standard error against the true one: the root mean square over 256 texels at one place (its
// own accuracy is 5 %).
#include <gtest/gtest.h>

#include <cmath>

#include "made_scenes.h"
#include "relume/core/progress.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

using Shape = DistanceWeight::Shape;

struct Place {
  const char* name;
  scene::Scene scene;
  Point p;
  float texel;  // metres
};

std::vector<Place> places() {
  std::vector<Place> result;
  for (const auto& [name, d, h, texel] : {std::tuple{"wall", 1.0f, 1.0f, 0.0f},
                                          {"high wall", 0.5f, 2.0f, 0.0f},
                                          {"high wall, wide texel", 0.5f, 2.0f, 0.3f}}) {
    scene::Mesh mesh;
    made::addQuad(mesh, {d, -2000, 0}, {0, 0, h}, {0, 4000, 0});
    result.push_back({name, made::sceneOf(std::move(mesh)), {}, texel});
  }
  scene::Mesh ball;
  made::addSphere(ball, {0.7f, 0, 1.2f}, 0.5f, 64, 128);
  result.push_back({"ball", made::sceneOf(std::move(ball)), {}, 0.0f});
  result.push_back({"room, corner", made::room(), {-1.5f, -0.5f, 0}, 0.02f});
  result.push_back({"room", made::room(), {0.2f, 0.5f, 0}, 0.1f});
  result.push_back({"temple", made::temple(8000), {0.3f, 0.2f, 0}, 0.05f});
  return result;
}

struct Errors {
  double truth, reported;
};

// Over 16 seeds of the 16 sequences of a block.
Errors errorsAt(const trace::Tracer& tracer, const Place& place, OcclusionOptions options, double expected) {
  atlas::Texels texels = made::repeatedPoint(16, place.p);
  for (atlas::SurfacePoint& p : texels.points) p.dp_dx = {place.texel, 0, 0}, p.dp_dy = {0, place.texel, 0};
  SilentProgress silent;
  double squares = 0, reported = 0;
  for (options.seed = 1; options.seed <= 16; ++options.seed) {
    const OcclusionResult result = solveOcclusion(tracer, texels, options, silent);
    for (std::size_t i = 0; i < texels.points.size(); ++i) {
      squares += std::pow(result.value[i].x - expected, 2) / 256.0;
      reported += std::pow(result.error[i], 2) / 256.0;
    }
  }
  return {std::sqrt(squares), std::sqrt(reported)};
}

double convergedAt(const trace::Tracer& tracer, const Place& place, OcclusionOptions options) {
  options.max_samples = 8192, options.target_error = 0, options.seed = 99;
  atlas::Texels texels = made::repeatedPoint(64, place.p);
  for (atlas::SurfacePoint& p : texels.points) p.dp_dx = {place.texel, 0, 0}, p.dp_dy = {0, place.texel, 0};
  SilentProgress silent;
  double mean = 0;
  for (const Vec3& v : solveOcclusion(tracer, texels, options, silent).value) mean += v.x / 64.0;
  return mean;
}

TEST(ErrorEstimate, IsWithinAFactorOfTwoForVisibility) {
  for (const Place& place : places()) {
    const trace::Tracer tracer(place.scene);
    OcclusionOptions options;
    const double expected = convergedAt(tracer, place, options);
    for (const bool smoothed : {false, true}) {
      for (const std::uint32_t n : {64u, 256u, 1024u}) {
        SCOPED_TRACE(testing::Message()
                     << place.name << ", " << n << " rays" << (smoothed ? ", shared" : ""));
        options.max_samples = n;
        options.smoothed = smoothed;
        const Errors e = errorsAt(tracer, place, options, expected);
        EXPECT_GT(e.reported, 0.5 * e.truth);
        // Chunks of 256 shared samples are judged one by one, though together they are a net, too.
        EXPECT_LT(e.reported, (smoothed && n > 256 ? 4.0 : 2.0) * e.truth);
      }
    }
  }
}

// A smooth weight makes a net better than any local look at its samples can tell: never too hopeful, and
// small anyway.
TEST(ErrorEstimate, IsSafeForSmoothWeights) {
  for (const Place& place : places()) {
    const trace::Tracer tracer(place.scene);
    OcclusionOptions options;
    options.weight = {Shape::kExponential, 1.0f, 2.5f};
    const double expected = convergedAt(tracer, place, options);
    for (const std::uint32_t n : {64u, 256u}) {
      SCOPED_TRACE(testing::Message() << place.name << ", " << n << " rays");
      options.max_samples = n;
      const Errors e = errorsAt(tracer, place, options, expected);
      EXPECT_GT(e.reported, 0.8 * e.truth);
      EXPECT_TRUE(e.reported < 2.0 * e.truth || e.reported < 0.008) << e.reported << " for " << e.truth;
    }
  }
}

// Stopping early must not be a way to fool oneself: where the estimate decides, the true error is still about
// what was asked for.
TEST(ErrorEstimate, StoppingByItReachesTheTarget) {
  for (const Place& place : places()) {
    const trace::Tracer tracer(place.scene);
    OcclusionOptions options;
    const double expected = convergedAt(tracer, place, options);
    options.min_samples = 64, options.max_samples = 8192, options.target_error = 0.01f;
    for (const bool smoothed : {false, true}) {
      options.smoothed = smoothed;
      const Errors e = errorsAt(tracer, place, options, expected);
      const double gain = smoothed ? 4.0 / 1.5 : 1.0;  // a whole block of one chart, to be smoothed
      EXPECT_LT(e.reported, 0.01 * gain) << place.name;
      EXPECT_LT(e.truth, 0.02 * gain) << place.name;
    }
  }
}

TEST(ErrorEstimate, IsNeverZero) {  // what no ray has met may still be there
  const scene::Scene empty;
  SilentProgress silent;
  OcclusionOptions options;
  const OcclusionResult result =
      solveOcclusion(trace::Tracer(empty), made::repeatedPoint(1, {}), options, silent);
  EXPECT_GT(result.error[0], 0.0f);
  EXPECT_LT(result.error[0], 0.002f);
}

}  // namespace
}  // namespace relume::transport
