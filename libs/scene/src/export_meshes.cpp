// SPDX-License-Identifier: MIT
// Geometry of the bake: each baked node gets a mesh whose primitives carry the atlas coordinates as
// TEXCOORD_1. Vertices are gathered element by element, of every attribute and morph target, in the component
// types of the file. Equal data are stored once, so uses of one mesh that are split alike share their
// vertices.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <string_view>

#include "export.h"
#include "extensions.h"
#include "glb.h"
#include "import.h"
#include "primitive.h"
#include "relume/core/check.h"

namespace relume::scene::gltf {

using Json = nlohmann::json;

namespace {

constexpr int kVertices = 34962, kIndices = 34963;

double component(const Accessor& accessor, const std::byte* p) {
  const auto load = [p](auto v) {
    std::memcpy(&v, p, sizeof v);
    return static_cast<double>(v);
  };
  switch (accessor.component) {
    case Component::kByte:
      return load(std::int8_t{});
    case Component::kUnsignedByte:
      return load(std::uint8_t{});
    case Component::kShort:
      return load(std::int16_t{});
    case Component::kUnsignedShort:
      return load(std::uint16_t{});
    case Component::kUnsignedInt:
      return load(std::uint32_t{});
    case Component::kFloat:
      break;
  }
  return load(float{});
}

/// min and max of each component of the stored numbers, as accessor.min and .max want them.
void putBounds(Json& fields, const Accessor& accessor, std::span<const std::uint32_t> pick) {
  if (accessor.rows != accessor.components) return;  // no bounds are asked of matrices
  Json lowest = Json::array(), highest = Json::array();
  for (std::uint32_t k = 0; k < accessor.components; ++k) {
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    for (const std::uint32_t v : pick) {
      const double c = component(accessor, accessor.element(v) + k * sizeOf(accessor.component));
      if (!std::isfinite(c)) continue;
      lo = std::min(lo, c), hi = std::max(hi, c);
    }
    if (lo > hi) lo = hi = 0;
    const auto number = [&](double v) {
      return accessor.component == Component::kFloat ? Json(v) : Json(std::int64_t(v));
    };
    lowest.push_back(number(lo));
    highest.push_back(number(hi));
  }
  fields["min"] = std::move(lowest);
  fields["max"] = std::move(highest);
}

/// An accessor of the elements that `pick` names; `original` is the JSON of the accessor they come from.
std::uint32_t gather(Output& out, const Json& original, const Accessor& accessor,
                     std::span<const std::uint32_t> pick, bool bounds) {
  Json fields = original;
  for (const char* key : {"bufferView", "byteOffset", "sparse"}) fields.erase(key);
  fields["count"] = pick.size();
  if (bounds || fields.contains("min") || fields.contains("max")) putBounds(fields, accessor, pick);
  const std::size_t stride = alignedSize(accessor.element_size);
  return out.addAccessor(std::move(fields), gatherBytes(accessor, pick, stride),
                         stride == accessor.element_size ? 0 : stride, kVertices);
}

template <class T>
std::vector<std::byte> bytesOf(const std::vector<T>& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {bytes.begin(), bytes.end()};
}

std::uint32_t addIndices(Output& out, const std::vector<UVec3>& triangles, std::size_t vertices) {
  const bool small = vertices <= 0xffff;  // the highest 16-bit value is not an index
  Json fields = {{"type", "SCALAR"}, {"componentType", small ? 5123 : 5125}, {"count", 3 * triangles.size()}};
  if (!small) return out.addAccessor(std::move(fields), bytesOf(triangles), 0, kIndices);
  std::vector<std::uint16_t> corners;
  corners.reserve(3 * triangles.size());
  for (const UVec3 t : triangles)
    for (int k = 0; k < 3; ++k) corners.push_back(static_cast<std::uint16_t>(t[k]));
  return out.addAccessor(std::move(fields), bytesOf(corners), 0, kIndices);
}

/// Whether a texture that stays after the bake reads TEXCOORD_1.
bool readsSecondSet(Json& doc, Json& primitive, bool occlusion_is_replaced) {
  Json* materials = fieldOf(doc, "materials");
  if (!materials || !materials->is_array()) return false;
  bool reads = false;
  visitMaterialUsers(primitive, [&](Json& user) {
    Json* reference = fieldOf(user, "material");
    const auto m = reference ? asIndex(*reference, materials->size()) : std::nullopt;
    if (!m) return;
    visitTextureInfos((*materials)[*m], [&](const std::string& key, Json& info) {
      if (occlusion_is_replaced && key == "occlusionTexture") return;
      reads |= texCoordOf(info) == 1;
    });
  });
  return reads;
}

/// The vertices of a baked primitive.
struct Split {
  std::vector<std::uint32_t> source;  ///< elements of the accessors
  std::vector<UVec3> triangles;
  std::vector<Vec2> uv;
};

Split splitOf(const Mesh& mesh, const AtlasUse& use, std::uint32_t vertices) {
  RELUME_CHECK_EQ(use.uv.size(), use.source_vertex.size());
  RELUME_CHECK_EQ(use.triangles.size(), mesh.triangles.size());
  for (const UVec3 t : use.triangles)
    for (int k = 0; k < 3; ++k) RELUME_CHECK_LT(t[k], use.uv.size());
  Split split{use.source_vertex, use.triangles, use.uv};
  for (std::uint32_t& v : split.source) {
    RELUME_CHECK_LT(v, mesh.positions.size());
    if (!mesh.gltf_vertex.empty()) v = mesh.gltf_vertex[v];
    RELUME_CHECK_LT(v, vertices);
  }
  return split;
}

bool isIdentity(const Split& split, std::uint32_t vertices) {
  if (split.source.size() != vertices) return false;
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (split.source[v] != v) return false;
  return true;
}

std::string_view elementBytes(const Accessor& accessor, std::uint32_t i) {
  return {reinterpret_cast<const char*>(accessor.element(i)), accessor.element_size};
}

/// Makes one of the vertices that are alike in all streams and in the atlas: an earlier bake cut its seams
/// into the vertices, and another atlas would cut its own on top.
void weld(Split& split, const std::vector<Accessor>& streams) {
  const std::size_t count = split.source.size();
  std::vector<std::uint32_t> group(count);
  const auto refine = [&](auto bytes_of) {
    std::map<std::pair<std::uint32_t, std::string_view>, std::uint32_t> groups;
    for (std::size_t v = 0; v < count; ++v)
      group[v] = groups.try_emplace({group[v], bytes_of(v)}, static_cast<std::uint32_t>(groups.size()))
                     .first->second;
  };
  refine([&](std::size_t v) {
    return std::string_view(reinterpret_cast<const char*>(&split.uv[v]), sizeof(Vec2));
  });
  for (const Accessor& stream : streams)
    refine([&](std::size_t v) { return elementBytes(stream, split.source[v]); });
  // Groups are numbered in the order in which they appear.
  Split welded;
  for (std::size_t v = 0; v < count; ++v)
    if (group[v] == welded.source.size())
      welded.source.push_back(split.source[v]), welded.uv.push_back(split.uv[v]);
  welded.triangles = std::move(split.triangles);
  for (UVec3& t : welded.triangles) t = {group[t.x], group[t.y], group[t.z]};
  split = std::move(welded);
}

/// Moves TEXCOORD_1 of the attributes and morph targets to another set; 0 removes it from the targets.
void moveSecondSet(Json& json, std::uint32_t set) {
  const std::string name = fmt::format("TEXCOORD_{}", set);
  if (set != 0) json["attributes"][name] = json["attributes"]["TEXCOORD_1"];
  Json* targets = fieldOf(json, "targets");
  if (!targets || !targets->is_array()) return;
  for (Json& target : *targets)
    if (Json* deltas = fieldOf(target, "TEXCOORD_1")) {
      if (set != 0) target[name] = *deltas;
      target.erase("TEXCOORD_1");
    }
}

/// Puts the use into the JSON of a primitive. Returns where its former TEXCOORD_1 went, 0: nowhere.
std::uint32_t rewritePrimitive(Output& out, const Mesh& mesh, const AtlasUse& use, bool occlusion_is_replaced,
                               PrimitiveReader& reader, Json& json) {
  Split split = splitOf(mesh, use, reader.vertexCount());
  const bool keep_vertices = !reader.isDraco() && isIdentity(split, reader.vertexCount());
  const bool keep_indices = keep_vertices && reader.mode() == Mode::kTriangles && json.contains("indices") &&
                            split.triangles == mesh.triangles;

  // The former second set stays where a texture needs it: it moves behind the others.
  Json& attributes = json["attributes"];
  const bool same =
      mesh.uv[1].size() == mesh.positions.size() &&
      std::ranges::equal(use.source_vertex, use.uv, {}, [&](std::uint32_t v) { return mesh.uv[1][v]; });
  std::uint32_t moved_set = 0;
  if (attributes.contains("TEXCOORD_1") && !same && readsSecondSet(out.doc, json, occlusion_is_replaced)) {
    moved_set = 2;
    while (attributes.contains(fmt::format("TEXCOORD_{}", moved_set))) ++moved_set;
  }
  moveSecondSet(json, moved_set);
  attributes.erase("TEXCOORD_1");

  if (!keep_vertices) {
    struct Place {
      Json* reference;
      bool bounds;  ///< glTF demands them of positions
    };
    std::vector<Place> places;
    std::vector<Accessor> streams;
    for (auto& [semantic, reference] : attributes.items()) {
      const bool moved = moved_set != 0 && semantic == fmt::format("TEXCOORD_{}", moved_set);
      const auto accessor = reader.attribute(moved ? "TEXCOORD_1" : semantic);
      RELUME_CHECK(accessor.has_value());
      places.push_back({&reference, semantic == "POSITION"});
      streams.push_back(*accessor);
    }
    if (Json* targets = fieldOf(json, "targets"); targets && targets->is_array())
      for (std::size_t t = 0; t < targets->size(); ++t)
        for (auto& [semantic, reference] : (*targets)[t].items()) {
          const bool moved = moved_set != 0 && semantic == fmt::format("TEXCOORD_{}", moved_set);
          places.push_back({&reference, semantic == "POSITION"});
          streams.push_back(reader.targetAttribute(t, moved ? "TEXCOORD_1" : semantic));
        }
    if (mesh.atlas_page != kNone) weld(split, streams);
    const Json& originals = out.in.root()["accessors"].json();
    for (std::size_t s = 0; s < streams.size(); ++s)
      *places[s].reference = gather(out, originals[places[s].reference->get<std::uint32_t>()], streams[s],
                                    split.source, places[s].bounds);
    eraseExtension(json, kDracoExtension);
  }
  if (!keep_indices) {
    json["indices"] = addIndices(out, split.triangles, split.uv.size());
    json.erase("mode");
  }
  const std::uint32_t uv =
      out.addAccessor({{"type", "VEC2"}, {"componentType", 5126}, {"count", split.uv.size()}},
                      bytesOf(split.uv), 0, kVertices);
  attributes["TEXCOORD_1"] = uv;
  // Sets must be numbered without a gap.
  if (!attributes.contains("TEXCOORD_0")) attributes["TEXCOORD_0"] = uv;
  json["extensions"][kTransferExtension] = {{"page", use.page}};
  return moved_set;
}

/// A node whose mesh is copied by EXT_mesh_gpu_instancing, where a copy is baked, becomes a parent of one
/// node for each copy. Returns the node of each copy.
std::vector<std::uint32_t> expandCopies(Output& out, std::uint32_t node) {
  const Value json = out.in.root()["nodes"].at(node);
  const std::vector<Mat4> copies = instancingTransforms(out.in, json.extension(kInstancingExtension));
  Json& nodes = out.doc["nodes"];
  std::vector<std::uint32_t> added;
  for (const Mat4& m : copies) {
    Json child = {{"mesh", nodes[node]["mesh"]}};
    if (nodes[node].contains("name")) child["name"] = nodes[node]["name"];
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) child["matrix"].push_back(m[c][r]);
    added.push_back(static_cast<std::uint32_t>(nodes.size()));
    nodes.push_back(std::move(child));
  }
  for (const std::uint32_t child : added) arrayOf(nodes[node], "children").push_back(child);
  nodes[node].erase("mesh");
  eraseExtension(nodes[node], kInstancingExtension);
  return added;
}

}  // namespace

