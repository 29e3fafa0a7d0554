// SPDX-License-Identifier: MIT
// Least squares over the texels that seams look up: with values v, originals o, seam samples s and their
// bilinear weights w,
//   minimise  sum_s (sum_k w_s0k v_s0k - sum_k w_s1k v_s1k)^2 + sum_i f_i (v_i - o_i)^2,
// f_i = fidelity for covered texels, a quarter of it for the others, whose values were made up anyway. In d =
// v - o:
//   (S^T S + F) d = -S^T S o,
// by conjugate gradients with the diagonal as preconditioner. The eigenvalues of F^-1 (S^T S) stay below
// about 10 / fidelity, so some tens of steps do. Every sum is formed in a fixed order. Results are clamped to
// the range of the values that the texel's own seam samples looked up, so that nothing overshoots.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "relume/atlas/texels.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::atlas {
namespace {

constexpr float kFollow = 0.25f;      // fidelity of texels that are not covered, relative
constexpr double kReduction = 1e-10;  // of the squared residual
constexpr int kMostSteps = 200;
constexpr std::size_t kGrain = 8192;

/// The numbers 0, 1, ... of the texels that seams touch, by increasing texel.
class TexelIndex {
 public:
  TexelIndex(std::span<const SeamSample> seams, std::size_t texels)
      : words_((texels + 63) / 64), before_(words_.size()) {
    for (const SeamSample& s : seams) {
      for (int side = 0; side < 2; ++side) {
        for (int k = 0; k < 4; ++k) {
          if (s.weight[side][k] == 0) continue;
          RELUME_CHECK_LT(s.texel[side][k], texels);
          words_[s.texel[side][k] / 64] |= std::uint64_t{1} << (s.texel[side][k] % 64);
        }
      }
    }
    for (std::size_t i = 0; i < words_.size(); ++i) {
      before_[i] = count_;
      count_ += static_cast<std::uint32_t>(std::popcount(words_[i]));
    }
  }
  std::uint32_t count() const { return count_; }
  std::uint32_t operator[](std::uint32_t texel) const {
    const std::uint64_t below = (std::uint64_t{1} << (texel % 64)) - 1;
    return before_[texel / 64] + static_cast<std::uint32_t>(std::popcount(words_[texel / 64] & below));
  }
  template <class Body>
  void forEach(const Body& body) const {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      std::uint32_t number = before_[i];
      for (std::uint64_t bits = words_[i]; bits != 0; bits &= bits - 1) {
        body(number++, i * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
      }
    }
  }

 private:
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;
  std::uint32_t count_ = 0;
};

/// kWidth channels of one unknown; a block of channels goes through the matrix at once.
template <std::size_t kWidth>
struct Block {
  std::array<float, kWidth> v{};

  void addScaled(float s, const Block& x) {
    for (std::size_t c = 0; c < kWidth; ++c) v[c] += s * x.v[c];
  }
};

/// S, its transpose, and the fidelity of each unknown.
class SeamSystem {
 public:
  struct Row {
    std::uint32_t unknown[8] = {};
    float weight[8] = {};
  };
  struct Entry {
    std::uint32_t row;
    float weight;
  };

  SeamSystem(std::span<const SeamSample> seams, const TexelIndex& index, std::vector<float> fidelity)
      : rows_(seams.size()),
        first_(index.count() + 2, 0),
        fidelity_(std::move(fidelity)),
        diagonal_(fidelity_) {
    forEachEntry(seams, [&](std::size_t row, std::size_t k, std::uint32_t texel, float weight) {
      const std::uint32_t i = index[texel];
      rows_[row].unknown[k] = i;
      rows_[row].weight[k] = weight;
      diagonal_[i] += weight * weight;
      ++first_[i + 2];
    });
    for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
    entries_.resize(first_.back());
    for (std::uint32_t row = 0; row < rows_.size(); ++row) {
      for (std::size_t k = 0; k < 8; ++k) {
        const float weight = rows_[row].weight[k];
        if (weight != 0) entries_[first_[rows_[row].unknown[k] + 1]++] = {row, weight};
      }
    }
    first_.pop_back();
  }

