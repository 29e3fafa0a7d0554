// SPDX-License-Identifier: MIT
#include "report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "exposure.h"
#include "files.h"
#include "relume/image/colour.h"
#include "relume/image/io.h"
#include "relume/picture/picture.h"

namespace relume::app {
namespace {

namespace fs = std::filesystem;
using picture::View;

constexpr int kThumbnail = 512;  // texels along the longer side, at most
constexpr std::size_t kMostPages = 16;

struct Shot {
  View view;
  std::string file, caption;
  std::string layer = "";
};

bool weightsAmbientLight(const asset::Layer& layer) { return isShareOfAmbientLight(layer.kind); }

std::vector<Shot> shotsFor(const asset::Asset& asset, bool has_lights) {
  std::vector<Shot> shots;
  const bool weighted = std::any_of(asset.layers.begin(), asset.layers.end(), weightsAmbientLight);
  if (has_lights && weighted)
    shots.push_back({View::kLit, "lit.png", "The scene's lights, with ambient light weighted by the bake"});
  for (const asset::Layer& layer : asset.layers) {
    if (layer.kind == "lightmap")
      shots.push_back({View::kLightmap, "layer-" + layer.name + ".png",
                       "The light of " + layer.name + " on the surfaces' colours", layer.name});
    if (!weightsAmbientLight(layer)) continue;
    shots.push_back({View::kObscurance, "ambient-" + layer.name + ".png",
                     "Ambient light alone, weighted by " + layer.name, layer.name});
    shots.push_back({View::kOcclusion, "layer-" + layer.name + ".png",
                     layer.name + " alone, on white surfaces", layer.name});
    if (layer.planes.size() > 1)
      shots.push_back({View::kBentNormal, "bent-" + layer.name + ".png",
                       "Bent normals of " + layer.name + ": where the open directions point", layer.name});
  }
  if (!asset.layers.empty())
    shots.push_back({View::kTexels, "texels.png", "Texels of the atlas: even squares mean even density"});
  shots.push_back({View::kCharts, "charts.png", "Charts of the atlas"});
  shots.push_back({View::kValidity, "validity.png",
                   "Red texels lie inside other geometry and were filled from their neighbours; magenta "
                   "objects move, so they are not baked"});
  return shots;
}

// One page, k x k texels to a pixel.
class Shrunk {
 public:
  Shrunk(int width, int height) : width_(width), height_(height) {
    step_ = (std::max(width, height) + kThumbnail - 1) / kThumbnail;
  }
  int width() const { return (width_ + step_ - 1) / step_; }
  int height() const { return (height_ + step_ - 1) / step_; }
  /// Calls visit(x, y) for the texels of a pixel.
  template <class Visit>
  void forEach(int px, int py, Visit visit) const {
    for (int y = py * step_; y < std::min(height_, (py + 1) * step_); ++y)
      for (int x = px * step_; x < std::min(width_, (px + 1) * step_); ++x) visit(x, y);
  }

 private:
  int width_, height_, step_;
};

image::Image valuesOfPage(const asset::AtlasTable& atlas, const asset::Plane& plane, std::uint32_t page) {
  const Shrunk shrunk(atlas.width, atlas.height);
  image::Image out(shrunk.width(), shrunk.height(), 3);
  const auto channels = static_cast<std::size_t>(plane.channels);
  for (int py = 0; py < out.height; ++py) {
    for (int px = 0; px < out.width; ++px) {
      Vec3 sum(0);
      float count = 0;
      shrunk.forEach(px, py, [&](int x, int y) {
        const std::size_t texel = (static_cast<std::size_t>(page) * static_cast<std::size_t>(atlas.height) +
                                   static_cast<std::size_t>(y)) *
                                      static_cast<std::size_t>(atlas.width) +
                                  static_cast<std::size_t>(x);
        const float* v = plane.values.data() + texel * channels;
        sum += channels >= 3 ? Vec3(v[0], v[1], v[2]) : Vec3(v[0]);
        ++count;
      });
      out.setRgb(px, py, sum / count);
    }
  }
  return out;
}

/// How a plane is shown: as it is where its values fill the range of a screen, else through a tone curve that
/// brings the middle of the covered texels to where it can be seen.
std::optional<float> exposureOf(const asset::AtlasTable& atlas, const asset::Plane& plane) {
  const auto channels = static_cast<std::size_t>(plane.channels);
  std::vector<float> seen;
  for (const std::uint32_t texel : atlas.texel) {
    const float* v = plane.values.data() + texel * channels;
    seen.push_back(channels >= 3 ? luminance({v[0], v[1], v[2]}) : v[0]);
  }
  if (seen.empty()) return std::nullopt;
  const auto at = [&](double share) {
    const auto n = seen.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(seen.size() - 1));
    std::nth_element(seen.begin(), n, seen.end());
    return *n;
  };
  const float bright = at(0.995), middle = at(0.5);
  constexpr float kDim = 0.25f, kGlare = 1.5f, kMiddle = 0.3f;
  if (bright <= kGlare && bright >= kDim) return std::nullopt;
  const float shown = middle > 1e-3f * bright ? middle : bright;
  return shown > 0 ? std::optional(std::log2(kMiddle / shown)) : std::nullopt;
}

/// For each texel of a page the covered one's index, or -1.
std::vector<std::int64_t> coveredOfPage(const asset::AtlasTable& atlas, std::uint32_t page) {
  const std::size_t count = static_cast<std::size_t>(atlas.width) * static_cast<std::size_t>(atlas.height);
  std::vector<std::int64_t> index(count, -1);
  const auto begin = std::lower_bound(atlas.texel.begin(), atlas.texel.end(), page * count);
  for (auto t = begin; t != atlas.texel.end() && *t < (page + 1) * count; ++t)
    index[*t - page * count] = t - atlas.texel.begin();
  return index;
}

// Of the texels that a pixel stands for, the most telling mark decides.
Vec3 colourOfMarks(std::uint8_t marks, Vec3 otherwise) {
  if (marks & bake::kStandsOut) return {1.0f, 0.1f, 0.8f};
  if (marks & bake::kInvalidMark) return {0.8f, 0.03f, 0.02f};
  if (marks & bake::kSeesBacks) return {0.02f, 0.55f, 0.9f};
  if (marks & bake::kBesideInvalid) return {0.95f, 0.45f, 0.02f};
  return otherwise;
}

}  // namespace

