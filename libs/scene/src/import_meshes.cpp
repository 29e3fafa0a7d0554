// SPDX-License-Identifier: MIT
// Meshes as indexed triangle lists, and their instances in the world.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "extensions.h"
#include "import.h"
#include "primitive.h"

namespace relume::scene::gltf {

namespace {

// Beyond these, products of coordinates leave the range of floats: mesh space, before a node scales it down,
// and metres.
constexpr float kFarthestLocal = 1e15f, kFarthestWorld = 1e9f;

bool isUsable(Point p) { return glm::all(glm::lessThanEqual(glm::abs(p), Vec3(kFarthestLocal))); }

glm::dvec3 faceNormal(const Mesh& mesh, UVec3 t) {
  const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
  return glm::cross(b - a, c - a);
}

/// Fills the normals that are zero or not finite by the area-weighted mean of the faces around.
void completeNormals(Mesh& mesh) {
  const auto isUnusable = [](Normal n) { return !isFinite(n) || n == Normal(0); };
  if (std::ranges::none_of(mesh.normals, isUnusable)) return;
  std::vector<bool> missing(mesh.normals.size());
  for (std::size_t v = 0; v < missing.size(); ++v)
    if (isUnusable(mesh.normals[v])) missing[v] = true, mesh.normals[v] = Normal(0);
  // Scaled by the largest face, so that sums of tiny or huge areas stay within floats.
  double largest = 0;
  for (const UVec3 t : mesh.triangles) largest = std::max(largest, glm::length(faceNormal(mesh, t)));
  for (const UVec3 t : mesh.triangles) {
    const Normal n = largest > 0 ? Normal(faceNormal(mesh, t) / largest) : Normal(0);
    for (int k = 0; k < 3; ++k)
      if (missing[t[k]]) mesh.normals[t[k]] += n;
  }
}

void normalizeNormals(Mesh& mesh) {
  for (Normal& n : mesh.normals) {
    const double length = glm::length(glm::dvec3(n));
    n = length > 0 ? Normal(glm::dvec3(n) / length) : Normal(0, 1, 0);
  }
}

/// Renumbers the corners to the vertices that occur, and returns those in ascending order.
std::vector<std::uint32_t> keepUsed(std::vector<UVec3>& triangles) {
  std::vector<std::uint32_t> used;
  used.reserve(3 * triangles.size());
  for (const UVec3 t : triangles) used.insert(used.end(), {t.x, t.y, t.z});
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (UVec3& t : triangles)
    for (int k = 0; k < 3; ++k)
      t[k] = static_cast<std::uint32_t>(std::ranges::lower_bound(used, t[k]) - used.begin());
  return used;
}

/// Leaves out triangles whose positions cannot be used, then the vertices that no triangle needs. Returns how
/// many.
std::size_t dropUnusable(Mesh& mesh) {
  if (std::ranges::all_of(mesh.positions, isUsable)) return 0;
  const std::size_t dropped = std::erase_if(mesh.triangles, [&](UVec3 t) {
    return !isUsable(mesh.positions[t.x]) || !isUsable(mesh.positions[t.y]) || !isUsable(mesh.positions[t.z]);
  });
  std::vector<std::uint32_t> used = keepUsed(mesh.triangles);
  // Ascending, so that no slot is read after it was written.
  for (std::size_t i = 0; i < used.size(); ++i) mesh.positions[i] = mesh.positions[used[i]];
  mesh.positions.resize(used.size());
  if (!mesh.gltf_vertex.empty())
    for (std::uint32_t& v : used) v = mesh.gltf_vertex[v];
  mesh.gltf_vertex = std::move(used);
  return dropped;
}

class MeshReader {
 public:
  MeshReader(Access& access, const ImportOptions& options, Scene& scene, Warnings& warnings)
      : access_(access), options_(options), scene_(scene), warnings_(warnings) {}

  /// Scene meshes of a glTF mesh: one for each primitive that has triangles.
  std::vector<std::uint32_t> read(std::uint32_t gltf_mesh);

 private:
  bool readPrimitive(const Value& json, std::uint32_t material, Mesh& mesh);
  void readAttributes(PrimitiveReader& reader, const Material& material, Mesh& mesh);
  void readUv(PrimitiveReader& reader, std::uint32_t set, Mesh& mesh);

