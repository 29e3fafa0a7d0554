// SPDX-License-Identifier: MIT
// The node hierarchy: where each node of the default scene stands, and whether it may move.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>

#include "import.h"

namespace relume::scene::gltf {

namespace {

constexpr std::uint32_t kNoParent = kNone;

bool isFiniteMatrix(const Mat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

Mat4 fromTrs(Vec3 t, Vec4 q, Vec3 s) {
  const float length = glm::length(q);
  const glm::quat rotation =
      length > 0 ? glm::quat(q.w / length, q.x / length, q.y / length, q.z / length) : glm::quat(1, 0, 0, 0);
  Mat4 m = glm::mat4_cast(rotation);
  for (int c = 0; c < 3; ++c) m[c] *= s[c];
  m[3] = Vec4(t, 1);
  return m;
}

Mat4 localTransform(const Value& node) {
  if (const Value matrix = node["matrix"]) {
    Mat4 m = matrix.mat4(Mat4(1));
    // Only affine maps place a mesh.
    m[0][3] = m[1][3] = m[2][3] = 0, m[3][3] = 1;
    return m;
  }
  return fromTrs(node["translation"].vec3(Vec3(0)), node["rotation"].vec4({0, 0, 0, 1}),
                 node["scale"].vec3(Vec3(1)));
}

/// Parents of all nodes. A node of a tree has one parent and is not its own ancestor.
std::vector<std::uint32_t> parentsOf(const Value& nodes) {
  std::vector<std::uint32_t> parents(nodes.size(), kNoParent);
  std::vector<std::uint32_t> twice;  // a child that was met again, and by whom
  for (std::uint32_t n = 0; n < parents.size(); ++n) {
    const Value children = nodes.at(n)["children"];
    for (std::size_t k = 0; k < children.size(); ++k) {
      const std::uint32_t child = children.at(k).index(parents.size(), "node");
      if (child == n) children.at(k).fail(ErrorCode::kCyclicNodes, "makes the node its own child");
      if (parents[child] == kNoParent)
        parents[child] = n;
      else
        twice.insert(twice.end(), {child, n});
    }
  }
  // Walking up from any node ends at a root, or goes round.
  std::vector<std::uint32_t> seen_from(parents.size(), kNone);
  for (std::uint32_t n = 0; n < parents.size(); ++n)
    for (std::uint32_t m = n; m != kNoParent && seen_from[m] != n; m = parents[m]) {
      if (seen_from[m] != kNone) break;
      seen_from[m] = n;
      if (parents[m] != kNoParent && seen_from[parents[m]] == n)
        nodes.at(m).fail(ErrorCode::kCyclicNodes,
                         fmt::format("is its own ancestor, through node {}", parents[m]),
                         "break the circle of children");
    }
  if (!twice.empty()) {
    const std::uint32_t child = twice[0], other = twice[1], first = parents[child];
    // A circle may show as a second parent only.
    for (std::uint32_t m = other; m != kNoParent; m = parents[m])
      if (m == child)
        nodes.at(child).fail(ErrorCode::kCyclicNodes,
                             fmt::format("is its own ancestor, through node {}", other),
                             "break the circle of children");
    nodes.at(child).fail(ErrorCode::kInvalidReference,
                         fmt::format("is a child of both node {} and node {}", first, other),
                         "give each parent its own copy");
  }
  return parents;
}

std::vector<std::uint32_t> rootsOfScene(const Value& root, const std::vector<std::uint32_t>& parents,
                                        Warnings& warnings) {
  std::vector<std::uint32_t> roots;
  const Value scenes = root["scenes"];
  if (scenes.size() == 0) {
    for (std::uint32_t n = 0; n < parents.size(); ++n)
      if (parents[n] == kNoParent) roots.push_back(n);
    return roots;
  }
  const std::uint32_t scene = root["scene"] ? root["scene"].index(scenes.size(), "scene") : 0;
  const Value nodes = scenes.at(scene)["nodes"];
  std::vector<bool> listed(parents.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::uint32_t n = nodes.at(k).index(parents.size(), "node");
    if (parents[n] != kNoParent || listed[n])
      warnings.push_back({nodes.at(k).subject(), fmt::format("node {} is no root or is listed twice", n),
                          "it is used once"});
    if (!listed[n]) roots.push_back(n);
    listed[n] = true;
  }
  // A node that an ancestor of the list brings along is placed by that ancestor.
  std::erase_if(roots, [&](std::uint32_t n) {
    for (std::uint32_t m = parents[n]; m != kNoParent; m = parents[m])
      if (listed[m]) return true;
    return false;
  });
  return roots;
}

std::optional<std::uint32_t> nodeOfPointer(const std::string& pointer, std::size_t count) {
  constexpr std::string_view kNodes = "/nodes/";
  if (pointer.compare(0, kNodes.size(), kNodes) != 0) return std::nullopt;
  std::uint32_t n = 0;
  const char* begin = pointer.data() + kNodes.size();
  const auto [end, ec] = std::from_chars(begin, pointer.data() + pointer.size(), n);
  if (ec != std::errc() || end == begin || n >= count) return std::nullopt;
  return n;
}

/// Nodes that an animation channel moves, reshapes or hides.
std::vector<bool> animatedNodes(const Value& root, std::size_t count) {
  std::vector<bool> animated(count);
  const Value animations = root["animations"];
  for (std::size_t a = 0; a < animations.size(); ++a) {
    const Value channels = animations.at(a)["channels"];
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const Value target = channels.at(c)["target"];
      if (const Value node = target["node"]) animated[node.index(count, "node")] = true;
      if (const Value pointer = target.extension("KHR_animation_pointer")["pointer"])
        if (const auto n = nodeOfPointer(pointer.text(""), count)) animated[*n] = true;
    }
  }
  return animated;
}

bool anyNonZero(const Value& weights) {
  bool any = false;
  for (std::size_t i = 0; i < weights.size(); ++i) any |= weights.at(i).number(0) != 0;
  return any;
}

bool isMorphed(const Value& root, const Value& node) {
  if (!node["mesh"]) return false;
  if (node["weights"]) return anyNonZero(node["weights"]);
  const Value meshes = root["meshes"];
  return anyNonZero(meshes.at(node["mesh"].index(meshes.size(), "mesh"))["weights"]);
}

/// extras.relume.dynamic or .static: what the author says, if anything.
std::optional<bool> markedDynamic(const Value& node, Warnings& warnings) {
  const Value mark = node.notes();
  if (!mark) return std::nullopt;
  std::optional<bool> dynamic;
  for (const char* key : {"static", "dynamic"}) {
    const Value flag = mark[key];
    if (!flag) continue;
    if (!flag.json().is_boolean())
      warnings.push_back({flag.subject(), "is not true or false", "it is ignored"});
    else
      dynamic = flag.boolean(false) == (key[0] == 'd');
  }
  return dynamic;
}

/// The specification ignores the place of a skinned mesh's own node. Where its first joint puts it stands for
/// the whole.
Mat4 skinnedPlace(Access& access, const Value& node, const std::vector<Mat4>& world) {
  const Value skins = access.root()["skins"];
  const Value skin = skins.at(node["skin"].index(skins.size(), "skin"));
  const Value joints = skin["joints"];
  if (joints.size() == 0) skin.fail(ErrorCode::kInvalidValue, "has no joints");
  const Mat4& joint = world[joints.at(0).index(world.size(), "node")];
  const Value reference = skin["inverseBindMatrices"];
  if (!reference) return joint;
  const Accessor matrices = access.accessor(reference);
  if (matrices.components != 16 || matrices.component != Component::kFloat || matrices.count == 0)
    matrices.fail(ErrorCode::kInvalidValue, "is not an array of MAT4 of floats");
  Mat4 inverse_bind;
  std::memcpy(&inverse_bind, matrices.element(0), sizeof inverse_bind);
  return joint * inverse_bind;
}

}  // namespace

std::vector<PlacedNode> placeNodes(Access& access, Warnings& warnings) {
  const Value nodes = access.root()["nodes"];
  const std::vector<std::uint32_t> parents = parentsOf(nodes);
  const std::vector<bool> animated = animatedNodes(access.root(), parents.size());

  struct State {
    bool moves = false;        // by animation, skin or morph, here or above
    std::optional<bool> mark;  // the nearest word of the author
  };
  std::vector<State> states(parents.size());
  std::vector<Mat4> world(parents.size(), Mat4(1));
  std::vector<PlacedNode> placed;
  std::vector<std::uint32_t> stack = rootsOfScene(access.root(), parents, warnings);
  std::ranges::reverse(stack);
  std::vector<bool> visited(parents.size());
  while (!stack.empty()) {
    const std::uint32_t n = stack.back();
    stack.pop_back();
    if (visited[n]) continue;
    visited[n] = true;
    const Value node = nodes.at(n);
    if (!node.extension("KHR_node_visibility")["visible"].boolean(true)) continue;

    const std::uint32_t parent = parents[n];
    world[n] = parent == kNoParent ? localTransform(node) : world[parent] * localTransform(node);
    if (!isFiniteMatrix(world[n]))
      node.fail(ErrorCode::kInvalidValue, "its place in the world is not a finite number");
    State& state = states[n];
    if (parent != kNoParent && visited[parent]) state = states[parent];
    state.moves = state.moves || animated[n] || node["skin"] || isMorphed(access.root(), node);
    if (const auto mark = markedDynamic(node, warnings)) state.mark = mark;

    PlacedNode& out = placed.emplace_back();
    out.index = n;
    out.name = node["name"].text("");
    if (out.name.empty()) out.name = fmt::format("node {}", n);
    out.world_from_local = world[n];
    out.dynamic = state.mark.value_or(state.moves);

    const Value children = node["children"];
    for (std::size_t k = children.size(); k-- > 0;)
      stack.push_back(children.at(k).index(parents.size(), "node"));
  }
  for (PlacedNode& node : placed) {
    if (!nodes.at(node.index)["skin"] || !nodes.at(node.index)["mesh"]) continue;
    const Mat4 place = skinnedPlace(access, nodes.at(node.index), world);
    if (isFiniteMatrix(place)) node.world_from_local = place;
  }
  return placed;
}

std::vector<Mat4> instancingTransforms(Access& access, const Value& extension) {
  const Value attributes = extension["attributes"];
  std::size_t count = 0;
  const auto read = [&](const char* name, auto components) {
    constexpr int kComponents = decltype(components)::value;
    std::vector<glm::vec<kComponents, float>> values;
    if (const Value reference = attributes[name]) {
      const Accessor accessor = access.accessor(reference);
      if (accessor.count > Access::plausibleCount(0) + access.inputBytes())
        accessor.fail(ErrorCode::kOutOfBounds, fmt::format("makes {} copies, too many for a file of {} bytes",
                                                           accessor.count, access.inputBytes()));
      values = readVectors<kComponents>(accessor);
    }
    if (!values.empty() && count != 0 && values.size() != count)
      attributes[name].fail(ErrorCode::kInvalidValue,
                            fmt::format("has {} elements instead of {}", values.size(), count));
    if (!values.empty()) count = values.size();
    return values;
  };
  const auto translations = read("TRANSLATION", std::integral_constant<int, 3>{});
  const auto rotations = read("ROTATION", std::integral_constant<int, 4>{});
  const auto scales = read("SCALE", std::integral_constant<int, 3>{});
  std::vector<Mat4> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(fromTrs(translations.empty() ? Vec3(0) : translations[i],
                          rotations.empty() ? Vec4(0, 0, 0, 1) : rotations[i],
                          scales.empty() ? Vec3(1) : scales[i]));
    if (!isFiniteMatrix(out.back()))
      extension.fail(ErrorCode::kInvalidValue, fmt::format("copy {} is not finite", i));
  }
  return out;
}

}  // namespace relume::scene::gltf
