// SPDX-License-Identifier: MIT
// Tests that draw: each has a context of its own, or says why there is none.
#pragma once
#include <gtest/gtest.h>

#include <optional>

#include "relume/core/error.h"
#include "relume/render/context.h"

namespace relume::render {

class GlTest : public testing::Test {
 protected:
  void SetUp() override {
    try {
      context_.emplace();
    } catch (const Error& e) {
      GTEST_SKIP() << e.what();
    }
  }

 private:
  std::optional<HeadlessContext> context_;
};

}  // namespace relume::render
