// SPDX-License-Identifier: MIT
// Samples stay in the order of the file, each plane padded to whole words, so neighbouring invocations read
// neighbouring words. Differs from the product of the run-time library (block_product.h) in that coefficients
// stay floats.
#include "product_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "relume/core/error.h"
#include "relume/render/context.h"

namespace relume::render {
namespace {

constexpr std::uint32_t kGroup = 64;  // local_size_x of the small shaders
constexpr std::uint32_t kWords = 32;  // words of a plane that one group of relight_planes takes
constexpr std::uint32_t kSlices = 8;  // invocations that share a word's components on a GPU

struct GpuComponent {
  std::uint32_t weights, place, words;
  float scale;
};
struct GpuChunk {
  std::uint32_t planes, words, word, blocks, rows, components, unused[2];
};
struct GpuCluster {
  std::uint32_t first, places;
};

std::uint32_t wordsFor(std::size_t samples, std::size_t per_word) {
  return static_cast<std::uint32_t>((samples + per_word - 1) / per_word);
}

void requireRoom(std::size_t words) {
  GLint64 most = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  if (words * 4 > static_cast<std::uint64_t>(most) || words > std::numeric_limits<std::uint32_t>::max())
    throw Error(
        ErrorCode::kUnsupported, "the transfer",
        fmt::format("has {} MiB of samples, and this OpenGL reads {} MiB at most", words >> 18, most >> 20),
        "take --renderer cpu, or bake it with fewer entries or a larger error");
}

}  // namespace

ProductPass::ProductPass(const codec::BlockMatrix& m)
    : rows_(m.rows),
      clusters_(static_cast<std::uint32_t>(m.clusters())),
      components_(static_cast<std::uint32_t>(m.components())),
      words_(4 / (m.bits / 8)) {
  const std::string defines =
      fmt::format("#define BITS {}\n#define CHANNELS {}\n#define WORDS {}\n#define SLICES {}\n", m.bits,
                  m.channels, kWords, isSoftware() ? 1 : kSlices);
  lit_program_ = Program::compute("relight_lit.comp.glsl");
  weights_program_ = Program::compute("relight_weights.comp.glsl", defines);
  planes_program_ = Program::compute("relight_planes.comp.glsl", defines);
  gather_program_ = Program::compute("relight_gather.comp.glsl");

  place_.resize(m.columns);
  std::vector<GpuCluster> clusters;
  std::uint32_t places = 0;
  for (std::size_t c = 0; c < m.clusters(); ++c) {
    const std::uint32_t begin = m.cluster_first[c], count = m.cluster_first[c + 1] - begin;
    for (std::uint32_t j = 0; j < count; ++j) place_[m.cluster_column[begin + j]] = places + j;
    clusters.push_back({places, count});
    places += wordsFor(count, words_) * words_;
  }
  x_ = Buffer(places * sizeof(Vec4));
  x_.clear();
  clusters_buffer_ = Buffer(clusters);
  lit_ = Buffer(clusters.size() * 4);

  if (m.bits == 8)
    placeSamples(m, m.planes8, m.weights8);
  else
    placeSamples(m, m.planes16, m.weights16);
  coefficients_ = Buffer(std::size_t{components_} * sizeof(Vec4));
  block_first_ = Buffer(m.component_first);
  exits_ = Buffer(std::size_t{rows_} * sizeof(Vec4));
  exits_.clear();
}

template <class Q>
void ProductPass::placeSamples(const codec::BlockMatrix& m, const std::vector<Q>& planes,
                               const std::vector<Q>& weights) {
  constexpr float kMost = std::numeric_limits<Q>::max();
  std::vector<GpuComponent> components;
  std::vector<std::uint32_t> cluster_of;
  std::vector<GpuChunk> chunks;
  std::vector<std::vector<std::uint32_t>> places_of_row(m.rows);
  std::size_t plane_words = 0, weight_words = 0;
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    const std::size_t count = m.component_first[(t + 1) * m.clusters()] - m.component_first[t * m.clusters()];
    plane_words += count * m.channels * wordsFor(m.tile_first[t + 1] - m.tile_first[t], words_);
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const std::size_t b = t * m.clusters() + c;
      weight_words += std::size_t{m.component_first[b + 1] - m.component_first[b]} *
                      wordsFor(m.cluster_first[c + 1] - m.cluster_first[c], words_);
    }
  }
  requireRoom(std::max(plane_words, weight_words));
  std::vector<std::uint32_t> plane_data(plane_words), weight_data(weight_words);
  const Q* plane = planes.data();
  const Q* weight = weights.data();
  std::uint32_t plane_at = 0, weight_at = 0, row_at = 0, place = 0;
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    const std::uint32_t rows = m.tile_first[t + 1] - m.tile_first[t], words = wordsFor(rows, words_);
    for (std::uint32_t w = 0; w < words; w += kWords)
      chunks.push_back({plane_at,
                        words,
                        w,
                        static_cast<std::uint32_t>(t * m.clusters()),
                        row_at,
                        m.component_first[t * m.clusters()],
                        {}});
    for (std::uint32_t i = 0; i < rows; ++i)
      places_of_row[m.tile_row[m.tile_first[t] + i]].push_back(row_at + i);
    row_at += words * words_;
    place = 0;
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const std::uint32_t columns = m.cluster_first[c + 1] - m.cluster_first[c],
                          column_words = wordsFor(columns, words_);
      const std::size_t b = t * m.clusters() + c;
      for (std::uint32_t k = m.component_first[b]; k < m.component_first[b + 1]; ++k) {
        components.push_back({weight_at, place, column_words, m.scale[k] * kMost});
        cluster_of.push_back(static_cast<std::uint32_t>(c));
        std::memcpy(weight_data.data() + weight_at, weight, columns * sizeof(Q));
        weight += columns, weight_at += column_words;
        for (std::uint32_t channel = 0; channel < m.channels; ++channel, plane += rows, plane_at += words)
          std::memcpy(plane_data.data() + plane_at, plane, rows * sizeof(Q));
      }
      place += column_words * words_;
    }
  }
  planes_ = Buffer(plane_data);
  weights_ = Buffer(weight_data);
  component_ = Buffer(components);
  cluster_of_ = Buffer(cluster_of);
  chunks_ = static_cast<std::uint32_t>(chunks.size());
  chunks_buffer_ = Buffer(chunks);
  tile_rows_ = Buffer(row_at * sizeof(Vec4));
  std::vector<std::uint32_t> first{0}, from;
  for (const auto& places : places_of_row) {
    from.insert(from.end(), places.begin(), places.end());
    first.push_back(static_cast<std::uint32_t>(from.size()));
  }
  first_ = Buffer(first);
  from_ = Buffer(from);
}

