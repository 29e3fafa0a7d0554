// SPDX-License-Identifier: MIT
// Error, size and decode time of every directional basis on the scene that RELUME_BASES_SCENE names: light
// gathered once at some hundreds of its texels, and handed to all bases and to the truth alike, so that what
// they differ in is the basis alone. The truth sums up, of each arrival of light, what turned normals and
// glossy lobes make of it. Nothing is registered without that variable. bench/bases.py runs it and writes
// docs/bases.md.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "relume/atlas/atlas.h"
#include "relume/basis/basis.h"
#include "relume/scene/gltf.h"
#include "relume/transport/lightmap.h"

namespace relume::transport {
namespace {

using basis::GlossyLobe;
using basis::Packing;

constexpr std::size_t kTexels = 600;
constexpr std::uint32_t kSamples = 4096;
constexpr std::array kRoughnesses = {0.3f, 0.5f, 0.8f};
constexpr Vec3 kF0{0.5f};
constexpr float kOneNormal = 0.02f;  // by which E over a texel may differ from E for its mean normal

/// Normals up to 37 degrees off the surface's, and directions to the eye, in its frame.
const std::vector<Vec3> kTilts = {{0, 0, 1},       {0.4f, 0, 1},   {-0.3f, 0.5f, 1}, {0, -0.6f, 1},
                                  {0.5f, 0.5f, 1}, {-0.75f, 0, 1}, {0.2f, 0.7f, 1},  {-0.5f, -0.5f, 1}};
const std::vector<Vec3> kViews = {{0, 0, 1},         {0.8f, 0, 1}, {-0.4f, 0.7f, 1},
                                  {-0.4f, -1.2f, 1}, {2, 0.5f, 1}, {-1.5f, 1.5f, 1}};

Direction inWorld(const basis::Receiver& at, Vec3 local) { return glm::normalize(at.frame.toWorld(local)); }
GlossyLobe lobeOf(const basis::Receiver& at, float roughness, Vec3 view) {
  return GlossyLobe::ggx(at.normal, inWorld(at, view), roughness, kF0);
}

/// What is true, and behind it the sums of all bases.
class Everything final : public basis::Basis {
 public:
  explicit Everything(std::vector<std::unique_ptr<Basis>> bases) : bases_(std::move(bases)) {}
  static constexpr std::size_t truths() { return 3 * 8 + kRoughnesses.size() * 3 * 6; }
  const std::vector<std::unique_ptr<Basis>>& bases() const { return bases_; }
  std::size_t at(std::size_t basis) const {
    std::size_t first = truths();
    for (std::size_t b = 0; b < basis; ++b) first += bases_[b]->sums();
    return first;
  }

  std::string name() const override { return "everything"; }
  std::size_t sums() const override { return at(bases_.size()); }
  std::size_t coefficients() const override { return sums(); }
  void add(const basis::Receiver& where, const basis::Arrival& light, std::span<double> sums) const override {
    std::size_t k = 0;
    const Vec3 flux = light.e.rgb / light.cosine;
    const auto put = [&](Vec3 v) {
      for (int c = 0; c < 3; ++c) sums[k++] += static_cast<double>(v[c]);
    };
    for (const Vec3 t : kTilts) put(flux * std::max(glm::dot(inWorld(where, t), light.from), 0.0f));
    for (const float r : kRoughnesses)
      for (const Vec3 v : kViews) put(flux * lobeOf(where, r, v).evaluate(light.from));
    for (const auto& b : bases_) b->add(where, light, sums.subspan(k, b->sums())), k += b->sums();
  }
  void finish(const basis::Receiver&, std::span<const float>, std::span<float>) const override {}
  Irradiance irradiance(const basis::Receiver&, std::span<const float>, Normal) const override { return {}; }
  Radiance glossy(const basis::Receiver&, std::span<const float>, const GlossyLobe&) const override {
    return {};
  }
  std::vector<basis::TexturePlane> planes(Packing) const override { return {}; }
  void pack(std::span<const float>, Packing, std::span<float>) const override {}
  void unpack(std::span<const float>, Packing, std::span<float>) const override {}

 private:
  std::vector<std::unique_ptr<Basis>> bases_;
};

struct Case {
  std::shared_ptr<const Everything> all;
  std::vector<basis::Receiver> receivers;
  LightmapResult light;

