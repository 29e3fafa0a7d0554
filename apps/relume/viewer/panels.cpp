// SPDX-License-Identifier: MIT
#include "viewer/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "relume/image/colour.h"
#include "relume/image/image.h"

namespace relume::app {
namespace {

constexpr float kPanelWidth = 320;
constexpr float kHandle = 8;  // pixels

const char* kindName(Light::Kind kind) {
  switch (kind) {
    case Light::Kind::kPoint:
      return "point";
    case Light::Kind::kSpot:
      return "spot";
    case Light::Kind::kDirectional:
      return "directional";
    case Light::Kind::kArea:
      return "area";
  }
  return "";
}

/// As a display shows it.
ImU32 shown(Vec3 colour, float alpha) {
  const float most = std::max({colour.x, colour.y, colour.z, 1e-6f});
  const auto channel = [&](float v) { return image::linearToSrgb(v / most); };
  return ImGui::ColorConvertFloat4ToU32(
      ImVec4(channel(colour.x), channel(colour.y), channel(colour.z), alpha));
}

void lightFields(Light& light) {
  ImGui::ColorEdit3("colour", &light.colour.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs);
  const char* unit = light.kind == Light::Kind::kDirectional ? "%.2f lux"
                     : light.kind == Light::Kind::kArea      ? "%.2f W/(m2 sr)"
                                                             : "%.2f cd";
  ImGui::DragFloat("intensity", &light.intensity, 0.01f * std::max(light.intensity, 0.1f), 0, 1e6f, unit);
  if (light.kind != Light::Kind::kDirectional) ImGui::DragFloat3("position, m", &light.position.x, 0.02f);
  if (light.kind == Light::Kind::kPoint) return;
  Vec3 direction = light.direction;
  if (ImGui::DragFloat3("direction", &direction.x, 0.01f) && glm::length(direction) > 1e-3f)
    light.direction = glm::normalize(direction);
  if (light.kind == Light::Kind::kArea) ImGui::DragFloat("area, m2", &light.area, 0.01f, 1e-4f, 1e3f);
}

void lightsPanel(Stage& stage) {
  LightSet& lights = stage.frame.lights;
  if (ImGui::Button("add a lamp")) stage.addLight();
  ImGui::SameLine();
  const bool any = stage.selected >= 0 && stage.selected < static_cast<int>(lights.size());
  if (ImGui::Button("delete") && any) {
    lights.erase(lights.begin() + stage.selected);
    stage.selected = -1;
    return;
  }
  ImGui::BeginChild("list", ImVec2(0, std::min(140.0f, 24.0f + 20.0f * static_cast<float>(lights.size()))),
                    true);
  for (int i = 0; i < static_cast<int>(lights.size()); ++i) {
    const Light& l = lights[static_cast<std::size_t>(i)];
    const std::string label = fmt::format(
        "{} ({})##{}", l.name.empty() ? fmt::format("light {}", i + 1) : l.name, kindName(l.kind), i);
    if (ImGui::Selectable(label.c_str(), stage.selected == i)) stage.selected = i;
  }
  ImGui::EndChild();
  if (any && stage.selected >= 0) lightFields(lights[static_cast<std::size_t>(stage.selected)]);
}

ImU32 colourOf(const std::string& pass) {
  const Vec3 c = image::labelColour(static_cast<std::uint32_t>(std::hash<std::string>()(pass) % 97));
  return ImGui::ColorConvertFloat4ToU32(ImVec4(c.x, c.y, c.z, 1));
}

/// A column for each frame, its passes one on top of the other.
void passGraph(const PanelState& state) {
  constexpr float kHeight = 70;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  double most = 1e-6;
  for (const auto& frame : state.pass_times) {
    double sum = 0;
    for (const render::PassTime& pass : frame) sum += pass.seconds;
    most = std::max(most, sum);
  }
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, ImVec2(at.x + width, at.y + kHeight), IM_COL32(20, 20, 20, 255));
  const float step = width / static_cast<float>(std::max<std::size_t>(state.pass_times.size(), 1));
  for (std::size_t i = 0; i < state.pass_times.size(); ++i) {
    float base = at.y + kHeight;
    for (const render::PassTime& pass : state.pass_times[i]) {
      const float h = kHeight * static_cast<float>(pass.seconds / most);
      const float x = at.x + step * static_cast<float>(i);
      list->AddRectFilled(ImVec2(x, base - h), ImVec2(x + step, base), colourOf(pass.name));
      base -= h;
    }
  }
  ImGui::Dummy(ImVec2(width, kHeight));
}

void timesPanel(const Stage& stage, const PanelState& state) {
  const std::vector<float> history(state.frame_ms.begin(), state.frame_ms.end());
  if (history.empty()) return;
  float mean = 0;
  for (const float ms : history) mean += ms / static_cast<float>(history.size());
  const float most = *std::max_element(history.begin(), history.end());
  const std::string overlay = fmt::format("{:.1f} ms, {:.1f} frames/s", mean, 1000 / mean);
  ImGui::PlotLines("##frames", history.data(), static_cast<int>(history.size()), 0, overlay.c_str(), 0,
                   1.2f * most, ImVec2(ImGui::GetContentRegionAvail().x, 60));
  passGraph(state);
  double sum = 1e-9;
  for (const render::PassTime& pass : stage.times()) sum += pass.seconds;
  for (const render::PassTime& pass : stage.times()) {
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, colourOf(pass.name));
    ImGui::ProgressBar(static_cast<float>(pass.seconds / sum), ImVec2(-1, 14),
                       fmt::format("{} {:.2f} ms", pass.name, 1e3 * pass.seconds).c_str());
    ImGui::PopStyleColor();
  }
}

