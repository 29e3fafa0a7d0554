// SPDX-License-Identifier: MIT
// Albedo of texels that fine textures cover, against brute-force means over their footprints.
#include <gtest/gtest.h>

#include <cmath>

#include "relume/atlas/texels.h"
#include "relume/core/sampling.h"
#include "texels_scene.h"

namespace relume::atlas {
namespace {

using testing::HandMade;

/// Noise over blocks of 3 x 3 pixels, slowly brighter to the right: neither constant nor free of edges.
std::shared_ptr<image::Image8> noise(int width, int height, std::uint32_t seed) {
  auto image = std::make_shared<image::Image8>();
  image->width = width, image->height = height, image->channels = 4;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (std::uint32_t c = 0; c < 4; ++c) {
        const std::uint32_t bits = hashCombine(static_cast<std::uint32_t>((y / 3) * 1000 + x / 3), seed + c);
        image->data.push_back(static_cast<unsigned char>((bits >> 8) % 160 + 95 * x / width));
      }
    }
  }
  return image;
}

std::uint32_t addTexture(scene::Scene& scene, std::shared_ptr<image::Image8> image, bool srgb,
                         scene::Wrap wrap) {
  scene::Texture texture;
  texture.image = std::move(image);
  texture.srgb = srgb;
  texture.wrap_u = texture.wrap_v = wrap;
  scene.textures.push_back(texture);
  return static_cast<std::uint32_t>(scene.textures.size() - 1);
}

/// A square of 12 x 12 texels with a corner at (2.3, 1.6); the texture runs over it turned and shifted.
HandMade texturedSquare(float pixels_per_texel, float width) {
  HandMade made(16);
  scene::Mesh& mesh = made.addQuad({0, 0, 0}, {12, 0, 0}, {0, 12, 0}, {2.3f, 1.6f}, {12, 12});
  const float span = 12 * pixels_per_texel / width;
  const Vec2 along = span * Vec2(std::cos(0.4f), std::sin(0.4f)), across(-along.y, along.x);
  const Vec2 from(-0.37f, 0.21f);
  mesh.uv[0] = {from, from + along, from + along + across, from + across};
  return made;
}

struct Difference {
  double worst = 0, rms = 0, bias = 0;
};

/// Wholly covered texels against the mean of 48 x 48 interpolated look-ups in each, weighted by opacity.
Difference againstBruteForce(const HandMade& made) {
  SilentProgress silent;
  const Texels texels = rasterize(made.scene, made.atlas, silent);
  const scene::Material& material = made.scene.materials[0];
  Difference difference;
  double count = 0;
  constexpr int kSide = 48;
  for (const SurfacePoint& p : texels.points) {
    if (p.coverage < 1.0f) continue;
    double sum = 0, weight = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
      const float x =
          static_cast<float>(p.texel % 16) + (static_cast<float>(i % kSide) + 0.5f) / kSide - 2.3f;
      const float y =
          static_cast<float>(p.texel / 16) + (static_cast<float>(i / kSide) + 0.5f) / kSide - 1.6f;
      const bool lower = y <= x;  // triangle (0, 1, 2)
      const scene::Hit hit =
          lower ? scene::Hit{0, 0, (x - y) / 12, y / 12} : scene::Hit{0, 1, x / 12, (y - x) / 12};
      const scene::Surface surface = scene::surfaceAt(made.scene, hit);
      const float a = surface.base_colour.a;
      const float opacity = material.alpha_mode == scene::AlphaMode::kOpaque ? 1.0f
                            : material.alpha_mode == scene::AlphaMode::kMask
                                ? (a >= material.alpha_cutoff ? 1.0f : 0.0f)
                                : a;
      sum += static_cast<double>(surface.albedo().rgb.y * opacity), weight += static_cast<double>(opacity);
    }
    const double off = static_cast<double>(p.albedo.rgb.y) - sum / weight;
    difference.worst = std::max(difference.worst, std::abs(off));
    difference.rms += off * off, difference.bias += off, ++count;
  }
  EXPECT_GT(count, 100);
  difference.rms = std::sqrt(difference.rms / count), difference.bias /= count;
  return difference;
}

// One look-up would be off by the texture's own deviation, 0.15 and more.
TEST(TexelsTexture, IsTheMeanOverTheFootprint) {
  for (const scene::Wrap wrap : {scene::Wrap::kRepeat, scene::Wrap::kMirror}) {
    for (const float pixels : {1.3f, 2.5f, 5.0f, 11.0f, 23.0f}) {
      SCOPED_TRACE(::testing::Message() << pixels << " pixels to a texel, wrap " << static_cast<int>(wrap));
      HandMade made = texturedSquare(pixels, 64);
      made.scene.materials[0].base_colour_texture.texture =
          addTexture(made.scene, noise(64, 37, 1), true, wrap);  // an odd height
      made.scene.materials[0].base_colour = {0.9f, 0.8f, 0.7f, 1.0f};
      const Difference difference = againstBruteForce(made);
      EXPECT_LT(difference.rms, 0.03);
      EXPECT_LT(difference.worst, 0.1);
      EXPECT_LT(std::abs(difference.bias), 0.006);
    }
  }
}

