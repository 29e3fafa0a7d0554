// SPDX-License-Identifier: MIT
// One texel's footprint. Its quantities are means over the covered part of the square, uniform in the page's
// plane:
//   coverage = sum_k A_k, area = sum_k A_k |dp/dx x dp/dy|_k over the pieces k of triangles in the square,
//   A_k in texels^2.
// Position: the place of the chart nearest to the square's centre, pulled off chart edges by about a
// hundredth of a texel, since a ray origin on an edge between two walls may start behind one of them.
// Sub-samples: a lattice on the unit square, mapped to the covered polygons with equal areas (fans of
// triangles about the centroids, by cumulative area): 16 for a full square's worth of partly covered texel, 8
// where a texel is full but not flat. Albedo and emission: integrated piece by piece with rules that are
// exact for linear functions (midpoints of sub-squares, centroids of sub-triangles), up to 16 points per
// square, jittered where a texture is finer than that; weighted by opacity, because only the opaque part
// reflects and emits. Limits: shares are equal in the page's plane; where triangles of one square are
// stretched differently, equal shares of the sub-samples are not equal areas in space.
#include "texels/texel_footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "relume/core/check.h"
#include "relume/core/sampling.h"

namespace relume::atlas {
namespace {

constexpr double kInset = 1e-2;       // texels from an edge that places keep where they can
constexpr double kFull = 1.0 - 1e-4;  // coverage that counts as the whole square
constexpr double kPartialSamples = 16, kFullSamples = 8, kFewestSamples = 4;  // for each whole square covered
constexpr double kFine =
    2;  // pixels of a texture across a texel, from which they are counted, not interpolated
constexpr double kGolden = 0.61803398874989485;

DVec2 pulledInside(DVec2 p, const TriangleMap& map, const Polygon& polygon) {
  if (map.containsWell(p)) return p;
  const DVec2 to_centre = centroid(polygon) - p;
  const double distance = glm::length(to_centre);
  return p + to_centre * (distance > 0 ? std::min(0.5, kInset / distance) : 0.0);
}

}  // namespace

scene::Hit TriangleMap::hit(std::uint32_t instance, DVec2 p) const {
  const DVec2 d = p - page[0];
  double b1 = std::max(cross(d, edge2), 0.0), b2 = std::max(cross(edge1, d), 0.0);
  const double sum = b1 + b2;
  if (sum > 1) b1 /= sum, b2 /= sum;
  return {instance, triangle, static_cast<float>(b1), static_cast<float>(b2)};
}

bool TriangleMap::contains(DVec2 p) const {
  const double a = cross(page[1] - page[0], p - page[0]), b = cross(page[2] - page[1], p - page[1]),
               c = cross(page[0] - page[2], p - page[2]);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

bool TriangleMap::containsWell(DVec2 p) const {
  const double sign = cross(page[1] - page[0], page[2] - page[0]) < 0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const DVec2 edge = page[(i + 1) % 3] - page[i];
    const double c = sign * cross(edge, p - page[i]);  // inset times length
    if (c < 0 || c * c < kInset * kInset * glm::dot(edge, edge)) return false;
  }
  return true;
}

FootprintBuilder::FootprintBuilder(const scene::Scene& scene, const InstanceUv& uv, std::uint32_t chart,
                                   const MaterialTextures* textures)
    : scene_(scene),
      uv_(uv),
      instance_(scene.instances[uv.instance]),
      mesh_(scene.meshes[instance_.mesh]),
      material_(scene.materials[mesh_.material]),
      chart_(chart),
      shaded_(textures != nullptr),
      texture_(shaded_ ? textures->of(mesh_) : nullptr),
      maps_(kMaps) {
  if (!shaded_) return;
  textured_ =
      material_.base_colour_texture || material_.metallic_roughness_texture || material_.emission_texture;
  coloured_ = !mesh_.colours.empty();
}

TriangleMap FootprintBuilder::makeMap(std::uint32_t triangle) const {
  TriangleMap map;
  map.triangle = triangle;
  map.page = pageTriangle(uv_, triangle);
  const UVec3 t = mesh_.triangles[triangle];
  for (int i = 0; i < 3; ++i) {
    // Float, as the tracer has it.
    map.world[static_cast<std::size_t>(i)] =
        glm::dvec3(Vec3(instance_.world_from_local * Vec4(mesh_.positions[t[i]], 1.0f)));
  }
  const DVec2 d1 = map.page[1] - map.page[0], d2 = map.page[2] - map.page[0];
  const glm::dvec3 e1 = map.world[1] - map.world[0], e2 = map.world[2] - map.world[0];
  const double det = cross(d1, d2);
  map.dp_dx = (e1 * d2.y - e2 * d1.y) / det;
  map.dp_dy = (e2 * d1.x - e1 * d2.x) / det;
  map.edge1 = d1 / det, map.edge2 = d2 / det;
  map.area = glm::length(glm::cross(map.dp_dx, map.dp_dy));
  map.normal = map.shading = scene::geometricNormal(scene_, uv_.instance, triangle);
  map.even = mesh_.flat_normals || mesh_.normals.empty();
  if (!map.even && mesh_.normals[t.x] == mesh_.normals[t.y] && mesh_.normals[t.x] == mesh_.normals[t.z]) {
    map.even = true;
    map.shading = scene::shadingNormal(scene_, {uv_.instance, triangle, 0, 0});
  }
  if (!textured_) return map;
  if (texture_ != nullptr) {
    const scene::TextureRef& ref = texture_->mapping();
    const auto at = [&](int i) {
      return DVec2(ref.apply(mesh_.uv[ref.uv_set][t[i]])) * DVec2(texture_->width(), texture_->height());
    };
    map.pixel = at(0);
    const DVec2 t1 = at(1) - map.pixel, t2 = at(2) - map.pixel;
    map.dpixel_dx = (t1 * d2.y - t2 * d1.y) / det, map.dpixel_dy = (t2 * d1.x - t1 * d2.x) / det;
    map.texture_texels = std::max(glm::length(map.dpixel_dx), glm::length(map.dpixel_dy));
    // Coarser textures are smooth from look-up to look-up: interpolated.
    if (map.texture_texels > kFine) {
      for (map.level = 0; map.texture_texels > 4 && map.level < 30; ++map.level) map.texture_texels /= 2;
    }
    return map;
  }
  for (const scene::TextureRef* ref :
       {&material_.base_colour_texture, &material_.metallic_roughness_texture, &material_.emission_texture}) {
    if (!*ref || ref->uv_set > 1 || mesh_.uv[ref->uv_set].empty()) continue;
    const scene::Texture& texture = scene_.textures[ref->texture];
    if (!texture.image) continue;
    const auto at = [&](int i) {
      return DVec2(ref->apply(mesh_.uv[ref->uv_set][t[i]])) *
             DVec2(texture.image->width, texture.image->height);
    };
    const DVec2 t1 = at(1) - at(0), t2 = at(2) - at(0);
    const double across_x = glm::length((t1 * d2.y - t2 * d1.y) / det);
    const double across_y = glm::length((t2 * d1.x - t1 * d2.x) / det);
    map.texture_texels = std::max({map.texture_texels, across_x, across_y});
  }
  return map;
}

const TriangleMap& FootprintBuilder::mapOf(std::uint32_t triangle) {
  TriangleMap& map = maps_[triangle % kMaps];
  if (map.triangle != triangle) map = makeMap(triangle);
  return map;
}

Point FootprintBuilder::positionAt(const TriangleMap& map, DVec2 p) const {
  const scene::Hit hit = map.hit(0, p);
  const double b1 = static_cast<double>(hit.b1), b2 = static_cast<double>(hit.b2);
  return Point(map.world[0] + b1 * (map.world[1] - map.world[0]) + b2 * (map.world[2] - map.world[0]));
}

SurfacePoint FootprintBuilder::pointAt(const TriangleMap& map, DVec2 p) {
  SurfacePoint point;
  point.chart = chart_;
  point.instance = uv_.instance;
  point.triangle = map.triangle;
  point.position = positionAt(map, p);
  point.geometric_normal = map.normal;
  point.shading_normal = map.even ? map.shading : scene::shadingNormal(scene_, map.hit(uv_.instance, p));
  point.dp_dx = Vec3(map.dp_dx);
  point.dp_dy = Vec3(map.dp_dy);
  return point;
}

void FootprintBuilder::cut(int x, int y, std::span<const Fragment> fragments) {
  pieces_.clear();
  for (const Fragment& f : fragments) {
    Piece piece{mapOf(f.triangle), {}, static_cast<double>(f.coverage)};
    piece.polygon = clipToTexel(piece.map.page, x, y);
    if (piece.polygon.count >= 3) pieces_.push_back(piece);
  }
}

FootprintBuilder::Place FootprintBuilder::placeAt(DVec2 p) const {
  Place place;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].map.contains(p)) {
      place = {p, i};
      break;
    }
    const DVec2 q = nearestOnOutline(pieces_[i].polygon, p);
    const double distance = glm::dot(q - p, q - p);
    if (distance < best) best = distance, place = {q, i};
  }
  const Piece& piece = pieces_[place.piece];
  place.page = pulledInside(place.page, piece.map, piece.polygon);
  return place;
}

