// SPDX-License-Identifier: MIT
// Frames are found where the eye asks for them (codec/keyframes.h), smoothed alike, each divided by what the
// eye adapts to, so that night counts as much as noon, and written as few eigen-images.
#include "day_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "day_judge.h"
#include "day_light.h"
#include "forecast.h"
#include "light_digest.h"
#include "pages.h"
#include "relume/codec/keyframes.h"
#include "relume/codec/pca.h"
#include "relume/core/error.h"
#include "relume/core/hash.h"
#include "relume/transport/lightmap.h"
#include "relume/transport/occlusion.h"

namespace relume::bake {
namespace {

using Kind = asset::DayFrames::Receivers;
using Frame = std::vector<Vec3>;

constexpr std::size_t kMostComponents = 96;  // that are looked at
constexpr const char* kVisibleKeyframes = "visible_keyframes";
constexpr double kNoVariance = 1e-9;  // of all: what components leave that is not worth one more
// Of an eigen-image, in the light that the eye adapts to, where a mid grey is 0.18 pi / albedo.
constexpr float kStep = 0.01f;
// Likewise, and far beyond what a display shows: beside a flame in the dark there is more, which would take
// the place of what is seen.
constexpr float kBrightest = 64.0f;
// Of all pixels, what may differ and yet two pictures pass for equal: perceptualdiff's 100, of the 800 x 600
// of [BDPTM].
constexpr double kPerceptualDiff = 100.0 / (800 * 600);

struct DayOptions {
  asset::DayFrames shape;
  transport::SequenceOptions transport;
  DayMetric metric = DayMetric::kYee;
  double unseen = 0;  // share of the pixels
  double every = 0;   // minutes; 0: keyframes are chosen
  codec::KeyframeOptions keyframes;
  std::size_t components = 0;
  bool all_components = false, smooth = true;
};

const std::string& word(const Parameters& parameters, const char* name) {
  return std::get<std::string>(parameters.at(name));
}
double number(const Parameters& parameters, const char* name, double otherwise) {
  const auto found = parameters.find(name);
  return found == parameters.end() ? otherwise : std::get<double>(found->second);
}

std::uint32_t raysOf(const QualitySettings& quality) {
  if (quality.exact()) return quality.max_samples;
  switch (quality.quality) {
    case Quality::kDraft:
      return 64;
    case Quality::kMedium:
      return 256;
    case Quality::kHigh:
      return 512;
    case Quality::kFinal:
      return 1024;
  }
  return 256;
}

std::uint32_t sizeOf(const Parameters& parameters, const char* name, double otherwise) {
  constexpr double kMost = 8192;
  const double size = number(parameters, name, otherwise);
  if (!(size >= 1 && size <= kMost))
    throw Error(ErrorCode::kUsage, "--layer day", fmt::format("{}={} is no size of a picture", name, size),
                fmt::format("use 1 to {} pixels", kMost));
  return static_cast<std::uint32_t>(size);
}

asset::DayFrames shapeOf(const LayerContext& context, const Parameters& parameters) {
  asset::DayFrames shape;
  const std::string& kind = word(parameters, "receivers");
  if (kind == "atlas") {
    shape.width = static_cast<std::uint32_t>(context.texels.width);
    shape.height = static_cast<std::uint32_t>(context.texels.height);
    return shape;
  }
  shape.receivers = kind == "cube" ? Kind::kCube : Kind::kImage;
  shape.width = sizeOf(parameters, "width", kind == "cube" ? 512 : 800);
  shape.height = kind == "cube" ? shape.width : sizeOf(parameters, "height", 600);
  const auto& cameras = context.tracer.scene().cameras;
  const double camera = number(parameters, "camera", 0);
  if (!(camera < static_cast<double>(cameras.size())) ||
      cameras[static_cast<std::size_t>(camera)].orthographic)
    throw Error(
        ErrorCode::kUsage, "--layer day",
        fmt::format("camera={} is no perspective camera of the scene, which has {}", camera, cameras.size()),
        "give the scene one, or use receivers=atlas");
  const scene::Camera& seen_by = cameras[static_cast<std::size_t>(camera)];
  shape.camera = {seen_by.world_from_camera, seen_by.vertical_fov};
  return shape;
}

DayOptions optionsOf(const LayerContext& context, const Parameters& parameters) {
  DayOptions o;
  o.shape = shapeOf(context, parameters);
  const double rays = number(parameters, "rays", raysOf(context.quality));
  constexpr double kMostRays = 65536;
  o.transport.gather_samples = std::bit_ceil(static_cast<std::uint32_t>(std::clamp(rays, 8.0, kMostRays)));
  o.transport.bounce_samples = std::min(32u, o.transport.gather_samples / 2);
  o.transport.materials = word(parameters, "materials") == "lambert" ? transport::Materials::kLambert
                                                                     : transport::Materials::kFull;
  o.transport.seed = context.seed;
  o.metric = word(parameters, "metric") == "flip" ? DayMetric::kFlip : DayMetric::kYee;
  o.unseen = number(parameters, "unseen", kPerceptualDiff);
  o.every = number(parameters, "every", 0);
  o.keyframes.shortest = number(parameters, "shortest", 1);
  const double components = number(parameters, "components", 0);
  o.components = static_cast<std::size_t>(std::min(components, static_cast<double>(kMostComponents)));
  o.all_components = word(parameters, "error") == "none" && o.components == 0;
  o.smooth = context.quality.filter;
  if (!(o.keyframes.shortest < kDayMinutes) || (o.every > 0 && !(o.every < kDayMinutes)))
    throw Error(ErrorCode::kUsage, "--layer day", "an interval is longer than the day",
                "give minutes, for example shortest=1 or every=5");
  return o;
}

Digest keyOf(const LayerContext& context, const DayOptions& o) {
  Hasher hasher;
  addLightsAndNormals(hasher, context.tracer.scene());
  return hasher
      .add(std::string_view("day 2"))  // raise when results change
      .add(std::string_view(context.day.text))
      .add(o.shape.receivers)
      .add(o.shape.width)
      .add(o.shape.height)
      .add(o.shape.camera.world_from_camera)
      .add(o.shape.camera.vertical_fov)
      .add(o.transport.gather_samples)
      .add(o.transport.materials)
      .add(o.transport.seed)
      .add(o.metric)
      .add(o.unseen)
      .add(o.every)
      .add(o.keyframes.shortest)
      .add(o.components)
      .add(o.all_components)
      .add(o.smooth)
      .digest();
}

/// Smooths all frames by the same weights, which the mean of the day chooses: what changes from one to the
/// next is light alone. Linear.
class DaySmoothing {
 public:
  /// From frames at `times`, each over its `typical` luminance.
  DaySmoothing(const atlas::Texels& texels, std::span<const std::uint8_t> valid)
      : texels_(texels),
        valid_(valid),
        guide_(texels.points.size(), Vec3(0.0f)),
        error_(texels.points.size(), 0.0f) {}

