// SPDX-License-Identifier: MIT
#include "shader_text.h"

#include <set>
#include <sstream>
#include <string_view>

#include "relume/core/check.h"

namespace relume::render {
namespace {

struct Row {
  std::string_view name, text;
};
constexpr Row kTable[] = {
#include "shader_table.inc"
};

std::string_view find(std::string_view name) {
  for (const Row& row : kTable)
    if (row.name == name) return row.text;
  return {};
}

void append(std::string_view name, std::set<std::string, std::less<>>& seen, std::string& out) {
  constexpr std::string_view kInclude = "#include \"";
  const std::string_view text = find(name);
  RELUME_CHECK(!text.empty());
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (!line.starts_with(kInclude)) {
      out += line + '\n';
      continue;
    }
    const std::string included = line.substr(kInclude.size(), line.rfind('"') - kInclude.size());
    if (!seen.insert(included).second) continue;
    out += "#line 1\n";
    append(included, seen, out);
    out += "#line " + std::to_string(number + 1) + '\n';
  }
}

}  // namespace

std::string shaderText(const std::string& name, const std::string& defines) {
  std::string out = "#version 450 core\n" + defines + "#line 1\n";
  std::set<std::string, std::less<>> seen{name};
  append(name, seen, out);
  return out;
}

}  // namespace relume::render
