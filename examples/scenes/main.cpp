// SPDX-License-Identifier: MIT
// make_scenes OUT_DIR [--scene NAME] [--detail N]: writes the example scenes as .glb files.
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "relume/core/error.h"
#include "relume/core/file.h"
#include "scenes.h"

namespace {

using namespace relume;
using namespace relume::scenes;

constexpr const char* kUsage =
    "usage: make_scenes OUT_DIR [--scene NAME] [--detail N]\n"
    "  --scene NAME  cornell, hall, halls, temple, car, rooms, crossing, lampshade, furniture, "
    "glossy_room, courtyard, vase or day_hall; default: all\n"
    "  --detail N    tessellation, 1 to 16; default 2. make_scenes . --scene temple --detail 6 has 106,000 "
    "triangles\n";

struct Options {
  std::filesystem::path folder;
  std::string scene;
  int detail = kDefaultDetail;
};

std::optional<Options> parse(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--help") return std::nullopt;
    if (arg == "--scene" || arg == "--detail") {
      if (++i == argc) throw Error(ErrorCode::kUsage, arg, "needs a value", "see make_scenes --help");
      const std::string value = argv[i];
      if (arg == "--scene") {
        o.scene = value;
        continue;
      }
      const auto [end, failed] = std::from_chars(value.data(), value.data() + value.size(), o.detail);
      if (failed != std::errc() || end != value.data() + value.size() || o.detail < 1 ||
          o.detail > kLargestDetail)
        throw Error(ErrorCode::kUsage, "--detail " + value, "is not a whole number from 1 to 16",
                    "try --detail 2");
    } else if (arg.starts_with("-") || !o.folder.empty()) {
      throw Error(ErrorCode::kUsage, arg, "is not known here", "see make_scenes --help");
    } else {
      o.folder = arg;
    }
  }
  if (o.folder.empty()) throw Error(ErrorCode::kUsage, "OUT_DIR", "is missing", "see make_scenes --help");
  return o;
}

void run(const Options& o) {
  bool found = false;
  std::error_code ignored;  // a folder that cannot be made shows when the file is written
  std::filesystem::create_directories(o.folder, ignored);
  for (const SceneEntry& entry : allScenes()) {
    if (!o.scene.empty() && o.scene != entry.name) continue;
    found = true;
    const GlbScene scene = entry.make(o.detail);
    const std::vector<std::byte> file = scene.glb();
    const std::filesystem::path path = o.folder / (std::string(entry.name) + ".glb");
    writeFileAtomically(path, file);
    std::printf("%s: %zu triangles, %zu lights, %zu bytes\n", path.c_str(), scene.triangleCount(),
                scene.lightCount(), file.size());
  }
  if (!found)
    throw Error(ErrorCode::kUsage, "--scene " + o.scene, "is not one of the scenes",
                "cornell, hall, halls, temple, car, rooms, crossing, lampshade, furniture");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::optional<Options> o = parse(argc, argv);
    if (!o) {
      std::fputs(kUsage, stdout);
      return 0;
    }
    run(*o);
  } catch (const Error& e) {
    std::fprintf(stderr, "make_scenes: %s\n", e.what());
    return exitStatus(e.code());
  }
  return 0;
}
