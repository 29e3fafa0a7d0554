// SPDX-License-Identifier: MIT
#include "light_paths/elements.h"

#include <array>
#include <atomic>
#include <cmath>
#include <memory>

#include "light_paths/vector_row.h"
#include "radiosity/row_builder.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

constexpr std::size_t kGrain = 64;  // elements
constexpr std::uint32_t kMostSweeps = 1024;
constexpr std::size_t kRow = ElementLight::kRow, kBlock = ElementLight::kBlock;

}  // namespace

Elements makeElements(const Sides& sides, const Pieces& pieces, const MeanReflectance& reflectance,
                      std::vector<std::uint32_t> of_piece, std::size_t count, std::vector<float> shape,
                      Progress& progress) {
  Elements e;
  e.of_piece = std::move(of_piece), e.shape = std::move(shape);
  e.area.assign(count, 0.0f), e.reflectance.assign(count, Vec3(0.0f));
  e.factors = FormFactors(count);
  e.of_side.assign(sides.size(), scene::kNone);
  for (std::size_t side = 0; side < sides.size(); ++side)
    if (pieces.of_side[side] != scene::kNone) e.of_side[side] = e.of_piece[pieces.of_side[side]];
  const Members members = membersOf(e.of_side, count);
  const Stage stage(progress, "form factors", count);
  parallelFor(
      count, kGrain,
      [&](std::size_t begin, std::size_t end) {
        RowBuilder row(count);
        for (std::size_t i = begin; i < end; ++i) {
          const auto own = members.of(i);
          double area = 0;
          for (const std::uint32_t side : own) area += static_cast<double>(sides.area(side));
          e.area[i] = static_cast<float>(area);
          std::uint32_t rays = 0;
          for (const std::uint32_t side : own) {
            const double share = area > 0 ? static_cast<double>(sides.area(side)) / area
                                          : 1.0 / static_cast<double>(own.size());
            e.reflectance[i] += reflectance.value[sides.point(side)] *
                                (static_cast<float>(share) * e.shape[pieces.of_side[side]]);
            for (const SideOfTexel hit : sides.ends(side)) {
              const std::uint32_t met = sides.answering(hit);
              if (met != scene::kNone && e.of_side[met] != scene::kNone)
                row.add(e.of_side[met],
                        share / sides.raysEach() * static_cast<double>(e.shape[pieces.of_side[met]]));
            }
            rays += sides.raysEach();
          }
          e.factors.set(i, row.take(), rays);
        }
      },
      &progress);
  return e;
}

FirstReflection firstReflection(const Elements& elements, const Sides& sides, const Pieces& pieces,
                                const MeanReflectance& reflectance, const PieceEntries& entries,
                                std::size_t columns, Progress& progress) {
  const Members members = membersOf(elements.of_side, elements.size());
  std::vector<std::vector<Weight>> rows(elements.size());
  parallelFor(
      elements.size(), kGrain,
      [&](std::size_t begin, std::size_t end) {
        WeightSum sum(columns);
        for (std::size_t i = begin; i < end; ++i) {
          const auto own = members.of(i);
          for (const std::uint32_t side : own) {
            const float part = elements.area[i] > 0 ? sides.area(side) / elements.area[i]
                                                    : 1.0f / static_cast<float>(own.size());
            for (const SideOfTexel hit : sides.ends(side)) {
              const std::uint32_t met = sides.answering(hit);
              if (met == scene::kNone || pieces.of_side[met] == scene::kNone) continue;
              const std::uint32_t point = sides.point(met), piece = pieces.of_side[met];
              const Vec3 seen = reflectance.value[point] *
                                (reflectance.direct[point] * part / static_cast<float>(sides.raysEach()));
              for (const EntryShare& s : entries.of(piece)) sum.add(s.entry, s.value * seen);
            }
          }
          sum.take(rows[i]);
        }
      },
      &progress);
  FirstReflection result;
  result.first.assign(1, 0);
  for (std::vector<Weight>& row : rows) {
    result.weights.insert(result.weights.end(), row.begin(), row.end());
    result.first.push_back(result.weights.size());
    row = {};
  }
  return result;
}

namespace {

using Row = std::array<float, kRow>;

/// sum_j F_ij B_j without j = i, and F_ii.
float gathered(const FormFactors& factors, std::size_t i, const float* b, Row& out) {
  VectorRow<kRow> sum;
  sum.clear();
  float own = 0;
  for (const FormFactors::Entry& f : factors.row(i)) {
    if (f.patch == i) {
      own = f.value;
    } else {
      sum.add(f.value, b + f.patch * kRow);
    }
  }
  sum.store(out.data());
  return own;
}

/// One block of columns, solved in place: what elements send out of light that has been reflected before.
class Block {
 public:
  /// sources: irradiance on elements after one reflection.
  Block(const Elements& elements, std::vector<float> sources)
      : elements_(elements), sources_(std::move(sources)), b_(sources_.size()) {
    for (std::size_t i = 0; i < elements.size(); ++i)
      for (std::size_t k = 0; k < kRow; ++k)
        b_[i * kRow + k] = elements.reflectance[i][static_cast<int>(k / kBlock)] * sources_[i * kRow + k];
  }

  std::uint32_t solve(double residual, Progress& progress) {
    for (std::uint32_t sweep = 1;; ++sweep) {
      progress.throwIfCancelled();
      double change = 0, all = 0;
      for (std::size_t i = 0; i < elements_.size(); ++i) relax(i, change, all);
      if (!(change > residual * all) || sweep == kMostSweeps) return sweep;
    }
  }
  /// What falls on an element.
  void irradiance(std::size_t i, float* out) const {
    Row sum;
    const float own = gathered(elements_.factors, i, b_.data(), sum);
    for (std::size_t k = 0; k < kRow; ++k) out[k] = sources_[i * kRow + k] + sum[k] + own * b_[i * kRow + k];
  }

 private:
  void relax(std::size_t i, double& change, double& all) {
    Row sum;
    const float own = gathered(elements_.factors, i, b_.data(), sum);
    float *b = b_.data() + i * kRow, moved = 0, total = 0;
    const float* source = sources_.data() + i * kRow;
    for (int c = 0; c < 3; ++c) {
      const float rho = elements_.reflectance[i][c], scale = rho / (1.0f - rho * own);
      for (std::size_t k = 0; k < kBlock; ++k) {
        const std::size_t at = static_cast<std::size_t>(c) * kBlock + k;
        const float next = (source[at] + sum[at]) * scale;
        moved += std::abs(next - b[at]), total += std::abs(next);
        b[at] = next;
      }
    }
    change += static_cast<double>(moved * elements_.area[i]);
    all += static_cast<double>(total * elements_.area[i]);
  }

  const Elements& elements_;
  std::vector<float> sources_, b_;
};

}  // namespace

ElementLight::ElementLight(const Elements& elements, std::size_t columns, const Fill& fill, double residual,
                           Progress& progress)
    : columns_(columns), elements_(elements.size()), light_(blocks() * elements.size() * kRow) {
  const Stage stage(progress, "reflections", blocks());
  std::vector<std::uint32_t> sweeps(blocks());
  parallelFor(
      blocks(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
          std::vector<float> sources(elements_ * kRow, 0.0f);
          fill(block, sources);
          Block solver(elements, std::move(sources));
          sweeps[block] = solver.solve(residual, progress);
          for (std::size_t i = 0; i < elements_; ++i)
            solver.irradiance(i, light_.data() + (block * elements_ + i) * kRow);
        }
      },
      &progress);
  for (const std::uint32_t s : sweeps) sweeps_ = std::max(sweeps_, s);
}

}  // namespace relume::transport
