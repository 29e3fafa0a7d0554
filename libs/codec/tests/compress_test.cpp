// SPDX-License-Identifier: MIT
#include "relume/codec/compress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "relume/codec/quantize.h"
#include "relume/core/error.h"

namespace relume::codec {
namespace {

std::vector<std::byte> noise(std::size_t size) {
  std::vector<std::byte> data(size);
  std::uint32_t state = 1;
  for (std::byte& b : data) {
    state = state * 1664525u + 1013904223u;
    b = static_cast<std::byte>(state >> 24);
  }
  return data;
}

// Smooth float16 values, [count][channels], like an occlusion layer.
std::vector<std::byte> smoothHalves(std::size_t count, std::size_t channels) {
  std::vector<std::byte> data;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < channels; ++c) {
      const std::uint16_t h = halfFromFloat(0.5f + 0.4f * std::sin(0.01f * static_cast<float>(i + 70 * c)));
      data.push_back(static_cast<std::byte>(h & 0xff));
      data.push_back(static_cast<std::byte>(h >> 8));
    }
  return data;
}

class RoundTrip : public testing::TestWithParam<Filter> {};

TEST_P(RoundTrip, GivesTheSameBytesForEveryLayout) {
  for (const std::size_t element : {1u, 2u, 4u})
    for (const std::size_t channels : {1u, 2u, 3u, 7u})
      for (const std::size_t rows : {0u, 1u, 2u, 1000u}) {
        const auto data = noise(rows * channels * element);
        const Layout layout{element, channels};
        const auto stored = compress(data, GetParam(), layout);
        ASSERT_EQ(decompress(stored, data.size(), GetParam(), layout), data)
            << element << ' ' << channels << ' ' << rows;
        ASSERT_EQ(compress(data, GetParam(), layout), stored) << "not deterministic";
      }
}

TEST_P(RoundTrip, EveryTruncationIsRefused) {
  const auto data = smoothHalves(50, 3);
  const auto stored = compress(data, GetParam(), {2, 3});
  for (std::size_t size = 0; size < stored.size(); ++size) {
    // In a buffer of its own, so that a read past the end is seen by the sanitizer.
    const std::vector<std::byte> cut(stored.begin(), stored.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_THROW(decompress(cut, data.size(), GetParam(), {2, 3}), Error) << size;
  }
  auto longer = stored;
  longer.push_back({});
  EXPECT_THROW(decompress(longer, data.size(), GetParam(), {2, 3}), Error);
}

INSTANTIATE_TEST_SUITE_P(Filters, RoundTrip,
                         testing::Values(Filter::kNone, Filter::kShuffle, Filter::kDelta));

// docs/format.md's example of the delta filter: what a stranger's reader must undo.
TEST(Filter, DeltaThenShuffleIsAsSpecified) {
  const std::uint16_t rows[3][2] = {{0x0102, 0x2000}, {0x0105, 0x1fff}, {0x0205, 0x1fff}};
  std::vector<std::byte> data(sizeof rows);
  std::memcpy(data.data(), rows, sizeof rows);
  const auto stored = compress(data, Filter::kDelta, {2, 2});
  const auto coded = decompress(stored, data.size(), Filter::kNone, {1, 1});
  const std::uint8_t expected[12] = {0x02, 0x03, 0x00, 0x01, 0x00, 0x01, 0x00, 0xff, 0x00, 0x20, 0xff, 0x00};
  ASSERT_EQ(coded.size(), sizeof expected);
  for (std::size_t i = 0; i < coded.size(); ++i) EXPECT_EQ(std::to_integer<int>(coded[i]), expected[i]) << i;
}

TEST(Filter, DeltaMakesSmoothDataSmaller) {
  const auto data = smoothHalves(20000, 3);
  const auto plain = compress(data, Filter::kNone, {2, 3}).size();
  const auto shuffled = compress(data, Filter::kShuffle, {2, 3}).size();
  const auto delta = compress(data, Filter::kDelta, {2, 3}).size();
  EXPECT_LT(shuffled, plain);
  EXPECT_LT(delta, shuffled);
}

TEST(Decompress, RefusesAnotherSizeThanDeclared) {
  const auto data = noise(1000);
  const auto stored = compress(data, Filter::kNone, {1, 1});
  for (const std::size_t size : {0u, 999u, 1001u}) {
    try {
      decompress(stored, size, Filter::kNone, {1, 1});
      FAIL() << size;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::kCorruptAsset);
    }
  }
}

std::vector<std::byte> bytesOf(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int v : values) bytes.push_back(static_cast<std::byte>(v));
  return bytes;
}

// Two frames where one is promised, the second one empty; and a frame that keeps its size to itself.
TEST(Decompress, RefusesWhatIsNotOneFrameOfStatedSize) {
  const auto data = noise(100);
  auto stored = compress(data, Filter::kNone, {1, 1});
  for (const std::byte b : bytesOf({0x50, 0x2a, 0x4d, 0x18, 0, 0, 0, 0})) stored.push_back(b);
  EXPECT_THROW(decompress(stored, data.size(), Filter::kNone, {1, 1}), Error);
  const auto silent = bytesOf({0x28, 0xb5, 0x2f, 0xfd, 0x00, 0x58, 0x09, 0, 0, 'x'});
  EXPECT_THROW(decompress(silent, 1, Filter::kNone, {1, 1}), Error);
}

// A frame header may claim any size; twenty bytes do not earn an allocation of terabytes.
TEST(Decompress, RefusesAFrameTooSmallForWhatItClaims) {
  const auto bomb = bytesOf({0x28, 0xb5, 0x2f, 0xfd, 0xe0, 0, 0, 0, 0, 0, 1, 0, 0, 0x03, 0, 0, 0});
  EXPECT_THROW(decompress(bomb, std::size_t{1} << 40, Filter::kNone, {1, 1}), Error);
}

// The limit is not too strict for the most compressible data there is.
TEST(Decompress, AcceptsConstantData) {
  const std::vector<std::byte> zeros(std::size_t{64} << 20);
  const auto stored = compress(zeros, Filter::kDelta, {4, 1});
  EXPECT_EQ(decompress(stored, zeros.size(), Filter::kDelta, {4, 1}).size(), zeros.size());
}

}  // namespace
}  // namespace relume::codec
