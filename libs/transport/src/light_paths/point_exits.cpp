// SPDX-License-Identifier: MIT
#include "light_paths/point_exits.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "light_paths/light_walks.h"
#include "relume/basis/sh9.h"
#include "relume/core/error.h"
#include "relume/core/frame.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kProbeViews = 256;  // rays that tell whether a place is free
constexpr std::uint32_t kMostProbes = 1u << 20;
constexpr float kFootShare = 1.0f / 3;  // of a triangle, along its sides
constexpr float kNormalSteps = 1024;    // normals that agree to this are one

using VertexKey = std::tuple<float, float, float, int, int, int>;

VertexKey keyOf(Point p, Normal n) {
  const auto round = [](float v) { return static_cast<int>(std::lround(v * kNormalSteps)); };
  return {p.x, p.y, p.z, round(n.x), round(n.y), round(n.z)};
}

scene::Hit cornerOf(std::uint32_t instance, std::uint32_t triangle, std::uint32_t corner) {
  return {instance, triangle, corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f};
}

/// Barycentrics of the place of a triangle nearest to p, in its plane, clamped.
Vec3 barycentrics(Point a, Point b, Point c, Point p) {
  const Vec3 n = glm::cross(b - a, c - a);
  const float all = glm::dot(n, n);
  if (!(all > 0)) return {1, 0, 0};
  Vec3 w(0, glm::dot(glm::cross(p - a, c - a), n) / all, glm::dot(glm::cross(b - a, p - a), n) / all);
  w.x = 1 - w.y - w.z;
  w = glm::max(w, Vec3(0));
  return w / (w.x + w.y + w.z);
}

}  // namespace

PointExits vertexExits(const scene::Scene& scene, const atlas::Atlas& atlas, const atlas::Texels& texels) {
  PointExits points;
  points.exits.rows_each = 1;
  std::map<VertexKey, std::uint32_t> numbers;
  std::vector<std::vector<Foot>> feet;
  std::vector<std::vector<std::array<std::uint32_t, 3>>> exits_of(scene.instances.size());
  for (const atlas::InstanceUv& uv : atlas.instances) {
    const scene::Mesh& mesh = scene.meshes[scene.instances[uv.instance].mesh];
    auto& own = exits_of[uv.instance];
    own.resize(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      std::array<Point, 3> p;
      for (std::uint32_t k = 0; k < 3; ++k) p[k] = scene::worldPosition(scene, cornerOf(uv.instance, t, k));
      const float area = 0.5f * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
      if (!(area > 0)) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Normal n = scene::shadingNormal(scene, cornerOf(uv.instance, t, k));
        const auto [at, fresh] = numbers.try_emplace(keyOf(p[k], n), static_cast<std::uint32_t>(feet.size()));
        if (fresh) {
          feet.emplace_back();
          Exit& exit = points.exits.all.emplace_back();
          exit.position = p[k], exit.normal = n;
        }
        feet[at->second].push_back({uv.instance, t, k, area});
        points.exits.all[at->second].area += area / 3;
        own[t][k] = at->second;
      }
    }
  }
  points.first_foot.push_back(0);
  for (const auto& f : feet) {
    points.feet.insert(points.feet.end(), f.begin(), f.end());
    points.first_foot.push_back(static_cast<std::uint32_t>(points.feet.size()));
  }
  for (const atlas::SurfacePoint& p : texels.points) {
    const auto corner = [&](std::uint32_t k) {
      return scene::worldPosition(scene, cornerOf(p.instance, p.triangle, k));
    };
    points.exits.vertices_of_texel.push_back(
        {exits_of[p.instance][p.triangle], barycentrics(corner(0), corner(1), corner(2), p.position)});
  }
  return points;
}

PointExits probeExits(const trace::Tracer& tracer, const Box3& box, float spacing) {
  PointExits points;
  points.exits.rows_each = basis::kSh9;
  ProbeGrid& grid = points.exits.grid;
  grid.spacing = spacing;
  const glm::dvec3 cells = glm::max(glm::ceil(glm::dvec3(box.extent()) / static_cast<double>(spacing)), 1.0);
  if (!(cells.x * cells.y * cells.z <= kMostProbes))
    throw Error(ErrorCode::kUsage, "light paths", "the grid has more than a million probes",
                "place them farther apart (spacing=)");
  grid.count = UVec3(cells);
  grid.origin = box.centre() - 0.5f * spacing * (Vec3(grid.count) - 1.0f);
  const std::size_t places = std::size_t{grid.count.x} * grid.count.y * grid.count.z;
  const auto placeOf = [&](std::size_t i) {
    return grid.origin +
           spacing * Vec3(i % grid.count.x, i / grid.count.x % grid.count.y, i / grid.count.x / grid.count.y);
  };
  std::vector<std::uint8_t> free(places);
  parallelFor(places, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::uint32_t met = 0, backs = 0;
      for (std::uint32_t k = 0; k < kProbeViews; ++k) {
        const trace::RayHit hit = tracer.intersect({placeOf(i), squareToSphere(sobol2(k, 0)), kInfinity}, k);
        met += static_cast<bool>(hit), backs += hit && hit.back_face;
      }
      free[i] = met > 0 && static_cast<float>(backs) <= kBuriedShare * static_cast<float>(met);
    }
  });
  grid.exit.assign(places, scene::kNone);
  for (std::size_t i = 0; i < places; ++i) {
    if (!free[i]) continue;
    grid.exit[i] = static_cast<std::uint32_t>(points.exits.all.size());
    Exit& exit = points.exits.all.emplace_back();
    exit.position = placeOf(i), exit.area = spacing * spacing;
  }
  if (points.exits.all.empty())
    throw Error(ErrorCode::kEmptyScene, "light paths", "no probe finds room",
                "place probes closer together (spacing=)");
  return points;
}

