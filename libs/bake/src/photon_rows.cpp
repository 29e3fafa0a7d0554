// SPDX-License-Identifier: MIT
#include "photon_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "light_digest.h"
#include "relume/core/error.h"
#include "relume/transport/occlusion.h"

namespace relume::bake {
namespace {

using transport::PhotonKernel;
using transport::PhotonOptions;

constexpr std::size_t kRow = 5;
constexpr std::uint32_t kBackRays = 16;  // of a texel: whether it lies inside something
constexpr double kMostPaths = 1e11, kMostWidth = 17;

/// Cancels with another, says nothing.
class Quiet : public Progress {
 public:
  explicit Quiet(const Progress& other) : other_(other) {}
  void begin(std::string_view, std::uint64_t) override {}
  void advance(std::uint64_t) override {
    if (other_.cancelled()) cancel();
  }
  void end() override {}

 private:
  const Progress& other_;
};

/// What all rows come from, once it is there.
struct Traced {
  std::vector<float> rows;
  std::size_t row = 0;
};

}  // namespace

PhotonOptions photonOptionsOf(const LayerContext& context, const Parameters& parameters,
                              std::shared_ptr<const basis::Basis> receiver) {
  PhotonOptions o;
  const std::string& kernel = std::get<std::string>(parameters.at("kernel"));
  o.kernel.shape = kernel == "box"       ? PhotonKernel::Shape::kBox
                   : kernel == "pyramid" ? PhotonKernel::Shape::kPyramid
                                         : PhotonKernel::Shape::kAdaptive;
  const double width = std::get<double>(parameters.at("kernelwidth"));
  if (!(width >= 1 && width <= kMostWidth))
    throw Error(ErrorCode::kUsage, "kernelwidth", fmt::format("is {}", width), "use 1 to 17 texels");
  o.kernel.width = static_cast<float>(width);
  o.paths = std::max<std::uint64_t>(
      std::uint64_t{context.quality.max_samples} * context.texels.points.size() / 4, 1);
  if (const auto paths = parameters.find("paths"); paths != parameters.end()) {
    const double n = std::get<double>(paths->second);
    if (!(n >= 1 && n <= kMostPaths))
      throw Error(ErrorCode::kUsage, "paths", fmt::format("is {}", n), "use 1 to 100000000000");
    o.paths = static_cast<std::uint64_t>(n);
  }
  const std::string& part = std::get<std::string>(parameters.at("part"));
  o.part = part == "direct"     ? transport::Part::kDirect
           : part == "indirect" ? transport::Part::kIndirect
                                : transport::Part::kTotal;
  o.materials = std::get<std::string>(parameters.at("materials")) == "lambert"
                    ? transport::Materials::kLambert
                    : transport::Materials::kFull;
  const double bounces = std::get<double>(parameters.at("bounces"));
  o.max_bounces = bounces < 1e6 ? static_cast<int>(bounces) : transport::ReferenceOptions::kUnlimited;
  o.seed = context.seed;
  o.receiver = std::move(receiver);
  return o;
}

Digest keyOf(const PhotonOptions& o, const scene::Scene& scene) {
  Hasher hasher;
  hasher
      .add("photons 1")  // raise when results change
      .add(o.paths)
      .add(o.part)
      .add(o.materials)
      .add(o.max_bounces)
      .add(o.kernel.shape)
      .add(o.kernel.width)
      .add(o.kernel.paths)
      .add(o.seed);
  if (o.receiver) hasher.add(std::string_view(o.receiver->name()));
  addLightsAndNormals(hasher, scene);
  return hasher.digest();
}

TexelSolver photonSolver(const LayerContext& context, const PhotonOptions& options) {
  TexelSolver solver;
  const auto traced = std::make_shared<Traced>();
  traced->row = kRow + (options.receiver ? options.receiver->sums() : 0);
  solver.row = static_cast<int>(traced->row);
  solver.key = keyOf(options, context.tracer.scene());
  const std::uint64_t seed = context.seed;
  solver.solve = [traced, options, seed, &tracer = context.tracer, &atlas = context.atlas,
                  &texels = context.texels](std::span<const std::uint32_t> which, std::span<float> rows,
                                            Progress& progress) -> std::uint64_t {
    std::uint64_t rays = 0;
    if (traced->rows.empty()) {
      Quiet quiet(progress);
      const transport::PhotonResult light = tracePhotons(tracer, atlas, texels, options, quiet);
      transport::OcclusionOptions backs;
      backs.min_samples = backs.max_samples = kBackRays, backs.seed = seed;
      const transport::OcclusionResult inside = solveOcclusion(tracer, texels, backs, quiet);
      const std::size_t sums = traced->row - kRow;
      traced->rows.resize(texels.points.size() * traced->row);
      for (std::size_t i = 0; i < texels.points.size(); ++i) {
        float* row = &traced->rows[i * traced->row];
        for (int c = 0; c < 3; ++c) row[c] = light.value[i].rgb[c];
        row[3] = light.error[i], row[4] = inside.back_share[i];
        std::copy_n(light.sums.data() + i * sums, sums, row + kRow);
      }
      rays = light.rays;
    }
    for (std::size_t i = 0; i < which.size(); ++i)
      std::copy_n(&traced->rows[which[i] * traced->row], traced->row, &rows[i * traced->row]);
    progress.advance(which.size());
    return rays;
  };
  return solver;
}

}  // namespace relume::bake