bool isShareOfAmbientLight(const std::string& kind) {
  return kind == "ao" || kind == "obscurance" || kind == "spectral";
}

std::vector<ReportPicture> drawScene(const fs::path& folder, const fs::path& baked, Progress& progress) {
  const auto opened = open(baked);
  const trace::Tracer tracer(opened->scene, {.isa = "", .include_dynamic = true});
  const picture::Viewpoint viewpoint = picture::defaultViewpoint(tracer, -1);
  std::vector<ReportPicture> pictures;
  for (const Shot& shot : shotsFor(*opened->asset, !opened->scene.lights.empty())) {
    picture::PictureOptions options{.width = 960, .height = 540, .samples = 16, .view = shot.view};
    options.layer = shot.layer;
    options.lights = opened->scene.lights;
    options.background = Vec3(0.05f);
    const bool light = shot.view == View::kLit || shot.view == View::kLightmap;
    if (light) options.ambient = Irradiance(0.3f);
    const image::Image linear = picture::render(tracer, &*opened->asset, viewpoint, options, progress);
    image::writeImage(folder / shot.file,
                      image::toneMap(linear, light ? image::ToneCurve::kFilmic : image::ToneCurve::kPlain,
                                     light ? chooseExposure(linear, options.background, false) : 0.0f));
    pictures.push_back({shot.file, shot.caption, options.width, options.height});
  }
  return pictures;
}

LayerPictures drawPages(const fs::path& folder, const asset::Asset& asset, std::size_t layer,
                        const bake::LayerReport& report) {
  const asset::AtlasTable& atlas = asset.atlas;
  const asset::Plane& plane = asset.layers[layer].planes.front();
  const auto exposure = exposureOf(atlas, plane);
  LayerPictures result;
  std::vector<float> errors = report.errors;
  if (!errors.empty()) {
    const auto high = errors.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(errors.size()));
    std::nth_element(errors.begin(), high, errors.end());
    result.error_scale = *high;
  }
  const Shrunk shrunk(atlas.width, atlas.height);
  const std::size_t drawn = std::min<std::size_t>(atlas.pages, kMostPages);
  result.left_out = atlas.pages - drawn;
  for (std::uint32_t page = 0; page < drawn; ++page) {
    const image::Image values = valuesOfPage(atlas, plane, page);
    const std::vector<std::int64_t> covered = coveredOfPage(atlas, page);
    image::Image error(values.width, values.height, 3), marks = error;
    for (int py = 0; py < values.height; ++py) {
      for (int px = 0; px < values.width; ++px) {
        float worst = -1;
        std::uint8_t seen = 0;
        shrunk.forEach(px, py, [&](int x, int y) {
          const std::int64_t i = covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(atlas.width) +
                                         static_cast<std::size_t>(x)];
          if (i < 0) return;
          seen |= report.marks[static_cast<std::size_t>(i)];
          if (!(report.marks[static_cast<std::size_t>(i)] & bake::kInvalidMark))
            worst = std::max(worst, report.errors[static_cast<std::size_t>(i)]);
          else
            worst = std::max(worst, 0.0f);
        });
        const bool inside = worst >= 0;
        error.setRgb(px, py,
                     inside ? image::falseColour(result.error_scale > 0 ? worst / result.error_scale : 0)
                            : Vec3(0.05f));
        marks.setRgb(px, py, colourOfMarks(seen, Vec3(inside ? 0.045f : 0.012f)));
      }
    }
    const auto write = [&](const char* what, const image::Image& picture, std::string caption) {
      const std::string file = fmt::format("{}-page{}{}.png", report.name, page, what);
      image::writeImage(folder / file, picture);
      return ReportPicture{file, std::move(caption), picture.width, picture.height};
    };
    result.pages.push_back(
        {.page = page,
         .values =
             write("",
                   image::toneMap(values, exposure ? image::ToneCurve::kFilmic : image::ToneCurve::kPlain,
                                  exposure.value_or(0)),
                   exposure ? fmt::format("Values, through a tone curve at {:+.1f} stops", *exposure)
                            : std::string("Values")),
         .errors = write(
             "-error", error,
             fmt::format("Standard error: black is 0, pale yellow {:.2g} and more", result.error_scale)),
         .marks = write("-suspects", marks, "Invalid texels and suspects")});
  }
  return result;
}

}  // namespace relume::app
