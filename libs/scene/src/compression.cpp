// SPDX-License-Identifier: MIT
#include "compression.h"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <cstring>
#include <limits>
#include <new>

namespace relume::scene::gltf {

namespace {

[[noreturn]] void corrupt(const std::string& subject, const std::string& what) {
  throw Error(ErrorCode::kInvalidValue, subject, what, "export the file again, or without compression");
}

}  // namespace

std::vector<std::byte> decompressView(const CompressedView& view) {
  std::vector<std::byte> out(view.stride * view.count);
  const auto* packed = reinterpret_cast<const unsigned char*>(view.bytes.data());
  int failed = 0;
  if (view.mode == "ATTRIBUTES") {
    if (view.stride % 4 != 0)
      corrupt(view.subject, fmt::format("byteStride {} is not a multiple of 4", view.stride));
    failed = meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, packed, view.bytes.size());
  } else if (view.mode == "TRIANGLES" || view.mode == "INDICES") {
    if (view.stride != 2 && view.stride != 4)
      corrupt(view.subject, fmt::format("indices of {} bytes", view.stride));
    if (view.mode == "TRIANGLES" && view.count % 3 != 0)
      corrupt(view.subject, fmt::format("{} indices are no triangles", view.count));
    failed =
        view.mode == "TRIANGLES"
            ? meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, packed, view.bytes.size())
            : meshopt_decodeIndexSequence(out.data(), view.count, view.stride, packed, view.bytes.size());
  } else {
    corrupt(view.subject, fmt::format("mode \"{}\" is not known", view.mode.substr(0, 20)));
  }
  if (failed) corrupt(view.subject, "cannot be decompressed");
  if (view.filter == "NONE") return out;

  if (view.mode != "ATTRIBUTES") corrupt(view.subject, "filters indices");
  if (view.filter == "OCTAHEDRAL") {
    if (view.stride != 4 && view.stride != 8)
      corrupt(view.subject, "an octahedral filter needs byteStride 4 or 8");
    meshopt_decodeFilterOct(out.data(), view.count, view.stride);
  } else if (view.filter == "QUATERNION") {
    if (view.stride != 8) corrupt(view.subject, "a quaternion filter needs byteStride 8");
    meshopt_decodeFilterQuat(out.data(), view.count, view.stride);
  } else if (view.filter == "EXPONENTIAL") {
    meshopt_decodeFilterExp(out.data(), view.count, view.stride);
  } else {
    corrupt(view.subject, fmt::format("filter \"{}\" is not known", view.filter.substr(0, 20)));
  }
  return out;
}

namespace {

// Draco allocates what the stream's header asks for, so the header is read first (Draco bitstream 2.2,
// sections 4 and 6).
void refuseImplausibleHeader(std::span<const std::byte> bytes, const std::string& subject) {
  constexpr std::size_t kFixed = 11;
  if (bytes.size() < kFixed || std::memcmp(bytes.data(), "DRACO", 5) != 0)
    corrupt(subject, "is not Draco data");
  const auto field = [&](std::size_t at) { return std::to_integer<unsigned>(bytes[at]); };
  if (field(5) != 2 || field(6) != 2)
    throw Error(ErrorCode::kUnsupported, subject,
                fmt::format("is Draco of version {}.{}; glTF uses 2.2", field(5), field(6)));
  if (field(7) != draco::TRIANGULAR_MESH) corrupt(subject, "is Draco data but not a mesh");
  const bool edgebreaker = field(8) == draco::MESH_EDGEBREAKER_ENCODING;
  if (!edgebreaker && field(8) != draco::MESH_SEQUENTIAL_ENCODING)
    corrupt(subject, "is Draco data of an unknown method");
  const bool has_metadata = (field(9) | field(10) << 8) & 0x8000u;

  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()) + kFixed, bytes.size() - kFixed);
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  if (has_metadata) {
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
      corrupt(subject, "has broken Draco metadata");
  }
  std::uint8_t traversal = 0;
  std::uint32_t first = 0, second = 0, symbols = 0, splits = 0;
  bool read = !edgebreaker || buffer.Decode(&traversal);
  read = read && draco::DecodeVarint(&first, &buffer) && draco::DecodeVarint(&second, &buffer);
  if (read && edgebreaker) {
    std::uint8_t attribute_data = 0;
    read = buffer.Decode(&attribute_data) && draco::DecodeVarint(&symbols, &buffer) &&
           draco::DecodeVarint(&splits, &buffer);
  }
  if (!read) corrupt(subject, "ends within the Draco header");
  const std::size_t most = Access::plausibleCount(bytes.size());
  for (const std::uint32_t n : {first, second, symbols, splits})
    if (n > most)
      throw Error(ErrorCode::kOutOfBounds, subject,
                  fmt::format("claims {} elements, more than {} compressed bytes can hold", n, bytes.size()));
}

template <class T>
std::vector<std::byte> convert(const draco::PointAttribute& attribute, std::uint32_t vertices,
                               std::uint32_t components, const std::string& subject) {
  std::vector<std::byte> out(vertices * components * sizeof(T));
  T element[16] = {};
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(v));
    if (value.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(value, static_cast<std::int8_t>(components), element))
      corrupt(subject, "has a Draco attribute that cannot be converted");
    std::memcpy(out.data() + v * components * sizeof(T), element, components * sizeof(T));
  }
  return out;
}

std::vector<std::byte> convert(const draco::PointAttribute& attribute, std::uint32_t vertices,
                               const DracoRequest& request) {
  switch (request.component) {
    case Component::kByte:
      return convert<std::int8_t>(attribute, vertices, request.components, request.subject);
    case Component::kUnsignedByte:
      return convert<std::uint8_t>(attribute, vertices, request.components, request.subject);
    case Component::kShort:
      return convert<std::int16_t>(attribute, vertices, request.components, request.subject);
    case Component::kUnsignedShort:
      return convert<std::uint16_t>(attribute, vertices, request.components, request.subject);
    case Component::kUnsignedInt:
      return convert<std::uint32_t>(attribute, vertices, request.components, request.subject);
    case Component::kFloat:
      break;
  }
  return convert<float>(attribute, vertices, request.components, request.subject);
}

}  // namespace

DracoMesh decodeDraco(std::span<const std::byte> bytes, const std::vector<DracoRequest>& requests,
                      const std::string& subject) {
  refuseImplausibleHeader(bytes, subject);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  std::unique_ptr<draco::Mesh> mesh;
  try {
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
      corrupt(subject, fmt::format("cannot be decompressed ({})", decoded.status().error_msg_string()));
    mesh = std::move(decoded).value();
  } catch (const std::bad_alloc&) {
    corrupt(subject, "asks for more memory than there is");
  } catch (const std::length_error&) {
    corrupt(subject, "asks for more memory than there can be");
  }

  DracoMesh out;
  out.vertices = mesh->num_points();
  out.indices.reserve(std::size_t{mesh->num_faces()} * 3);
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
    for (const draco::PointIndex& p : mesh->face(f)) out.indices.push_back(p.value());
  for (const DracoRequest& request : requests) {
    const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(request.id);
    if (!attribute)
      throw Error(ErrorCode::kInvalidReference, request.subject,
                  fmt::format("names the Draco attribute {}, which does not exist", request.id));
    out.attributes.push_back(convert(*attribute, out.vertices, request));
  }
  return out;
}

}  // namespace relume::scene::gltf
