// SPDX-License-Identifier: MIT
#include "texel_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <system_error>

#include "relume/core/check.h"
#include "relume/core/error.h"
#include "relume/core/file.h"
#include "relume/core/version.h"

namespace relume::bake {
namespace fs = std::filesystem;

namespace {

constexpr char kMagic[8] = {'R', 'E', 'L', 'T', 'E', 'X', 'L', '1'};
// Texels between chances to save: about a second's rays; few enough that their copies take little memory.
constexpr std::size_t kLeastBlock = 1 << 14, kMostBlock = 1 << 18, kBlockRays = 1 << 25;
constexpr std::uint32_t kBand = 16;  // rows of a page that stay together: solvers work on neighbours at once
constexpr auto kSaveEvery = std::chrono::seconds(30);

// The file: this header, then placements, flags, rows; closed by a checksum of all before it.
struct Header {
  char magic[8];
  std::uint64_t points, row, placements;
};

template <class T>
void append(std::vector<std::byte>& out, const T* values, std::size_t count) {
  const auto* bytes = reinterpret_cast<const std::byte*>(values);
  out.insert(out.end(), bytes, bytes + count * sizeof(T));
}

// Reads the parts of a file in order; says no when it is too short.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}
  template <class T>
  bool read(T* values, std::size_t count) {
    if (count > rest_.size() / sizeof(T)) return false;
    if (count) std::memcpy(values, rest_.data(), count * sizeof(T));
    rest_ = rest_.subspan(count * sizeof(T));
    return true;
  }

 private:
  std::span<const std::byte> rest_;
};

// Sound when whole and unchanged.
bool checksumHolds(std::span<const std::byte> file) {
  std::uint32_t stored = 0;
  if (file.size() < sizeof stored) return false;
  std::memcpy(&stored, file.data() + file.size() - sizeof stored, sizeof stored);
  return stored == crc32(file.first(file.size() - sizeof stored));
}

// How far a texel's footprint may reach from its position, with room for rounding.
float footprintRadius(const atlas::SurfacePoint& p) {
  return 1.01f * (glm::length(p.dp_dx) + glm::length(p.dp_dy)) + 1e-4f;
}

}  // namespace

TexelStore::TexelStore(const fs::path& folder, const Digest& structure, const TexelSolver& solver,
                       const atlas::Texels& texels, std::vector<Placement> now)
    : texels_(texels),
      row_(static_cast<std::size_t>(solver.row)),
      now_(std::move(now)),
      done_(texels.points.size(), 0),
      rows_(texels.points.size() * row_, 0.0f) {
  if (folder.empty()) {
    stale_because_ = "there is no cache";
    return;
  }
  const Digest key = Hasher().add(std::string_view(version())).add(structure).add(solver.key).digest();
  file_ = folder / (key.hex() + ".texels");
  if (!load(solver.reach)) {
    std::fill(done_.begin(), done_.end(), std::uint8_t{0});
    stale_because_ = "nothing baked with this geometry and these settings is in the cache";
  }
  reused_ = static_cast<std::size_t>(std::count(done_.begin(), done_.end(), 1));
}

bool TexelStore::load(float reach) {
  std::error_code ec;
  if (!fs::exists(file_, ec)) return false;
  const std::vector<std::byte> file = readFile(file_);
  Header header{};
  Reader reader(file);
  if (!checksumHolds(file) || !reader.read(&header, 1) ||
      std::memcmp(header.magic, kMagic, sizeof kMagic) != 0)
    return false;
  if (header.points != done_.size() || header.row != row_ || header.placements != now_.size()) return false;
  std::vector<Placement> before(now_.size());
  if (!reader.read(before.data(), before.size()) || !reader.read(done_.data(), done_.size()) ||
      !reader.read(rows_.data(), rows_.size()))
    return false;
  fs::last_write_time(file_, fs::file_time_type::clock::now(), ec);  // used: trimmed last

  const auto finished = static_cast<std::size_t>(std::count(done_.begin(), done_.end(), 1));
  if (finished < done_.size()) stale_because_ = "an earlier bake was interrupted";

  std::vector<Box3> changed;
  std::vector<bool> moved;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (std::memcmp(&now_[i].world_from_local, &before[i].world_from_local, sizeof(Mat4)) == 0) continue;
    moved.resize(std::max<std::size_t>(moved.size(), now_[i].instance + 1));
    moved[now_[i].instance] = true;
    changed.push_back(before[i].bounds);
    changed.push_back(now_[i].bounds);
  }
  if (changed.empty()) return true;
  std::size_t touched = 0;
  for (std::size_t i = 0; i < done_.size(); ++i) {
    const atlas::SurfacePoint& p = texels_.points[i];
    const float radius = reach + footprintRadius(p);
    const bool own = p.instance < moved.size() && moved[p.instance];
    if (own || std::any_of(changed.begin(), changed.end(),
                           [&](const Box3& box) { return box.distance(p.position) <= radius; })) {
      done_[i] = 0, ++touched;
    }
  }
  stale_because_ =
      fmt::format("{} object{} moved; {} of {} texels are within {:.3g} m of the change", changed.size() / 2,
                  changed.size() == 2 ? "" : "s", touched, done_.size(), reach);
  return true;
}

