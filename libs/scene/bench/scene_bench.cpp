// SPDX-License-Identifier: MIT
// Look-ups at hits, which happen once per ray, and import and export of a grid of 100,000 triangles.
#include <benchmark/benchmark.h>

#include <random>

#include "../tests/fake_bake.h"
#include "../tests/gltf_builder.h"

namespace relume::scene {
namespace {

gltf::GltfBuilder gridFile(int cells) {
  gltf::GltfBuilder b;
  std::vector<float> positions, normals, uv;
  std::vector<std::uint32_t> indices;
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(cells),
                  v = static_cast<float>(y) / static_cast<float>(cells);
      positions.insert(positions.end(), {u, v, u * v});
      normals.insert(normals.end(), {0, 0, 1});
      uv.insert(uv.end(), {u, v});
    }
  for (std::uint32_t y = 0; y + 1 < row; ++y)
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t a = y * row + x;
      indices.insert(indices.end(), {a, a + 1, a + row, a + row, a + 1, a + row + 1});
    }
  nlohmann::json primitive;
  primitive["attributes"] = {{"POSITION", b.accessor<float>(positions, "VEC3")},
                             {"NORMAL", b.accessor<float>(normals, "VEC3")},
                             {"TEXCOORD_0", b.accessor<float>(uv, "VEC2")}};
  primitive["indices"] = b.accessor<std::uint32_t>(indices, "SCALAR");
  primitive["material"] = 0;
  image::Image picture(512, 512, 3);
  for (std::size_t i = 0; i < picture.data.size(); ++i)
    picture.data[i] = static_cast<float>(i * 2654435761u % 256) / 255;
  b.doc["images"] = {{{"bufferView", b.view(image::encodePngData(picture))}, {"mimeType", "image/png"}}};
  b.doc["textures"] = {{{"source", 0}}};
  b.doc["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}}};
  b.node({{"mesh", b.mesh(primitive)}});
  return b;
}

std::vector<Hit> randomHits(const Scene& scene) {
  std::mt19937 random(1);
  std::vector<Hit> hits(4096);
  for (Hit& h : hits) {
    h.instance = 0;
    h.triangle = static_cast<std::uint32_t>(random() % scene.meshes[0].triangles.size());
    h.b1 = h.b2 = 0.3f;
  }
  return hits;
}

template <class LookUp>
void lookUps(benchmark::State& state, LookUp look_up) {
  const Scene scene = gridFile(224).scene();
  const std::vector<Hit> hits = randomHits(scene);
  for (auto _ : state)
    for (const Hit& h : hits) benchmark::DoNotOptimize(look_up(scene, h));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(hits.size()));
}

void surface(benchmark::State& state) {
  lookUps(state, [](const Scene& s, const Hit& h) { return surfaceAt(s, h); });
}
void normal(benchmark::State& state) {
  lookUps(state, [](const Scene& s, const Hit& h) { return shadingNormal(s, h); });
}

void importGrid(benchmark::State& state) {
  const auto file = gridFile(224).glb();
  for (auto _ : state) {
    Warnings warnings;
    benchmark::DoNotOptimize(gltf::import(gltf::Document::parse(file, "grid", {}), warnings));
  }
}

void exportGrid(benchmark::State& state) {
  const auto document = gridFile(224).document();
  Warnings warnings;
  const Scene scene = gltf::import(document, warnings);
  const auto bake = gltf::fakeBake(scene, {.split = state.range(0) != 0});
  for (auto _ : state) benchmark::DoNotOptimize(gltf::exportGlb(document, scene, bake));
}

BENCHMARK(surface)->Name("scene.surface_at.textured");
BENCHMARK(normal)->Name("scene.shading_normal");
BENCHMARK(importGrid)->Name("scene.import.grid/100k")->Unit(benchmark::kMillisecond);
BENCHMARK(exportGrid)
    ->Name("scene.export.grid/100k")
    ->ArgName("split")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relume::scene
