// SPDX-License-Identifier: MIT
// The atlas of a scene: which instances share charts, which keep the layout they came with, how dense, where.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "charts/centre_counter.h"
#include "charts/instance_shape.h"
#include "charts/pack.h"
#include "charts/reuse.h"
#include "charts/topology.h"
#include "charts/unwrap.h"
#include "relume/atlas/atlas.h"
#include "relume/core/parallel.h"

namespace relume::atlas {
namespace {

constexpr double kExpectedCoverage = 0.75;  // of a page, for the first guess at the size of a texel

void checkOptions(const AtlasOptions& options) {
  const auto refuse = [](const std::string& problem, const std::string& remedy) {
    throw Error(ErrorCode::kUsage, "atlas", problem, remedy);
  };
  if (options.page_size < 16 || options.page_size > 16384 || options.page_size % 4 != 0) {
    refuse(fmt::format("a page of {} texels is not possible", options.page_size),
           "use a multiple of 4 from 16 to 16384");
  }
  if (options.gutter < 0 || options.gutter > 64 || 4 * options.gutter > options.page_size) {
    refuse(fmt::format("a gutter of {} texels is not possible on a page of {}", options.gutter,
                       options.page_size),
           "use 0 to 64, at most a quarter of the page");
  }
  if (!(options.texels_per_metre >= 0) || !std::isfinite(options.texels_per_metre)) {
    refuse(fmt::format("a density of {} texels per metre is not possible", options.texels_per_metre),
           "use a positive number, or 0 to fit one page");
  }
  if (!(options.discontinuity_angle > 0) || !(options.cone_angle > 0 && options.cone_angle < 1.5f)) {
    refuse("the angles of charts are out of range",
           "use a positive discontinuity angle and a cone of less than 1.5 rad");
  }
}

struct Use {
  std::uint32_t instance = 0, layout = 0;
  double scale = 1;  // metres in the world per metre of the metric
};

/// The charts of one mesh under one metric.
struct Layout {
  std::uint32_t mesh = 0;
  Mat3 metric{1.0f};
  double area = 0;                               // m^2 in the metric
  double largest_scale = 0, smallest_scale = 0;  // of its uses
  std::string first_instance;
  bool reused = false;
  Reused came;                                       // when reused
  Unwrap made;                                       // otherwise
  std::vector<std::uint32_t> members, first_member;  // triangles by chart
  const Unwrap& charts() const { return reused ? came.layout : made; }
};

class Builder {
 public:
  Builder(const scene::Scene& scene, const AtlasOptions& options, Warnings& warnings, Progress& progress)
      : scene_(scene), options_(options), warnings_(warnings), progress_(progress) {}

  Atlas build() {
    collect();
    keepLayouts();
    makeCharts();
    // What looked sound at the expected size may not be at the one that was found; each round gives up at
    // least one layout.
    while (true) {
      const Packing packing = pack();
      if (!refuseAtFinalSize(packing)) return write(packing);
      makeCharts();
    }
  }

