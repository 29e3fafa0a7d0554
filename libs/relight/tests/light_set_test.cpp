// SPDX-License-Identifier: MIT
#include "relume/relight/light_set.h"

#include <gtest/gtest.h>

#include "relume/core/error.h"

namespace relume::relight {
namespace {

TEST(ParseLights, EveryKindAndField) {
  const LightSet lights = parseLights(R"([
    {"type": "point", "name": "lamp", "color": [1, 0.5, 0.25], "intensity": 40, "range": 12, "position": [1, 2, 3]},
    {"type": "spot", "position": [0, 3, 0], "direction": [0, -2, 0], "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}},
    {"type": "directional", "direction": [3, 0, 4], "intensity": 1000, "extras": {"sun": true}},
    {"type": "area", "position": [0, 2.5, 0], "normal": [0, -1e-30, 0], "area": 0.36, "intensity": 12}
  ])",
                                      "lights.json");
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_EQ(lights[0].kind, Light::Kind::kPoint);
  EXPECT_EQ(lights[0].name, "lamp");
  EXPECT_EQ(lights[0].colour, Vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(lights[0].intensity, 40);
  EXPECT_EQ(lights[0].range, 12);
  EXPECT_EQ(lights[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(lights[1].kind, Light::Kind::kSpot);
  EXPECT_EQ(lights[1].direction, Vec3(0, -1, 0));
  EXPECT_EQ(lights[1].inner_cone, 0.2f);
  EXPECT_EQ(lights[1].outer_cone, 0.5f);
  EXPECT_EQ(lights[1].intensity, 1);
  EXPECT_EQ(lights[1].range, kInfinity);
  EXPECT_EQ(lights[2].kind, Light::Kind::kDirectional);
  EXPECT_NEAR(lights[2].direction.x, 0.6f, 1e-6f);
  EXPECT_NEAR(lights[2].direction.z, 0.8f, 1e-6f);
  EXPECT_EQ(lights[3].kind, Light::Kind::kArea);
  EXPECT_EQ(lights[3].direction, Vec3(0, -1, 0));
  EXPECT_EQ(lights[3].area, 0.36f);
}

TEST(ParseLights, DefaultsAreThoseOfKhrLightsPunctual) {
  const Light spot = parseLights(R"([{"type":"spot","position":[0,0,0],"direction":[0,0,-1]}])", "")[0];
  EXPECT_EQ(spot.colour, Vec3(1));
  EXPECT_EQ(spot.intensity, 1);
  EXPECT_EQ(spot.inner_cone, 0);
  EXPECT_FLOAT_EQ(spot.outer_cone, kPi / 4);
}

TEST(ParseLights, AlsoAnObjectWithAListAndAnEmptyList) {
  EXPECT_EQ(parseLights(R"({"lights":[{"type":"point","position":[0,0,0]}]})", "").size(), 1u);
  EXPECT_TRUE(parseLights("[]", "").empty());
}

TEST(ParseLights, ASunMayHaveASize) {
  const LightSet lights =
      parseLights(R"([{"type":"directional","direction":[0,-1,0],"angularDiameter":0.0093}])", "");
  EXPECT_FLOAT_EQ(lights[0].angular_radius, 0.00465f);
}

TEST(ParseLights, AnAreaLightMayBeAPolygon) {
  const Light light = parseLights(R"([{"type": "area", "intensity": 5, "twoSided": true,
      "vertices": [[0,3,0], [2,3,0], [2,3,1], [1,3,1], [1,3,3], [0,3,3]]}])",
                                  "")[0];
  EXPECT_EQ(light.kind, Light::Kind::kArea);
  EXPECT_TRUE(light.two_sided);
  EXPECT_FLOAT_EQ(light.area, 4.0f);
  EXPECT_EQ(light.triangles.size(), 4u);
  EXPECT_NEAR(glm::length(light.direction - Vec3(0, -1, 0)), 0, 1e-6f);  // counter-clockwise from below
  EXPECT_NEAR(glm::length(light.position - Vec3(0.75f, 3, 1.25f)), 0, 1e-6f);
  EXPECT_TRUE(parseLights(R"([{"type":"area","position":[0,0,0],"normal":[0,1,0],"area":1}])", "")[0]
                  .triangles.empty());
}

TEST(ParseEnvironment, ConstantFileAndSky) {
  EXPECT_FALSE(parseEnvironment("[]", ""));
  EXPECT_FALSE(parseEnvironment(R"({"lights":[]})", ""));
  const auto constant = parseEnvironment(R"({"environment":{"radiance":[1,2,3]}})", "");
  ASSERT_TRUE(constant);
  EXPECT_EQ(constant->radiance, Vec3(1, 2, 3));
  EXPECT_TRUE(parseLights(R"({"environment":{"radiance":[1,2,3]}})", "").empty());
  const auto file = parseEnvironment(R"({"environment":{"file":"a.hdr","rotation":1.5}})", "");
  EXPECT_EQ(file->file, "a.hdr");
  EXPECT_EQ(file->radiance, Vec3(1));
  EXPECT_EQ(file->rotation, 1.5f);
  const auto sky = parseEnvironment(R"({"environment":{"sky":{"direction":[0,-2,0],"turbidity":4}}})", "");
  ASSERT_TRUE(sky->sky);
  EXPECT_EQ(sky->sky->sun_direction, Vec3(0, -1, 0));
  EXPECT_EQ(sky->sky->turbidity, 4);
}

TEST(ParseEnvironment, RefusesWhatItCannotMean) {
  for (const char* bad : {"7", "{}", R"({"radiance":1})", R"({"radiance":[1,-1,1]})", R"({"fiel":"a.hdr"})",
                          R"({"file":3})", R"({"sky":{"direction":[0,1,0]}})", R"({"sky":{}})",
                          R"({"sky":{"direction":[0,-1,0],"turbidity":1}})",
                          R"({"file":"a.hdr","sky":{"direction":[0,-1,0]}})"}) {
    EXPECT_THROW(parseEnvironment(std::string(R"({"environment":)") + bad + "}", "l.json"), Error) << bad;
  }
}

struct Bad {
  const char* json;
  const char* place;  ///< what the message must name
};
class BadLights : public testing::TestWithParam<Bad> {};

TEST_P(BadLights, AreRefusedNamingTheFieldOfTheLight) {
  const std::string good = R"({"type":"point","position":[0,0,0]},)";
  try {
    parseLights("[" + good + GetParam().json + "]", "lights.json");
    FAIL() << "accepted " << GetParam().json;
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kInvalidValue);
    EXPECT_EQ(e.subject(), "lights.json");
    EXPECT_EQ(e.problem().find(std::string("lights[1]") + GetParam().place + " "), 0u) << e.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BadLights,
    testing::Values(
        Bad{"7", ""}, Bad{"{}", ".type"}, Bad{R"({"type":"lamp"})", ".type"}, Bad{R"({"type":3})", ".type"},
        Bad{R"({"type":"point"})", ".position"}, Bad{R"({"type":"point","position":[0,0]})", ".position"},
        Bad{R"({"type":"point","position":[0,"1",0]})", ".position[1]"},
        Bad{R"({"type":"point","position":[0,0,1e300]})", ".position[2]"},
        Bad{R"({"type":"point","position":[0,0,0],"intesity":2})", ".intesity"},
        Bad{R"({"type":"point","position":[0,0,0],"intensity":-2})", ".intensity"},
        Bad{R"({"type":"point","position":[0,0,0],"intensity":"2"})", ".intensity"},
        Bad{R"({"type":"point","position":[0,0,0],"color":[1,1,-1]})", ".color[2]"},
        Bad{R"({"type":"point","position":[0,0,0],"range":0})", ".range"},
        Bad{R"({"type":"point","position":[0,0,0],"range":1e-60})", ".range"},
        Bad{R"({"type":"point","position":[0,0,0],"name":5})", ".name"},
        Bad{R"({"type":"point","position":[0,0,0],"area":5})", ".area"},
        Bad{R"({"type":"directional"})", ".direction"},
        Bad{R"({"type":"directional","direction":[0,0,0]})", ".direction"},
        Bad{R"({"type":"spot","position":[0,0,0],"direction":[0,0,1],"spot":1})", ".spot"},
        Bad{R"({"type":"spot","position":[0,0,0],"direction":[0,0,1],"spot":{"innerConeAngle":1}})",
            ".spot.innerConeAngle"},
        Bad{R"({"type":"spot","position":[0,0,0],"direction":[0,0,1],"spot":{"outerConeAngle":2}})",
            ".spot.outerConeAngle"},
        Bad{R"({"type":"spot","position":[0,0,0],"direction":[0,0,1],"spot":{"inner":1}})", ".spot.inner"},
        Bad{R"({"type":"area","position":[0,0,0],"area":1})", ".normal"},
        Bad{R"({"type":"area","position":[0,0,0],"normal":[0,1,0]})", ".area"},
        Bad{R"({"type":"area","position":[0,0,0],"normal":[0,1,0],"area":0})", ".area"},
        Bad{R"({"type":"area","position":[0,0,0],"normal":[0,1,0],"area":1,"twoSided":1})", ".twoSided"},
        Bad{R"({"type":"area","vertices":3})", ".vertices"},
        Bad{R"({"type":"area","vertices":[[0,0,0],[1,0,0]]})", ".vertices"},
        Bad{R"({"type":"area","vertices":[[0,0,0],[1,0,0],[0,1]]})", ".vertices[2]"},
        Bad{R"({"type":"area","vertices":[[0,0,0],[1,0,0],[0,1,"0"]]})", ".vertices[2][2]"},
        Bad{R"({"type":"area","vertices":[[0,0,0],[1,0,0],[2,0,0]]})", ".vertices"},
        Bad{R"({"type":"area","vertices":[[0,0,0],[2,2,0],[2,0,0],[0,1,0]]})", ".vertices"},
        Bad{R"({"type":"area","vertices":[[0,0,0],[2,0,0],[2,2,0.5],[0,2,0]]})", ".vertices"},
        Bad{R"({"type":"area","vertices":[[0,0,0],[1e30,0,0],[0,1e30,0]]})", ".vertices"},
        Bad{R"({"type":"area","area":2,"vertices":[[0,0,0],[1,0,0],[0,1,0]]})", ".area"},
        Bad{R"({"type":"point","position":[0,0,0],"twoSided":true})", ".twoSided"}));

TEST(ParseLights, RefusesWhatIsNoList) {
  const auto code = [](const char* json) {
    try {
      parseLights(json, "lights.json");
    } catch (const Error& e) {
      return e.code();
    }
    return ErrorCode::kInterrupted;
  };
  EXPECT_EQ(code("[{"), ErrorCode::kInvalidJson);
  EXPECT_EQ(code("[1e999]"), ErrorCode::kInvalidJson);
  EXPECT_EQ(code(""), ErrorCode::kInvalidJson);
  EXPECT_EQ(code("3"), ErrorCode::kInvalidValue);
  EXPECT_EQ(code(R"({"lights":{}})"), ErrorCode::kInvalidValue);
  EXPECT_EQ(code(R"({"type":"point","position":[0,0,0]})"), ErrorCode::kInvalidValue);
}

}  // namespace
}  // namespace relume::relight
