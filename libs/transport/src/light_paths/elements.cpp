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
                      std::vector<std::uint32_t> of_piece, std::size_t count, Progress& progress) {
  Elements e;
  e.of_piece = std::move(of_piece);
  e.area.assign(count, 0.0f), e.reflectance.assign(count, Vec3(0.0f));
  e.factors = FormFactors(count);
  std::vector<std::uint32_t> of_side(sides.size(), scene::kNone);
  for (std::size_t side = 0; side < of_side.size(); ++side)
    if (pieces.of_side[side] != scene::kNone) of_side[side] = e.of_piece[pieces.of_side[side]];
  const Members members = membersOf(of_side, count);
  std::vector<std::vector<Weight>> sources(count);
  const Stage stage(progress, "form factors", count);
  parallelFor(
      count, kGrain,
      [&](std::size_t begin, std::size_t end) {
        RowBuilder row(count);
        WeightSum sum(pieces.size());
        for (std::size_t i = begin; i < end; ++i) {
          const auto own = members.of(i);
          double area = 0;
          for (const std::uint32_t side : own) area += static_cast<double>(sides.area(side));
          e.area[i] = static_cast<float>(area);
          std::uint32_t rays = 0;
          for (const std::uint32_t side : own) {
            const double share = area > 0 ? static_cast<double>(sides.area(side)) / area
                                          : 1.0 / static_cast<double>(own.size());
            const std::uint32_t point = sides.point(side);
            const Vec3 rho = reflectance.value[point] * static_cast<float>(share);
            e.reflectance[i] += rho;
            sum.add(pieces.of_side[side], rho * reflectance.direct[point]);
            for (const SideOfTexel hit : sides.ends(side)) {
              const std::uint32_t met = sides.answering(hit);
              if (met != scene::kNone && of_side[met] != scene::kNone)
                row.add(of_side[met], share / sides.raysEach());
            }
            rays += sides.raysEach();
          }
          e.factors.set(i, row.take(), rays);
          sum.take(sources[i]);
        }
      },
      &progress);
  e.first_source.assign(1, 0);
  for (const std::vector<Weight>& s : sources) {
    e.sources.insert(e.sources.end(), s.begin(), s.end());
    e.first_source.push_back(static_cast<std::uint32_t>(e.sources.size()));
  }
  return e;
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

/// Radiosity of one block of columns, found in place.
class Block {
 public:
  Block(const Elements& elements, std::vector<float> sources)
      : elements_(elements), sources_(std::move(sources)), b_(sources_) {}

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
    for (std::size_t k = 0; k < kRow; ++k) out[k] = sum[k] + own * b_[i * kRow + k];
  }

 private:
  void relax(std::size_t i, double& change, double& all) {
    Row sum;
    const float own = gathered(elements_.factors, i, b_.data(), sum);
    float *b = b_.data() + i * kRow, moved = 0, total = 0;
    const float* source = sources_.data() + i * kRow;
    for (int c = 0; c < 3; ++c) {
      const float rho = elements_.reflectance[i][c], scale = 1.0f / (1.0f - rho * own);
      for (std::size_t k = 0; k < kBlock; ++k) {
        const std::size_t at = static_cast<std::size_t>(c) * kBlock + k;
        const float next = (source[at] + rho * sum[at]) * scale;
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
