// SPDX-License-Identifier: MIT
// OpenGL without a window: what `relume render --renderer gl` and tests draw in.
#pragma once
#include <memory>
#include <string>

namespace relume::render {

/// An OpenGL 4.5 core context by EGL, on the first device that has one: a GPU, or Mesa's software renderer.
/// Current on the thread that made it until it ends.
class HeadlessContext {
 public:
  /// Throws Error kUnsupported saying what is missing.
  HeadlessContext();
  ~HeadlessContext();
  HeadlessContext(HeadlessContext&&) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Of the current context, e.g. "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
std::string deviceName();
/// Whether the current context is drawn by the processor.
bool isSoftware();
/// Throws Error kUnsupported unless the current context is OpenGL 4.5 or newer.
void requireOpenGl();

}  // namespace relume::render