  explicit Case(const char* file) {
    Warnings warnings;
    SilentProgress silent;
    const scene::Scene scene =
        scene::gltf::import(scene::gltf::Document::read(file), warnings, {.normal_maps = true});
    const atlas::Atlas atlas = atlas::buildAtlas(scene, {.page_size = 256}, warnings, silent);
    const atlas::Texels texels = atlas::rasterize(scene, atlas, silent);
    const trace::Tracer tracer(scene);
    std::vector<std::unique_ptr<basis::Basis>> bases;
    for (const std::string& name : basis::basisNames()) bases.push_back(basis::makeBasis(name));
    for (const char* name : {"directions:6", "directions:32", "directions:64"})
      bases.push_back(basis::makeBasis(name));
    all = std::make_shared<Everything>(std::move(bases));
    std::vector<std::uint32_t> which;
    const std::size_t step = std::max<std::size_t>(texels.points.size() / kTexels, 1);
    for (std::size_t i = step / 2; i < texels.points.size(); i += step)
      which.push_back(static_cast<std::uint32_t>(i));
    LightmapOptions options{.min_samples = kSamples, .max_samples = kSamples, .cache_samples = 64};
    options.receiver = all;
    const LightmapResult found = LightmapSolver(tracer, atlas, texels, options).solve(silent, which);
    for (std::size_t i = 0; i < which.size(); ++i) {  // what lies inside something has no light to speak of
      if (found.back_share[i] > 0.05f) continue;
      // Nor does a texel that covers a whole candle have one normal.
      const float* flat = &found.sums[i * all->sums()];
      const float own = luminance(found.value[i].rgb), of_normal = luminance(Vec3(flat[0], flat[1], flat[2]));
      if (std::abs(own - of_normal) > kOneNormal * of_normal) continue;
      receivers.emplace_back(texels.points[which[i]].shading_normal);
      light.sums.insert(light.sums.end(), found.sums.begin() + static_cast<std::ptrdiff_t>(i * all->sums()),
                        found.sums.begin() + static_cast<std::ptrdiff_t>((i + 1) * all->sums()));
    }
  }
};

const Case& theCase() {
  static const Case instance(std::getenv("RELUME_BASES_SCENE"));
  return instance;
}

/// Sums of squares, of texels in proportion to their light: a dark corner counts as much as a lit wall.
struct Error {
  double squares = 0, truth = 0;
  double value() const { return std::sqrt(squares / truth); }
};

Vec3 tripleAt(const float* v) { return {v[0], v[1], v[2]}; }

void measure(benchmark::State& state, std::size_t index, Packing packing) {
  const Case& c = theCase();
  const basis::Basis& b = *c.all->bases()[index];
  const std::size_t first = c.all->at(index);
  std::vector<float> coefficients(b.coefficients()), stored(b.storedNumbers(packing));
  const auto planes = b.planes(packing);
  Error diffuse;
  std::array<Error, kRoughnesses.size()> glossy;
  for (std::size_t i = 0; i < c.receivers.size(); ++i) {
    const basis::Receiver& at = c.receivers[i];
    const float* sums = &c.light.sums[i * c.all->sums()];
    const double flat = static_cast<double>(luminance(tripleAt(sums)));
    if (!(flat > 0)) continue;
    b.finish(at, {sums + first, b.sums()}, coefficients);
    b.pack(coefficients, packing, stored);
    basis::roundToPlanes(planes, stored);
    b.unpack(stored, packing, coefficients);
    const float* truth = sums;
    const auto compare = [&](Error& error, Vec3 value) {
      const glm::dvec3 is(value), ought(tripleAt(truth));
      error.squares += glm::dot(is - ought, is - ought) / (flat * flat),
          error.truth += glm::dot(ought, ought) / (flat * flat);
      truth += 3;
    };
    for (const Vec3 t : kTilts) compare(diffuse, b.irradiance(at, coefficients, inWorld(at, t)).rgb);
    for (std::size_t r = 0; r < kRoughnesses.size(); ++r)
      for (const Vec3 v : kViews)
        compare(glossy[r], b.glossy(at, coefficients, lobeOf(at, kRoughnesses[r], v)).rgb);
  }
  const basis::Receiver& at = c.receivers.front();
  const Normal n = inWorld(at, kTilts[2]);
  for (auto _ : state) benchmark::DoNotOptimize(b.irradiance(at, coefficients, n));
  constexpr int kRuns = 2000;
  const GlossyLobe lobe = lobeOf(at, 0.5f, kViews[2]);
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < kRuns; ++k) benchmark::DoNotOptimize(b.glossy(at, coefficients, lobe));
  const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
  state.counters["bytes"] = static_cast<double>(b.bytesPerTexel(packing));
  state.counters["diffuse"] = diffuse.value();
  state.counters["glossy03"] = glossy[0].value(), state.counters["glossy05"] = glossy[1].value();
  state.counters["glossy08"] = glossy[2].value();
  state.counters["glossy_ns"] = took.count() / kRuns;
  state.counters["texels"] = static_cast<double>(c.receivers.size());
}

const bool kRegistered = [] {
  if (!std::getenv("RELUME_BASES_SCENE")) return false;
  std::vector<std::string> names = basis::basisNames();
  for (const char* more : {"directions:6", "directions:32", "directions:64"}) names.emplace_back(more);
  for (std::size_t i = 0; i < names.size(); ++i)
    for (const Packing packing : {Packing::kHalf, Packing::kCompact})
      benchmark::RegisterBenchmark(
          ("bases." + names[i] + (packing == Packing::kHalf ? ".half" : ".compact")).c_str(),
          [=](benchmark::State& s) { measure(s, i, packing); })
          ->Iterations(20000);
  return true;
}();

}  // namespace
}  // namespace relume::transport