void TexelStore::save() const {
  if (file_.empty()) return;
  Header header{.magic = {}, .points = done_.size(), .row = row_, .placements = now_.size()};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  std::vector<std::byte> out;
  out.reserve(sizeof header + now_.size() * sizeof(Placement) + done_.size() + rows_.size() * sizeof(float) +
              4);
  append(out, &header, 1);
  append(out, now_.data(), now_.size());
  append(out, done_.data(), done_.size());
  append(out, rows_.data(), rows_.size());
  const std::uint32_t checksum = crc32(out);
  append(out, &checksum, 1);
  std::error_code ec;
  fs::create_directories(file_.parent_path(), ec);
  try {
    writeFileAtomically(file_, out);
  } catch (const Error&) {
    // A cache that cannot be written costs time later, not the bake now.
  }
}

std::vector<std::uint32_t> TexelStore::pending() const {
  std::vector<std::uint32_t> result;
  for (std::uint32_t i = 0; i < done_.size(); ++i)
    if (!done_[i]) result.push_back(i);
  return result;
}

std::size_t TexelStore::endOfBlock(std::span<const std::uint32_t> todo, std::size_t first,
                                   std::size_t block) const {
  const auto width = static_cast<std::uint32_t>(texels_.width),
             height = static_cast<std::uint32_t>(texels_.height);
  const auto band = [&](std::uint32_t point) {
    const std::uint32_t row = texels_.points[point].texel / width;
    return std::pair(row / height, row % height / kBand);
  };
  std::size_t end = std::min(todo.size(), first + block);
  while (end < todo.size() && band(todo[end]) == band(todo[end - 1])) ++end;
  return end;
}

std::uint64_t TexelStore::complete(const TexelSolver& solver, Progress& progress) {
  const std::vector<std::uint32_t> todo = pending();
  if (todo.empty()) return 0;
  std::uint64_t rays = 0;
  const std::size_t block_texels =
      std::clamp(kBlockRays / std::max<std::size_t>(solver.most_rays, 1), kLeastBlock, kMostBlock);
  std::vector<float> block;
  auto saved = std::chrono::steady_clock::now();
  try {
    for (std::size_t first = 0; first < todo.size();) {
      const auto which = std::span(todo).subspan(first, endOfBlock(todo, first, block_texels) - first);
      first += which.size();
      block.resize(which.size() * row_);
      rays += solver.solve(which, block, progress);
      for (std::size_t i = 0; i < which.size(); ++i) {
        std::copy_n(block.data() + i * row_, row_, rows_.data() + which[i] * row_);
        done_[which[i]] = 1;
      }
      if (std::chrono::steady_clock::now() - saved > kSaveEvery) {
        save();
        saved = std::chrono::steady_clock::now();
      }
    }
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kInterrupted || error.code() == ErrorCode::kOutOfMemory) save();
    if (error.code() != ErrorCode::kInterrupted || file_.empty()) throw;
    throw Error(ErrorCode::kInterrupted, "", "interrupted", "run the same command again to go on");
  }
  save();
  return rays;
}

void trimStore(const fs::path& folder, std::uint64_t limit) {
  struct Entry {
    fs::path path;
    std::uint64_t size;
    fs::file_time_type used;
  };
  std::vector<Entry> entries;
  std::uint64_t total = 0;
  std::error_code ec;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const fs::path kind = it->path().extension();
    if (kind != ".texels" && kind != ".layer") continue;
    std::error_code entry_ec;
    const std::uint64_t size = it->file_size(entry_ec);
    const fs::file_time_type used = it->last_write_time(entry_ec);
    if (entry_ec) continue;  // another bake has just removed it
    entries.push_back({it->path(), size, used});
    total += size;
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (total <= limit) break;
    fs::remove(entry.path, ec);
    total -= entry.size;
  }
}

}  // namespace relume::bake
