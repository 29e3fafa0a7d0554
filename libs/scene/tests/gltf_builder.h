// SPDX-License-Identifier: MIT
// glTF files made by code: JSON and a binary chunk, put together as a .glb.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "glb.h"
#include "relume/scene/gltf.h"

namespace relume::scene::gltf {

inline std::vector<std::byte> toBytes(const void* data, std::size_t size) {
  const auto* p = static_cast<const std::byte*>(data);
  return {p, p + size};
}
template <class T>
std::vector<std::byte> toBytes(const std::vector<T>& values) {
  return toBytes(values.data(), values.size() * sizeof(T));
}
inline std::vector<std::byte> toBytes(const std::string& text) { return toBytes(text.data(), text.size()); }

class GltfBuilder {
 public:
  using Json = nlohmann::json;
  Json doc = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::byte> bin;

  std::size_t push(const char* list, Json element) {
    if (!doc.contains(list)) doc[list] = Json::array();
    doc[list].push_back(std::move(element));
    return doc[list].size() - 1;
  }
  std::size_t view(const std::vector<std::byte>& bytes, std::size_t stride = 0) {
    bin.resize(alignedSize(bin.size()));
    Json json = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) json["byteStride"] = stride;
    bin.insert(bin.end(), bytes.begin(), bytes.end());
    return push("bufferViews", json);
  }
  /// componentType from the C++ type of the numbers; count from how many there are.
  template <class T>
  std::size_t accessor(const std::vector<T>& numbers, const char* type, bool normalized = false) {
    const Json json = {{"bufferView", view(toBytes(numbers))},
                       {"componentType", componentType<T>()},
                       {"count", numbers.size() / componentsOf(type)},
                       {"type", type}};
    const std::size_t index = push("accessors", json);
    if (normalized) doc["accessors"][index]["normalized"] = true;
    return index;
  }
  std::size_t mesh(Json primitive) {
    return push("meshes", {{"primitives", Json::array({std::move(primitive)})}});
  }
  /// A node that is a root of the scene.
  std::size_t node(Json json) {
    const std::size_t n = push("nodes", std::move(json));
    if (!doc.contains("scenes")) doc["scenes"] = Json::array({{{"nodes", Json::array()}}});
    doc["scenes"][0]["nodes"].push_back(n);
    return n;
  }
  /// Attributes of a triangle (0,0,0), (1,0,0), (0,1,0) facing +z.
  Json triangleAttributes() {
    return {{"POSITION", accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")},
            {"NORMAL", accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")},
            {"TEXCOORD_0", accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2")}};
  }
  Json trianglePrimitive() {
    Json attributes = triangleAttributes();
    return {{"attributes", attributes}, {"indices", accessor<std::uint16_t>({0, 1, 2}, "SCALAR")}};
  }
  /// A scene of one node that shows one triangle.
  GltfBuilder& triangle(Json node_fields = Json::object()) {
    node_fields["mesh"] = mesh(trianglePrimitive());
    node(std::move(node_fields));
    return *this;
  }

  std::vector<std::byte> glb() const {
    Json json = doc;
    if (!bin.empty() && !json.contains("buffers"))
      json["buffers"] = Json::array({{{"byteLength", bin.size()}}});
    std::vector<std::span<const std::byte>> pieces;
    if (!bin.empty()) pieces.emplace_back(bin);
    return joinGlb(json.dump(), pieces);
  }
  Document document() const { return Document::parse(glb(), "test.glb", {}); }
  Scene scene(const ImportOptions& options = {}) {
    warnings.clear();
    return import(document(), warnings, options);
  }
  Warnings warnings;

  static std::size_t componentsOf(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "MAT3") return 9;
    if (type == "MAT4") return 16;
    return static_cast<std::size_t>(type.back() - '0');
  }
  template <class T>
  static int componentType() {
    if constexpr (std::is_same_v<T, std::int8_t>)
      return 5120;
    else if constexpr (std::is_same_v<T, std::uint8_t>)
      return 5121;
    else if constexpr (std::is_same_v<T, std::int16_t>)
      return 5122;
    else if constexpr (std::is_same_v<T, std::uint16_t>)
      return 5123;
    else if constexpr (std::is_same_v<T, std::uint32_t>)
      return 5125;
    else
      return 5126;
  }
};

/// The code of the Error that `action` throws; fails the test when it throws none.
template <class Action>
std::string errorOf(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return name(error.code());
  }
  return "no error";
}

}  // namespace relume::scene::gltf
