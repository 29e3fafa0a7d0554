// SPDX-License-Identifier: MIT
// Radiance pictures (.hdr, RGBE): three 8-bit mantissas and one exponent per pixel.
//   value = mantissa * 2^(exponent - 136), 0 when the exponent is 0
// Based on: G. Ward, Real Pixels, Graphics Gems II, 1991, and the Radiance reference manual.
// Differs: the writer rounds to nearest (relative error below 2^-8 of the largest channel) where Radiance
// truncates and its readers add half a unit; readers of textures do not add it, so rounding leaves no bias.
// Limits: only 32-bit_rle_rgbe in the usual order "-Y height +X width"; EXPOSURE and PRIMARIES are not
// applied.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "codecs.h"
#include "relume/core/error.h"

namespace relume::image::detail {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

constexpr int kMinRunWidth = 8, kMaxRunWidth = 32767;  // widths outside are stored without runs
constexpr int kMinRun = 4, kMaxRun = 127;

class Input {
 public:
  Input(Bytes file, const std::string& subject) : file_(file), subject_(subject) {}
  std::uint8_t byte() {
    if (at_ == file_.size()) throwTruncated(subject_);
    return byteAt(file_, at_++);
  }
  std::uint8_t peek(std::size_t ahead) const {
    return at_ + ahead < file_.size() ? byteAt(file_, at_ + ahead) : 0;
  }
  Rgbe pixel() { return {byte(), byte(), byte(), byte()}; }
  std::string line() {
    std::string text;
    for (std::uint8_t c; (c = byte()) != '\n';) {
      if (text.size() == 1024) throwUnreadable(subject_, "HDR", "a header line is too long");
      text.push_back(static_cast<char>(c));
    }
    if (!text.empty() && text.back() == '\r') text.pop_back();
    return text;
  }

 private:
  Bytes file_;
  const std::string& subject_;
  std::size_t at_ = 0;
};

bool takeNumber(std::string_view& text, std::string_view before, int& number) {
  if (!text.starts_with(before)) return false;
  text.remove_prefix(before.size());
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

void readRuns(Input& in, std::vector<Rgbe>& row, const std::string& subject) {
  for (std::size_t channel = 0; channel < 4; ++channel) {
    for (std::size_t x = 0; x < row.size();) {
      const std::uint8_t code = in.byte();
      const std::size_t count = code > 128 ? code - 128u : code;
      if (count == 0 || count > row.size() - x) throwUnreadable(subject, "HDR", "a run leaves its row");
      if (code > 128) {
        const std::uint8_t value = in.byte();
        for (std::size_t i = 0; i < count; ++i) row[x++][channel] = value;
      } else {
        for (std::size_t i = 0; i < count; ++i) row[x++][channel] = in.byte();
      }
    }
  }
}

// Pixels one by one; (1, 1, 1, n) repeats the one before n times, shifted by 8 bits for each such pixel in a
// row.
void readPlain(Input& in, std::vector<Rgbe>& row, const std::string& subject) {
  int shift = 0;
  for (std::size_t x = 0; x < row.size();) {
    const Rgbe p = in.pixel();
    if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
      row[x++] = p;
      shift = 0;
      continue;
    }
    const std::size_t count = shift <= 16 ? static_cast<std::size_t>(p[3]) << shift : 0;
    if (x == 0 || count == 0 || count > row.size() - x)
      throwUnreadable(subject, "HDR", "a run leaves its row");
    std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
    x += count;
    shift += 8;
  }
}

Rgbe toRgbe(const float* p, int channels) {
  // Radiance knows neither negative nor infinite light; the largest value is 255 * 2^119.
  const auto clean = [](float v) { return v > 0.0f ? std::min(v, 1.6e38f) : 0.0f; };
  const float r = clean(p[0]), g = channels >= 3 ? clean(p[1]) : r, b = channels >= 3 ? clean(p[2]) : r;
  const float largest = std::max({r, g, b});
  if (largest < 1e-32f) return {0, 0, 0, 0};
  int exponent = 0;
  std::frexp(largest, &exponent);
  if (std::lround(std::ldexp(largest, 8 - exponent)) > 255) ++exponent;
  const auto mantissa = [&](float v) {
    return static_cast<std::uint8_t>(std::lround(std::ldexp(v, 8 - exponent)));
  };
  return {mantissa(r), mantissa(g), mantissa(b), static_cast<std::uint8_t>(exponent + 128)};
}

void appendRuns(std::vector<std::byte>& out, const std::vector<Rgbe>& row, std::size_t channel) {
  const auto runAt = [&](std::size_t x) {
    std::size_t n = 1;
    while (x + n < row.size() && n < kMaxRun && row[x + n][channel] == row[x][channel]) ++n;
    return n;
  };
  for (std::size_t x = 0; x < row.size();) {
    const std::size_t run = runAt(x);
    if (run >= kMinRun) {
      out.push_back(static_cast<std::byte>(128 + run));
      out.push_back(static_cast<std::byte>(row[x][channel]));
      x += run;
      continue;
    }
    std::size_t end = x;
    while (end < row.size() && end - x < 128 && runAt(end) < kMinRun) ++end;
    out.push_back(static_cast<std::byte>(end - x));
    for (; x < end; ++x) out.push_back(static_cast<std::byte>(row[x][channel]));
  }
}

}  // namespace

