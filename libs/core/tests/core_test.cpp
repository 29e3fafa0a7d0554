// SPDX-License-Identifier: MIT
// Errors, hashes, sizes, parallel loops.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <numeric>
#include <vector>

#include "relume/core/error.h"
#include "relume/core/hash.h"
#include "relume/core/memory.h"
#include "relume/core/parallel.h"

namespace relume {
namespace {

TEST(ErrorText, IsOneLineWithSubjectProblemAndRemedy) {
  const Error e(ErrorCode::kOutOfBounds, "room.gltf: accessors[3]", "ends at byte 90\nof 80",
                "export the file again");
  EXPECT_STREQ(e.what(), "room.gltf: accessors[3]: ends at byte 90 of 80; export the file again");
  EXPECT_EQ(exitStatus(ErrorCode::kOutOfBounds), 1);
  EXPECT_EQ(exitStatus(ErrorCode::kUsage), 2);
  EXPECT_EQ(exitStatus(ErrorCode::kCannotWrite), 3);
  EXPECT_EQ(exitStatus(ErrorCode::kOutOfMemory), 4);
  EXPECT_EQ(exitStatus(ErrorCode::kInterrupted), 130);
}

TEST(Hash, DependsOnContentAndOnItsDivision) {
  const auto of = [](std::string_view a, std::string_view b) { return Hasher().add(a).add(b).digest(); };
  EXPECT_EQ(of("ab", "c"), of("ab", "c"));
  EXPECT_NE(of("ab", "c"), of("a", "bc"));
  EXPECT_EQ(of("ab", "c").hex().size(), 32u);
}

TEST(Hash, Crc32IsThePublishedCheckValue) {
  const char* digits = "123456789";
  EXPECT_EQ(crc32(std::as_bytes(std::span(digits, std::strlen(digits)))),
            0xcbf43926u);  // ISO 3309 check value
  EXPECT_EQ(crc32({}), 0u);
}

TEST(Size, ReadsWhatPeopleWrite) {
  EXPECT_EQ(parseSize("1500000"), 1500000u);
  EXPECT_EQ(parseSize("512M"), 512u << 20);
  EXPECT_EQ(parseSize("2GiB"), std::uint64_t{2} << 30);
  EXPECT_EQ(parseSize("1.5k"), 1536u);
  for (const char* wrong : {"", "x", "5Q", "-1M", "1MM", "1e400"})
    EXPECT_THROW(parseSize(wrong), Error) << wrong;
  EXPECT_EQ(formatSize(1536), "1.5 KiB");
  EXPECT_EQ(formatSize(12), "12 B");
}

TEST(Parallel, VisitsEveryItemOnceInAlignedRanges) {
  std::vector<int> visits(1000, 0);
  parallelFor(visits.size(), 64, [&](std::size_t begin, std::size_t end) {
    EXPECT_EQ(begin % 64, 0u);
    EXPECT_LE(end - begin, 64u);
    for (std::size_t i = begin; i < end; ++i) ++visits[i];
  });
  EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), 0), 1000);
  EXPECT_EQ(*std::max_element(visits.begin(), visits.end()), 1);
}

TEST(Parallel, StopsWhenCancelledAndPassesExceptionsOn) {
  SilentProgress progress;
  std::atomic<int> ran{0};
  try {
    parallelFor(
        1 << 20, 1, [&](std::size_t, std::size_t) { ++ran, progress.cancel(); }, &progress);
    FAIL() << "went on after the cancel";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kInterrupted);
  }
  EXPECT_LT(ran, 1 << 20);
  EXPECT_THROW(parallelFor(10, 1, [](std::size_t, std::size_t) { throw Error(ErrorCode::kUsage, "", "x"); }),
               Error);
}

TEST(Parallel, ThreadLimitHolds) {
  const ThreadLimit one(1);
  EXPECT_EQ(threadCount(), 1);
}

}  // namespace
}  // namespace relume
