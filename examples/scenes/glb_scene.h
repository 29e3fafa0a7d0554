// SPDX-License-Identifier: MIT
// A glTF 2.0 scene being written: materials, meshes shared by nodes, lights, cameras, one kind of animation.
// Same calls, same bytes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mesh_builder.h"

namespace relume::scenes {

struct MaterialSpec {
  std::string name;
  Vec3 base_colour{0.8f};  ///< linear
  float roughness = 0.9f, metallic = 0.0f;
  Vec3 emission{0.0f};  ///< radiance; above 1 written with KHR_materials_emissive_strength
  bool double_sided = false;
  std::optional<std::uint32_t> texture = std::nullopt;  ///< base colour, TEXCOORD_0
  std::optional<std::uint32_t> height = std::nullopt;   ///< extras.relume.height, TEXCOORD_0
  double height_scale = 0.05;
};

struct Placement {
  P3 position{0.0};
  double turn_y = 0.0;  ///< radians
  P3 scale{1.0};
};

struct PunctualSpec {
  std::string name;
  std::string type;  ///< "point", "spot" or "directional"
  Vec3 colour{1.0f};
  float intensity = 1.0f;  ///< cd, or lux
  std::string group;       ///< extras.relume.group
  double inner_cone = 0.0, outer_cone = 0.7853981633974483;
};

class GlbScene {
 public:
  explicit GlbScene(std::string name);

  std::uint32_t addMaterial(const MaterialSpec& spec);
  /// A PNG file that repeats.
  std::uint32_t addTexture(const std::string& name, const std::vector<std::byte>& png);
  std::uint32_t addMesh(const std::string& name, const MeshBuilder& mesh, double crease_deg = 38.0);
  std::uint32_t addLight(const PunctualSpec& spec);

  std::uint32_t place(const std::string& name, std::uint32_t mesh, const Placement& where = {});
  /// A light of `addLight` at a point; `towards` is where spots and suns shine to.
  void placeLight(const std::string& name, std::uint32_t light, P3 position, P3 towards = P3(0, -1e3, 0));
  void addCamera(const std::string& name, P3 eye, P3 target, double vertical_fov_deg);
  /// Swings a node about its z axis through -angle and +angle, a period of `seconds`.
  void swing(std::uint32_t node, double angle_deg, double seconds);
  void note(const std::string& generator_comment);

  std::size_t triangleCount() const;  ///< as drawn: shared meshes count once per node
  std::size_t lightCount() const;
  std::vector<std::byte> glb() const;

 private:
  using Json = nlohmann::ordered_json;
  std::uint32_t addView(const void* data, std::size_t size, int target);
  std::uint32_t addAccessor(std::uint32_t view, int component, std::size_t count, const char* type);

  Json json_;
  std::vector<std::byte> bin_;
  std::vector<std::size_t> mesh_triangles_;
};

}  // namespace relume::scenes
