// SPDX-License-Identifier: MIT
// Directional light on surfaces: what is stored, looked up, turned by normals and mirrored.
#include <gtest/gtest.h>

#include "hand_made.h"
#include "relume/asset/direction_maps.h"
#include "relume/basis/basis.h"
#include "relume/basis/receiver.h"
#include "relume/core/error.h"
#include "relume/picture/baked_directions.h"

namespace relume::picture {
namespace {

/// A lightmap of 4 x 4 texels with the receiver `ahd`: even light `ambient` and a lamp `direct` from `d`.
asset::Asset ahdBake(float ambient, float direct, Direction d) {
  asset::Asset bake = emptyBake(4, 4);
  const auto plane = [&](Vec3 v) {
    std::vector<float> values;
    for (int i = 0; i < 16; ++i) values.insert(values.end(), {v.x, v.y, v.z});
    return values;
  };
  addLayer(bake, "lightmap", "value", plane(Vec3(9.0f)));
  asset::Layer& layer = bake.layers.back();
  layer.parameters = {{"receiver", std::string("ahd")}, {"packing", std::string("half")}};
  for (const auto& [name, v] :
       {std::pair{"ahd-ambient", Vec3(ambient)}, {"ahd-direct", Vec3(direct)}, {"ahd-direction", d}})
    layer.planes.push_back({name, 3, asset::Storage::kFloat32, 0, 1, plane(v)});
  return bake;
}

Vec3 middleOf(const scene::Scene& scene, const asset::Asset& bake, Gloss gloss) {
  PictureOptions options = optionsOf(View::kLightmap, 5);
  options.gloss = gloss;
  return rendered(scene, &bake, squareOn(1.0f), options).rgb(2, 2);
}

TEST(DirectionalLight, LightsDiffuseSurfaces) {
  Quad quad;
  quad.material = matte(Vec3(0.5f));
  const Direction d = glm::normalize(Vec3(0.6f, 0, 0.8f));
  const Vec3 seen = middleOf(sceneOf({quad}), ahdBake(0.3f, 2, d), Gloss::kNone);
  EXPECT_NEAR(seen.x, 0.5f * kInvPi * (0.3f + 2 * 0.8f), 1e-4f);
}

/// Diffuse light under the coat and the lobe itself, put together by hand.
TEST(DirectionalLight, GlossIsTheLobeOfTheBasis) {
  Quad quad;
  quad.material = matte(Vec3(0.5f));
  quad.material.roughness = 0.5f;
  const Direction d = glm::normalize(Vec3(0.1f, 0, 1));
  const asset::Asset bake = ahdBake(0.3f, 2, d);
  const scene::Scene scene = sceneOf({quad});
  const Vec3 seen = middleOf(scene, bake, Gloss::kGgx);
  const Normal n(0, 0, 1);
  const auto ahd = basis::makeBasis("ahd");
  const std::vector<float> c = {0.3f, 0.3f, 0.3f, 2, 2, 2, d.x, d.y, d.z};
  const basis::GlossyLobe lobe = basis::GlossyLobe::ggx(n, n, 0.5f, Vec3(0.04f));
  const basis::Receiver at(n);
  const float diffuse = (1 - lobe.albedo().x) * 0.5f * kInvPi * ahd->irradiance(at, c, n).rgb.x;
  // The view is all but square on.
  EXPECT_NEAR(seen.x, diffuse + ahd->glossy(at, c, lobe).rgb.x, 5e-3f);
  EXPECT_GT(middleOf(scene, bake, Gloss::kPhong).x, diffuse);
}

/// The highlight of a lamp on the left is seen from the right.
TEST(DirectionalLight, HighlightsFollowTheEye) {
  Quad quad;
  quad.material = matte(Vec3(0.5f));
  quad.material.roughness = 0.473f, quad.material.metallic = 0.6f;
  const scene::Scene scene = sceneOf({quad});
  const asset::Asset bake = ahdBake(0.3f, 2, glm::normalize(Vec3(-1, 0, 1)));
  const auto from = [&](float x, Gloss gloss) {
    PictureOptions options = optionsOf(View::kLightmap);
    options.gloss = gloss;
    Viewpoint view = lookAt({0.5f + x, 0.5f, 1}, {0.5f, 0.5f, 0}, 0.8f);
    view.ortho_height = 0.1f;
    return onePixel(scene, &bake, view, options).x;
  };
  for (const Gloss gloss : {Gloss::kGgx, Gloss::kPhong}) EXPECT_GT(from(1, gloss), 2 * from(-1, gloss));
  EXPECT_NEAR(from(1, Gloss::kNone), from(-1, Gloss::kNone), 1e-5f);
}

TEST(DirectionalLight, MapsAreLookedUpByChart) {
  Quad quad;
  quad.material = matte(Vec3(1.0f));
  asset::Asset bake = emptyBake(4, 4);
  addLayer(bake, "directional", "value", std::vector<float>(48, 9.0f));
  asset::DirectionMaps maps;
  maps.directions = {{0, 0, 1}, {1, 0, 0}};
  maps.charts = {{0, 0, 0, 4, 4}};
  maps.rectangles = {{1, 1, 2, 2, 4.0f}, {}};
  maps.textures = {{4, 4, std::vector<std::uint8_t>(48, 255)}, {}};
  bake.layers.back().tables = asset::tablesOf(maps);
  EXPECT_NEAR(middleOf(sceneOf({quad}), bake, Gloss::kNone).x, 4 * kInvPi, 1e-4f);
}

TEST(DirectionalLight, MissingPlanesAreSaid) {
  asset::Asset bake = ahdBake(1, 1, {0, 0, 1});
  bake.layers[0].planes.pop_back();
  EXPECT_THROW(BakedDirections(bake.layers[0], bake.atlas), Error);
  bake.layers[0].parameters["receiver"] = std::string("sh99");
  EXPECT_THROW(BakedDirections(bake.layers[0], bake.atlas), Error);
}

}  // namespace
}  // namespace relume::picture
