// SPDX-License-Identifier: MIT
// The shipped scenes: made again they are the same bytes, and their geometry is sound.
#include "scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <set>

#include "relume/core/file.h"

namespace relume::scenes {
namespace {

using Json = nlohmann::json;

// The test's own reader of the files, as far as the writer uses the format.
struct File {
  explicit File(const std::vector<std::byte>& bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    const char* text = reinterpret_cast<const char*>(bytes.data()) + 20;
    json = Json::parse(text, text + length);
    bin.assign(bytes.begin() + 28 + length, bytes.end());
  }
  template <class T>
  std::vector<T> read(std::size_t accessor) const {
    const Json& a = json["accessors"][accessor];
    const std::size_t offset =
        json["bufferViews"][a["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
    std::vector<T> out(a["count"].get<std::size_t>());
    EXPECT_LE(offset + out.size() * sizeof(T), bin.size());
    std::memcpy(out.data(), bin.data() + offset, out.size() * sizeof(T));
    return out;
  }
  std::vector<std::uint32_t> indices(const Json& primitive) const {
    const std::size_t accessor = primitive["indices"];
    if (json["accessors"][accessor]["componentType"] == 5125) return read<std::uint32_t>(accessor);
    const auto small = read<std::uint16_t>(accessor);
    return {small.begin(), small.end()};
  }
  Json json;
  std::vector<std::byte> bin;
};

class ExampleScene : public testing::TestWithParam<SceneEntry> {};

TEST_P(ExampleScene, ReproducesTheShippedBytes) {
  const auto path = std::filesystem::path(RELUME_SCENES_DIR) / (std::string(GetParam().name) + ".glb");
  const GlbScene scene = GetParam().make(kDefaultDetail);
  const std::vector<std::byte> made = scene.glb(), shipped = readFile(path);
  EXPECT_EQ(made.size(), shipped.size());
  EXPECT_TRUE(made == shipped) << "run make_scenes on examples/scenes, look at the result, and commit it";
  EXPECT_LE(shipped.size(), 600'000u);
  std::printf("%s: %zu triangles, %zu lights, %zu bytes\n", GetParam().name, scene.triangleCount(),
              scene.lightCount(), made.size());
}

TEST_P(ExampleScene, HasSoundTriangles) {
  for (const int detail : {1, kDefaultDetail, 5}) {
    const File file(GetParam().make(detail).glb());
    for (const Json& mesh : file.json["meshes"]) {
      // Within a mesh no directed edge occurs twice: no doubled face, no face against its neighbour's
      // winding.
      std::map<std::array<float, 6>, int> edges;
      for (const Json& primitive : mesh["primitives"]) {
        const auto p = file.read<Point>(primitive["attributes"]["POSITION"]);
        const auto n = file.read<Normal>(primitive["attributes"]["NORMAL"]);
        const auto index = file.indices(primitive);
        ASSERT_EQ(index.size() % 3, 0u);
        for (const Point& q : p) ASSERT_TRUE(isFinite(q));
        for (const Normal& q : n) ASSERT_NEAR(glm::length(q), 1.0f, 1e-3f);
        for (std::size_t t = 0; t < index.size(); t += 3) {
          for (int k = 0; k < 3; ++k) ASSERT_LT(index[t + k], p.size());
          const P3 a(p[index[t]]), b(p[index[t + 1]]), c(p[index[t + 2]]);
          const P3 face = glm::cross(b - a, c - a);
          ASSERT_GT(glm::length(face), 3e-8) << mesh["name"];
          for (int k = 0; k < 3; ++k) {
            ASSERT_GT(glm::dot(face, P3(n[index[t + k]])), 0.0) << mesh["name"];
            const Point u = p[index[t + k]], v = p[index[t + (k + 1) % 3]];
            ++edges[{u.x, u.y, u.z, v.x, v.y, v.z}];
          }
        }
      }
      int twice = 0;
      for (const auto& [edge, count] : edges) twice += count > 1;
      EXPECT_EQ(twice, 0) << mesh["name"] << ", detail " << detail;
    }
  }
}

TEST_P(ExampleScene, IsMeasuredInMetresAndStandsOnTheGround) {
  const File file(GetParam().make(kDefaultDetail).glb());
  float lo = kInfinity, hi = -kInfinity;
  for (const Json& node : file.json["nodes"]) {
    if (!node.contains("mesh")) continue;
    const float y = node.contains("translation") ? node["translation"][1].get<float>() : 0.0f;
    const float scale = node.contains("scale") ? node["scale"][1].get<float>() : 1.0f;
    for (const Json& primitive : file.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
      const Json& a = file.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
      lo = std::min(lo, y + scale * a["min"][1].get<float>()),
      hi = std::max(hi, y + scale * a["max"][1].get<float>());
    }
  }
  EXPECT_GE(lo, -2.5f);
  EXPECT_LE(lo, 0.0f);
  EXPECT_GE(hi, 1.4f);
  EXPECT_LE(hi, 16.0f);
  EXPECT_FALSE(file.json["cameras"].empty());
}

INSTANTIATE_TEST_SUITE_P(All, ExampleScene, testing::ValuesIn(allScenes().begin(), allScenes().end()),
                         [](const auto& entry) { return std::string(entry.param.name); });

TEST(Temple, ReachesThePapersSize) {
  // Multi-scale obscurances' Temple has 106,000 polygons.
  EXPECT_NEAR(double(makeTemple(6).triangleCount()), 106'000.0, 1'500.0);
}

TEST(Car, BodyIsClosedAndOfAPlausibleVolume) {
  const File file(makeCar(kDefaultDetail).glb());
  const auto mesh = std::find_if(file.json["meshes"].begin(), file.json["meshes"].end(),
                                 [](const Json& m) { return m["name"] == "body"; });
  std::map<std::array<float, 6>, int> edges;
  double volume = 0;
  for (const Json& primitive : (*mesh)["primitives"]) {
    const auto p = file.read<Point>(primitive["attributes"]["POSITION"]);
    const auto index = file.indices(primitive);
    for (std::size_t t = 0; t < index.size(); t += 3) {
      const Point q[3] = {p[index[t]], p[index[t + 1]], p[index[t + 2]]};
      volume += glm::dot(P3(q[0]), glm::cross(P3(q[1]), P3(q[2]))) / 6;
      for (int k = 0; k < 3; ++k) {
        const Point a = q[k], b = q[(k + 1) % 3];
        ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}], --edges[{b.x, b.y, b.z, a.x, a.y, a.z}];
      }
    }
  }
  EXPECT_TRUE(std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; }));
  EXPECT_GT(volume, 4.0);
  EXPECT_LT(volume, 6.0);
}

TEST(Hall, NamesItsLightGroupsAndMovesItsChandeliers) {
  const File file(makeHall(kDefaultDetail).glb());
  std::set<std::string> groups;
  for (const Json& node : file.json["nodes"])
    if (node.contains("extensions")) groups.insert(node["extras"]["relume"]["group"].get<std::string>());
  EXPECT_EQ(groups,
            (std::set<std::string>{"chandeliers", "east candelabra", "sun", "throne", "west candelabra"}));
  EXPECT_EQ(file.json["animations"][0]["channels"].size(), 2u);
}

}  // namespace
}  // namespace relume::scenes
