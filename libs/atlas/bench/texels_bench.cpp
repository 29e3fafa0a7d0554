// SPDX-License-Identifier: MIT
// Texels of hand-made atlases: items are texels of the page (rasterize, dilate) or seam samples.
#include <benchmark/benchmark.h>

#include <cmath>

#include "relume/atlas/texels.h"

namespace relume::atlas {
namespace {

struct Sheets {
  scene::Scene scene;
  Atlas atlas;
};

/// sheets^2 bumpy squares side by side, one chart each, of cells^2 cells.
Sheets sheets(int page, std::uint32_t count, std::uint32_t cells) {
  Sheets out;
  out.atlas.width = out.atlas.height = page;
  out.atlas.pages = 1;
  out.scene.materials.resize(1);
  const float slot = static_cast<float>(page) / static_cast<float>(count), size = slot - 2.7f;
  for (std::uint32_t k = 0; k < count * count; ++k) {
    const Vec2 corner(static_cast<float>(k % count), static_cast<float>(k / count));
    scene::Mesh mesh;
    scene::Instance instance;
    InstanceUv uv;
    instance.mesh = uv.instance = k;
    for (std::uint32_t j = 0; j <= cells; ++j) {
      for (std::uint32_t i = 0; i <= cells; ++i) {
        const Vec2 u = Vec2(static_cast<float>(i), static_cast<float>(j)) / static_cast<float>(cells),
                   p = corner + u;
        mesh.positions.push_back({p, 0.1f * std::sin(5 * p.x) * std::cos(4 * p.y)});
        uv.uv.push_back(slot * corner + 1.3f + size * u);
        const std::uint32_t v = j * (cells + 1) + i;
        uv.source_vertex.push_back(v);
        if (i == cells || j == cells) continue;
        mesh.triangles.push_back({v, v + 1, v + cells + 2});
        mesh.triangles.push_back({v, v + cells + 2, v + cells + 1});
      }
    }
    mesh.normals.assign(mesh.positions.size(), Normal(0, 0, 1));
    uv.triangles = mesh.triangles;
    uv.triangle_chart.assign(mesh.triangles.size(), k);
    out.scene.meshes.push_back(mesh);
    out.scene.instances.push_back(instance);
    out.atlas.instances.push_back(uv);
    Chart chart;
    chart.instance = k;
    out.atlas.charts.push_back(chart);
  }
  return out;
}

void report(benchmark::State& state, std::size_t items) {
  state.SetItemsProcessed(static_cast<std::int64_t>(items) * state.iterations());
}

void rasterizeBench(benchmark::State& state) {
  const Sheets made =
      sheets(1024, static_cast<std::uint32_t>(state.range(0)), static_cast<std::uint32_t>(state.range(1)));
  SilentProgress progress;
  std::size_t points = 0;
  for (auto _ : state) points = rasterize(made.scene, made.atlas, progress).points.size();
  report(state, points);
}
BENCHMARK(rasterizeBench)
    ->Name("atlas.rasterize.1024")
    ->ArgNames({"charts", "cells"})
    ->Args({30, 1})
    ->Args({30, 4})
    ->Args({1, 512})
    ->Unit(benchmark::kMillisecond);

void findSeamsBench(benchmark::State& state) {
  const Sheets made = sheets(1024, 30, 4);
  SilentProgress progress;
  std::size_t samples = 0;
  for (auto _ : state) samples = findSeams(made.scene, made.atlas, progress).size();
  report(state, samples);
}
BENCHMARK(findSeamsBench)->Name("atlas.find_seams.1024")->Unit(benchmark::kMillisecond);

struct Filled {
  Texels texels;
  std::vector<float> pages;
  std::vector<std::uint8_t> covered;
  std::vector<SeamSample> seams;
};
Filled filled(int channels) {
  const Sheets made = sheets(1024, 30, 1);
  SilentProgress progress;
  Filled out;
  out.texels = rasterize(made.scene, made.atlas, progress);
  out.seams = findSeams(made.scene, made.atlas, progress);
  std::vector<float> values(out.texels.points.size() * static_cast<std::size_t>(channels));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * 7919 % 1000) / 1000;
  scatter(out.texels, values, channels, {}, out.pages, out.covered);
  return out;
}

void dilateBench(benchmark::State& state) {
  const int channels = static_cast<int>(state.range(0));
  const Filled from = filled(channels);
  for (auto _ : state) {
    std::vector<float> pages = from.pages;
    dilate(1024, 1024, 1, channels, pages, from.covered, &from.texels);
    benchmark::DoNotOptimize(pages.data());
  }
  report(state, from.covered.size());
}
BENCHMARK(dilateBench)
    ->Name("atlas.dilate.1024")
    ->ArgName("channels")
    ->Arg(1)
    ->Arg(3)
    ->Unit(benchmark::kMillisecond);

void stitchBench(benchmark::State& state) {
  const int channels = static_cast<int>(state.range(0));
  const Filled from = filled(channels);
  for (auto _ : state) {
    std::vector<float> pages = from.pages;
    stitchSeams(from.seams, channels, pages, 0.1f, from.covered);
    benchmark::DoNotOptimize(pages.data());
  }
  report(state, from.seams.size());
}
BENCHMARK(stitchBench)
    ->Name("atlas.stitch.1024")
    ->ArgName("channels")
    ->Arg(1)
    ->Arg(3)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relume::atlas