void FootprintBuilder::addSamples(std::uint32_t count, std::vector<SubSample>& samples) const {
  double total = 0;
  for (const Piece& piece : pieces_) total += area(piece.polygon);
  std::uint32_t next = 0;
  double before = 0;  // area up to the present triangle of the fans
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    const DVec2 middle = centroid(piece.polygon);
    for (int k = 0; k < piece.polygon.count && next < count; ++k) {
      const DVec2 a = piece.polygon[k], b = piece.polygon[k + 1 == piece.polygon.count ? 0 : k + 1];
      const double part = 0.5 * std::abs(cross(a - middle, b - middle));
      const bool last = i + 1 == pieces_.size() && k + 1 == piece.polygon.count;
      for (; next < count; ++next) {
        const double at = (next + 0.5) / count * total - before;
        if (at > part && !last) break;
        const double s = part > 0 ? std::min(at / part, 1.0) : 0.5;
        // Samples half a turn apart have one radius, so that their mean stays near the centroid.
        const double v = (next % (count / 2)) * kGolden + 0.25, r = std::sqrt(v - std::floor(v));
        const DVec2 p = pulledInside(middle + r * (a + s * (b - a) - middle), piece.map, piece.polygon);
        samples.push_back({positionAt(piece.map, p), piece.map.triangle});
      }
      before += part;
    }
  }
}

