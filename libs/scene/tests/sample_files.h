// SPDX-License-Identifier: MIT
// Small files for tests and as seeds of the fuzzer: a bit of everything, and the compressed kinds.
#pragma once
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <cstdlib>

#include "gltf_builder.h"
#include "relume/image/io.h"

namespace relume::scene::gltf {

/// Small, but with a bit of everything that import reads.
inline GltfBuilder everything() {
  GltfBuilder b;
  nlohmann::json primitive = b.trianglePrimitive();
  primitive["material"] = 0;
  primitive["attributes"]["COLOR_0"] =
      b.accessor<std::uint8_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 2, 3}, "VEC4", true);
  primitive["targets"] = {{{"POSITION", 0}}};
  b.doc["accessors"][1]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", b.view(toBytes(std::string("\1")))}, {"componentType", 5121}}},
      {"values", {{"bufferView", 0}}}};
  const auto mesh = b.mesh(primitive);
  const auto joint = b.node({{"children", {1}}, {"scale", {1, 2, 1}}});
  b.push("nodes", {{"mesh", mesh}, {"skin", 0}, {"rotation", {0, 0, 0, 1}}});
  b.node({{"mesh", mesh}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
  b.doc["skins"] = {
      {{"joints", {joint}}, {"inverseBindMatrices", b.accessor<float>(std::vector<float>(16, 1), "MAT4")}}};
  b.doc["animations"] = {{{"samplers", {{{"input", 0}, {"output", 1}}}},
                          {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
  b.doc["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 0}}}}},
                         {"emissiveFactor", {1, 0, 0}},
                         {"alphaMode", "MASK"},
                         {"extras", {{"relume", {{"copyOf", 0}}}}}}};
  b.doc["textures"] = {{{"source", 0}, {"sampler", 0}}};
  b.doc["samplers"] = {{{"wrapS", 33071}}};
  b.doc["images"] = {
      {{"bufferView", b.view(image::encodePngData(image::Image(2, 2, 1)))}, {"mimeType", "image/png"}}};
  b.doc["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}}}}};
  b.doc["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}};
  b.node({{"camera", 0},
          {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
          {"extras", {{"relume", {{"static", true}}}}}});
  return b;
}

inline std::vector<std::byte> meshoptVertices(const std::vector<float>& values, std::size_t stride) {
  const std::size_t count = values.size() * 4 / stride;
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
  return toBytes(out);
}

inline std::vector<std::byte> meshoptTriangles(const std::vector<unsigned>& indices) {
  std::vector<unsigned char> out(meshopt_encodeIndexBufferBound(indices.size(), 100));
  out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
  return toBytes(out);
}

inline std::vector<std::byte> meshoptSequence(const std::vector<unsigned>& indices) {
  std::vector<unsigned char> out(meshopt_encodeIndexSequenceBound(indices.size(), 100));
  out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
  return toBytes(out);
}

/// A view whose bytes are compressed: it stands for `length` bytes of buffer 1, which has none.
inline std::size_t compressedView(GltfBuilder& b, const std::vector<std::byte>& packed, std::size_t stride,
                                  std::size_t count, const char* mode,
                                  const char* extension = "EXT_meshopt_compression",
                                  const char* filter = "NONE") {
  const std::size_t raw = b.view(packed);
  nlohmann::json view = {{"buffer", 1}, {"byteLength", stride * count}};
  view["extensions"][extension] = {{"buffer", 0},
                                   {"byteOffset", b.doc["bufferViews"][raw]["byteOffset"]},
                                   {"byteLength", packed.size()},
                                   {"byteStride", stride},
                                   {"count", count},
                                   {"mode", mode},
                                   {"filter", filter}};
  return b.push("bufferViews", view);
}

inline GltfBuilder meshoptFile(const char* extension, bool sequence) {
  GltfBuilder b;
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  const std::vector<unsigned> indices = {0, 1, 2, 2, 1, 3};
  const auto vertices = compressedView(b, meshoptVertices(positions, 12), 12, 4, "ATTRIBUTES", extension);
  const auto corners = sequence ? compressedView(b, meshoptSequence(indices), 4, 6, "INDICES", extension)
                                : compressedView(b, meshoptTriangles(indices), 2, 6, "TRIANGLES", extension);
  b.doc["accessors"] = {
      {{"bufferView", vertices}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
      {{"bufferView", corners}, {"componentType", sequence ? 5125 : 5123}, {"count", 6}, {"type", "SCALAR"}}};
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", 0}}}, {"indices", 1}})}});
  b.doc["buffers"] = {{{"byteLength", b.bin.size()}},
                      {{"byteLength", 100}, {"extensions", {{extension, {{"fallback", true}}}}}}};
  b.doc["extensionsRequired"] = {extension};
  return b;
}

/// A quad as a Draco stream, positions as floats with unique id 0, colours as bytes with unique id 1.
inline std::vector<std::byte> dracoQuad(bool edgebreaker) {
  draco::Mesh mesh;
  mesh.set_num_points(4);
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  const std::vector<std::uint8_t> colours = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
  draco::GeometryAttribute position, colour;
  position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  colour.Init(draco::GeometryAttribute::COLOR, nullptr, 3, draco::DT_UINT8, true, 3, 0);
  for (const auto& attribute : {position, colour}) mesh.AddAttribute(attribute, true, 4);
  for (unsigned v = 0; v < 4; ++v) {
    mesh.attribute(0)->SetAttributeValue(draco::AttributeValueIndex(v), positions.data() + 3 * v);
    mesh.attribute(1)->SetAttributeValue(draco::AttributeValueIndex(v), colours.data() + 3 * v);
  }
  using P = draco::PointIndex;
  mesh.AddFace({P(0), P(1), P(2)});
  mesh.AddFace({P(2), P(1), P(3)});
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) std::abort();
  return toBytes(buffer.data(), buffer.size());
}

inline GltfBuilder dracoFile(bool edgebreaker) {
  GltfBuilder b;
  const auto view = b.view(dracoQuad(edgebreaker));
  b.doc["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                        {{"componentType", 5121}, {"count", 4}, {"type", "VEC3"}, {"normalized", true}},
                        {{"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}};
  nlohmann::json primitive = {{"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}, {"indices", 2}};
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                           {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
  b.node({{"mesh", b.mesh(primitive)}});
  b.doc["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return b;
}

}  // namespace relume::scene::gltf