  void learn(const DayLight::Light& light, float share) {
    for (std::size_t i = 0; i < guide_.size(); ++i)
      guide_[i] += share * light.irradiance[i], error_[i] += share * light.error[i];
  }
  void apply(Frame& frame) const {
    constexpr std::size_t kChannels = 6;
    std::vector<float> values(frame.size() * kChannels);
    for (std::size_t i = 0; i < frame.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        values[i * kChannels + c] = guide_[i][static_cast<int>(c)];
        values[i * kChannels + 3 + c] = frame[i][static_cast<int>(c)];
      }
    transport::filterTexels(texels_, error_, valid_, kChannels, values, {}, {.guides = 3});
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const float* v = &values[i * kChannels + 3];
      frame[i] = {v[0], v[1], v[2]};
    }
  }
  /// RMS of the error over that of the light, of the mean of the day before it is smoothed.
  double relativeError() const {
    double error2 = 0, value2 = 0;
    for (std::size_t i = 0; i < error_.size(); ++i) {
      if (!valid_[i]) continue;
      const auto y = static_cast<double>(luminance(guide_[i])), e = static_cast<double>(error_[i]);
      error2 += e * e, value2 += y * y;
    }
    return value2 > 0 ? std::sqrt(error2 / value2) : 0;
  }

 private:
  const atlas::Texels& texels_;
  const std::span<const std::uint8_t> valid_;
  Frame guide_;
  std::vector<float> error_;
};

/// Frames as receivers see them, by time; kept while they may be asked for again.
class FrameStore {
 public:
  FrameStore(std::function<Frame(double)> make, Progress& progress)
      : make_(std::move(make)), progress_(progress) {}