 private:
  void collect() {
    std::size_t triangles = 0;
    for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
      const scene::Instance& instance = scene_.instances[i];
      if (instance.dynamic) continue;
      const InstanceShape shape = shapeOf(instance.world_from_local);
      const auto found = std::find_if(layouts_.begin(), layouts_.end(), [&](const Layout& l) {
        return l.mesh == instance.mesh && sameMetric(l.metric, shape.metric);
      });
      const auto index = static_cast<std::uint32_t>(found - layouts_.begin());
      if (found == layouts_.end()) {
        Layout layout;
        layout.mesh = instance.mesh;
        layout.metric = shape.metric;
        layout.first_instance = instance.name;
        layout.largest_scale = layout.smallest_scale = shape.scale;
        layouts_.push_back(std::move(layout));
      }
      Layout& layout = layouts_[index];
      layout.largest_scale = std::max(layout.largest_scale, shape.scale);
      layout.smallest_scale = std::min(layout.smallest_scale, shape.scale);
      uses_.push_back({i, index, shape.scale});
      triangles += scene_.meshes[instance.mesh].triangles.size();
    }
    double area = 0;
    parallelFor(layouts_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t l = begin; l < end; ++l) {
        const scene::Mesh& mesh = scene_.meshes[layouts_[l].mesh];
        for (const UVec3 t : mesh.triangles) {
          const glm::dvec3 a(layouts_[l].metric * mesh.positions[t[0]]),
              b(layouts_[l].metric * mesh.positions[t[1]]), c(layouts_[l].metric * mesh.positions[t[2]]);
          const double twice = glm::length(glm::cross(b - a, c - a));
          if (std::isfinite(twice)) layouts_[l].area += 0.5 * twice;
        }
      }
    });
    for (const Use& use : uses_) area += layouts_[use.layout].area * use.scale * use.scale;
    if (triangles == 0 || !(area > 0)) {
      throw Error(ErrorCode::kEmptyScene, scene_.name, "there is no static surface to bake",
                  "add a mesh, or mark moving ones with extras.relume.static");
    }
    const double page = double(options_.page_size) * options_.page_size;
    expected_density_ = options_.texels_per_metre > 0 ? double(options_.texels_per_metre)
                                                      : std::sqrt(kExpectedCoverage * page / area);
    refuseTooMany();
  }

  /// Covered texels at a density; an instance has one page at most.
  double texelsAt(double density) const {
    const double page = double(options_.page_size) * options_.page_size;
    double texels = 0;
    for (const Use& use : uses_)
      texels += std::min(page, layouts_[use.layout].area * use.scale * use.scale * density * density);
    return texels;
  }

  void refuseTooMany() const {
    const auto most = static_cast<double>(options_.most_texels);
    const double texels = texelsAt(expected_density_);
    if (texels <= most) return;
    std::string remedy;
    if (options_.texels_per_metre > 0) {
      double possible = expected_density_;
      while (texelsAt(possible) > most) possible *= 0.9;
      remedy = fmt::format("lower --texel-density to {:.3g}", 0.99 * possible);
    } else {
      remedy = fmt::format("lower --atlas-size to {:.0f}",
                           4 * std::floor(options_.page_size * std::sqrt(most / texels) / 4));
    }
    throw Error(
        ErrorCode::kOutOfMemory, scene_.name,
        fmt::format(
            "its atlas takes {:.3g} million texels; the memory there is, or --max-memory, allows {:.3g}",
            texels * 1e-6, most * 1e-6),
        remedy);
  }

  void refuseLayout(const Layout& layout, const std::string& fault) {
    warnings_.push_back({fmt::format("mesh \"{}\"", scene_.meshes[layout.mesh].name),
                         "its TEXCOORD_1 cannot carry a bake: " + fault,
                         "it is replaced by charts made here; unwrap the mesh anew to keep your own"});
  }

  void keepLayouts() {
    if (!options_.reuse_uv1) return;
    std::vector<Fault> faults(layouts_.size());
    parallelFor(layouts_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t l = begin; l < end; ++l) {
        Layout& layout = layouts_[l];
        const scene::Mesh& mesh = scene_.meshes[layout.mesh];
        if (mesh.uv[1].size() != mesh.positions.size() || mesh.triangles.empty()) continue;
        std::optional<Reused> reused = reuseLayout(mesh, layout.metric, faults[l]);
        if (!reused) continue;
        const double texels = reused->metres_per_unit * layout.smallest_scale * expected_density_;
        if (!guttersSuffice(*reused, texels, options_.gutter, faults[l])) continue;
        layout.came = std::move(*reused);
        layout.reused = true;
      }
    });
    for (std::size_t l = 0; l < layouts_.size(); ++l) {
      if (!faults[l].empty()) refuseLayout(layouts_[l], faults[l]);
    }
  }

  void makeCharts() {
    std::uint64_t triangles = 0;
    for (const Layout& layout : layouts_) triangles += scene_.meshes[layout.mesh].triangles.size();
    Stage stage(progress_, "charts", triangles);
    parallelFor(layouts_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t l = begin; l < end; ++l) {
        Layout& layout = layouts_[l];
        const scene::Mesh& mesh = scene_.meshes[layout.mesh];
        if (!layout.reused && layout.made.triangles.size() != mesh.triangles.size()) {
          UnwrapOptions unwrap_options;
          unwrap_options.discontinuity_angle = options_.discontinuity_angle;
          unwrap_options.cone_angle = options_.cone_angle;
          unwrap_options.gutter = options_.gutter;
          // What does not fit a page at the density asked for will be scaled down to it.
          const double page = double(options_.page_size) * options_.page_size;
          unwrap_options.texel = std::max(1.0 / (expected_density_ * layout.largest_scale),
                                          std::sqrt(layout.area / (kExpectedCoverage * page)));
          unwrap_options.page_size = options_.page_size;
          layout.made = unwrap(mesh, layout.metric, unwrap_options, progress_);
        }
        sortMembers(layout);
        stage.advance(mesh.triangles.size());
      }
    });
    progress_.throwIfCancelled();
  }

  static void sortMembers(Layout& layout) {
    const Unwrap& charts = layout.charts();
    const std::size_t blocks = layout.reused ? 1 : charts.charts.size();
    const auto blockOf = [&](std::uint32_t chart) { return layout.reused ? 0u : chart; };
    layout.first_member.assign(blocks + 1, 0);
    for (const std::uint32_t c : charts.triangle_chart) {
      if (c != kNone) ++layout.first_member[blockOf(c) + 1];
    }
    std::partial_sum(layout.first_member.begin(), layout.first_member.end(), layout.first_member.begin());
    layout.members.resize(layout.first_member.back());
    std::vector<std::uint32_t> next(layout.first_member.begin(), layout.first_member.end() - 1);
    for (std::uint32_t t = 0; t < charts.triangle_chart.size(); ++t) {
      const std::uint32_t c = charts.triangle_chart[t];
      if (c != kNone) layout.members[next[blockOf(c)]++] = t;
    }
  }

  Packing pack() {
    std::vector<Block> blocks;
    first_block_.clear();
    for (std::uint32_t u = 0; u < uses_.size(); ++u) {
      const Layout& layout = layouts_[uses_[u].layout];
      const Unwrap& charts = layout.charts();
      first_block_.push_back(blocks.size());
      for (std::size_t b = 0; b + 1 < layout.first_member.size(); ++b) {
        const std::span members(layout.members.data() + layout.first_member[b],
                                layout.first_member[b + 1] - layout.first_member[b]);
        if (members.empty()) continue;
        blocks.push_back({charts.uv, charts.triangles, members,
                          layout.reused ? layout.came.extent : charts.charts[b].extent,
                          uses_[u].scale * (layout.reused ? layout.came.metres_per_unit : 1.0), u});
      }
    }
    first_block_.push_back(blocks.size());
    if (blocks.empty()) {
      throw Error(ErrorCode::kEmptyScene, scene_.name, "every static triangle is degenerate",
                  "check the scale of the scene");
    }
    Stage stage(progress_, "packing", 1);
    PackOptions pack_options;
    pack_options.page_size = options_.page_size;
    pack_options.gutter = options_.gutter;
    pack_options.texels_per_metre = options_.texels_per_metre;
    Packing packing = packBlocks(blocks, static_cast<std::uint32_t>(uses_.size()), pack_options, progress_);
    stage.advance();
    return packing;
  }

  /// Gives up layouts whose gutters turn out too narrow or that overlap where they were placed; returns
  /// whether there are any.
  bool refuseAtFinalSize(const Packing& packing) {
    std::vector<Fault> faults(uses_.size());
    parallelFor(uses_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t u = begin; u < end; ++u) {
        const Layout& layout = layouts_[uses_[u].layout];
        if (!layout.reused || first_block_[u] == first_block_[u + 1]) continue;
        const Placement& placement = packing.placements[first_block_[u]];
        if (!guttersSuffice(layout.came, placement.scale, options_.gutter, faults[u])) continue;
        const IVec2 size = placement.turnedSize();
        CentreCounter counter(size.x, size.y);
        for (const std::uint32_t t : layout.members) {
          Vec2 corner[3];
          for (int k = 0; k < 3; ++k) {
            corner[k] = place(placement, layout.came.layout.uv[layout.came.layout.triangles[t][k]]) -
                        Vec2(placement.corner);
          }
          counter.add(corner[0], corner[1], corner[2]);
        }
        if (counter.claimedTwice() == 0) continue;
        faults[u] = fmt::format("{} of its {} texels overlap", counter.claimedTwice(), counter.claimed());
      }
    });
    bool any = false;
    for (std::uint32_t u = 0; u < uses_.size(); ++u) {
      Layout& layout = layouts_[uses_[u].layout];
      if (faults[u].empty() || !layout.reused) continue;
      refuseLayout(layout, faults[u]);
      layout.reused = false;
      layout.came = {};
      any = true;
    }
    return any;
  }

  Atlas write(const Packing& packing) {
    Atlas atlas;
    atlas.width = atlas.height = options_.page_size;
    atlas.pages = packing.pages;
    atlas.statistics.texels_per_metre = static_cast<float>(packing.texels_per_metre);
    atlas.statistics.coverage = static_cast<double>(packing.covered) / static_cast<double>(atlas.texels());
    warnOfScale(packing);
    double surface = 0, squares = 0, largest = 1;
    for (std::uint32_t u = 0; u < uses_.size(); ++u) {
      const Layout& layout = layouts_[uses_[u].layout];
      const Unwrap& charts = layout.charts();
      const auto first_chart = static_cast<std::uint32_t>(atlas.charts.size());
      const std::span placements(packing.placements.data() + first_block_[u],
                                 first_block_[u + 1] - first_block_[u]);
      InstanceUv uv = placed(layout, placements);
      uv.instance = uses_[u].instance;
      for (const FlatChart& flat : charts.charts) {
        Chart chart;
        chart.instance = uv.instance;
        chart.page = uv.page;
        const double coarser = 1.0 / packing.group_scale[u];
        chart.mean_stretch = static_cast<float>(flat.mean_stretch * coarser);
        chart.max_stretch = static_cast<float>(flat.max_stretch * coarser);
        atlas.charts.push_back(chart);
        if (layout.reused) continue;
        const double area = flat.area * uses_[u].scale * uses_[u].scale;
        surface += area;
        squares += area * chart.mean_stretch * chart.mean_stretch;
        largest = std::max(largest, double(chart.max_stretch));
      }
      boundCharts(uv, first_chart, atlas.charts);
      for (std::uint32_t& c : uv.triangle_chart) c = c == kNone ? kNone : c + first_chart;
      atlas.instances.push_back(std::move(uv));
    }
    atlas.statistics.charts = atlas.charts.size();
    atlas.statistics.mean_stretch = surface > 0 ? std::sqrt(squares / surface) : 1.0;
    atlas.statistics.max_stretch = largest;
    atlas.statistics.overlapping_texels = countOverlaps(atlas);
    return atlas;
  }

  InstanceUv placed(const Layout& layout, std::span<const Placement> placements) const {
    const Unwrap& charts = layout.charts();
    InstanceUv uv;
    uv.reused = layout.reused;
    uv.source_vertex = charts.source_vertex;
    uv.triangles = charts.triangles;
    uv.triangle_chart = charts.triangle_chart;
    if (placements.empty()) {  // all degenerate
      uv.uv.assign(charts.uv.size(), Vec2(0.5f));
      return uv;
    }
    uv.page = placements[0].page;
    if (layout.reused) {
      for (const Vec2 p : charts.uv) uv.uv.push_back(place(placements[0], p));
      return uv;
    }
    // Vertices of degenerate triangles lie in the first chart.
    uv.uv.assign(charts.uv.size(), Vec2(placements[0].corner) + 0.5f);
    for (std::size_t c = 0; c < charts.charts.size(); ++c) {
      const FlatChart& chart = charts.charts[c];
      for (std::uint32_t v = chart.first_vertex; v < chart.first_vertex + chart.vertex_count; ++v) {
        uv.uv[v] = place(placements[c], charts.uv[v]);
      }
    }
    return uv;
  }

  static void boundCharts(const InstanceUv& uv, std::uint32_t first_chart, std::vector<Chart>& charts) {
    std::vector<Vec2> lo(charts.size() - first_chart, Vec2(kInfinity)), hi(lo.size(), Vec2(-kInfinity));
    for (std::size_t t = 0; t < uv.triangles.size(); ++t) {
      const std::uint32_t c = uv.triangle_chart[t];
      if (c == kNone) continue;
      for (int k = 0; k < 3; ++k) {
        lo[c] = glm::min(lo[c], uv.uv[uv.triangles[t][k]]);
        hi[c] = glm::max(hi[c], uv.uv[uv.triangles[t][k]]);
      }
    }
    for (std::size_t c = 0; c < lo.size(); ++c) {
      Chart& chart = charts[first_chart + c];
      const IVec2 first = glm::max(IVec2(0), IVec2(glm::floor(lo[c])));
      const IVec2 size = glm::max(IVec2(1), IVec2(glm::ceil(hi[c])) - first);
      chart.first_texel_x = static_cast<std::uint32_t>(first.x),
      chart.first_texel_y = static_cast<std::uint32_t>(first.y);
      chart.width = static_cast<std::uint32_t>(size.x), chart.height = static_cast<std::uint32_t>(size.y);
    }
  }

  void warnOfScale(const Packing& packing) {
    for (std::uint32_t u = 0; u < uses_.size(); ++u) {
      if (packing.group_scale[u] >= 1) continue;
      warnings_.push_back({fmt::format("\"{}\"", scene_.instances[uses_[u].instance].name),
                           fmt::format("it does not fit a page of {0} x {0} texels at {1:.4g} texels per "
                                       "metre and is baked at {2:.4g}",
                                       options_.page_size, packing.texels_per_metre,
                                       packing.texels_per_metre * packing.group_scale[u]),
                           "use larger pages, a lower density, or cut the mesh into several"});
    }
    if (options_.texels_per_metre == 0 && packing.pages > 1) {
      warnings_.push_back(
          {scene_.name,
           fmt::format("its charts are too many for one page of {0} x {0} texels; {1} pages are used",
                       options_.page_size, packing.pages),
           "use a larger atlas size"});
    }
  }

  std::uint64_t countOverlaps(const Atlas& atlas) const {
    std::vector<std::uint64_t> twice(atlas.pages, 0);
    parallelFor(atlas.pages, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t page = begin; page < end; ++page) {
        CentreCounter counter(atlas.width, atlas.height);
        for (const InstanceUv& uv : atlas.instances) {
          if (uv.page != page) continue;
          for (std::size_t t = 0; t < uv.triangles.size(); ++t) {
            const UVec3 c = uv.triangles[t];
            if (uv.triangle_chart[t] != kNone) counter.add(uv.uv[c[0]], uv.uv[c[1]], uv.uv[c[2]]);
          }
        }
        twice[page] = counter.claimedTwice();
      }
    });
    return std::accumulate(twice.begin(), twice.end(), std::uint64_t{0});
  }

  const scene::Scene& scene_;
  AtlasOptions options_;
  Warnings& warnings_;
  Progress& progress_;
  double expected_density_ = 0;
  std::vector<Use> uses_;
  std::vector<Layout> layouts_;
  std::vector<std::size_t> first_block_;  // per use, and the end
};

}  // namespace

Atlas buildAtlas(const scene::Scene& scene, const AtlasOptions& options, Warnings& warnings,
                 Progress& progress) {
  checkOptions(options);
  return Builder(scene, options, warnings, progress).build();
}

}  // namespace relume::atlas
