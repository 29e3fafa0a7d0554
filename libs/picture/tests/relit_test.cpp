// SPDX-License-Identifier: MIT
// Relit light against its formula by hand: [LPM] section 10.
#include <gtest/gtest.h>

#include "hand_made.h"
#include "relume/core/error.h"

namespace relume::picture {
namespace {

constexpr Vec3 kAlbedo{0.5f, 0.4f, 0.2f}, kIndirect{0.3f, 0.6f, 0.9f}, kW{0.5f, 0.75f, 0.25f};

struct Composed {
  scene::Scene scene = sceneOf({{.material = matte(kAlbedo)}});
  asset::Asset bake = constantBake(0.5f);
  PictureOptions options = optionsOf(View::kRelit);
  Irradiance direct;

  Composed() {
    std::vector<float> irradiance, w;
    for (int i = 0; i < 16; ++i)
      for (int c = 0; c < 3; ++c) irradiance.push_back(kIndirect[c]), w.push_back(kW[c]);
    addLayer(bake, "lightpath", "value", irradiance);
    addLayer(bake, "spectral", "value", w);
    options.ambient = Irradiance(0.0f);
    options.lights = {{.intensity = 5, .position = {0.5f, 0.5f, 2}}};
    direct = directIrradiance(options.lights[0], {0.5f, 0.5f, 0}, {0, 0, 1});
  }
  Vec3 colour() const { return onePixel(scene, &bake, middle(0.001f), options); }
};

TEST(Relit, IsTheSumOfDirectAndIndirectLight) {
  Composed c;
  expectNear(c.colour(), kAlbedo * (c.direct.rgb + kIndirect) * kInvPi, 1e-5f);
  c.options.view = View::kIndirect;
  expectNear(c.colour(), kAlbedo * kIndirect * kInvPi, 1e-5f);
}

TEST(Relit, IndirectLightIsWeightedByObscurance) {
  Composed c;
  c.options.obscurance = 1;
  expectNear(c.colour(), kAlbedo * (c.direct.rgb + kIndirect * kW) * kInvPi, 1e-5f);
  c.options.obscurance = 0.25f;
  expectNear(c.colour(), kAlbedo * (c.direct.rgb + kIndirect * (0.75f + 0.25f * kW)) * kInvPi, 1e-5f);
  c.options.obscurance_layer = "obscurance";
  expectNear(c.colour(), kAlbedo * (c.direct.rgb + kIndirect * 0.875f) * kInvPi, 1e-5f);
}

TEST(Relit, DirectLightTimesObscuranceIsTheShortBounce) {
  Composed c;
  c.options.bounce = 1;
  expectNear(c.colour(), kAlbedo * (c.direct.rgb * (1.0f + kW) + kIndirect) * kInvPi, 1e-5f);
  c.options.view = View::kIndirect;
  c.options.obscurance = 1, c.options.bounce = 0.5f;
  expectNear(c.colour(), kAlbedo * (0.5f * c.direct.rgb * kW + kIndirect * kW) * kInvPi, 1e-5f);
}

TEST(Relit, ObscuranceThatIsNotThereIsSaid) {
  Composed c;
  c.options.obscurance = 1;
  c.options.obscurance_layer = "lightpath";
  EXPECT_THROW(c.colour(), Error);
  c.options.obscurance_layer.clear();
  c.bake.layers.erase(c.bake.layers.begin());
  c.bake.layers.pop_back();
  EXPECT_THROW(c.colour(), Error);
}

}  // namespace
}  // namespace relume::picture
