// SPDX-License-Identifier: MIT
// The transfer of a scene that needs no other library: two rooms of 8 x 6 x 3.2 m with a door between them
// and six boxes in them, by radiosity (Lambert's form factors of polygons, visibility by segments, an LU
// solution). It has what real transfer has: near fields at creases, a dark room, colour bleeding. For tests
// and benchmarks of the codecs.
#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "relume/core/kmeans.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"
#include "relume/core/vec.h"

namespace relume::codec::test {

struct TwoRoomsSize {
  std::size_t elements = 1000;  ///< about as many
  std::size_t entries = 128;
  std::size_t rows = 1000;  ///< about as many
};

class TwoRooms {
 public:
  explicit TwoRooms(const TwoRoomsSize& size) : entries(size.entries) {
    makeSurfaces();
    const std::vector<Cell> elements = cells(size.elements), receivers = cells(size.rows);
    rows = receivers.size();
    for (const Cell& c : receivers) {
      row_position.push_back(c.centre());
      row_normal.push_back(c.normal);
    }
    makeEntries(elements);
    solve(elements, receivers);
  }

  std::size_t rows = 0, entries = 0;
  std::vector<Vec3> row_position, row_normal, entry_position, entry_normal;
  /// Irradiance at a row for unit irradiance on an entry; shape: [rows][3][entries]
  std::vector<float> transfer;

  bool free(Vec3 p, float distance) const {
    if (p.x < distance || p.x > 16 - distance || p.y < distance || p.y > 3.2f - distance || p.z < distance ||
        p.z > 6 - distance)
      return false;
    const bool in_door = p.z > kDoor0 + distance && p.z < kDoor1 - distance && p.y < kDoorTop - distance;
    if (std::abs(p.x - kWall) < distance && !in_door) return false;
    return std::all_of(boxes_.begin(), boxes_.end(),
                       [&](const Box3& b) { return b.distance(p) >= distance; });
  }

  /// Points of free space, at least `distance` from surfaces.
  std::vector<Vec3> lightPositions(std::size_t count, std::uint32_t seed, float distance) const {
    std::vector<Vec3> out;
    for (std::uint32_t i = 0; out.size() < count; ++i) {
      const Vec2 a = sobol2(i, streamOf(seed, 0, 0)), b = sobol2(i, streamOf(seed, 0, 1));
      const Vec3 p(16 * a.x, 3.2f * a.y, 6 * b.x);
      if (free(p, distance)) out.push_back(p);
    }
    return out;
  }

  /// Irradiance of point lights of unit intensity on the entries. shape: [lights][entries]
  std::vector<float> light(const std::vector<Vec3>& positions) const {
    std::vector<float> out(positions.size() * entries);
    parallelFor(positions.size(), 1, [&](std::size_t l, std::size_t) {
      for (const Sample& s : samples_) {
        const Vec3 d = positions[l] - s.position;
        const float cosine = glm::dot(d, s.normal), r2 = glm::dot(d, d);
        if (cosine > 0 && sees(s.position + 1e-4f * s.normal, positions[l]))
          out[l * entries + s.entry] += s.share * cosine / (r2 * std::sqrt(r2));
      }
    });
    return out;
  }

 private:
  static constexpr float kWall = 8, kDoor0 = 2.4f, kDoor1 = 3.6f, kDoorTop = 2.2f;

  struct Surface {
    Vec3 origin, u, v, normal, albedo;
  };
  struct Cell {
    Vec3 origin, u, v, normal, albedo;
    Vec3 centre() const { return origin + 0.5f * (u + v); }
    float area() const { return glm::length(glm::cross(u, v)); }
  };
  struct Sample {
    Vec3 position, normal;
    std::size_t entry;
    float share;  // of the entry's area
  };

  void add(Vec3 origin, Vec3 u, Vec3 v, Vec3 albedo) {
    surfaces_.push_back({origin, u, v, glm::normalize(glm::cross(u, v)), albedo});
  }