  const Frame& at(double minutes) {
    const auto found = frames_.find(minutes);
    if (found != frames_.end()) return found->second;
    progress_.throwIfCancelled();
    progress_.advance(1);
    return frames_.emplace(minutes, make_(minutes)).first->second;
  }
  /// Frames before `minutes` that no one keeps will not be asked for again.
  void forget(double minutes) {
    std::erase_if(frames_, [&](const auto& f) { return f.first < minutes && !kept_.contains(f.first); });
  }
  void keep(double minutes) { kept_.insert(minutes); }

 private:
  std::function<Frame(double)> make_;
  Progress& progress_;
  std::map<double, Frame> frames_;
  std::set<double> kept_;
};

class DayBaker {
 public:
  DayBaker(const LayerContext& context, const DayOptions& options, Progress& progress)
      : context_(context),
        options_(options),
        day_(context.day.day),
        progress_(progress),
        sequence_(context.tracer, context.atlas, context.texels, options.transport, progress),
        light_(sequence_, context.tracer.scene(), day_),
        receivers_(context, options.shape, sequence_.valid()),
        smoothing_(context.texels, sequence_.valid()),
        store_([this](double t) { return frameAt(t); }, progress) {}

  WholeLayer bake() {
    const std::vector<double> times = chooseTimes();
    asset::DayFrames frames = options_.shape;
    frames.minutes = times;
    std::vector<float> data = framesAt(times, frames.gain);
    if (options_.shape.receivers == Kind::kAtlas) stitch(data);
    encode(data, frames);
    WholeLayer solved;
    solved.layer.tables = asset::tablesOf(frames);
    solved.layer.samples = options_.transport.gather_samples;
    solved.layer.error_estimate = smoothing_.relativeError();
    solved.rays = sequence_.rays();
    auto& told = solved.layer.parameters;
    told["day"] = context_.day.text;
    told["keyframes"] = static_cast<double>(times.size());
    told["frames_baked"] = static_cast<double>(light_.frames());
    told["kept_components"] = static_cast<double>(frames.series.rank);
    told[kVisibleKeyframes] = visible_;
    return solved;
  }

 private:
  Frame seen(const Frame& texels) const {
    Frame out(receivers_.size());
    receivers_.gather(texels, out);
    return out;
  }

  Frame frameAt(double minutes) {
    DayLight::Light light = light_.at(minutes);
    if (options_.smooth) smoothing_.apply(light.irradiance);
    return seen(light.irradiance);
  }

  /// A few times all over the day say where it is smooth.
  void learnSmoothing() {
    constexpr int kTimes = 12;
    for (int i = 0; i < kTimes; ++i) {
      const double t = day_.begin + (day_.end - day_.begin) * (i + 0.5) / kTimes;
      const DayLight::Light light = light_.at(t);
      const float typical = receivers_.typical(seen(light.irradiance));
      if (typical > 0) smoothing_.learn(light, 1 / (kTimes * typical));
    }
  }

  std::vector<double> chooseTimes() {
    const Stage stage(progress_, "frames", 0);
    learnSmoothing();
    std::vector<double> seeds = day_.breaks();
    if (options_.every > 0) {
      seeds.clear();
      for (double t = day_.begin; t <= day_.end; t += options_.every) seeds.push_back(t);
    }
    float brightest = 0;
    for (const double t : seeds) {
      brightest = std::max(brightest, receivers_.typical(store_.at(t)));
      store_.keep(t);
    }
    judge_.emplace(receivers_, options_.metric, options_.unseen, brightest);
    if (options_.every > 0) return seeds;
    const codec::Visible visible = [&](const codec::Interval& keys, double t) {
      store_.keep(keys.before), store_.keep(keys.after);
      store_.forget(keys.before);
      const Frame &before = store_.at(keys.before), &after = store_.at(keys.after), &truth = store_.at(t);
      const auto share = static_cast<float>((t - keys.before) / (keys.after - keys.before));
      Frame between(before.size());
      for (std::size_t i = 0; i < before.size(); ++i) between[i] = glm::mix(before[i], after[i], share);
      return judge_->visible(between, truth);
    };
    return codec::chooseKeyframes(seeds, visible, options_.keyframes);
  }