void helpWindow(PanelState& state) {
  ImGui::SetNextWindowSize(ImVec2(430, 0), ImGuiCond_Appearing);
  ImGui::SetNextWindowPos(ImVec2(0.5f * ImGui::GetIO().DisplaySize.x, 0.5f * ImGui::GetIO().DisplaySize.y),
                          ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
  if (ImGui::Begin("Keys and mouse", &state.help, ImGuiWindowFlags_NoCollapse)) {
    constexpr const char* kRows[][2] = {
        {"left mouse", "turn about what is looked at; on a handle: move the light"},
        {"right mouse", "look about"},
        {"wheel", "nearer, farther"},
        {"W A S D", "walk"},
        {"Q E", "down, up; with Shift all five times as fast"},
        {"1 to 9", "views"},
        {"Tab", "panels on and off"},
        {"L", "a new lamp in front of the camera"},
        {"Delete", "the chosen lamp"},
        {"P", "screenshot to a PNG file, without panels"},
        {"R", "record the path of camera and lamps, until R again; relume render --path shows it"},
        {"C", "light straight from lamps on the left half, all light on the right one"},
        {"N", "entries of light, coloured by their cluster"},
        {"T", "path-traced truth beside, and the difference"},
        {"? or F1", "this page"},
        {"drop a file", "open it"},
        {"Esc", "end"}};
    if (ImGui::BeginTable("keys", 2)) {
      ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 90);
      for (const auto& row : kRows) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(row[0]);
        ImGui::TableNextColumn();
        ImGui::TextWrapped("%s", row[1]);
      }
      ImGui::EndTable();
    }
  }
  ImGui::End();
}

}  // namespace

void drawPanels(Stage& stage, PanelState& state) {
  if (state.help) helpWindow(state);
  if (!state.panels) return;
  ImGui::SetNextWindowPos(ImVec2(8, 8), ImGuiCond_Always);
  ImGui::SetNextWindowSizeConstraints(ImVec2(kPanelWidth, 0),
                                      ImVec2(kPanelWidth, ImGui::GetIO().DisplaySize.y - 16));
  ImGui::Begin("relume view", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove);
  ImGui::PushItemWidth(170);
  ImGui::TextWrapped("%s", stage.caption().c_str());
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##view", stage.views()[stage.view()].name)) {
    for (std::size_t i = 0; i < stage.views().size(); ++i)
      if (ImGui::Selectable(stage.views()[i].name, i == stage.view())) stage.choose(i);
    ImGui::EndCombo();
  }
  if (ImGui::CollapsingHeader("Light", ImGuiTreeNodeFlags_DefaultOpen)) {
    ImGui::SliderFloat("direct", &stage.frame.direct_gain, 0, 2);
    ImGui::SliderFloat("indirect", &stage.frame.indirect_gain, 0, 2);
    if (stage.has_obscurance) {
      ImGui::SliderFloat("obscurance", &stage.frame.obscurance_gain, 0, 1);
      ImGui::SliderFloat("short bounce", &stage.frame.bounce_gain, 0, 1);
    }
    float ambient = stage.frame.ambient.rgb.x;
    if (ImGui::SliderFloat("ambient", &ambient, 0, 4)) stage.frame.ambient = Irradiance(ambient);
    if (ImGui::SliderFloat("lamps alone, left", &stage.frame.split, 0, 1) && stage.frame.split < 0.01f)
      stage.frame.split = 0;
    if (!stage.entries().empty()) ImGui::Checkbox("entries of light, by cluster", &state.entries);
    ImGui::Checkbox("beside path-traced truth", &stage.compare_with_truth);
    ImGui::Checkbox("exposure by itself", &stage.auto_exposure);
    ImGui::SliderFloat("exposure, stops", &stage.exposure, -12, 12);
    ImGui::Checkbox("glossy materials, normal maps", &stage.frame.full_materials);
    if (stage.frame.full_materials && stage.has_relief) {
      ImGui::Checkbox("relief", &stage.frame.relief_steps);
      ImGui::SameLine();
      ImGui::Checkbox("its shadows", &stage.frame.relief_shadows);
      ImGui::SliderFloat("its occlusion", &stage.frame.small_scale_gain, 0, 1);
    }
    ImGui::Checkbox("smooth edges", &stage.fxaa);
  }
  if (!stage.object_moved.empty() && ImGui::CollapsingHeader("Things", ImGuiTreeNodeFlags_DefaultOpen)) {
    int light = static_cast<int>(stage.frame.object_light);
    if (ImGui::Combo("lit by", &light,
                     stage.has_probes ? "lamps alone\0cube maps\0probes\0" : "lamps alone\0cube maps\0"))
      stage.frame.object_light = static_cast<render::ObjectLight>(light);
    ImGui::SliderFloat("their occlusion", &stage.frame.object_occlusion_gain, 0, 1);
    for (std::size_t i = 0; i < stage.object_moved.size(); ++i)
      ImGui::DragFloat3(fmt::format("thing {}, m", i + 1).c_str(), &stage.object_moved[i].x, 0.02f);
  }
  if (ImGui::CollapsingHeader("Lamps", ImGuiTreeNodeFlags_DefaultOpen)) lightsPanel(stage);
  if (ImGui::CollapsingHeader("Time", ImGuiTreeNodeFlags_DefaultOpen)) timesPanel(stage, state);
  if (!state.message.empty()) ImGui::TextWrapped("%s", state.message.c_str());
  ImGui::TextDisabled("? for help");
  ImGui::PopItemWidth();
  ImGui::End();
}

