// SPDX-License-Identifier: MIT
// relume view: a window on a bake or a scene.
#include "command.h"
#include "files.h"
#include "viewer/viewer.h"

namespace relume::app {

void addView(CLI::App& app, Program& program) {
  struct Options {
    ViewerOptions viewer;
    std::string input, size = "1280x720";
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("view",
                                         "A window on a bake or a plain scene: walk through it, move its "
                                         "lamps, look at the bake; ? shows the keys."
                                         "\nExample: relume view castle.baked.glb --lights evening.json");
  command->add_option("INPUT", options->input, "a scene (.gltf, .glb) or a baked .glb")->required();
  command->add_option("--lights", options->viewer.lights, "JSON list of lights; without it, the scene's own");
  command->add_option("--layer", options->viewer.layer, "layer of transfer; without it, the first");
  command
      ->add_option("--camera", options->viewer.camera,
                   "camera of the file to begin with; -1: its first, or one that frames the scene")
      ->capture_default_str();
  command->add_option("--size", options->size, "of the window, width x height")->capture_default_str();
  command->add_option("--object", options->viewer.objects,
                      "repeatable: FILE.glb@x,y,z[,turn[,scale]], something to carry about");
  command->add_option("--object-light", options->viewer.object_light, "what lights them beside lamps")
      ->check(CLI::IsMember({"cube", "probes", "none"}))
      ->capture_default_str();
  command
      ->add_option("--shadow-size", options->viewer.shadow_size,
                   "texels along a side of a shadow map's face; 0: 1024, without a GPU 256")
      ->check(CLI::Range(0, 8192))
      ->capture_default_str();
  command
      ->add_option("--frames", options->viewer.frames,
                   "end after so many frames and print their times; 0: at will")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command->add_option("--screenshot", options->viewer.screenshot, "with --frames: the last one, to .png");
  command->add_option("--record", options->viewer.record,
                      "with --frames: their path of camera and lamps, to .json");
  command
      ->add_option(
          "--show", options->viewer.show,
          "from the start: split, entries, truth, help, as by their keys; panels: on the screenshot too")
      ->delimiter(',')
      ->check(CLI::IsMember({"split", "entries", "truth", "help", "panels"}));
  command->add_flag("--sweep", options->viewer.sweep, "with --frames: the first lamp moves to and fro");
  onCommand(command, program, options, [](const Options& o, Progress&) {
    ViewerOptions viewer = o.viewer;
    viewer.file = o.input;
    viewer.size = parseExtent(o.size, "--size");
    runViewer(viewer);
  });
}

}  // namespace relume::app
