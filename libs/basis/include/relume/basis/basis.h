// SPDX-License-Identifier: MIT
// Directional bases of light at a surface: what a lightmap's texel or a probe may hold instead of one
// irradiance, so that normal maps and gloss respond to baked light. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.5.2, and the sources
//   named in src/bases/ one by one.
// Three steps, the same for all:
//   project   add() arrivals of light, in any order, into sums that are linear in the light and can
//             themselves be added, scaled and smoothed; finish() makes coefficients of them.
//   evaluate  irradiance() for any normal, glossy() for any lobe; both touch no memory but the coefficients'.
//   store     pack() to the planes of planes(), which an 8-bit or half-float texture can hold; unpack().
// Directions are world directions. What light comes from below the surface is not part of any basis.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relume/basis/glossy.h"
#include "relume/basis/receiver.h"

namespace relume::basis {

/// How coefficients lie in textures.
enum class Packing : std::uint8_t {
  kHalf,  ///< half floats as they are, directions 8 bit: any filter of the hardware is right for most bases
  kCompact,  ///< 8 bit a number beside one half float or three of scale: about half the size
};

/// One texture of a texel's coefficients.
struct TexturePlane {
  enum class Format : std::uint8_t { kHalf, kUnorm8 };
  std::string name;
  int channels = 3;
  Format format = Format::kHalf;
  float lo = 0, hi = 1;    ///< kUnorm8: what 0 and 255 stand for
  bool direction = false;  ///< unit vectors, to be normalized after filtering
  std::size_t bytes() const { return static_cast<std::size_t>(channels) * (format == Format::kHalf ? 2 : 1); }
};

class Basis {
 public:
  virtual ~Basis() = default;

  virtual std::string name() const = 0;
  virtual std::size_t sums() const = 0;          ///< numbers that add() writes to
  virtual std::size_t coefficients() const = 0;  ///< numbers that finish() makes of them

  /// Adds an arrival to `sums`, shape [sums()].
  virtual void add(const Receiver& at, const Arrival& light, std::span<double> sums) const = 0;
  /// `coefficients`, shape [coefficients()], of all light that was added.
  virtual void finish(const Receiver& at, std::span<const float> sums,
                      std::span<float> coefficients) const = 0;

  /// E on a surface there whose normal is `n` (unit, world; on the receiver's side). Never below 0.
  virtual Irradiance irradiance(const Receiver& at, std::span<const float> coefficients, Normal n) const = 0;
  /// Radiance that the lobe reflects to the eye.
  virtual Radiance glossy(const Receiver& at, std::span<const float> coefficients,
                          const GlossyLobe& lobe) const = 0;

  virtual std::vector<TexturePlane> planes(Packing packing) const = 0;
  /// `stored`: the planes' numbers one after the other, before their rounding.
  virtual void pack(std::span<const float> coefficients, Packing packing, std::span<float> stored) const = 0;
  virtual void unpack(std::span<const float> stored, Packing packing,
                      std::span<float> coefficients) const = 0;

  /// Of a plane in a file, beside those of other bases: "sh3-0", "ahd-direction".
  std::string planeName(const TexturePlane& plane) const;
  std::size_t bytesPerTexel(Packing packing) const;
  /// Numbers in all planes.
  std::size_t storedNumbers(Packing packing) const;
};

struct BasisOptions {
  /// sh and hbasis: where the irradiance would be negative for some normal (ringing), fade high bands out by
  /// as little as it takes.
  bool window = false;
};

/// "irradiance", "sh2" to "sh4", "hbasis4", "hbasis6", "hl2", "ahd", "dominant", "farcry", "sg5" to "sg9",
/// "cube", "dice", "directions:n" with n from 6 to 64 ("directions" alone: 14). Throws Error kUsage that
/// names them.
std::unique_ptr<Basis> makeBasis(const std::string& name, const BasisOptions& options = {});
/// directions:n of directions that somebody else chose, world, unit; at most 64.
std::unique_ptr<Basis> makeDirections(std::vector<Direction> set);
/// What makeBasis() knows, with "directions:14" for all of their kind.
std::vector<std::string> basisNames();

/// What is left of numbers after their planes have rounded them.
void roundToPlanes(std::span<const TexturePlane> planes, std::span<float> stored);

}  // namespace relume::basis