  void makeSurfaces() {
    const Vec3 floor(0.45f, 0.35f, 0.25f), ceiling(0.8f), white(0.7f), red(0.65f, 0.15f, 0.12f),
        blue(0.15f, 0.25f, 0.6f);
    for (const float x : {0.0f, 8.0f}) {
      add({x, 0, 0}, {0, 0, 6}, {8, 0, 0}, floor);
      add({x, 3.2f, 0}, {8, 0, 0}, {0, 0, 6}, ceiling);
      add({x, 0, 0}, {8, 0, 0}, {0, 3.2f, 0}, white);
      add({x, 0, 6}, {0, 3.2f, 0}, {8, 0, 0}, white);
    }
    add({0, 0, 0}, {0, 3.2f, 0}, {0, 0, 6}, red);
    add({16, 0, 0}, {0, 0, 6}, {0, 3.2f, 0}, blue);
    const std::array<std::array<float, 4>, 3> walls{
        // z0, z1, y0, y1 around the door
        {{0, kDoor0, 0, 3.2f}, {kDoor1, 6, 0, 3.2f}, {kDoor0, kDoor1, kDoorTop, 3.2f}}};
    for (const auto& w : walls) {
      add({kWall, w[2], w[0]}, {0, 0, w[1] - w[0]}, {0, w[3] - w[2], 0}, white);  // faces -x
      add({kWall, w[2], w[0]}, {0, w[3] - w[2], 0}, {0, 0, w[1] - w[0]}, white);
    }
    boxes_ = {Box3{{1, 0, 1}, {2.8f, 0.8f, 2}},       Box3{{4.5f, 0, 3.8f}, {5.7f, 1.8f, 4.6f}},
              Box3{{0.6f, 0, 4.4f}, {1.6f, 2, 5.4f}}, Box3{{10, 0, 0.8f}, {11.5f, 1, 2.2f}},
              Box3{{13, 0, 3}, {14.5f, 0.6f, 5}},     Box3{{9, 0, 4.6f}, {10, 1.6f, 5.4f}}};
    for (const Box3& b : boxes_) {
      const Vec3 e = b.extent(), albedo(0.6f, 0.5f, 0.3f);
      const Vec3 x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
      add(b.lo + y, z, x, albedo);
      add(b.lo, y, x, albedo);
      add(b.lo + z, x, y, albedo);
      add(b.lo, z, y, albedo);
      add(b.lo + x, y, z, albedo);
    }
  }

  std::vector<Cell> cells(std::size_t count) const {
    float area = 0;
    for (const Surface& s : surfaces_) area += glm::length(glm::cross(s.u, s.v));
    const float side = std::sqrt(area / static_cast<float>(count));
    std::vector<Cell> out;
    for (const Surface& s : surfaces_) {
      const int n = std::max(1, static_cast<int>(std::lround(glm::length(s.u) / side)));
      const int m = std::max(1, static_cast<int>(std::lround(glm::length(s.v) / side)));
      const Vec3 u = s.u / static_cast<float>(n), v = s.v / static_cast<float>(m);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j)
          out.push_back(
              {s.origin + static_cast<float>(i) * u + static_cast<float>(j) * v, u, v, s.normal, s.albedo});
    }
    return out;
  }

  bool sees(Vec3 a, Vec3 b) const {
    if ((a.x - kWall) * (b.x - kWall) < 0) {
      const Vec3 p = a + (kWall - a.x) / (b.x - a.x) * (b - a);
      if (p.z < kDoor0 || p.z > kDoor1 || p.y > kDoorTop) return false;
    }
    const Vec3 d = b - a;
    return std::none_of(boxes_.begin(), boxes_.end(), [&](const Box3& box) {
      float t0 = 0, t1 = 1;
      for (int k = 0; k < 3; ++k) {
        if (d[k] == 0) {
          if (a[k] <= box.lo[k] || a[k] >= box.hi[k]) return false;
          continue;
        }
        const float near = (box.lo[k] - a[k]) / d[k], far = (box.hi[k] - a[k]) / d[k];
        t0 = std::max(t0, std::min(near, far));
        t1 = std::min(t1, std::max(near, far));
      }
      return t0 < t1;
    });
  }

