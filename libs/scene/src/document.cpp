// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "extensions.h"
#include "glb.h"
#include "json_value.h"
#include "relume/core/file.h"
#include "relume/scene/gltf.h"
#include "uri.h"

namespace relume::scene::gltf {

using Json = nlohmann::json;

struct Document::Container {
  Json document;
  std::optional<std::vector<std::byte>> binary;
  std::size_t bytes = 0;
};

namespace {

// Copying and writing JSON is recursive; no honest file is nested deeper.
constexpr int kDeepest = 256;

void refuseDeepNesting(std::string_view text, const std::string& name) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest)
        throw Error(ErrorCode::kInvalidJson, name, fmt::format("is nested deeper than {} levels", kDeepest));
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

Json parseJson(std::string_view text, const std::string& name) {
  refuseDeepNesting(text, name);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw Error(ErrorCode::kInvalidJson, name, fmt::format("the JSON is invalid at byte {}", error.byte),
                "export it again");
  } catch (const Json::exception&) {
    throw Error(ErrorCode::kInvalidJson, name, "the JSON holds a number out of range", "export it again");
  }
}

// Some writers pad the chunk with zeros, which is not JSON.
std::string_view withoutPadding(std::string_view text) {
  while (!text.empty() && text.back() == '\0') text.remove_suffix(1);
  return text;
}

void checkVersion(const Value& root) {
  const Value asset = root["asset"];
  if (!asset) throw Error(ErrorCode::kNotGltf, root.subject(), "has no \"asset\", so it is not glTF 2.0");
  const std::string version = asset["version"].text("");
  if (version.empty()) asset["version"].fail(ErrorCode::kInvalidValue, "is missing");
  if (version != "2" && version.substr(0, 2) != "2.")
    asset["version"].fail(ErrorCode::kUnsupported, fmt::format("is \"{}\"", version.substr(0, 20)),
                          "export it as glTF 2.0");
  const std::string least = asset["minVersion"].text("2.0");
  if (least != "2.0")
    asset["minVersion"].fail(ErrorCode::kUnsupported, fmt::format("is \"{}\"", least.substr(0, 20)),
                             "export it as glTF 2.0");
}

void checkRequiredExtensions(const Value& root) {
  const Value required = root["extensionsRequired"];
  for (std::size_t i = 0; i < required.size(); ++i) {
    const std::string extension = required.at(i).text("");
    if (!isReadable(extension))
      required.fail(ErrorCode::kUnsupported,
                    fmt::format("needs the extension {}, which is not known here", extension),
                    "export the file without it");
  }
}

bool isFallback(const Value& buffer) {
  return std::ranges::any_of(kMeshoptExtensions, [&](const char* name) {
    return buffer.extension(name)["fallback"].boolean(false);
  });
}

}  // namespace

Document Document::fromContainer(Container container, const std::string& name,
                                 const std::filesystem::path& folder) {
  Document document;
  document.json_ = std::move(container.document);
  document.name_ = name;
  document.folder_ = folder;
  document.input_bytes_ = container.bytes;
  const Value root(document.name_, document.json_);
  if (!document.json_.is_object()) root.fail(ErrorCode::kNotGltf, "is JSON but not an object");
  checkVersion(root);
  checkRequiredExtensions(root);

  const Value buffers = root["buffers"];
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const Value buffer = buffers.at(i);
    const std::uint64_t length = buffer["byteLength"].integer();
    auto& bytes = document.buffers_.emplace_back();
    if (const Value uri = buffer["uri"]) {
      const std::string text = uri.text("");
      bytes =
          isDataUri(text) ? decodeDataUri(text, uri.subject()) : readRelative(folder, text, buffer.subject());
      if (!isDataUri(text)) document.input_bytes_ += bytes->size();
    } else if (i == 0 && container.binary) {
      bytes = std::move(container.binary);
    } else {
      continue;
    }
    if (bytes->size() < length && !isFallback(buffer))
      buffer.fail(ErrorCode::kTruncated,
                  fmt::format("has {} bytes, but byteLength is {}", bytes->size(), length),
                  "copy or export it again");
    if (bytes->size() > length) bytes->resize(static_cast<std::size_t>(length));
  }
  return document;
}

Document Document::parse(std::span<const std::byte> file, const std::string& name,
                         const std::filesystem::path& folder) {
  Container container;
  container.bytes = file.size();
  if (isGlb(file)) {
    const GlbChunks chunks = splitGlb(file, name);
    container.document = parseJson(withoutPadding(chunks.json), name);
    if (chunks.binary) container.binary.emplace(chunks.binary->begin(), chunks.binary->end());
  } else {
    if (file.empty()) throw Error(ErrorCode::kTruncated, name, "is empty");
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    const std::size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (begin == std::string_view::npos || text[begin] != '{')
      throw Error(ErrorCode::kNotGltf, name, "is neither a .gltf nor a .glb file");
    container.document = parseJson(text, name);
  }
  return fromContainer(std::move(container), name, folder);
}

Document Document::read(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  std::vector<std::byte> file = readFile(path);
  const std::filesystem::path folder =
      path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!isGlb(file)) return parse(file, name, folder);

  // The binary chunk stays in the memory of the file: a copy would double the peak.
  const GlbChunks chunks = splitGlb(file, name);
  Container container;
  container.bytes = file.size();
  container.document = parseJson(withoutPadding(chunks.json), name);
  if (chunks.binary) {
    const auto offset = chunks.binary->data() - file.data();
    const std::size_t size = chunks.binary->size();
    file.erase(file.begin(), file.begin() + offset);
    file.resize(size);
    container.binary = std::move(file);
  }
  return fromContainer(std::move(container), name, folder);
}

}  // namespace relume::scene::gltf