bool FootprintBuilder::flat(DVec2 centre, const TriangleMap& base) const {
  const glm::dvec3 origin =
      base.world[0] + base.dp_dx * (centre.x - base.page[0].x) + base.dp_dy * (centre.y - base.page[0].y);
  const double texel = std::max(glm::length(base.dp_dx), glm::length(base.dp_dy));
  for (const Piece& piece : pieces_) {
    const TriangleMap& map = piece.map;
    if (glm::length(map.dp_dx - base.dp_dx) > 0.01 * texel ||
        glm::length(map.dp_dy - base.dp_dy) > 0.01 * texel) {
      return false;
    }
    const glm::dvec3 normal = glm::normalize(glm::cross(map.dp_dx, map.dp_dy));
    if (!(glm::dot(normal, glm::cross(base.dp_dx, base.dp_dy)) > 0)) return false;
    const glm::dvec3 to = glm::max(glm::abs(origin), glm::abs(map.world[0]));
    const double spacing = 0x1p-22 * std::max({to.x, to.y, to.z, texel});  // a few floats
    for (int corner = 0; corner < 4; ++corner) {
      const glm::dvec3 p =
          origin + (corner & 1 ? 0.5 : -0.5) * base.dp_dx + (corner & 2 ? 0.5 : -0.5) * base.dp_dy;
      if (!(std::abs(glm::dot(normal, p - map.world[0])) <= spacing)) return false;
    }
  }
  return true;
}

void FootprintBuilder::addBlock(const TriangleMap& map, DVec2 p, double weight, Mean& mean) const {
  const DVec2 d = p - map.page[0];
  const Vec4 found = texture_->look(map.level, map.pixel + d.x * map.dpixel_dx + d.y * map.dpixel_dy);
  Vec3 albedo = Vec3(found) * Vec3(material_.base_colour);
  if (coloured_) albedo *= vertexColour(map, p);
  mean.albedo += static_cast<float>(weight) * albedo;
  mean.emission += static_cast<float>(weight) * found.a * material_.emission;
  mean.weight += weight * static_cast<double>(found.a), mean.all_weight += weight;
}

Vec3 FootprintBuilder::vertexColour(const TriangleMap& map, DVec2 p) const {
  const scene::Hit hit = map.hit(uv_.instance, p);
  const UVec3 t = mesh_.triangles[map.triangle];
  return Vec3((1 - hit.b1 - hit.b2) * mesh_.colours[t.x] + hit.b1 * mesh_.colours[t.y] +
              hit.b2 * mesh_.colours[t.z]);
}

void FootprintBuilder::addSurface(const TriangleMap& map, DVec2 p, double weight, Mean& mean) const {
  map.level >= 0 ? addBlock(map, p, weight, mean) : addInterpolated(map, p, weight, mean);
}

void FootprintBuilder::addInterpolated(const TriangleMap& map, DVec2 p, double weight, Mean& mean) const {
  const scene::Surface surface = scene::surfaceAt(scene_, map.hit(uv_.instance, p));
  const Vec3 albedo = surface.albedo().rgb * static_cast<float>(weight);
  const Vec3 emission = surface.emission.rgb * static_cast<float>(weight);
  mean.all_albedo += albedo, mean.all_emission += emission, mean.all_weight += weight;
  float opacity = 1;
  if (material_.alpha_mode == scene::AlphaMode::kMask) {
    opacity = surface.base_colour.a >= material_.alpha_cutoff ? 1.0f : 0.0f;
  } else if (material_.alpha_mode == scene::AlphaMode::kBlend) {
    opacity = surface.base_colour.a;
  }
  mean.albedo += albedo * opacity, mean.emission += emission * opacity;
  mean.weight += weight * static_cast<double>(opacity);
}

