// SPDX-License-Identifier: MIT
#include "relume/codec/compress.h"

#include <fmt/format.h>
#include <zstd.h>

#include <memory>
#include <string>

#include "relume/core/check.h"
#include "relume/core/error.h"

namespace relume::codec {
namespace {

constexpr int kLevel = 9;
// The densest block of Zstandard turns 4 bytes into 128 KiB.
constexpr std::size_t kMaxRatio = (128u << 10) / 4;

[[noreturn]] void corrupt(const std::string& problem) {
  throw Error(ErrorCode::kCorruptAsset, "compressed data", problem, "the file was damaged; make it again");
}

std::uint32_t loadElement(const std::byte* p, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t b = 0; b < size; ++b) value |= std::to_integer<std::uint32_t>(p[b]) << (8 * b);
  return value;
}

// The element size is a template parameter for speed: the loops over bytes unroll.
template <std::size_t kSize>
void shuffle(std::span<const std::byte> data, std::size_t channels, bool delta, std::span<std::byte> out) {
  const std::size_t rows = data.size() / (kSize * channels);
  for (std::size_t c = 0; c < channels; ++c) {
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      const std::uint32_t value = loadElement(&data[(i * channels + c) * kSize], kSize);
      const std::uint32_t coded = delta ? value - before : value;
      for (std::size_t b = 0; b < kSize; ++b)
        out[(c * kSize + b) * rows + i] = static_cast<std::byte>((coded >> (8 * b)) & 0xffu);
      before = value;
    }
  }
}

template <std::size_t kSize>
void unshuffle(std::span<const std::byte> coded, std::size_t channels, bool delta, std::span<std::byte> out) {
  const std::size_t rows = coded.size() / (kSize * channels);
  for (std::size_t c = 0; c < channels; ++c) {
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      std::uint32_t value = delta ? before : 0;
      for (std::size_t b = 0; b < kSize; ++b)
        value += std::to_integer<std::uint32_t>(coded[(c * kSize + b) * rows + i]) << (8 * b);
      for (std::size_t b = 0; b < kSize; ++b)
        out[(i * channels + c) * kSize + b] = static_cast<std::byte>((value >> (8 * b)) & 0xffu);
      before = value;
    }
  }
}

template <class Bytes>
std::vector<std::byte> filtered(Bytes&& run, std::size_t size, Layout layout) {
  std::vector<std::byte> out(size);
  switch (layout.element_size) {
    case 1:
      run.template operator()<1>(std::span(out));
      break;
    case 2:
      run.template operator()<2>(std::span(out));
      break;
    default:
      run.template operator()<4>(std::span(out));
      break;
  }
  return out;
}

void checkLayout(std::size_t size, Layout layout) {
  RELUME_CHECK(layout.element_size == 1 || layout.element_size == 2 || layout.element_size == 4);
  RELUME_CHECK_LT(std::size_t{0}, layout.channels);
  RELUME_CHECK_EQ(size % (layout.element_size * layout.channels), std::size_t{0});
}

struct FreeContext {
  void operator()(ZSTD_CCtx* c) const { ZSTD_freeCCtx(c); }
};

}  // namespace

std::vector<std::byte> compress(std::span<const std::byte> data, Filter filter, Layout layout) {
  checkLayout(data.size(), layout);
  std::vector<std::byte> coded;
  if (filter != Filter::kNone) {
    const bool delta = filter == Filter::kDelta;
    coded = filtered([&]<std::size_t kSize>(
                         std::span<std::byte> out) { shuffle<kSize>(data, layout.channels, delta, out); },
                     data.size(), layout);
    data = coded;
  }
  const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  std::vector<std::byte> stored(ZSTD_compressBound(data.size()));
  const std::size_t size =
      ZSTD_compressCCtx(context.get(), stored.data(), stored.size(), data.data(), data.size(), kLevel);
  if (ZSTD_isError(size)) throw Error(ErrorCode::kOutOfMemory, "compression", ZSTD_getErrorName(size));
  stored.resize(size);
  stored.shrink_to_fit();
  return stored;
}

std::vector<std::byte> decompress(std::span<const std::byte> stored, std::size_t decoded_size, Filter filter,
                                  Layout layout) {
  checkLayout(decoded_size, layout);
  const auto declared = ZSTD_getFrameContentSize(stored.data(), stored.size());
  if (declared != decoded_size) corrupt(fmt::format("is not a Zstandard frame of {} bytes", decoded_size));
  if (ZSTD_findFrameCompressedSize(stored.data(), stored.size()) != stored.size())
    corrupt("is cut off or followed by other bytes");
  if (decoded_size / kMaxRatio > stored.size())
    corrupt(fmt::format("{} bytes cannot hold the {} they declare", stored.size(), decoded_size));
  std::vector<std::byte> coded(decoded_size);
  const std::size_t size = ZSTD_decompress(coded.data(), coded.size(), stored.data(), stored.size());
  if (size != decoded_size) corrupt(ZSTD_isError(size) ? ZSTD_getErrorName(size) : "is shorter than it says");
  if (filter == Filter::kNone) return coded;
  const bool delta = filter == Filter::kDelta;
  return filtered([&]<std::size_t kSize>(
                      std::span<std::byte> out) { unshuffle<kSize>(coded, layout.channels, delta, out); },
                  decoded_size, layout);
}

}  // namespace relume::codec