  /// Each frame over its gain. shape: [times][receivers][3]
  std::vector<float> framesAt(const std::vector<double>& times, std::vector<float>& gain) {
    const std::size_t values = receivers_.size() * 3;
    std::vector<float> data(times.size() * values);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const Frame& frame = store_.at(times[k]);
      const float e = judge_->exposure(frame);
      gain.push_back(1 / e);
      for (std::size_t i = 0; i < values; ++i)
        data[k * values + i] = std::min(e * frame[i / 3][static_cast<int>(i % 3)], kBrightest);
    }
    return data;
  }

  void encode(const std::vector<float>& data, asset::DayFrames& frames) {
    const std::size_t count = frames.minutes.size(), values = receivers_.size() * 3;
    codec::Pca pca = codec::pca(data, count, values, {.rank = std::min(kMostComponents, count)});
    const double all = pca.error(0);
    for (const double v : pca.variance) frames.variance.push_back(static_cast<float>(all > 0 ? v / all : 0));
    while (pca.rank > 0 && pca.error(pca.rank - 1) < kNoVariance * all) dropLast(pca);
    if (options_.components > 0 || options_.all_components) {
      const std::size_t rank = options_.components > 0 ? std::min(options_.components, pca.rank) : pca.rank;
      frames.series = codec::encodeTimeSeries(pca, rank, kStep);
      return;
    }
    frames.series = fewestComponents(pca, data, frames.gain);
  }

  static void dropLast(codec::Pca& pca) {
    const std::size_t rank = pca.rank - 1;
    for (std::size_t k = 0; k < pca.rows; ++k)
      for (std::size_t c = 0; c < rank; ++c) pca.weights[k * rank + c] = pca.weights[k * pca.rank + c];
    pca.weights.resize(pca.rows * rank), pca.components.resize(rank * pca.columns);
    pca.rank = rank;
  }

  /// What texels buried in geometry hold, and what the two sides of seams differ by, in all frames.
  void stitch(std::span<float> data) {
    const std::vector<atlas::SeamSample> seams =
        atlas::findSeams(context_.tracer.scene(), context_.atlas, progress_);
    const auto finish = [&](std::span<float> values) {
      const asset::Plane plane =
          finishPlane(context_.texels, seams, sequence_.valid(),
                      {.name = "image", .channels = 3, .values = {values.begin(), values.end()}});
      for (std::size_t i = 0; i < context_.texels.points.size(); ++i)
        std::copy_n(&plane.values[std::size_t{context_.texels.points[i].texel} * 3], 3, &values[3 * i]);
    };
    const std::size_t values = receivers_.size() * 3;
    for (std::size_t at = 0; at < data.size(); at += values) finish(data.subspan(at, values));
  }

  /// The fewest that leave no frame visibly different; with a finer step where all of them do not.
  codec::TimeSeries fewestComponents(const codec::Pca& pca, std::span<const float> data,
                                     std::span<const float> gain) {
    constexpr int kHalvings = 4;
    float step = kStep;
    codec::TimeSeries all;
    int h = 0;
    for (; h < kHalvings; ++h, step /= 2) {
      all = codec::encodeTimeSeries(pca, pca.rank, step);
      if (!anyVisible(pca, data, all, gain)) break;
    }
    if (h == kHalvings) {  // no fewer would do better
      visible_ = static_cast<double>(howManyVisible(pca, data, all, gain));
      return all;
    }
    std::size_t too_few = 0, enough = pca.rank;
    if (!anyVisible(pca, data, codec::encodeTimeSeries(pca, 0, step), gain))
      return codec::encodeTimeSeries(pca, 0, step);
    while (enough > too_few + 1) {
      const std::size_t middle = (too_few + enough) / 2;
      (anyVisible(pca, data, codec::encodeTimeSeries(pca, middle, step), gain) ? too_few : enough) = middle;
    }
    return codec::encodeTimeSeries(pca, enough, step);
  }