  Access& access_;
  const ImportOptions& options_;
  Scene& scene_;
  Warnings& warnings_;
  std::size_t triangles_ = 0;  ///< so far
};

std::vector<std::uint32_t> MeshReader::read(std::uint32_t gltf_mesh) {
  std::vector<std::uint32_t> out;
  const Value json = access_.root()["meshes"].at(gltf_mesh), primitives = json["primitives"];
  std::string name = json["name"].text("");
  if (name.empty()) name = fmt::format("mesh {}", gltf_mesh);
  const auto default_material = static_cast<std::uint32_t>(scene_.materials.size() - 1);
  std::size_t skipped = 0;
  for (std::uint32_t p = 0; p < primitives.size(); ++p) {
    Mesh mesh;
    mesh.name = primitives.size() > 1 ? fmt::format("{}[{}]", name, p) : name;
    mesh.gltf_mesh = gltf_mesh;
    mesh.gltf_primitive = p;
    const Value primitive = primitives.at(p), material = primitive["material"];
    mesh.material = material ? material.index(default_material, "material") : default_material;
    if (!readPrimitive(primitive, mesh.material, mesh)) {
      ++skipped;
      continue;
    }
    if (mesh.triangles.empty()) continue;
    out.push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
    scene_.meshes.push_back(std::move(mesh));
  }
  if (skipped > 0)
    warnings_.push_back({json.subject(), fmt::format("{} of its primitives are points or lines", skipped),
                         "they are not baked"});
  return out;
}

bool MeshReader::readPrimitive(const Value& json, std::uint32_t material, Mesh& mesh) {
  PrimitiveReader reader(access_, json);
  if (reader.mode() < Mode::kTriangles && !reader.isDraco()) return false;
  mesh.triangles = reader.triangles();
  // Accessors may be used again and again: what they unfold to stays in proportion to the file.
  triangles_ += mesh.triangles.size();
  if (triangles_ > (std::size_t{1} << 20) + 16 * access_.inputBytes())
    json.fail(ErrorCode::kOutOfBounds,
              fmt::format("with it there are {} triangles, too many for a file of {} bytes", triangles_,
                          access_.inputBytes()));
  if (mesh.triangles.empty()) return true;

  // Primitives may share one large set of vertices, of which each uses few.
  if (reader.vertexCount() > 6 * mesh.triangles.size() + 64) mesh.gltf_vertex = keepUsed(mesh.triangles);
  const auto positions = reader.attribute("POSITION");
  mesh.positions = readVectors<3>(*positions, mesh.gltf_vertex);
  const std::size_t before = mesh.triangles.size(), dropped = dropUnusable(mesh);
  if (dropped > 0)
    warnings_.push_back({json.subject(),
                         fmt::format("{} of {} triangles have positions that are not finite or absurdly far",
                                     dropped, before),
                         "they are left out"});
  if (mesh.triangles.empty()) return true;
  if (std::ranges::all_of(mesh.triangles, [&](UVec3 t) { return faceNormal(mesh, t) == glm::dvec3(0); }))
    warnings_.push_back({json.subject(), "all its triangles are degenerate", "it receives no light"});
  readAttributes(reader, scene_.materials[material], mesh);
  if (const Value page = json.extension(kTransferExtension)["page"]; page && !mesh.uv[1].empty())
    mesh.atlas_page = static_cast<std::uint32_t>(std::min<std::uint64_t>(page.integer(), kNone));
  return true;
}

void MeshReader::readUv(PrimitiveReader& reader, std::uint32_t set, Mesh& mesh) {
  const auto accessor = reader.attribute(fmt::format("TEXCOORD_{}", set));
  if (!accessor) return;
  mesh.uv[set] = readVectors<2>(*accessor, mesh.gltf_vertex);
  mesh.uv[set].resize(mesh.positions.size());
  for (Vec2& uv : mesh.uv[set])
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = Vec2(0);
}

void MeshReader::readAttributes(PrimitiveReader& reader, const Material& material, Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  if (const auto normals = reader.attribute("NORMAL")) {
    mesh.normals = readVectors<3>(*normals, mesh.gltf_vertex);
  } else {
    mesh.flat_normals = true;
  }
  mesh.normals.resize(count, Normal(0));
  completeNormals(mesh);
  normalizeNormals(mesh);

  for (const std::uint32_t set : {0u, 1u}) readUv(reader, set, mesh);
  for (const TextureRef* ref :
       {&material.base_colour_texture, &material.metallic_roughness_texture, &material.emission_texture,
        &material.normal_texture, &material.height_texture})
    if (*ref && ref->uv_set > 1 && mesh.uv[ref->uv_set].empty()) readUv(reader, ref->uv_set, mesh);

  if (options_.normal_maps && material.normal_texture)
    if (const auto tangents = reader.attribute("TANGENT")) {
      mesh.tangents = readVectors<4>(*tangents, mesh.gltf_vertex);
      mesh.tangents.resize(count);
    }
  if (const auto colours = reader.attribute("COLOR_0")) {
    if (colours->components == 3) {
      for (const Vec3 c : readVectors<3>(*colours, mesh.gltf_vertex)) mesh.colours.emplace_back(c, 1.0f);
    } else {
      mesh.colours = readVectors<4>(*colours, mesh.gltf_vertex);
    }
    mesh.colours.resize(count, Vec4(1));
    for (Vec4& c : mesh.colours)
      for (int k = 0; k < 4; ++k) c[k] = c[k] >= 0 && c[k] <= 1 ? c[k] : c[k] < 0 ? 0.0f : 1.0f;
  }
}

/// Whether a mesh with these bounds stays within reach when it is placed there.
bool isWithinReach(const Box3& box, const Mat4& place) {
  for (int corner = 0; corner < 8; ++corner) {
    const Point p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                  corner & 4 ? box.hi.z : box.lo.z);
    const Point q(place * Vec4(p, 1));
    if (!glm::all(glm::lessThanEqual(glm::abs(q), Vec3(kFarthestWorld)))) return false;
  }
  return true;
}

}  // namespace