void drawEntries(const Stage& stage, Vec2 size) {
  const picture::Viewpoint viewpoint = stage.camera.viewpoint();
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  for (const Stage::Entry& entry : stage.entries()) {
    const Vec3 at = project(viewpoint, size, entry.position);
    if (!(at.z > 0) || at.x < 0 || at.y < 0 || at.x > size.x || at.y > size.y) continue;
    if (!stage.sees(entry.position, entry.normal)) continue;
    const float radius = std::clamp(40.0f / at.z, 2.0f, 8.0f);
    list->AddCircleFilled(ImVec2(at.x, at.y), radius, shown(entry.colour, 1));
    list->AddCircle(ImVec2(at.x, at.y), radius, IM_COL32(0, 0, 0, 200));
  }
}

bool drawHandles(Stage& stage, Vec2 size) {
  const picture::Viewpoint viewpoint = stage.camera.viewpoint();
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const ImGuiIO& io = ImGui::GetIO();
  const Vec2 mouse(io.MousePos.x, io.MousePos.y);
  static int dragged = -1;
  int nearest = -1;
  float least = 2 * kHandle;
  LightSet& lights = stage.frame.lights;
  for (int i = 0; i < static_cast<int>(lights.size()); ++i) {
    const Light& l = lights[static_cast<std::size_t>(i)];
    if (l.kind == Light::Kind::kDirectional) continue;
    const Vec3 at = project(viewpoint, size, l.position);
    if (!(at.z > 0)) continue;
    const ImVec2 place(at.x, at.y);
    list->AddCircleFilled(place, kHandle, shown(l.colour, 0.85f));
    list->AddCircle(place, kHandle + (stage.selected == i ? 4.0f : 1.0f),
                    stage.selected == i ? IM_COL32(255, 255, 255, 255) : IM_COL32(0, 0, 0, 180), 0, 2);
    const float away = glm::distance(mouse, Vec2(at));
    if (away < least) least = away, nearest = i;
  }
  // Things are handles after the lights, square ones.
  const int first_thing = static_cast<int>(lights.size());
  for (std::size_t i = 0; i < stage.object_moved.size(); ++i) {
    const Vec3 at = project(viewpoint, size, stage.objectCentre(i));
    if (!(at.z > 0)) continue;
    list->AddRect(ImVec2(at.x - kHandle, at.y - kHandle), ImVec2(at.x + kHandle, at.y + kHandle),
                  IM_COL32(255, 255, 255, 220), 0, 0, 2);
    const float away = glm::distance(mouse, Vec2(at));
    if (away < least) least = away, nearest = first_thing + static_cast<int>(i);
  }
  if (!ImGui::IsMouseDown(0)) dragged = -1;
  if (ImGui::IsMouseClicked(0) && !io.WantCaptureMouse && nearest >= 0) {
    dragged = nearest;
    if (nearest < first_thing) stage.selected = nearest;
  }
  if (dragged >= first_thing) {
    const auto thing = static_cast<std::size_t>(dragged - first_thing);
    const Point centre = stage.objectCentre(thing);
    const float depth = project(viewpoint, size, centre).z;
    if (depth > 0 && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0))
      stage.object_moved[thing] += unproject(viewpoint, size, Vec3(mouse, depth)) - centre;
  }
  if (dragged >= 0 && dragged < static_cast<int>(lights.size())) {
    Light& l = lights[static_cast<std::size_t>(dragged)];
    const float depth = project(viewpoint, size, l.position).z;
    if (depth > 0 && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0))
      l.position = unproject(viewpoint, size, Vec3(mouse, depth));
  }
  return dragged >= 0 || (nearest >= 0 && !io.WantCaptureMouse);
}

}  // namespace relume::app
