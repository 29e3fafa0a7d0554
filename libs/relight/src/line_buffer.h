// SPDX-License-Identifier: MIT
// Memory for what is read from one end to the other: whole lines of the cache, in large pages where the
// system has them, since looking up one page of 4 KiB after the other costs a third of the rate.
#pragma once
#include <cstddef>
#include <memory>

namespace relume::relight {

struct alignas(64) Line {
  std::byte bytes[64];
};

class LineBuffer {
 public:
  LineBuffer() = default;
  explicit LineBuffer(std::size_t lines);  ///< all 0

  std::byte* data() { return lines_ ? lines_->bytes : nullptr; }
  const std::byte* data() const { return lines_ ? lines_->bytes : nullptr; }

 private:
  struct Release {
    void operator()(Line* lines) const;
  };
  std::unique_ptr<Line, Release> lines_;
};

}  // namespace relume::relight