  /// Whether keyframe k, against what was baked, shows that it is made of components.
  auto differs(std::span<const float> data, const codec::TimeSeries& series,
               std::span<const float> gain) const {
    const auto frameOf = [](std::span<const float> values, float times) {
      Frame frame(values.size() / 3);
      for (std::size_t i = 0; i < frame.size(); ++i)
        frame[i] = times * Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
      return frame;
    };
    return [this, data, &series, gain, frameOf](std::size_t k) {
      std::vector<float> kept(series.values);
      series.frame(k, kept);
      const std::span<const float> truth = data.subspan(k * series.values, series.values);
      return judge_->visible(frameOf(kept, gain[k]), frameOf(truth, gain[k]));
    };
  }

  bool anyVisible(const codec::Pca& pca, std::span<const float> data, const codec::TimeSeries& series,
                  std::span<const float> gain) const {
    const std::vector<std::size_t> order = byDoubt(pca, series.rank);
    return std::any_of(order.begin(), order.end(), differs(data, series, gain));
  }
  std::size_t howManyVisible(const codec::Pca& pca, std::span<const float> data,
                             const codec::TimeSeries& series, std::span<const float> gain) const {
    const std::vector<std::size_t> order = byDoubt(pca, series.rank);
    return static_cast<std::size_t>(std::count_if(order.begin(), order.end(), differs(data, series, gain)));
  }

  /// Frames by what these components leave of them, the most first.
  static std::vector<std::size_t> byDoubt(const codec::Pca& pca, std::size_t rank) {
    std::vector<std::pair<double, std::size_t>> left;
    for (std::size_t k = 0; k < pca.rows; ++k) {
      double sum = 0;
      for (std::size_t c = rank; c < pca.rank; ++c) {
        const auto w = static_cast<double>(pca.weights[k * pca.rank + c]);
        sum -= w * w;
      }
      left.emplace_back(sum, k);
    }
    std::sort(left.begin(), left.end());
    std::vector<std::size_t> order;
    for (const auto& [error, k] : left) order.push_back(k);
    return order;
  }

  const LayerContext& context_;
  const DayOptions& options_;
  const Day& day_;
  Progress& progress_;
  const transport::LightSequence sequence_;
  DayLight light_;
  const DayReceivers receivers_;
  DaySmoothing smoothing_;
  FrameStore store_;
  std::optional<DayJudge> judge_;
  double visible_ = 0;  // keyframes that no number of components makes right
};

Warnings warningsOf(const asset::Layer& layer) {
  const auto found = layer.parameters.find(kVisibleKeyframes);
  const double* visible = found == layer.parameters.end() ? nullptr : std::get_if<double>(&found->second);
  if (!visible || *visible == 0) return {};
  return {
      {"layer " + layer.name,
       fmt::format("{} of its keyframes differ visibly from what was baked, with as many as {} components",
                   *visible, kMostComponents),
       "take a higher quality, since noise does not compress, or let more pixels differ (unseen=)"}};
}

/// From the transport of a quarter of the rays, and one frame.
double forecastDay(const LayerContext& context, DayOptions options, Progress& progress) {
  constexpr std::uint32_t kLess = 4;
  constexpr double kFrames = 150;
  options.transport.gather_samples =
      std::max(options.transport.gather_samples / kLess, 2 * options.transport.bounce_samples);
  const double begin = steadySeconds();
  const transport::LightSequence sequence(context.tracer, context.atlas, context.texels, options.transport,
                                          progress);
  const double traced = steadySeconds();
  DayLight light(sequence, context.tracer.scene(), context.day.day);
  light.at(0.5 * (context.day.day.begin + context.day.day.end));
  return kLess * (traced - begin) + kFrames * (steadySeconds() - traced);
}

}  // namespace

WholeJob prepareDay(const LayerContext& context, const Parameters& parameters) {
  const DayOptions options = optionsOf(context, parameters);
  const asset::AtlasTable& table = context.table;
  return {
      .key = keyOf(context, options),
      .solve = [context, options](Progress& progress) { return DayBaker(context, options, progress).bake(); },
      .forecast = [context, options](Progress& progress) { return forecastDay(context, options, progress); },
      .raw_bytes =
          [&table](const asset::Layer& layer) {
            const asset::DayFrames frames = asset::dayFramesOf(layer, table);
            return std::uint64_t{4} * frames.series.frames * frames.series.values;
          },
      .warnings = warningsOf};
}

}  // namespace relume::bake
