// SPDX-License-Identifier: MIT
#include "viewer/truth_window.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <vector>

#include "relume/image/colour.h"
#include "relume/image/metrics.h"

namespace relume::app {
namespace {

constexpr int kWidth = 320;

/// A picture's pixels as an 8-bit texture; values between 0 and 1, linear.
void upload(unsigned& name, const image::Image& picture) {
  std::vector<unsigned char> rgb;
  rgb.reserve(picture.data.size());
  for (const float v : picture.data)
    rgb.push_back(
        static_cast<unsigned char>(std::lround(255 * image::linearToSrgb(std::clamp(v, 0.0f, 1.0f)))));
  if (name) glDeleteTextures(1, &name);
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glTextureStorage2D(name, 1, GL_RGB8, picture.width, picture.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(name, 0, 0, 0, picture.width, picture.height, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
}

/// The mean of the pixels that fall into each of a smaller picture's.
image::Image smaller(const image::Image& picture, int width, int height) {
  image::Image out(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int x0 = x * picture.width / width, x1 = std::max((x + 1) * picture.width / width, x0 + 1);
      const int y0 = y * picture.height / height, y1 = std::max((y + 1) * picture.height / height, y0 + 1);
      Vec3 sum(0.0f);
      for (int j = y0; j < y1; ++j)
        for (int i = x0; i < x1; ++i) sum += picture.rgb(i, j);
      out.setRgb(x, y, sum / static_cast<float>((x1 - x0) * (y1 - y0)));
    }
  return out;
}

}  // namespace

TruthWindow::~TruthWindow() {
  if (truth_texture_) glDeleteTextures(1, &truth_texture_);
  if (difference_texture_) glDeleteTextures(1, &difference_texture_);
}

void TruthWindow::renew(Stage& stage, const image::Image& truth) {
  const image::Image shown = image::toneMap(truth, image::ToneCurve::kFilmic, stage.exposure);
  const image::Image ours = smaller(stage.screenshot(), truth.width, truth.height);
  const image::Difference difference = image::flip(ours, shown);
  flip_ = difference.mean;
  upload(truth_texture_, shown);
  upload(difference_texture_, image::falseColour(difference.map, 0.0f, 0.5f));
}

void TruthWindow::draw(Stage& stage) {
  const int height = std::max(1, kWidth * stage.frame.size.y / std::max(stage.frame.size.x, 1));
  stage.truth().want(
      stage.camera.viewpoint(), stage.frame.lights,
      stage.frame.full_materials ? transport::Materials::kFull : transport::Materials::kLambert,
      {kWidth, height});
  image::Image truth;
  const std::uint32_t samples = stage.truth().picture(truth);
  if (samples > 0 && samples != samples_) renew(stage, truth);
  samples_ = samples;
  ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x - kWidth - 24, 8), ImGuiCond_Appearing);
  ImGui::Begin("Truth", &stage.compare_with_truth, ImGuiWindowFlags_AlwaysAutoResize);
  if (samples == 0) {
    ImGui::TextUnformatted("tracing paths...");
  } else {
    const ImVec2 size(kWidth, static_cast<float>(height));
    ImGui::Text("%u samples a pixel", samples);
    ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(truth_texture_)), size);
    ImGui::Text("FLIP, mean %.3f; yellow: 0.5", flip_);
    ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(difference_texture_)), size);
  }
  ImGui::End();
}

}  // namespace relume::app
