// SPDX-License-Identifier: MIT
// relume: bakes light transport into glTF scenes and relights them.
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "command.h"
#include "console_progress.h"
#include "heap.h"
#include "relume/core/check.h"
#include "relume/core/error.h"
#include "relume/core/version.h"
#include "shell.h"

namespace {

using relume::Error;
using relume::ErrorCode;

relume::Progress* g_progress = nullptr;

// The first Ctrl-C lets the work stop at a safe place; a second one ends the program as usual.
extern "C" void onInterrupt(int signal) {
  if (g_progress) g_progress->cancel();
  std::signal(signal, SIG_DFL);
}

int fail(ErrorCode code, const char* text) {
  fmt::print(stderr, "relume: {}\n", text);
  return relume::exitStatus(code);
}

}  // namespace

int main(int argc, char** argv) {
  relume::app::prepareHeap();
  CLI::App app{
      "Relume bakes how light travels through a glTF scene, and relights it.\n"
      "Example: relume bake castle.glb -o castle.baked.glb && relume render castle.baked.glb -o castle.png",
      "relume"};
  app.set_version_flag("--version", std::string("relume ") + relume::version());
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  relume::app::Program program;
  program.command_line = relume::app::shellLine(std::vector<std::string>(argv, argv + argc));
  relume::app::addBake(app, program);
  relume::app::addRelight(app, program);
  relume::app::addRender(app, program);
  relume::app::addInspect(app, program);
  relume::app::addExport(app, program);
  relume::app::addCompare(app, program);
  relume::app::addVerify(app, program);
  relume::app::addView(app, program);
  relume::app::addRelief(app, program);
  relume::setReplayCommand(program.command_line);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);  // --help, --version
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    fmt::print(stderr, "relume: {}; see relume {}--help\n", error.what(),
               chosen.empty() ? "" : chosen[0]->get_name() + " ");
    return relume::exitStatus(ErrorCode::kUsage);
  } catch (const Error& error) {
    return fail(error.code(), error.what());
  }

  const auto progress = relume::app::makeConsoleProgress(program.progress_mode);
  g_progress = progress.get();
  std::signal(SIGINT, onInterrupt);
  std::signal(SIGTERM, onInterrupt);
  try {
    program.run(*progress);
    return 0;
  } catch (const Error& error) {
    return fail(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kOutOfMemory,
                "out of memory; use a smaller --atlas-size, or close other programs");
  } catch (const std::exception& error) {
    return fail(ErrorCode::kFileUnreadable, error.what());
  }
}
