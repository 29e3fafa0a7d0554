// SPDX-License-Identifier: MIT
#include "viewer/viewer.h"

#include <epoxy/gl.h>
// After it, so that GLFW takes its functions.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>

#include "relume/core/error.h"
#include "relume/core/file.h"
#include "relume/image/io.h"
#include "relume/render/context.h"
#include "viewer/panels.h"
#include "viewer/stage.h"

namespace relume::app {
namespace {

constexpr float kRadiansPerPixel = 0.006f;
constexpr float kWalk = 0.5f;  // of the camera's reach, a second
constexpr std::size_t kHistory = 120;

std::string glfwSays() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "it gives no reason";
}

class Window {
 public:
  explicit Window(IVec2 size) {
    if (!glfwInit())
      throw Error(ErrorCode::kUnsupported, "relume view",
                  fmt::format("there is no display to open a window on ({})", glfwSays()),
                  "take relume render --renderer gl, which needs none");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window_ = glfwCreateWindow(size.x, size.y, "relume view", nullptr, nullptr);
    if (!window_) {
      const std::string reason = glfwSays();
      glfwTerminate();
      throw Error(ErrorCode::kUnsupported, "relume view",
                  fmt::format("no window with OpenGL 4.5 could be opened ({})", reason),
                  "update the graphics driver, set LIBGL_ALWAYS_SOFTWARE=1, or take relume render");
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(0);
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4;
    ImGui::GetStyle().Alpha = 0.94f;
  }
  ~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// After callbacks of ours are set: ImGui calls those that were there.
  void startPanels() {
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 450");
  }
  GLFWwindow* get() const { return window_; }
  IVec2 pixels() const {
    IVec2 size;
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    return size;
  }

 private:
  GLFWwindow* window_ = nullptr;
};

struct Events {
  std::optional<std::filesystem::path> dropped;
  float wheel = 0;
  std::vector<int> keys;
  bool question = false;
};

Events& eventsOf(GLFWwindow* window) { return *static_cast<Events*>(glfwGetWindowUserPointer(window)); }

void listen(GLFWwindow* window, Events& events) {
  glfwSetWindowUserPointer(window, &events);
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    if (count > 0) eventsOf(w).dropped = paths[0];
  });
  glfwSetScrollCallback(window,
                        [](GLFWwindow* w, double, double y) { eventsOf(w).wheel += static_cast<float>(y); });
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
    if (action == GLFW_PRESS) eventsOf(w).keys.push_back(key);
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned c) { eventsOf(w).question |= c == '?'; });
}

/// The first name with a number that no file has.
std::string freeName(const char* stem, const char* ending) {
  for (int i = 1;; ++i)
    if (std::string name = fmt::format("{}-{:03}{}", stem, i, ending); !std::filesystem::exists(name))
      return name;
}

/// Ends a recording by writing it.
void toggleRecording(PanelState& state) {
  state.record = !state.record;
  if (state.record || state.recorded.empty()) return;
  const std::string name = freeName("relume-path", ".json");
  writeFileAtomically(name, toJson(state.recorded));
  state.message = fmt::format("written: {}; relume render --path {} makes pictures of it", name, name);
  state.recorded.clear();
}

void onKey(int key, Stage& stage, PanelState& state, GLFWwindow* window) {
  if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) stage.choose(static_cast<std::size_t>(key - GLFW_KEY_1));
  if (key == GLFW_KEY_TAB) state.panels = !state.panels;
  if (key == GLFW_KEY_F1) state.help = !state.help;
  if (key == GLFW_KEY_L) stage.addLight();
  if (key == GLFW_KEY_P) state.screenshot = true;
  if (key == GLFW_KEY_R) toggleRecording(state);
  if (key == GLFW_KEY_C) stage.frame.split = stage.frame.split > 0 ? 0.0f : 0.5f;
  if (key == GLFW_KEY_N) state.entries = !state.entries;
  if (key == GLFW_KEY_T) stage.compare_with_truth = !stage.compare_with_truth;
  if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(window, GLFW_TRUE);
  if (key == GLFW_KEY_DELETE && stage.selected >= 0 &&
      stage.selected < static_cast<int>(stage.frame.lights.size())) {
    stage.frame.lights.erase(stage.frame.lights.begin() + stage.selected);
    stage.selected = -1;
  }
}

bool asksFor(const ViewerOptions& options, const char* what) {
  return std::find(options.show.begin(), options.show.end(), what) != options.show.end();
}

/// The window as it is, with its panels.
image::Image windowPicture(IVec2 size) {
  std::vector<unsigned char> rgb(3 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
  image::Image out(size.x, size.y, 3);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < 3 * size.x; ++x)
      out.data[static_cast<std::size_t>(y * 3 * size.x + x)] = image::srgbToLinear(
          static_cast<float>(rgb[static_cast<std::size_t>((size.y - 1 - y) * 3 * size.x + x)]) / 255.0f);
  return out;
}