// Where colour and metal change together, the mean of the product is not the product of the means: red paint
// of albedo 0.9 on black-looking metal gives 0.45 where the means give 0.225.
TEST(TexelsTexture, ColourAndMetalAreAveragedTogether) {
  HandMade made = texturedSquare(16, 64);
  auto colour = std::make_shared<image::Image8>(), metal = std::make_shared<image::Image8>();
  colour->width = colour->height = metal->width = metal->height = 64;
  colour->channels = metal->channels = 3;
  for (int i = 0; i < 64 * 64; ++i) {
    const bool paint = ((i % 64) ^ (i / 64)) & 1;
    const auto c = static_cast<unsigned char>(paint ? 230 : 0),
               m = static_cast<unsigned char>(paint ? 0 : 255);
    colour->data.insert(colour->data.end(), {c, c, c});
    metal->data.insert(metal->data.end(), {0, 255, m});
  }
  scene::Material& material = made.scene.materials[0];
  material.metallic = 1;
  material.base_colour_texture.texture = addTexture(made.scene, colour, false, scene::Wrap::kRepeat);
  material.metallic_roughness_texture.texture = addTexture(made.scene, metal, false, scene::Wrap::kRepeat);
  SilentProgress silent;
  for (const SurfacePoint& p : rasterize(made.scene, made.atlas, silent).points)
    EXPECT_NEAR(p.albedo.rgb.x, 0.5f * 230 / 255, p.coverage == 1.0f ? 0.01f : 0.03f);
}

TEST(TexelsTexture, IsWeightedByOpacity) {
  for (const scene::AlphaMode mode : {scene::AlphaMode::kMask, scene::AlphaMode::kBlend}) {
    HandMade made = texturedSquare(9, 64);
    made.scene.materials[0].base_colour_texture.texture =
        addTexture(made.scene, noise(64, 64, 7), true, scene::Wrap::kRepeat);
    made.scene.materials[0].alpha_mode = mode;
    const Difference difference = againstBruteForce(made);
    EXPECT_LT(difference.rms, 0.05);
    EXPECT_LT(std::abs(difference.bias), 0.01);
  }
}

TEST(TexelsTexture, ATransparentTexelHasItsOwnColour) {
  HandMade made = texturedSquare(9, 64);
  auto clear = std::make_shared<image::Image8>();
  clear->width = clear->height = 64, clear->channels = 4;
  for (int i = 0; i < 64 * 64; ++i) clear->data.insert(clear->data.end(), {255, 51, 0, 0});
  made.scene.materials[0].base_colour_texture.texture =
      addTexture(made.scene, clear, false, scene::Wrap::kRepeat);
  made.scene.materials[0].alpha_mode = scene::AlphaMode::kMask;
  SilentProgress silent;
  for (const SurfacePoint& p : rasterize(made.scene, made.atlas, silent).points)
    EXPECT_NEAR(p.albedo.rgb.y, 0.2f, 1e-4f);
}

// A bake of visibility alone leaves the textures shut; the surfaces are the same to the last bit.
TEST(TexelsTexture, WithoutMaterialsOnlyColoursAreMissing) {
  HandMade made = texturedSquare(16, 64);
  made.scene.materials[0].base_colour_texture.texture =
      addTexture(made.scene, noise(64, 64, 7), false, scene::Wrap::kRepeat);
  made.scene.materials[0].emission = Vec3(2);
  SilentProgress silent;
  const Texels with = rasterize(made.scene, made.atlas, silent);
  const Texels without = rasterize(made.scene, made.atlas, silent, {.materials = false});
  ASSERT_EQ(without.points.size(), with.points.size());
  ASSERT_EQ(without.samples.size(), with.samples.size());
  for (std::size_t i = 0; i < with.points.size(); ++i) {
    const SurfacePoint &a = with.points[i], &b = without.points[i];
    EXPECT_EQ(a.texel, b.texel);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.shading_normal, b.shading_normal);
    EXPECT_EQ(a.area, b.area);
    EXPECT_EQ(a.sample_count, b.sample_count);
    EXPECT_EQ(b.albedo.rgb, Vec3(0));
    EXPECT_EQ(b.emission.rgb, Vec3(0));
  }
}

}  // namespace
}  // namespace relume::atlas