Image decodeHdr(Bytes file, const std::string& subject) {
  Input in(file, subject);
  in.line();
  for (std::string line; !(line = in.line()).empty();) {
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
      throw Error(ErrorCode::kUnsupported, subject, "is an HDR picture with " + line,
                  "save it as 32-bit_rle_rgbe");
  }
  const std::string resolution = in.line();
  std::string_view rest = resolution;
  int width = 0, height = 0;
  if (!takeNumber(rest, "-Y ", height) || !takeNumber(rest, " +X ", width) || !rest.empty())
    throw Error(ErrorCode::kUnsupported, subject,
                "is an HDR picture of an unusual orientation: " + resolution,
                "save it top row first, left to right");
  requirePlausibleSize(width, height, file.size(), subject);

  Image out(width, height, 3);
  std::vector<Rgbe> row(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    const bool runs = width >= kMinRunWidth && width <= kMaxRunWidth && in.peek(0) == 2 && in.peek(1) == 2 &&
                      in.peek(2) * 256 + in.peek(3) == width;
    if (runs) {
      in.pixel();
      readRuns(in, row, subject);
    } else {
      readPlain(in, row, subject);
    }
    for (int x = 0; x < width; ++x) {
      const Rgbe& p = row[static_cast<std::size_t>(x)];
      const float scale = p[3] == 0 ? 0.0f : std::ldexp(1.0f, p[3] - 136);
      out.setRgb(x, y, scale * Vec3(p[0], p[1], p[2]));
    }
  }
  return out;
}

std::vector<std::byte> encodeHdr(const Image& image) {
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height) +
                             " +X " + std::to_string(image.width) + "\n";
  const auto text = std::as_bytes(std::span(header.data(), header.size()));
  std::vector<std::byte> out(text.begin(), text.end());
  std::vector<Rgbe> row(static_cast<std::size_t>(image.width));
  const bool runs = image.width >= kMinRunWidth && image.width <= kMaxRunWidth;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      row[static_cast<std::size_t>(x)] = toRgbe(image.at(x, y), image.channels);
    if (runs) {
      for (const int b : {2, 2, image.width >> 8, image.width & 255})
        out.push_back(static_cast<std::byte>(b));
      for (std::size_t channel = 0; channel < 4; ++channel) appendRuns(out, row, channel);
      continue;
    }
    // The largest mantissa is at least 128, so no pixel looks like the repeat mark (1, 1, 1, n).
    for (const Rgbe& p : row)
      for (const std::uint8_t b : p) out.push_back(static_cast<std::byte>(b));
  }
  return out;
}

}  // namespace relume::image::detail
