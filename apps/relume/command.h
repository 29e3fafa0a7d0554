// SPDX-License-Identifier: MIT
// The commands of the program. Each file of a command has one function that declares its options; what it
// does runs when its subcommand was parsed.
#pragma once
#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <string>

#include "relume/core/progress.h"

namespace relume::app {

/// What the chosen command will do; set by the callback of its subcommand.
struct Program {
  std::string command_line;  ///< as typed, for replay
  std::function<void(Progress&)> run;
  std::string progress_mode = "auto";  ///< auto | json | none
};

void addBake(CLI::App& app, Program& program);
void addRelight(CLI::App& app, Program& program);
void addRender(CLI::App& app, Program& program);
void addInspect(CLI::App& app, Program& program);
void addExport(CLI::App& app, Program& program);
void addCompare(CLI::App& app, Program& program);
void addVerify(CLI::App& app, Program& program);
void addView(CLI::App& app, Program& program);
void addRelief(CLI::App& app, Program& program);

/// Options that belong to one command live as long as the program: the callback holds them.
template <class Options, class Run>
void onCommand(CLI::App* command, Program& program, std::shared_ptr<Options> options, Run run) {
  command->callback([&program, options, run] {
    program.run = [options, run](Progress& progress) { run(*options, progress); };
  });
}

}  // namespace relume::app
