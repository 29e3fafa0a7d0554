// SPDX-License-Identifier: MIT
// The surface inside one texel: fragments of a chart to a SurfacePoint and its sub-samples.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/atlas/texels.h"
#include "texels/coverage.h"
#include "texels/material_texture.h"

namespace relume::atlas {

/// The affine map between the page and one triangle in space.
struct TriangleMap {
  std::uint32_t triangle = scene::kNone;
  std::array<DVec2, 3> page{};
  std::array<glm::dvec3, 3> world{};
  glm::dvec3 dp_dx{0}, dp_dy{0};  ///< metres per texel
  double area = 0;                ///< m^2 per texel
  Normal normal{0, 0, 1};         ///< of the face, world
  bool even = false;              ///< one shading normal all over
  Normal shading{0, 0, 1};        ///< then this
  DVec2 edge1{0}, edge2{0};       ///< of the page, from page[0], over twice the signed area
  double texture_texels = 0;      ///< texture texels across one texel of the page; 0: no texture

  /// Fine textures are read as blocks of 2^level pixels, and `texture_texels` counts these; -1: as they are.
  int level = -1;
  DVec2 pixel{0}, dpixel_dx{0}, dpixel_dy{0};  ///< of page[0], and pixels per texel

  scene::Hit hit(std::uint32_t instance, DVec2 p) const;  ///< clamped into the triangle
  bool contains(DVec2 p) const;
  bool containsWell(DVec2 p) const;  ///< at least kInset from each edge
};

/// Makes the surface points of one chart. Not shared between threads.
class FootprintBuilder {
 public:
  /// Without `textures` nothing is read of materials.
  FootprintBuilder(const scene::Scene& scene, const InstanceUv& uv, std::uint32_t chart,
                   const MaterialTextures* textures);

  /// fragments: of one chart in the square of texel (x, y), at least one. Sub-samples go to the end of
  /// `samples`, and `first_sample` counts from its beginning. `texel` is left to the caller.
  SurfacePoint build(int x, int y, std::span<const Fragment> fragments, std::vector<SubSample>& samples);

 private:
  struct Piece {
    TriangleMap map;
    Polygon polygon;
    double coverage = 0;
  };
  struct Place {
    DVec2 page{0};
    std::size_t piece = 0;
  };

  const TriangleMap& mapOf(std::uint32_t triangle);
  TriangleMap makeMap(std::uint32_t triangle) const;
  void cut(int x, int y, std::span<const Fragment> fragments);
  /// The place in a piece that is p or nearest to p, a little inside.
  Place placeAt(DVec2 p) const;
  /// `count` places, equal areas each.
  void addSamples(std::uint32_t count, std::vector<SubSample>& samples) const;
  /// Whether the pieces are one flat parallelogram.
  bool flat(DVec2 centre, const TriangleMap& base) const;
  SurfacePoint pointAt(const TriangleMap& map, DVec2 p);
  Point positionAt(const TriangleMap& map, DVec2 p) const;

  // Material, weighted by opacity.
  struct Mean {
    Vec3 albedo{0}, emission{0};
    double weight = 0;
    Vec3 all_albedo{0}, all_emission{0};  // without opacity, for texels in which nothing is opaque
    double all_weight = 0;
    bool opaque() const { return weight > 1e-3 * all_weight; }
  };
  void addSurface(const TriangleMap& map, DVec2 p, double weight, Mean& mean) const;
  void addInterpolated(const TriangleMap& map, DVec2 p, double weight, Mean& mean) const;
  void addBlock(const TriangleMap& map, DVec2 p, double weight, Mean& mean) const;
  Vec3 vertexColour(const TriangleMap& map, DVec2 p) const;
  void addSquare(const TriangleMap& map, int x, int y, Mean& mean) const;
  void addPiece(const Piece& piece, Mean& mean) const;
  void store(const Mean& mean, SurfacePoint& point) const;

  const scene::Scene& scene_;
  const InstanceUv& uv_;
  const scene::Instance& instance_;
  const scene::Mesh& mesh_;
  const scene::Material& material_;
  std::uint32_t chart_;
  bool shaded_ = false, textured_ = false, coloured_ = false;
  const MaterialTexture* texture_ = nullptr;  // of the material, where there can be one
  static constexpr std::uint32_t kMaps = 64;
  std::vector<TriangleMap> maps_;  // of triangles lately met, each at its number modulo kMaps
  std::vector<Piece> pieces_;
  SurfacePoint constant_;  // carries albedo and emission where nothing varies
  bool constant_known_ = false;
};

}  // namespace relume::atlas
