// SPDX-License-Identifier: MIT
// What a person may write after --layer, and what it resolves to.
#include <gtest/gtest.h>

#include <cmath>

#include "relume/bake/quality.h"
#include "relume/bake/registry.h"
#include "relume/core/error.h"

namespace relume::bake {
namespace {

TEST(LayerSpec, ReadsNameAndPairs) {
  EXPECT_EQ(parseLayerSpec("ao").kind, "ao");
  const LayerSpec spec = parseLayerSpec("obscurance:tau=1,distance=4");
  EXPECT_EQ(spec.kind, "obscurance");
  EXPECT_EQ(spec.values, (std::map<std::string, std::string>{{"tau", "1"}, {"distance", "4"}}));
}

TEST(LayerSpec, RefusesWhatIsMalformed) {
  for (const char* text : {"", ":a=1", "ao:", "ao:distance", "ao:=2", "ao:distance=", "ao:distance=2,",
                           "ao:bent=true,bent=false"}) {
    try {
      parseLayerSpec(text);
      ADD_FAILURE() << text << " was accepted";
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::kUsage) << text;
    }
  }
}

TEST(Resolve, FillsDefaultsFromTheSize) {
  const Parameters room = resolve(find("obscurance"), parseLayerSpec("obscurance"), 10.0f);
  EXPECT_DOUBLE_EQ(std::get<double>(room.at("distance")), 2.5);  // a quarter of the diagonal
  EXPECT_DOUBLE_EQ(std::get<double>(room.at("tau")), 0.625);
  EXPECT_EQ(std::get<std::string>(room.at("shape")), "exp");
  EXPECT_FALSE(std::get<bool>(room.at("bent")));
  EXPECT_FLOAT_EQ(autoDistance(100.0f), 4.0f);
  EXPECT_FLOAT_EQ(autoDistance(0.8f), 0.1f);  // a model in another unit
  EXPECT_FLOAT_EQ(autoDistance(960.0f), 120.0f);
}

TEST(Resolve, TauFollowsAGivenDistance) {
  const Parameters p = resolve(find("spectral"), parseLayerSpec("spectral:distance=8"), 10.0f);
  EXPECT_DOUBLE_EQ(std::get<double>(p.at("tau")), 2.0);
  const Parameters endless = resolve(find("obscurance"), parseLayerSpec("obscurance:distance=inf"), 10.0f);
  EXPECT_TRUE(std::isinf(std::get<double>(endless.at("distance"))));
  EXPECT_DOUBLE_EQ(std::get<double>(endless.at("tau")), 0.625);
}

TEST(Resolve, ALightmapsSolverIsGatheringUnlessItSays) {
  const Parameters usual = resolve(find("lightmap"), parseLayerSpec("lightmap"), 10.0f);
  EXPECT_EQ(std::get<std::string>(usual.at("solver")), "gather");
  const Parameters p = resolve(
      find("lightmap"), parseLayerSpec("lightmap:solver=radiosity,patch=8,formfactors=hemicube"), 10.0f);
  EXPECT_EQ(std::get<std::string>(p.at("solver")), "radiosity");
  EXPECT_EQ(std::get<double>(p.at("patch")), 8.0);
  EXPECT_EQ(std::get<std::string>(p.at("solution")), "gathering");
}

TEST(Resolve, RefusesWrongNamesAndValues) {
  for (const char* text :
       {"ao:tau=1", "ao:distance=far", "ao:distance=0", "ao:distance=nan", "ao:bent=maybe",
        "ao:correction=some", "obscurance:shape=linear,distance=inf", "obscurance:distance=2m",
        "lightmap:solver=photons", "lightmap:patch=0", "lightmap:patch=65", "lightmap:patch=inf",
        "lightmap:formfactors=exact", "lightmap:solution=direct"}) {
    const LayerSpec spec = parseLayerSpec(text);
    EXPECT_THROW(resolve(find(spec.kind), spec, 10.0f), Error) << text;
  }
  EXPECT_THROW(find("lightmaps"), Error);
}

TEST(QualityTest, PresetsRiseInEffort) {
  QualitySettings last;
  for (const Quality q : {Quality::kDraft, Quality::kMedium, Quality::kHigh, Quality::kFinal}) {
    const QualitySettings s = settings(q);
    EXPECT_GT(s.max_samples, last.max_samples);
    EXPECT_LE(s.min_samples, s.max_samples);
    if (last.target_error > 0) {
      EXPECT_LT(s.target_error, last.target_error);
    }
    EXPECT_EQ(parseQuality(name(q)), q);
    last = s;
  }
  EXPECT_THROW(parseQuality("best"), Error);
}

}  // namespace
}  // namespace relume::bake