void FootprintBuilder::addSquare(const TriangleMap& map, int x, int y, Mean& mean) const {
  // Midpoints of n x n cells. Without a texture colours are linear in the triangle and the midpoint is exact.
  const int n = textured_ ? static_cast<int>(std::clamp(std::ceil(map.texture_texels), 2.0, 4.0)) : 1;
  const bool jitter = map.texture_texels > 4;
  const std::uint32_t stream = hashCombine(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
  for (int i = 0; i < n * n; ++i) {
    const Vec2 u = jitter ? sobol2(static_cast<std::uint32_t>(i), stream) : Vec2(0.5f);
    const DVec2 p = DVec2(x, y) + (DVec2(i % n, i / n) + DVec2(u)) / static_cast<double>(n);
    addSurface(map, p, 1.0, mean);
  }
}

void FootprintBuilder::addPiece(const Piece& piece, Mean& mean) const {
  const double wanted =
      textured_ ? piece.coverage * std::clamp(piece.map.texture_texels * piece.map.texture_texels, 4.0, 16.0)
                : 0.0;
  if (wanted <= 1.0) return addSurface(piece.map, centroid(piece.polygon), piece.coverage, mean);
  // A fan of triangles about the centroid, each cut into four until there are enough.
  const DVec2 middle = centroid(piece.polygon);
  const int count = piece.polygon.count;
  const bool quarter = wanted > 1.5 * count;
  for (int i = 0; i < count; ++i) {
    const DVec2 a = piece.polygon[i], b = piece.polygon[i + 1 == count ? 0 : i + 1];
    const double part = 0.5 * std::abs(cross(a - middle, b - middle));
    const DVec2 centre = (a + b + middle) / 3.0;
    if (!quarter) {
      addSurface(piece.map, centre, part, mean);
      continue;
    }
    addSurface(piece.map, centre, part / 4, mean);
    for (const DVec2 corner : {a, b, middle}) addSurface(piece.map, 0.5 * (corner + centre), part / 4, mean);
  }
}

void FootprintBuilder::store(const Mean& mean, SurfacePoint& point) const {
  const bool opaque = mean.opaque();
  const float scale = static_cast<float>(1.0 / (opaque ? mean.weight : mean.all_weight));
  point.albedo = Albedo((opaque ? mean.albedo : mean.all_albedo) * scale);
  point.emission = Radiance((opaque ? mean.emission : mean.all_emission) * scale);
}

SurfacePoint FootprintBuilder::build(int x, int y, std::span<const Fragment> fragments,
                                     std::vector<SubSample>& samples) {
  const DVec2 centre(x + 0.5, y + 0.5);
  SurfacePoint point;
  Mean mean;
  const bool varies = textured_ || coloured_;
  if (fragments.size() == 1 && fragments[0].coverage == 1.0f) {
    const TriangleMap& map = mapOf(fragments[0].triangle);
    point = pointAt(map, centre);
    point.area = static_cast<float>(map.area);
    if (varies) addSquare(map, x, y, mean);
  } else {
    cut(x, y, fragments);
    RELUME_CHECK(!pieces_.empty());
    const Place place = placeAt(centre);
    const TriangleMap& base = pieces_[place.piece].map;
    point = pointAt(base, place.page);
    double coverage = 0, metres = 0;
    for (const Piece& piece : pieces_) {
      coverage += piece.coverage;
      metres += piece.coverage * piece.map.area;
      if (varies) addPiece(piece, mean);
    }
    point.coverage = static_cast<float>(std::min(coverage, 1.0));
    point.area = static_cast<float>(metres);
    if (coverage >= kFull && flat(centre, base)) {
      point.position = positionAt(base, centre);
    } else {
      const double most = coverage >= kFull ? kFullSamples : kPartialSamples;
      point.first_sample = static_cast<std::uint32_t>(samples.size());
      point.sample_count =
          static_cast<std::uint32_t>(std::clamp(std::round(most * coverage), kFewestSamples, most));
      addSamples(point.sample_count, samples);
    }
  }
  if (varies) {
    if (!mean.opaque() && texture_ != nullptr) {  // blocks know nothing of what is transparent
      mean = Mean();
      const TriangleMap& map = mapOf(point.triangle);
      addInterpolated(map, centre, 1.0, mean);
    }
    store(mean, point);
  } else if (shaded_) {
    if (!constant_known_) {
      const scene::Surface surface =
          scene::surfaceAt(scene_, {uv_.instance, point.triangle, 1.0f / 3, 1.0f / 3});
      constant_.albedo = surface.albedo(), constant_.emission = surface.emission;
      constant_known_ = true;
    }
    point.albedo = constant_.albedo, point.emission = constant_.emission;
  }
  return point;
}

}  // namespace relume::atlas
