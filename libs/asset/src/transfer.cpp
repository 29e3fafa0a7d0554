// SPDX-License-Identifier: MIT
#include "relume/asset/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "relume/core/error.h"
#include "surface_codec.h"

namespace relume::asset {
namespace {

constexpr float kUnitTolerance = 1e-3f;
constexpr float kPositionShare = 0x1p-11f;  // of an entry's side: the coarsest step of its points
constexpr const char* kPoint = "entry point";

// The columns of table "shape".
enum ShapeField : std::size_t { kExits, kEntries, kChannels, kBits, kSamples, kSide, kShapeFields };

[[noreturn]] void corrupt(const std::string& layer, const std::string& problem) {
  throw Error(ErrorCode::kCorruptAsset, "layer " + layer, problem, "the file was damaged; bake it again");
}

constexpr float kMixSteps = 127;

/// Calls visit(place in mix, entry).
template <class Visit>
void forEachMix(const Entries& entries, const Visit& visit) {
  for (std::size_t p = 0, at = 0; p < entries.patches(); ++p)
    for (std::uint32_t k = 0; k < entries.samples; ++k)
      for (std::uint32_t e = entries.first[p]; e < entries.first[p + 1]; ++e) visit(at++, e);
}

bool soundAmount(float v) { return std::isfinite(v) && v >= 0; }

void checkPatches(const Entries& entries, const std::string& layer) {
  const std::vector<std::uint32_t>& first = entries.first;
  // Strictly: a patch without an entry has no light.
  if (first.size() < 2 || first.front() != 0 || first.back() != entries.size() ||
      std::adjacent_find(first.begin(), first.end(), std::greater_equal<>()) != first.end())
    corrupt(layer,
            fmt::format("its {} patches do not share out {} entries", entries.patches(), entries.size()));
  if (entries.mix.size() != std::uint64_t{entries.samples} * entries.size())
    corrupt(layer, fmt::format("it mixes {} irradiances for {} entries of {} points", entries.mix.size(),
                               entries.size(), entries.samples));
  if (!std::all_of(entries.mix.begin(), entries.mix.end(), [](float m) { return std::isfinite(m); }))
    corrupt(layer, "how an entry mixes irradiances is not finite");
}

void checkEntries(const Entries& entries, std::size_t columns, const std::string& layer) {
  if (entries.size() != columns)
    corrupt(layer, fmt::format("it has {} entries for {} columns", entries.size(), columns));
  checkPatches(entries, layer);
  const std::uint64_t points = std::uint64_t{entries.samples} * entries.patches();
  if (entries.samples == 0 || entries.position.size() != points || entries.normal.size() != points)
    corrupt(layer,
            fmt::format("it has {} positions and {} normals where {} patches have {} points each",
                        entries.position.size(), entries.normal.size(), entries.patches(), entries.samples));
  for (std::size_t i = 0; i < points; ++i)
    if (!isFinite(entries.position[i]) || !(std::abs(glm::length(entries.normal[i]) - 1) < kUnitTolerance))
      corrupt(layer, fmt::format("entry point {} is not a place with a unit normal", i));
  if (!std::all_of(entries.area.begin(), entries.area.end(), soundAmount))
    corrupt(layer, "the area of an entry is negative or not finite");
}

/// By entry: the largest of its mix, 127 steps.
std::vector<float> mixScales(const Entries& entries) {
  std::vector<float> scale(entries.size(), 0.0f);
  forEachMix(entries, [&](std::size_t at, std::size_t entry) {
    scale[entry] = std::max(scale[entry], std::abs(entries.mix[at]));
  });
  for (float& s : scale) s /= kMixSteps;
  return scale;
}

/// Every entry the mean of its own points: what needs no tables.
bool allMeans(const Entries& entries) {
  return entries.patches() == entries.size() &&
         std::all_of(entries.mix.begin(), entries.mix.end(),
                     [&](float m) { return m == 1.0f / static_cast<float>(entries.samples); });
}

void addMix(const Entries& entries, std::vector<Table>& tables) {
  if (allMeans(entries)) return;
  std::vector<float> scale = mixScales(entries);
  std::vector<std::int8_t> mix(entries.mix.size());
  forEachMix(entries, [&](std::size_t at, std::size_t entry) {
    if (scale[entry] > 0) mix[at] = static_cast<std::int8_t>(std::lround(entries.mix[at] / scale[entry]));
  });
  tables.push_back({"patchFirst", 1, entries.first});
  tables.push_back({"entryMix", 1, std::move(mix)});
  tables.push_back({"entryMixScale", 1, std::move(scale)});
}

void checkVertices(const VertexExits& v, std::size_t rows, std::size_t texels, const std::string& layer) {
  if (v.position.size() != rows || v.normal.size() != rows)
    corrupt(layer, fmt::format("it has {} vertices with {} normals for {} exits", v.position.size(),
                               v.normal.size(), rows));
  for (std::size_t i = 0; i < rows; ++i)
    if (!isFinite(v.position[i]) || !(std::abs(glm::length(v.normal[i]) - 1) < kUnitTolerance))
      corrupt(layer, fmt::format("vertex {} is not a place with a unit normal", i));
  if (v.texel_exit.size() != 3 * texels || v.texel_weight.size() != 3 * texels)
    corrupt(layer, fmt::format("it does not say where {} texels lie between its vertices", texels));
  for (std::size_t i = 0; i < v.texel_exit.size(); ++i)
    if (v.texel_exit[i] >= rows)
      corrupt(layer, fmt::format("texel {} has vertex {} of {}", i / 3, v.texel_exit[i], rows));
  for (std::size_t i = 0; i < v.texel_weight.size(); i += 3)
    if (v.texel_weight[i] + v.texel_weight[i + 1] + v.texel_weight[i + 2] != 255)
      corrupt(layer, fmt::format("the weights of texel {} do not sum to 1", i / 3));
}

void checkProbes(const ProbeExits& p, std::size_t rows, const std::string& layer) {
  if (!isFinite(p.origin) || !(p.spacing > 0 && p.spacing < kInfinity))
    corrupt(layer, "its grid of probes has no place");
  std::uint64_t places = 1;
  for (const std::uint32_t n : p.count) places = n == 0 || places > p.probe.size() ? 0 : places * n;
  if (places == 0 || places != p.probe.size())
    corrupt(layer, fmt::format("its grid of {} x {} x {} has {} places", p.count[0], p.count[1], p.count[2],
                               p.probe.size()));
  for (const std::uint32_t probe : p.probe)
    if (probe != ProbeExits::kNoProbe && probe >= rows / ProbeExits::kRows)
      corrupt(layer, fmt::format("a place has probe {} of {}", probe, rows / ProbeExits::kRows));
  if (rows == 0 || rows % ProbeExits::kRows != 0)
    corrupt(layer, fmt::format("its probes have {} rows, which are not {} each", rows, ProbeExits::kRows));
}

void checkBlocks(const Exits& exits, std::size_t rows, const AtlasTable& atlas, const std::string& layer) {
  if (exits.side == 0) corrupt(layer, "its exits are blocks of 0 texels");
  if (exits.exit_of_texel.size() != atlas.texel.size())
    corrupt(layer, fmt::format("it has exits of {} texels where the atlas has {}", exits.exit_of_texel.size(),
                               atlas.texel.size()));
  const auto width = static_cast<std::uint32_t>(atlas.width),
             height = static_cast<std::uint32_t>(atlas.height);
  const auto blockOf = [&](std::size_t i) {
    const std::uint32_t texel = atlas.texel[i], row = texel / width;
    return std::tuple(row / height, row % height / exits.side, texel % width / exits.side, atlas.chart[i]);
  };
  constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> first(rows, kNone);
  for (std::size_t i = 0; i < exits.exit_of_texel.size(); ++i) {
    const std::uint32_t exit = exits.exit_of_texel[i];
    if (exit >= rows) corrupt(layer, fmt::format("texel {} has exit {} of {}", i, exit, rows));
    if (first[exit] == kNone) first[exit] = i;
    if (blockOf(i) != blockOf(first[exit]))
      corrupt(layer, fmt::format("exit {} is in more than one block of a chart", exit));
  }
}

constexpr float kMostNear = 250.0f / 255.0f;  // so that 1 / (1 - share) stays sound

void checkNear(const NearShares& shares, std::size_t texels, const std::string& layer) {
  if (!shares.empty() && shares.size() != texels)
    corrupt(layer, fmt::format("it has {} shares of short ways for {} texels", shares.size(), texels));
  for (const Vec3& s : shares)
    for (int c = 0; c < 3; ++c)
      if (!(s[c] >= 0 && s[c] < 1)) corrupt(layer, "a share of short ways is not in [0, 1)");
}

std::vector<std::uint8_t> encodeNear(const NearShares& shares) {
  std::vector<std::uint8_t> q;
  for (const Vec3& s : shares)
    for (int c = 0; c < 3; ++c)
      q.push_back(static_cast<std::uint8_t>(std::lround(255 * std::min(s[c], kMostNear))));
  return q;
}

void checkExits(const Exits& exits, std::size_t rows, const AtlasTable& atlas, const std::string& layer) {
  switch (exits.kind) {
    case Exits::Kind::kVertices:
      return checkVertices(exits.vertices, rows, atlas.texel.size(), layer);
    case Exits::Kind::kProbes:
      return checkProbes(exits.probes, rows, layer);
    case Exits::Kind::kTexels:
      return checkBlocks(exits, rows, atlas, layer);
  }
}

std::vector<float> flat(const std::vector<Point>& points) {
  std::vector<float> values;
  for (const Point& p : points)
    for (int c = 0; c < 3; ++c) values.push_back(p[c]);
  return values;
}

void addExits(const Exits& exits, std::vector<Table>& tables) {
  if (exits.kind == Exits::Kind::kTexels) tables.push_back({"exitOfTexel", 1, exits.exit_of_texel});
  if (exits.kind == Exits::Kind::kVertices) {
    const VertexExits& v = exits.vertices;
    tables.push_back({"vertexPosition", 3, flat(v.position)});
    tables.push_back({"vertexNormal", 2, encodeNormals(v.normal, "vertex")});
    tables.push_back({"texelVertex", 3, v.texel_exit});
    tables.push_back({"texelVertexWeight", 3, v.texel_weight});
  }
  if (exits.kind == Exits::Kind::kProbes) {
    const ProbeExits& p = exits.probes;
    tables.push_back({"probeGrid", 4, std::vector<float>{p.origin.x, p.origin.y, p.origin.z, p.spacing}});
    tables.push_back({"probeCount", 3, std::vector<std::uint32_t>(p.count.begin(), p.count.end())});
    tables.push_back({"probe", 1, p.probe});
  }
}

// Positions finer than what an entry can tell apart are noise that does not compress.
float coarsestStep(const Entries& entries) {
  const double total = std::accumulate(entries.area.begin(), entries.area.end(), 0.0);
  return entries.size() == 0
             ? 0.0f
             : static_cast<float>(std::sqrt(total / static_cast<double>(entries.size()))) * kPositionShare;
}

/// Looks tables up by name, type and shape.
class TableReader {
 public:
  explicit TableReader(const Layer& layer) : layer_(layer) {}