  std::size_t unknowns() const { return first_.size() - 1; }
  std::span<const Row> rows() const { return rows_; }
  std::span<const Entry> entriesOf(std::size_t unknown) const {
    return std::span(entries_).subspan(first_[unknown], first_[unknown + 1] - first_[unknown]);
  }
  float fidelity(std::size_t unknown) const { return fidelity_[unknown]; }
  float diagonal(std::size_t unknown) const { return diagonal_[unknown]; }

 private:
  template <class Body>
  static void forEachEntry(std::span<const SeamSample> seams, const Body& body) {
    for (std::size_t row = 0; row < seams.size(); ++row) {
      for (std::size_t k = 0; k < 8; ++k) {
        const float weight = seams[row].weight[k / 4][k % 4];
        if (weight != 0) body(row, k, seams[row].texel[k / 4][k % 4], k < 4 ? weight : -weight);
      }
    }
  }

  std::vector<Row> rows_;
  std::vector<std::uint32_t> first_;  // shape: [unknowns + 1], into entries_
  std::vector<Entry> entries_;
  std::vector<float> fidelity_, diagonal_;
};

template <class Body>
void forEach(std::size_t count, const Body& body) {
  parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Conjugate gradients for a block of channels, each with its own step lengths.
template <std::size_t kWidth>
class Solver {
 public:
  using Vector = std::vector<Block<kWidth>>;
  using Scalars = std::array<double, kWidth>;

  explicit Solver(const SeamSystem& system) : system_(system), seam_(system.rows().size()) {}

  /// The change of the values `original`.
  Vector solve(const Vector& original) {
    const std::size_t n = original.size();
    Vector d(n), r(n), p(n), q(n);
    multiply(original, r, 0.0f);
    forEach(n, [&](std::size_t i) {
      for (std::size_t c = 0; c < kWidth; ++c)
        r[i].v[c] = -r[i].v[c], p[i].v[c] = r[i].v[c] / system_.diagonal(i);
    });
    Scalars rz = preconditioned(r), enough;
    for (std::size_t c = 0; c < kWidth; ++c) enough[c] = kReduction * rz[c];
    for (int step = 0; step < kMostSteps && open(rz, enough); ++step) {
      multiply(p, q, 1.0f);
      const Scalars pq = dot(n, [&](std::size_t i, std::size_t c) { return p[i].v[c] * q[i].v[c]; });
      std::array<float, kWidth> alpha, beta;
      for (std::size_t c = 0; c < kWidth; ++c)
        alpha[c] = pq[c] > 0 ? static_cast<float>(rz[c] / pq[c]) : 0.0f;
      forEach(n, [&](std::size_t i) {
        for (std::size_t c = 0; c < kWidth; ++c)
          d[i].v[c] += alpha[c] * p[i].v[c], r[i].v[c] -= alpha[c] * q[i].v[c];
      });
      const Scalars next = preconditioned(r);
      for (std::size_t c = 0; c < kWidth; ++c)
        beta[c] = rz[c] > 0 ? static_cast<float>(next[c] / rz[c]) : 0.0f;
      forEach(n, [&](std::size_t i) {
        for (std::size_t c = 0; c < kWidth; ++c)
          p[i].v[c] = r[i].v[c] / system_.diagonal(i) + beta[c] * p[i].v[c];
      });
      rz = next;
    }
    return d;
  }

 private:
  static bool open(const Scalars& rz, const Scalars& enough) {
    for (std::size_t c = 0; c < kWidth; ++c) {
      if (rz[c] > enough[c]) return true;
    }
    return false;
  }

  /// y = (S^T S + with_fidelity F) x
  void multiply(const Vector& x, Vector& y, float with_fidelity) {
    forEach(seam_.size(), [&](std::size_t i) {
      const SeamSystem::Row& row = system_.rows()[i];
      Block<kWidth> sum;
      for (std::size_t k = 0; k < 8; ++k) sum.addScaled(row.weight[k], x[row.unknown[k]]);
      seam_[i] = sum;
    });
    forEach(x.size(), [&](std::size_t i) {
      Block<kWidth> sum;
      sum.addScaled(with_fidelity * system_.fidelity(i), x[i]);
      for (const SeamSystem::Entry& e : system_.entriesOf(i)) sum.addScaled(e.weight, seam_[e.row]);
      y[i] = sum;
    });
  }

  /// Sums of term(i, c), in chunks that do not depend on the number of threads.
  template <class Term>
  static Scalars dot(std::size_t count, const Term& term) {
    std::vector<Scalars> partial((count + kGrain - 1) / kGrain, Scalars{});
    parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
      Scalars sum{};
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t c = 0; c < kWidth; ++c) sum[c] += static_cast<double>(term(i, c));
      }
      partial[begin / kGrain] = sum;
    });
    Scalars total{};
    for (const Scalars& p : partial) {
      for (std::size_t c = 0; c < kWidth; ++c) total[c] += p[c];
    }
    return total;
  }
  Scalars preconditioned(const Vector& r) const {
    return dot(r.size(),
               [&](std::size_t i, std::size_t c) { return r[i].v[c] * r[i].v[c] / system_.diagonal(i); });
  }

  const SeamSystem& system_;
  Vector seam_;  // S x
};

