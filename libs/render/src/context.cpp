// SPDX-License-Identifier: MIT
// Devices are asked for by EGL_EXT_platform_device, GPUs before the processor, and where that is not there by
// Mesa's platform without surfaces.
#include "relume/render/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

#include "relume/core/error.h"

namespace relume::render {
namespace {

constexpr int kMajor = 4, kMinor = 5;

struct Candidate {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

/// No context in it: this display has none of that version; `problem` says why.
Candidate tryDisplay(EGLDisplay display, std::string& problem) {
  if (display == EGL_NO_DISPLAY) return {};
  if (!eglInitialize(display, nullptr, nullptr)) {
    problem = "no EGL device could be opened";
    return {};
  }
  constexpr EGLint kAttributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                    kMajor,
                                    EGL_CONTEXT_MINOR_VERSION,
                                    kMinor,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                    EGL_NONE};
  const bool bare = epoxy_has_egl_extension(display, "EGL_KHR_no_config_context") &&
                    epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context");
  if (!bare || !eglBindAPI(EGL_OPENGL_API)) {
    problem = "its EGL draws to windows alone";
    return {};
  }
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kAttributes);
  if (context == EGL_NO_CONTEXT) {
    problem = fmt::format("its driver has no OpenGL {}.{} core", kMajor, kMinor);
    return {};
  }
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    problem = "its context could not be made current";
    eglDestroyContext(display, context);
    return {};
  }
  return {display, context};
}

std::vector<EGLDisplay> displays() {
  std::vector<EGLDisplay> found;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) {
      for (const bool software : {false, true})
        for (int i = 0; i < count; ++i) {
          const auto device = devices[static_cast<std::size_t>(i)];
          const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
          const bool is_software =
              extensions &&
              std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos;
          if (is_software == software)
            found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
        }
    }
  }
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  return found;
}

}  // namespace

struct HeadlessContext::Impl {
  Candidate chosen;
  ~Impl() {
    if (chosen.context == EGL_NO_CONTEXT) return;
    eglMakeCurrent(chosen.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(chosen.display, chosen.context);
  }
};

HeadlessContext::HeadlessContext() : impl_(std::make_unique<Impl>()) {
  std::string problem = "there is no EGL device";
  for (const EGLDisplay display : displays()) {
    impl_->chosen = tryDisplay(display, problem);
    if (impl_->chosen.context != EGL_NO_CONTEXT) return;
  }
  throw Error(
      ErrorCode::kUnsupported, "OpenGL", problem,
      "install a graphics driver (Debian: libgl1-mesa-dri draws without a GPU), or take --renderer cpu");
}

HeadlessContext::~HeadlessContext() = default;
HeadlessContext::HeadlessContext(HeadlessContext&&) noexcept = default;

std::string deviceName() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  return fmt::format("{}, OpenGL {}.{}", renderer ? renderer : "unknown", major, minor);
}

bool isSoftware() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view name = renderer ? renderer : "";
  return name.find("llvmpipe") != name.npos || name.find("softpipe") != name.npos ||
         name.find("SWR") != name.npos;
}

void requireOpenGl() {
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (major < kMajor || (major == kMajor && minor < kMinor))
    throw Error(ErrorCode::kUnsupported, "OpenGL",
                fmt::format("is {}.{} here, where {}.{} is needed", major, minor, kMajor, kMinor),
                "update the graphics driver; LIBGL_ALWAYS_SOFTWARE=1 draws with the processor");
}

}  // namespace relume::render
