// SPDX-License-Identifier: MIT
// Pixel samples per second: a hilly square of 131,072 triangles under four lamps, seen from above; all
// threads.
#include <benchmark/benchmark.h>

#include <cmath>

#include "relume/picture/picture.h"

namespace relume::picture {
namespace {

constexpr std::uint32_t kCells = 256;
constexpr int kWidth = 480, kHeight = 270, kSamples = 16;

scene::Scene hills() {
  scene::Scene scene;
  scene::Mesh& mesh = scene.meshes.emplace_back();
  for (std::uint32_t z = 0; z <= kCells; ++z)
    for (std::uint32_t x = 0; x <= kCells; ++x) {
      const Vec2 uv = Vec2(x, z) / static_cast<float>(kCells);
      const Vec2 p = 20.0f * uv - 10.0f;
      mesh.positions.push_back({p.x, std::sin(p.x) * std::cos(p.y), p.y});
      mesh.normals.push_back(
          glm::normalize(Vec3(-std::cos(p.x) * std::cos(p.y), 1.0f, std::sin(p.x) * std::sin(p.y))));
      mesh.uv[1].push_back(uv);
      if (x == kCells || z == kCells) continue;
      const std::uint32_t a = z * (kCells + 1) + x, b = a + kCells + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({a + 1, b, b + 1});
    }
  mesh.atlas_page = 0;
  scene.materials.emplace_back().metallic = 0.0f;
  scene.instances.emplace_back();
  return scene;
}

asset::Asset bake() {
  asset::Asset asset;
  asset.atlas.width = asset.atlas.height = 256;
  asset.atlas.pages = 1;
  asset::Layer& layer = asset.layers.emplace_back();
  layer.name = layer.kind = "obscurance";
  layer.planes.push_back({"value", 1, asset::Storage::kFloat16, 0, 1, std::vector<float>(256 * 256, 0.5f)});
  return asset;
}

void renderView(benchmark::State& state, View view) {
  const scene::Scene scene = hills();
  const asset::Asset asset = bake();
  const trace::Tracer tracer(scene);
  const Viewpoint viewpoint = defaultViewpoint(tracer, -1);
  PictureOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.samples = kSamples;
  options.view = view;
  for (int i = 0; i < 4; ++i)
    options.lights.push_back(
        {.intensity = 30.0f, .position = {4.0f * static_cast<float>(i) - 6.0f, 3.0f, 0.0f}});
  SilentProgress silent;
  for (auto _ : state)
    benchmark::DoNotOptimize(render(tracer, &asset, viewpoint, options, silent).data.data());
  state.counters["pixel_samples"] = benchmark::Counter(static_cast<double>(kWidth) * kHeight * kSamples,
                                                       benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK_CAPTURE(renderView, picture.albedo.hills, View::kAlbedo)
    ->Name("picture.albedo.hills")
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(renderView, picture.obscurance.hills, View::kObscurance)
    ->Name("picture.obscurance.hills")
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(renderView, picture.lit_4_lights.hills, View::kLit)
    ->Name("picture.lit_4_lights.hills")
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void viewpoint(benchmark::State& state) {
  const scene::Scene scene = hills();
  const trace::Tracer tracer(scene);
  for (auto _ : state) benchmark::DoNotOptimize(defaultViewpoint(tracer, -1));
}
BENCHMARK(viewpoint)
    ->Name("picture.default_viewpoint.hills")
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relume::picture