void walk(GLFWwindow* window, Stage& stage, float seconds) {
  const auto down = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS ? 1.0f : 0.0f; };
  const Vec3 way(down(GLFW_KEY_D) - down(GLFW_KEY_A), down(GLFW_KEY_E) - down(GLFW_KEY_Q),
                 down(GLFW_KEY_W) - down(GLFW_KEY_S));
  const float speed = kWalk * stage.camera.reach() * (down(GLFW_KEY_LEFT_SHIFT) > 0 ? 5.0f : 1.0f);
  if (way != Vec3(0)) stage.camera.move(way * (speed * seconds));
}

void turn(Stage& stage, bool over_handle) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse) return;
  const Vec2 by = Vec2(io.MouseDelta.x, io.MouseDelta.y) * kRadiansPerPixel;
  if (ImGui::IsMouseDown(1)) stage.camera.look(by.x, -by.y);
  if (ImGui::IsMouseDown(0) && !over_handle) stage.camera.orbit(by.x, -by.y);
}

std::unique_ptr<Stage> openFile(GLFWwindow* window, const ViewerOptions& options,
                                const std::filesystem::path& file) {
  auto stage = std::make_unique<Stage>(options, file);
  glfwSetWindowTitle(window, fmt::format("{} - relume view", file.filename().string()).c_str());
  return stage;
}

}  // namespace

void runViewer(const ViewerOptions& options) {
  Window window(options.size);
  render::requireOpenGl();
  Events events;
  listen(window.get(), events);
  window.startPanels();
  std::unique_ptr<Stage> stage = openFile(window.get(), options, options.file);
  PanelState state;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  Clock::time_point before = start;
  const LightSet as_opened = stage->frame.lights;
  std::vector<PathFrame> recorded;
  std::optional<image::Image> window_picture;
  state.entries = asksFor(options, "entries");
  state.help = asksFor(options, "help");
  stage->compare_with_truth = asksFor(options, "truth");
  if (asksFor(options, "split")) stage->frame.split = 0.5f;

  for (int frame = 0; !glfwWindowShouldClose(window.get()) && (!options.frames || frame < options.frames);
       ++frame) {
    glfwPollEvents();
    if (events.dropped) {
      try {
        stage = openFile(window.get(), {.file = *events.dropped, .size = options.size}, *events.dropped);
        state.message.clear();
      } catch (const Error& e) {
        state.message = e.what();
      }
      events.dropped.reset();
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    if (!ImGui::GetIO().WantCaptureKeyboard)
      for (const int key : events.keys) onKey(key, *stage, state, window.get());
    if (events.question) state.help = !state.help;
    if (events.wheel != 0 && !ImGui::GetIO().WantCaptureMouse)
      stage->camera.zoom(std::pow(0.9f, events.wheel));
    events.keys.clear(), events.question = false, events.wheel = 0;
    const Clock::time_point now = Clock::now();
    const float seconds = std::chrono::duration<float>(now - before).count();
    before = now;
    if (frame > 0) state.frame_ms.push_back(1000 * seconds);
    if (state.frame_ms.size() > kHistory) state.frame_ms.pop_front();
    if (!ImGui::GetIO().WantCaptureKeyboard) walk(window.get(), *stage, seconds);
    if (options.sweep && !stage->frame.lights.empty())
      stage->frame.lights[0].position =
          as_opened[0].position + Vec3(0.5f * std::sin(0.2f * static_cast<float>(frame + 1)), 0, 0);

    const IVec2 size = window.pixels();
    if (size.x <= 0 || size.y <= 0) {  // minimized
      ImGui::EndFrame();
      glfwWaitEvents();
      continue;
    }
    // The times that matter are those of the picture.
    stage->draw(size);
    if (state.screenshot) {
      const std::string name = freeName("relume", ".png");
      image::writeImage(name, stage->screenshot());
      state.message = "written: " + name;
      state.screenshot = false;
    }
    if (state.record) {
      state.recorded.push_back({stage->camera.viewpoint(), stage->frame.lights, stage->object_moved});
      state.message = fmt::format("recording: {} frames; R ends it", state.recorded.size());
    }
    state.pass_times.push_back(stage->times());
    if (state.pass_times.size() > kHistory) state.pass_times.pop_front();
    if (state.entries) drawEntries(*stage, Vec2(size));
    const bool over = drawHandles(*stage, Vec2(size));
    if (stage->compare_with_truth) state.truth.draw(*stage);
    drawPanels(*stage, state);
    turn(*stage, over);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    if (options.frames > 0 && frame + 1 == options.frames && asksFor(options, "panels"))
      window_picture = windowPicture(size);
    if (!options.record.empty())
      recorded.push_back({stage->camera.viewpoint(), stage->frame.lights, stage->object_moved});
    glfwSwapBuffers(window.get());
  }
  if (!options.screenshot.empty())
    image::writeImage(options.screenshot, window_picture ? *window_picture : stage->screenshot());
  if (!options.record.empty()) writeFileAtomically(options.record, toJson(recorded));
  if (options.frames > 0) {
    const double all = std::chrono::duration<double>(before - start).count();
    fmt::print("{}: {} frames, {:.1f} a second\n", render::deviceName(), options.frames,
               all > 0 ? (options.frames - 1) / all : 0.0);
    for (const render::PassTime& pass : stage->times())
      fmt::print("  {}: {:.2f} ms\n", pass.name, 1e3 * pass.seconds);
  }
}

}  // namespace relume::app
