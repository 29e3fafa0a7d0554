// SPDX-License-Identifier: MIT
// Rows of texels that are already computed, kept in a file: an interrupted bake goes on, an unchanged one
// costs nothing, and after objects have moved only texels within the solver's reach of the change are
// computed again ([IKSZ03] section 4.4: with a distance limit the obscurance is a local property).
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/bake/registry.h"
#include "scene_digest.h"

namespace relume::bake {

class TexelStore {
 public:
  /// Loads what is usable from `folder` (nothing when it is empty or holds no such entry; a damaged entry is
  /// as good as none). `structure` is structureDigest; the placements say what moved since the entry was
  /// written. Keeps a reference to `texels`.
  TexelStore(const std::filesystem::path& folder, const Digest& structure, const TexelSolver& solver,
             const atlas::Texels& texels, std::vector<Placement> now);

  std::size_t reused() const { return reused_; }
  const std::string& staleBecause() const { return stale_because_; }  ///< empty when nothing is stale
  std::vector<std::uint32_t> pending() const;  ///< indices of texels still to be computed

  /// Computes all pending texels; keeps what is finished when interrupted (and now and then in long runs).
  /// Returns rays spent.
  std::uint64_t complete(const TexelSolver& solver, Progress& progress);

  std::span<const float> rows() const { return rows_; }  ///< shape [points][row]

 private:
  bool load(float reach);
  void save() const;
  std::size_t endOfBlock(std::span<const std::uint32_t> todo, std::size_t first, std::size_t block) const;

  const atlas::Texels& texels_;
  std::filesystem::path file_;
  std::size_t row_;
  std::vector<Placement> now_;
  std::vector<std::uint8_t> done_;
  std::vector<float> rows_;
  std::size_t reused_ = 0;
  std::string stale_because_;
};

/// Removes the entries of `folder` used longest ago until the rest takes at most `limit` bytes.
void trimStore(const std::filesystem::path& folder, std::uint64_t limit);

}  // namespace relume::bake