void ProductPass::write(std::span<const Irradiance> x) {
  std::vector<Vec4> placed(x_.bytes() / sizeof(Vec4), Vec4(0));
  for (std::size_t j = 0; j < x.size(); ++j) placed[place_[j]] = Vec4(x[j].rgb, 0);
  x_.write(0, placed.size() * sizeof(Vec4), placed.data());
}

void ProductPass::multiply() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  x_.bindStorage(1);
  clusters_buffer_.bindStorage(2);
  lit_.bindStorage(3);
  lit_program_.set("u_clusters", clusters_);
  lit_program_.dispatch(clusters_, kGroup);

  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  component_.bindStorage(2);
  weights_.bindStorage(3);
  coefficients_.bindStorage(4);
  lit_.bindStorage(5);
  cluster_of_.bindStorage(6);
  weights_program_.set("u_components", components_);
  weights_program_.dispatch(components_, kGroup);

  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  chunks_buffer_.bindStorage(1);
  planes_.bindStorage(2);
  coefficients_.bindStorage(3);
  block_first_.bindStorage(4);
  lit_.bindStorage(5);
  tile_rows_.bindStorage(6);
  planes_program_.set("u_clusters", clusters_);
  planes_program_.set("u_chunks", chunks_);
  planes_program_.dispatch(chunks_, 1);

  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  first_.bindStorage(1);
  from_.bindStorage(2);
  tile_rows_.bindStorage(3);
  exits_.bindStorage(4);
  gather_program_.set("u_rows", rows_);
  gather_program_.dispatch(rows_, kGroup);
}

std::vector<Irradiance> ProductPass::readExits() const {
  std::vector<Vec4> raw(rows_);
  exits_.read(0, raw.size() * sizeof(Vec4), raw.data());
  std::vector<Irradiance> out;
  out.reserve(raw.size());
  for (const Vec4& v : raw) out.emplace_back(Vec3(v));
  return out;
}

}  // namespace relume::render