  template <class T>
  const std::vector<T>& get(const char* name, std::size_t channels = 1) const {
    const Table* table = layer_.findTable(name);
    if (!table) corrupt(layer_.name, fmt::format("it has no table {}", name));
    const auto* values = std::get_if<std::vector<T>>(&table->values);
    if (!values || table->channels != channels || values->size() % channels != 0)
      corrupt(layer_.name, fmt::format("its table {} has another type or number of channels", name));
    return *values;
  }
  bool has(const char* name) const { return layer_.findTable(name) != nullptr; }

 private:
  const Layer& layer_;
};

std::vector<Point> readPositions(const TableReader& tables, const std::string& layer) {
  const auto& stored_grid = tables.get<float>("entryGrid", 4);
  if (stored_grid.size() != 4) corrupt(layer, "its table entryGrid has more than one row");
  const Grid grid{{stored_grid[0], stored_grid[1], stored_grid[2]}, stored_grid[3]};
  const auto& q = tables.get<std::uint32_t>("entryPosition", 3);
  std::vector<Point> positions(q.size() / 3);
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = decodePosition(q.data() + 3 * i, grid);
  return positions;
}

void readMix(const TableReader& tables, const std::string& layer, Entries& entries) {
  if (!tables.has("entryMix")) {
    if (entries.position.size() != std::uint64_t{entries.samples} * entries.size())
      corrupt(layer, fmt::format("it has {} positions for {} entries of {} points", entries.position.size(),
                                 entries.size(), entries.samples));
    return entries.setMeans(entries.size());
  }
  entries.first = tables.get<std::uint32_t>("patchFirst");
  const auto& q = tables.get<std::int8_t>("entryMix");
  const auto& scale = tables.get<float>("entryMixScale");
  if (scale.size() != entries.size()) corrupt(layer, "its tables entryMixScale and entryArea do not fit");
  entries.mix.assign(q.begin(), q.end());
  checkPatches(entries, layer);
  forEachMix(entries, [&](std::size_t at, std::size_t entry) { entries.mix[at] *= scale[entry]; });
}

std::vector<Normal> readNormals(const TableReader& tables, const char* table, const std::string& layer) {
  const auto& q = tables.get<std::uint16_t>(table, 2);
  if (std::any_of(q.begin(), q.end(), [](std::uint16_t v) { return v > kOctahedralLast; }))
    corrupt(layer, fmt::format("its table {} has a normal off the octahedron", table));
  std::vector<Normal> normals(q.size() / 2);
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = decodeNormal(q.data() + 2 * i);
  return normals;
}

Exits readExits(const TableReader& tables, const std::string& layer, std::uint32_t side) {
  Exits exits{.side = side, .exit_of_texel = {}, .vertices = {}, .probes = {}};
  if (tables.has("vertexPosition")) {
    exits.kind = Exits::Kind::kVertices;
    VertexExits& v = exits.vertices;
    const auto& p = tables.get<float>("vertexPosition", 3);
    for (std::size_t i = 0; i < p.size(); i += 3) v.position.emplace_back(p[i], p[i + 1], p[i + 2]);
    v.normal = readNormals(tables, "vertexNormal", layer);
    v.texel_exit = tables.get<std::uint32_t>("texelVertex", 3);
    v.texel_weight = tables.get<std::uint8_t>("texelVertexWeight", 3);
  } else if (tables.has("probeGrid")) {
    exits.kind = Exits::Kind::kProbes;
    ProbeExits& p = exits.probes;
    const auto& grid = tables.get<float>("probeGrid", 4);
    const auto& count = tables.get<std::uint32_t>("probeCount", 3);
    if (grid.size() != 4 || count.size() != 3) corrupt(layer, "its grid of probes has more than one row");
    p.origin = {grid[0], grid[1], grid[2]}, p.spacing = grid[3];
    std::copy(count.begin(), count.end(), p.count.begin());
    p.probe = tables.get<std::uint32_t>("probe");
  } else {
    exits.exit_of_texel = tables.get<std::uint32_t>("exitOfTexel");
  }
  return exits;
}

}  // namespace

void Entries::setMeans(std::size_t count) {
  first.resize(count + 1);
  std::iota(first.begin(), first.end(), 0u);
  mix.assign(count * samples, 1.0f / static_cast<float>(samples));
}

void Transfer::check(const AtlasTable& atlas, const std::string& layer) const {
  try {
    matrix.check();
  } catch (const Error& e) {
    throw Error(e.code(), "layer " + layer, e.problem(), e.remedy());
  }
  checkEntries(entries, matrix.columns, layer);
  checkExits(exits, matrix.rows, atlas, layer);
  checkNear(near_share, atlas.texel.size(), layer);
  if (errors &&
      !(soundAmount(errors->entries) && soundAmount(errors->transfer) && soundAmount(errors->encoding)))
    corrupt(layer, "one of its errors is negative or not finite");
}

float entryPointStep(const Entries& entries) {
  return gridOf(entries.position, kPoint, coarsestStep(entries)).step;
}

std::vector<Table> transferTables(const Transfer& transfer, const AtlasTable& atlas) {
  transfer.check(atlas, "to be written");
  const codec::BlockMatrix& m = transfer.matrix;
  const Entries& entries = transfer.entries;
  const Grid grid = gridOf(entries.position, kPoint, coarsestStep(entries));
  std::vector<std::uint32_t> shape(kShapeFields);
  shape[kExits] = m.rows, shape[kEntries] = m.columns, shape[kChannels] = m.channels, shape[kBits] = m.bits;
  shape[kSamples] = entries.samples, shape[kSide] = transfer.exits.side;
  std::vector<Table> tables{
      {"shape", kShapeFields, std::move(shape)},
      {"entryGrid", 4, std::vector<float>{grid.origin.x, grid.origin.y, grid.origin.z, grid.step}},
      {"entryPosition", 3, encodePositions(entries.position, grid)},
      {"entryNormal", 2, encodeNormals(entries.normal, kPoint)},
      {"entryArea", 1, entries.area},
      {"tileFirst", 1, m.tile_first},
      {"tileRow", 1, m.tile_row},
      {"clusterFirst", 1, m.cluster_first},
      {"clusterColumn", 1, m.cluster_column},
      {"componentFirst", 1, m.component_first},
      {"scale", 1, m.scale}};
  addExits(transfer.exits, tables);
  if (const auto& e = transfer.errors)
    tables.push_back({"errors", 3, std::vector<float>{e->entries, e->transfer, e->encoding}});
  addMix(entries, tables);
  if (!transfer.near_share.empty()) tables.push_back({"nearShare", 3, encodeNear(transfer.near_share)});
  if (m.bits == 8) {
    tables.push_back({"planes", 1, m.planes8});
    tables.push_back({"weights", 1, m.weights8});
  } else {
    tables.push_back({"planes", 1, m.planes16});
    tables.push_back({"weights", 1, m.weights16});
  }
  return tables;
}

Transfer readTransfer(const Layer& layer, const AtlasTable& atlas) {
  const TableReader tables(layer);
  if (!tables.has("shape"))
    throw Error(ErrorCode::kMismatch, "layer " + layer.name, "has no transfer of light",
                "relight a layer of kind lightpath");
  const auto& shape = tables.get<std::uint32_t>("shape", kShapeFields);
  if (shape.size() != kShapeFields) corrupt(layer.name, "its table shape has more than one row");
  Transfer t;
  t.matrix.rows = shape[kExits], t.matrix.columns = shape[kEntries];
  t.matrix.channels = shape[kChannels], t.matrix.bits = shape[kBits];
  t.matrix.tile_first = tables.get<std::uint32_t>("tileFirst");
  t.matrix.tile_row = tables.get<std::uint32_t>("tileRow");
  t.matrix.cluster_first = tables.get<std::uint32_t>("clusterFirst");
  t.matrix.cluster_column = tables.get<std::uint32_t>("clusterColumn");
  t.matrix.component_first = tables.get<std::uint32_t>("componentFirst");
  t.matrix.scale = tables.get<float>("scale");
  if (t.matrix.bits == 8) {
    t.matrix.planes8 = tables.get<std::int8_t>("planes");
    t.matrix.weights8 = tables.get<std::int8_t>("weights");
  } else {
    t.matrix.planes16 = tables.get<std::int16_t>("planes");
    t.matrix.weights16 = tables.get<std::int16_t>("weights");
  }
  t.entries.samples = shape[kSamples];
  t.entries.position = readPositions(tables, layer.name);
  t.entries.normal = readNormals(tables, "entryNormal", layer.name);
  t.entries.area = tables.get<float>("entryArea");
  readMix(tables, layer.name, t.entries);
  t.exits = readExits(tables, layer.name, shape[kSide]);
  if (tables.has("nearShare")) {
    const auto& q = tables.get<std::uint8_t>("nearShare", 3);
    for (std::size_t i = 0; i < q.size(); i += 3)
      t.near_share.push_back(Vec3(q[i], q[i + 1], q[i + 2]) / 255.0f);
  }
  if (tables.has("errors")) {
    const auto& e = tables.get<float>("errors", 3);
    if (e.size() != 3) corrupt(layer.name, "its table errors has more than one row");
    t.errors = TransferErrors{e[0], e[1], e[2]};
  }
  t.check(atlas, layer.name);
  return t;
}

}  // namespace relume::asset
