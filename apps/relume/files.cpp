// SPDX-License-Identifier: MIT
#include "files.h"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "relume/core/file.h"

namespace relume::app {

void print(const Warnings& warnings) {
  constexpr std::size_t kMostNamed = 4;
  std::vector<bool> said(warnings.size());
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    if (said[i]) continue;
    Warning line = warnings[i];
    std::size_t more = 0, named = 1;
    for (std::size_t k = i + 1; k < warnings.size(); ++k) {
      if (warnings[k].problem != line.problem || warnings[k].remedy != line.remedy) continue;
      said[k] = true;
      if (warnings[k].subject == warnings[i].subject) continue;
      if (named++ < kMostNamed)
        line.subject += ", " + warnings[k].subject;
      else
        ++more;
    }
    if (more > 0) line.subject += fmt::format(" and {} more", more);
    fmt::print(stderr, "warning: {}\n", line.text());
  }
}

std::unique_ptr<Opened> open(const std::filesystem::path& path, const scene::gltf::ImportOptions& options) {
  auto opened = std::make_unique<Opened>();
  const auto document = scene::gltf::Document::read(path);
  Warnings warnings;
  opened->scene = scene::gltf::import(document, warnings, options);
  print(warnings);
  const auto extensions = document.json().find("extensions");
  if (extensions != document.json().end() && extensions->contains("RELUME_transfer"))
    opened->asset = asset::readAsset(path);
  return opened;
}

Vec3 parseTriple(const std::string& text, const std::string& option, bool one_is_enough) {
  std::vector<float> values;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    float value = 0;
    const auto [stop, ec] = std::from_chars(text.data() + begin, text.data() + end, value);
    if (ec != std::errc() || stop != text.data() + end || !(std::abs(value) < kInfinity)) {
      values.clear();
      break;
    }
    values.push_back(value);
    begin = end + 1;
  }
  if (values.size() == 1 && one_is_enough) return Vec3(values[0]);
  if (values.size() != 3)
    throw Error(ErrorCode::kUsage, option + " " + text, "is not three numbers",
                "write for example " + option + " 1,0.5,2");
  return {values[0], values[1], values[2]};
}

IVec2 parseExtent(const std::string& text, const std::string& option) {
  IVec2 size{0, 0};
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.x);
  const bool has_height = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  const auto height = has_height ? std::from_chars(width.ptr + 1, end, size.y) : width;
  if (!has_height || height.ec != std::errc() || height.ptr != end || size.x < 1 || size.y < 1 ||
      size.x > 16384 || size.y > 16384)
    throw Error(ErrorCode::kUsage, option + " " + text, "is not a size",
                "write for example " + option + " 960x540");
  return size;
}

void makeFolder(const std::filesystem::path& path) {
  std::error_code ec;
  std::filesystem::create_directories(path, ec);
  if (ec)
    throw Error(ErrorCode::kCannotWrite, path.string(), "cannot make the folder: " + ec.message(),
                "choose a place that you may write to");
  requireWritable(path / "any");
}

std::filesystem::path beside(const std::filesystem::path& input, const std::string& ending) {
  return input.parent_path() / (input.stem().string() + ending);
}

}  // namespace relume::app