PointRays::PointRays(const ExitScene& scene, const PointExits& points)
    : scene_(scene),
      points_(points),
      direct_(points.exits.rows_each, WeightSum(scene.pieces.size())),
      reflected_(points.exits.rows_each, WeightSum(scene.elements.size())) {}

void PointRays::look(std::size_t exit, std::span<ExitView> views) {
  for (ExitView& view : views) view.direct.clear(), view.reflected.clear();
  if (points_.first_foot.empty()) {
    lookFromProbe(exit, views);
  } else {
    lookFromVertex(exit, views[0]);
  }
}

PointRays::Seen PointRays::seen(const trace::Ray& ray, std::uint32_t stream, bool& back) const {
  const trace::RayHit hit = scene_.surface.tracer.intersect(ray, stream);
  back = hit && hit.back_face;
  if (!hit || back) return {};
  const std::uint32_t side = sideWhere(scene_.surface, scene_.sides, ray, hit);
  if (side == scene::kNone) return {};
  const std::uint32_t point = scene_.sides.point(side);
  return {scene_.pieces.of_side[side], scene_.reflectance.value[point], scene_.reflectance.direct[point]};
}

void PointRays::lookFromVertex(std::size_t exit, ExitView& view) {
  const auto feet =
      std::span(points_.feet)
          .subspan(points_.first_foot[exit], points_.first_foot[exit + 1] - points_.first_foot[exit]);
  const scene::Scene& scene = scene_.surface.tracer.scene();
  const Exit& vertex = points_.exits.all[exit];
  const Frame frame = Frame::about(vertex.normal);
  const std::uint32_t stream = streamOf(scene_.seed, static_cast<std::uint32_t>(exit), 0x76657274u);
  float area = 0;
  for (const Foot& f : feet) area += f.area;
  std::uint32_t backs = 0;
  for (std::uint32_t i = 0; i < scene_.rays; ++i) {
    const Vec2 u = sobol2(i, stream), v = sobol2(i, hashCombine(stream, 1)),
               w = sobol2(i, hashCombine(stream, 2));
    float left = w.x * area;
    std::size_t k = 0;
    while (k + 1 < feet.size() && left >= feet[k].area) left -= feet[k++].area;
    const Foot& foot = feet[k];
    const float root = std::sqrt(v.x), b = kFootShare * root * (1 - v.y), c = kFootShare * root * v.y;
    Vec3 weight(0);  // of corners, from this one on
    weight[static_cast<int>(foot.corner)] = 1 - b - c;
    weight[static_cast<int>((foot.corner + 1) % 3)] = b, weight[static_cast<int>((foot.corner + 2) % 3)] = c;
    const Point from = scene::worldPosition(scene, {foot.instance, foot.triangle, weight.y, weight.z});
    const Normal n = scene::geometricNormal(scene, foot.instance, foot.triangle);
    const Direction d = frame.toWorld(squareToCosineHemisphere(u));
    if (!(glm::dot(d, n) > 0)) continue;
    bool back = false;
    const Seen s = seen({trace::offsetOrigin(from, n), d, kInfinity}, hashCombine(stream, i), back);
    backs += back;
    if (s.piece == scene::kNone) continue;
    direct_[0].add(s.piece, s.reflectance * s.direct);
    reflected_[0].add(scene_.elements.of_piece[s.piece], s.reflectance);
  }
  direct_[0].take(view.direct), reflected_[0].take(view.reflected);
  const float share = backs < scene_.rays ? 1.0f / static_cast<float>(scene_.rays - backs) : 0.0f;
  for (Weight& w : view.direct) w.value *= share;
  for (Weight& w : view.reflected) w.value *= share;
}

void PointRays::lookFromProbe(std::size_t exit, std::span<ExitView> views) {
  const Point from = points_.exits.all[exit].position;
  const std::uint32_t stream = streamOf(scene_.seed, static_cast<std::uint32_t>(exit), 0x70726f62u);
  // Radiance rho E / pi of a direction counts 4 pi / rays; irradiance has A_l more.
  const float share = 4.0f / static_cast<float>(scene_.rays);
  for (std::uint32_t i = 0; i < scene_.rays; ++i) {
    const Direction d = squareToSphere(sobol2(i, stream));
    bool back = false;
    const Seen s = seen({from, d, kInfinity}, hashCombine(stream, i), back);
    if (s.piece == scene::kNone) continue;
    const auto y = basis::sh9(d);
    for (std::size_t k = 0; k < views.size(); ++k) {
      const Vec3 weight = s.reflectance * (share * basis::kCosineLobe[k] * y[k]);
      direct_[k].add(s.piece, weight * s.direct);
      reflected_[k].add(scene_.elements.of_piece[s.piece], weight);
    }
  }
  for (std::size_t k = 0; k < views.size(); ++k)
    direct_[k].take(views[k].direct), reflected_[k].take(views[k].reflected);
}

}  // namespace relume::transport
