// SPDX-License-Identifier: MIT
// The bake inside a .glb: root extension RELUME_transfer (docs/format.md). Read by the run-time library,
// which has no glTF importer; written through scene::gltf::exportGlb, to which `encode` gives JSON and buffer
// views.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "relume/core/vec.h"

namespace relume::asset {

/// How a plane's numbers are stored.
enum class Storage : std::uint8_t { kFloat32, kFloat16, kUnorm8, kUnorm16, kUint32 };

/// A named array of one layer or of the atlas. shape: [count][channels]
struct Plane {
  std::string name;  ///< "value", "bent", ...
  int channels = 1;
  Storage storage = Storage::kFloat16;  ///< what the file keeps of `values`; errors in codec/quantize.h;
                                        ///< kUint32: whole numbers up to 2^24
  float lo = 0, hi = 1;                 ///< unorm planes: value = lo + q / max * (hi - lo)
  std::vector<float> values;            ///< finite
};

/// Numbers of a table, as the file keeps them.
using TableValues =
    std::variant<std::vector<std::int8_t>, std::vector<std::uint8_t>, std::vector<std::int16_t>,
                 std::vector<std::uint16_t>, std::vector<std::uint32_t>, std::vector<float>>;

/// A named array of a layer that is not over the atlas' texels. Kept bit for bit. shape: [count][channels]
struct Table {
  std::string name;          ///< "planes", "tileRow", ...
  std::size_t channels = 1;  ///< 1 to 256
  TableValues values;        ///< a whole number of rows; floats are finite
};

/// A number (infinity: no limit), a word or a switch.
using Parameter = std::variant<double, std::string, bool>;

struct Layer {
  std::string name;  ///< "ao", "obscurance", "spectral", ... ; a second one of a kind is "ao.2"
  std::string kind;  ///< registry name
  std::string emitters, transport, receivers, codec;  ///< the row of the registry
  std::map<std::string, Parameter> parameters;        ///< as baked, defaults filled in
  std::vector<Plane> planes;  ///< over all texels of all pages, dilated: shape [pages*height*width][channels]
  std::vector<Table> tables;  ///< what else the kind needs, e.g. transfer (asset/transfer.h)
  double error_estimate = 0;  ///< relative RMS standard error of the layer, as estimated by its solver
  std::uint64_t samples = 0;  ///< rays or paths per texel, at most

  /// Throws Error kMismatch, naming the planes there are.
  const Plane& plane(std::string_view plane_name) const;
  /// Null where there is none.
  const Table* findTable(std::string_view table_name) const;
};

/// Surface data that relighting needs, per covered texel. The file keeps positions to 2^-23 of the largest
/// extent, normals to 1e-4 rad, albedo to 0.4 %; the rest exactly.
struct AtlasTable {
  int width = 0, height = 0;
  std::uint32_t pages = 0;
  std::vector<std::uint32_t>
      texel;                    ///< (page * height + row) * width + column, increasing; row 0 is the top one
  std::vector<Point> position;  ///< world
  std::vector<Normal> normal;   ///< world, shading; unit length
  std::vector<Vec3> albedo;     ///< diffuse albedo, linear, in [0, 1]; empty in a bake of visibility alone
  std::vector<std::uint8_t> valid;  ///< 0: buried in geometry, its values were filled from neighbours
  std::vector<std::uint32_t> chart;

  std::size_t pageTexels() const;  ///< of all pages: pages * height * width
};

struct Asset {
  std::string generator;   ///< "relume 0.1.0"
  std::string input_hash;  ///< of the geometry and settings that were baked
  AtlasTable atlas;
  std::vector<Layer> layers;

  const Layer* find(std::string_view name) const;
  /// Throws Error kNoSuchLayer, naming those there are. An empty name is the first layer.
  const Layer& layer(std::string_view name) const;
};

/// JSON text of RELUME_transfer, whose bufferView numbers count in `views`. Deterministic.
struct Encoded {
  std::string json;
  std::vector<std::vector<std::byte>> views;
};
/// Throws Error kInvalidValue for a number that its storage cannot hold (infinite, above 65504 in float16,
/// outside lo..hi; in tables a float that is not finite).
Encoded encode(const Asset& asset);
/// A .glb that carries the bake and no scene: for engines that have the geometry already.
std::vector<std::byte> encodeGlb(const Asset& asset);

struct DecodeLimits {
  std::uint64_t max_bytes = std::uint64_t{4}
                            << 30;  ///< of decoded data; a file of a few KB can hold gigabytes of zeros
};

/// Reads the bake out of .glb bytes. Everything is bounds-checked and checksummed. Throws Error kNotGltf,
/// kTruncated, kInvalidJson, kCorruptAsset, kUnsupported (a newer version), kNoSuchLayer (the file carries no
/// bake), kOutOfMemory (over the limit, or the system's). `name` stands in messages.
Asset decode(std::span<const std::byte> glb, const std::string& name, const DecodeLimits& limits = {});
Asset readAsset(const std::filesystem::path& path, const DecodeLimits& limits = {});

}  // namespace relume::asset
