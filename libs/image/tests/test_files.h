// SPDX-License-Identifier: MIT
// Image files made on the spot, in kinds that the library reads and does not write.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "relume/image/image.h"

namespace relume::image::test {

/// A folder that vanishes with the object.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

using Bytes = std::vector<std::byte>;

/// A smooth picture with some noise, in [0, 1]; the same for equal arguments.
Image picture(int width, int height, int channels, std::uint32_t seed = 1);
Image8 toImage8(const Image& image);

struct PngOptions {
  bool interlaced = false;
  bool sixteen_bits = false;                         ///< `data` holds big-endian pairs
  std::vector<std::array<std::uint8_t, 3>> palette;  ///< then `data` holds indices
  std::vector<std::uint8_t> palette_alpha;
};
Bytes encodePng(const Image8& image, const PngOptions& options = {});
Bytes encodeJpeg(const Image8& image, bool progressive = false, bool cmyk = false);
Bytes encodeWebpLossless(const Image8& image);

enum class ExrLayout { kScanLines, kTiles, kDeep };
struct ExrChannel {
  std::string name;
  char type;  ///< 'f' float, 'h' half, 'u' unsigned integer
};
/// Channel c of `image` is written under the name channels[c].
Bytes encodeExr(const Image& image, const std::vector<ExrChannel>& channels,
                ExrLayout layout = ExrLayout::kScanLines, int compression = 3, int first_x = 0,
                int first_y = 0);

}  // namespace relume::image::test