void importMeshes(Access& access, const std::vector<PlacedNode>& nodes, const ImportOptions& options,
                  Scene& scene, Warnings& warnings) {
  MeshReader reader(access, options, scene, warnings);
  const Value json_nodes = access.root()["nodes"], json_meshes = access.root()["meshes"];
  std::map<std::uint32_t, std::vector<std::uint32_t>> read;
  std::vector<Box3> boxes;
  for (const PlacedNode& node : nodes) {
    const Value json = json_nodes.at(node.index), reference = json["mesh"];
    if (!reference) continue;
    const std::uint32_t gltf_mesh = reference.index(json_meshes.size(), "mesh");
    const auto [found, fresh] = read.try_emplace(gltf_mesh);
    if (fresh) found->second = reader.read(gltf_mesh);
    for (std::size_t m = boxes.size(); m < scene.meshes.size(); ++m) {
      Box3& box = boxes.emplace_back();
      for (const Point p : scene.meshes[m].positions) box.add(p);
    }

    std::vector<Mat4> copies = {Mat4(1)};
    const Value instancing = json.extension(kInstancingExtension);
    if (instancing) copies = instancingTransforms(access, instancing);
    // Nodes times primitives, or copies of nothing but zeros, may be far more than the file has bytes to
    // place them.
    const std::size_t total = scene.instances.size() + copies.size() * found->second.size();
    if (total > Access::plausibleCount(0) + access.inputBytes())
      json.fail(ErrorCode::kOutOfBounds,
                fmt::format("with it there are {} placed primitives, too many for a file of {} bytes", total,
                            access.inputBytes()));
    for (std::size_t c = 0; c < copies.size(); ++c)
      for (const std::uint32_t m : found->second) {
        Instance instance;
        instance.name = instancing ? fmt::format("{} copy {}", node.name, c) : node.name;
        instance.mesh = m;
        instance.node = node.index;
        instance.copy = instancing ? static_cast<std::uint32_t>(c) : kNone;
        instance.world_from_local = node.world_from_local * copies[c];
        instance.dynamic = node.dynamic;
        if (!isWithinReach(boxes[m], instance.world_from_local)) {
          warnings.push_back({json.subject(),
                              fmt::format("puts mesh \"{}\" farther than {:g} m from the origin",
                                          scene.meshes[m].name, kFarthestWorld),
                              "it is left out"});
          continue;
        }
        scene.instances.push_back(std::move(instance));
      }
  }
}

}  // namespace relume::scene::gltf