std::vector<BakedPrimitive> rewriteMeshes(Output& out, const Scene& scene, const BakeOutput& bake) {
  // glTF mesh -> node of the output -> its uses by primitive.
  std::map<std::uint32_t, std::map<std::uint32_t, std::map<std::uint32_t, const AtlasUse*>>> plan;
  std::map<std::uint32_t, std::vector<std::uint32_t>> expanded;
  for (const AtlasUse& use : bake.uses) {
    RELUME_CHECK_LT(use.instance, scene.instances.size());
    if (!bake.occlusion_png.empty()) RELUME_CHECK_LT(use.page, bake.occlusion_png.size());
    const Instance& instance = scene.instances[use.instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    std::uint32_t node = instance.node;
    if (instance.copy != kNone) {
      const auto [found, fresh] = expanded.try_emplace(node);
      if (fresh) found->second = expandCopies(out, node);
      RELUME_CHECK_LT(instance.copy, found->second.size());
      node = found->second[instance.copy];
    }
    const bool fresh = plan[mesh.gltf_mesh][node].try_emplace(mesh.gltf_primitive, &use).second;
    RELUME_CHECK(fresh);
  }

  std::vector<BakedPrimitive> baked;
  for (const auto& [mesh, nodes] : plan) {
    std::set<std::uint32_t> others;  // nodes that show the mesh as it was
    for (std::uint32_t n = 0; n < out.doc["nodes"].size(); ++n)
      if (Json* reference = fieldOf(out.doc["nodes"][n], "mesh"))
        if (asIndex(*reference, out.doc["meshes"].size()) == mesh && !nodes.contains(n)) others.insert(n);

    const Value json = out.in.root()["meshes"].at(mesh)["primitives"];
    std::map<std::uint32_t, PrimitiveReader> readers;
    for (const auto& [node, uses] : nodes)
      for (const auto& [p, use] : uses) readers.try_emplace(p, out.in, json.at(p));

    const Json original = out.doc["meshes"][mesh];
    bool in_place = others.empty();
    for (const auto& [node, uses] : nodes) {
      std::uint32_t target = mesh;
      if (!in_place) {
        target = static_cast<std::uint32_t>(out.doc["meshes"].size());
        out.doc["meshes"].push_back(original);
        out.doc["nodes"][node]["mesh"] = target;
      }
      in_place = false;
      for (const auto& [p, use] : uses) {
        const Mesh& source = scene.meshes[scene.instances[use->instance].mesh];
        const std::uint32_t moved =
            rewritePrimitive(out, source, *use, !bake.occlusion_png.empty(), readers.at(p),
                             out.doc["meshes"][target]["primitives"][p]);
        baked.push_back({target, p, use->page, moved});
      }
    }
  }
  return baked;
}

}  // namespace relume::scene::gltf
