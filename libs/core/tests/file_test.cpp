// SPDX-License-Identifier: MIT
#include "relume/core/file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "relume/core/error.h"

namespace relume {
namespace {
namespace fs = std::filesystem;

class FileTest : public testing::Test {
 protected:
  FileTest() : folder_(fs::temp_directory_path() / ("relume_file_test_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~FileTest() override { fs::remove_all(folder_); }
  template <class F>
  static ErrorCode codeOf(F f) {
    try {
      f();
    } catch (const Error& e) {
      return e.code();
    }
    ADD_FAILURE() << "nothing was thrown";
    return ErrorCode::kUsage;
  }
  fs::path folder_;
};

TEST_F(FileTest, WhatIsWrittenIsReadAndNothingElseIsLeft) {
  const fs::path path = folder_ / "a.txt";
  writeFileAtomically(path, std::string_view("first"));
  writeFileAtomically(path, std::string_view("second"));
  EXPECT_EQ(readTextFile(path), "second");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(FileTest, MistakesHaveTheirCodes) {
  EXPECT_EQ(codeOf([&] { readFile(folder_ / "none"); }), ErrorCode::kFileNotFound);
  EXPECT_EQ(codeOf([&] { readFile(folder_); }), ErrorCode::kFileUnreadable);
  EXPECT_EQ(codeOf([&] { writeFileAtomically(folder_ / "no" / "such", std::string_view("x")); }),
            ErrorCode::kCannotWrite);
  EXPECT_EQ(codeOf([&] { requireWritable(folder_ / "no" / "such"); }), ErrorCode::kCannotWrite);
  EXPECT_EQ(codeOf([&] { requireWritable(folder_); }), ErrorCode::kCannotWrite);
}

// A rename that fails (the target is a folder that is not empty) must not leave the half-made file behind.
TEST_F(FileTest, AFailedWriteLeavesNothing) {
  fs::create_directories(folder_ / "target" / "full");
  EXPECT_EQ(codeOf([&] { writeFileAtomically(folder_ / "target", std::string_view("x")); }),
            ErrorCode::kCannotWrite);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace relume