/// Channels [first, first + count) of `values`, count <= kWidth.
template <std::size_t kWidth>
void stitchBlock(const SeamSystem& system, const TexelIndex& index, std::size_t stride, std::size_t first,
                 std::vector<float>& values) {
  const std::size_t count = std::min(kWidth, stride - first);
  std::vector<Block<kWidth>> original(index.count());
  index.forEach([&](std::uint32_t i, std::size_t texel) {
    std::copy_n(values.data() + texel * stride + first, count, original[i].v.begin());
  });
  const auto change = Solver<kWidth>(system).solve(original);
  index.forEach([&](std::uint32_t i, std::size_t texel) {
    Block<kWidth> lo = original[i], hi = lo;
    for (const SeamSystem::Entry& e : system.entriesOf(i)) {
      const SeamSystem::Row& row = system.rows()[e.row];
      for (std::size_t k = 0; k < 8; ++k) {
        if (row.weight[k] == 0) continue;
        const Block<kWidth>& seen = original[row.unknown[k]];
        for (std::size_t c = 0; c < count; ++c) {
          lo.v[c] = std::min(lo.v[c], seen.v[c]), hi.v[c] = std::max(hi.v[c], seen.v[c]);
        }
      }
    }
    for (std::size_t c = 0; c < count; ++c) {
      values[texel * stride + first + c] = std::clamp(original[i].v[c] + change[i].v[c], lo.v[c], hi.v[c]);
    }
  });
}

}  // namespace

void stitchSeams(std::span<const SeamSample> seams, int channels, std::vector<float>& values, float fidelity,
                 std::span<const std::uint8_t> covered) {
  if (seams.empty()) return;
  RELUME_CHECK_LT(0.0f, fidelity);
  const std::size_t stride = static_cast<std::size_t>(channels), texels = values.size() / stride;
  RELUME_CHECK(covered.empty() || covered.size() == texels);
  const TexelIndex index(seams, texels);
  std::vector<float> hold(index.count(), fidelity);
  if (!covered.empty()) {
    index.forEach([&](std::uint32_t i, std::size_t texel) {
      if (!covered[texel]) hold[i] = kFollow * fidelity;
    });
  }
  const SeamSystem system(seams, index, std::move(hold));
  if (stride == 1) return stitchBlock<1>(system, index, stride, 0, values);
  for (std::size_t c = 0; c < stride; c += 4) stitchBlock<4>(system, index, stride, c, values);
}

}  // namespace relume::atlas