  // Of a point and the part of a cell above its horizon (Lambert 1760), all visible.
  static float formFactor(Vec3 p, Vec3 n, const Cell& cell) {
    const std::array<Vec3, 4> corner{cell.origin - p, cell.origin + cell.u - p,
                                     cell.origin + cell.u + cell.v - p, cell.origin + cell.v - p};
    std::array<Vec3, 5> polygon;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 a = corner[i], b = corner[(i + 1) % 4];
      const float ha = glm::dot(a, n), hb = glm::dot(b, n);
      if (ha > 0) polygon[count++] = glm::normalize(a);
      if ((ha > 0) != (hb > 0)) polygon[count++] = glm::normalize(a + ha / (ha - hb) * (b - a));
    }
    float sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 a = polygon[i], b = polygon[(i + 1) % count], c = glm::cross(a, b);
      const float sine = glm::length(c);
      if (sine > 1e-12f) sum += std::atan2(sine, glm::dot(a, b)) / sine * glm::dot(c, n);
    }
    return std::abs(sum) / (2 * kPi);
  }

  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Matrix formFactors(const std::vector<Cell>& from, const std::vector<Cell>& to) const {
    Matrix f = Matrix::Zero(static_cast<Eigen::Index>(from.size()), static_cast<Eigen::Index>(to.size()));
    parallelFor(from.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 p = from[i].centre() + 1e-4f * from[i].normal;
        for (std::size_t j = 0; j < to.size(); ++j) {
          const Cell& c = to[j];
          if (glm::dot(p - c.origin, c.normal) <= 1e-3f) continue;
          int seen = 0;
          for (const float u : {0.25f, 0.75f})
            for (const float v : {0.25f, 0.75f})
              seen += sees(p, c.origin + u * c.u + v * c.v + 1e-4f * c.normal) ? 1 : 0;
          if (seen > 0)
            f(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                0.25f * static_cast<float>(seen) * formFactor(p, from[i].normal, c);
        }
      }
    });
    return f;
  }

  void makeEntries(const std::vector<Cell>& elements) {
    std::vector<float> features, weights;
    float area = 0;
    for (const Cell& c : elements) area += c.area();
    const float normal_length = 4 * std::sqrt(area / static_cast<float>(entries));
    for (const Cell& c : elements) {
      const Vec3 p = c.centre(), n = normal_length * c.normal;
      features.insert(features.end(), {p.x, p.y, p.z, n.x, n.y, n.z});
      weights.push_back(c.area());
    }
    const KMeans k = kMeans(features, 6, weights, {.clusters = entries});
    entry_of_ = k.label;
    std::vector<float> entry_area(entries);
    for (std::size_t i = 0; i < elements.size(); ++i) entry_area[entry_of_[i]] += weights[i];
    for (std::size_t e = 0; e < entries; ++e) {
      const float* c = &k.centre[6 * e];
      entry_position.emplace_back(c[0], c[1], c[2]);
      entry_normal.push_back(glm::normalize(Vec3(c[3], c[4], c[5])));
    }
    for (std::size_t i = 0; i < elements.size(); ++i)
      for (const float u : {0.25f, 0.75f})
        for (const float v : {0.25f, 0.75f})
          samples_.push_back({elements[i].origin + u * elements[i].u + v * elements[i].v, elements[i].normal,
                              entry_of_[i], 0.25f * weights[i] / entry_area[entry_of_[i]]});
  }

  void solve(const std::vector<Cell>& elements, const std::vector<Cell>& receivers) {
    const Matrix f = formFactors(elements, elements), gather = formFactors(receivers, elements);
    const Eigen::Index n = f.rows(), columns = static_cast<Eigen::Index>(entries);
    transfer.resize(rows * 3 * entries);
    for (int channel = 0; channel < 3; ++channel) {
      Matrix system = Matrix::Identity(n, n), emitted = Matrix::Zero(n, columns);
      for (Eigen::Index i = 0; i < n; ++i) {
        const float albedo = elements[static_cast<std::size_t>(i)].albedo[channel];
        system.row(i) -= albedo * f.row(i);
        emitted(i, entry_of_[static_cast<std::size_t>(i)]) = albedo;
      }
      const Matrix result = gather * system.partialPivLu().solve(emitted);
      for (std::size_t r = 0; r < rows; ++r)
        Eigen::Map<Eigen::RowVectorXf>(&transfer[(r * 3 + static_cast<std::size_t>(channel)) * entries],
                                       columns) = result.row(static_cast<Eigen::Index>(r));
    }
  }

  std::vector<Surface> surfaces_;
  std::vector<Box3> boxes_;
  std::vector<std::uint32_t> entry_of_;  // of each element
  std::vector<Sample> samples_;
};

}  // namespace relume::codec::test
