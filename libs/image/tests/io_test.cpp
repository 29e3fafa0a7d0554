// SPDX-License-Identifier: MIT
#include "relume/image/io.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "relume/core/error.h"
#include "relume/core/file.h"
#include "test_files.h"

namespace relume::image {
namespace {

using namespace test;

double srgbToLinear64(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

Image readBytes(const Bytes& bytes) { return decodeImage(bytes, "x"); }

template <class F>
ErrorCode codeOf(F&& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::kUsage;
}

void expectSameBits(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.channels, b.channels);
  ASSERT_EQ(a.data.size(), b.data.size());
  EXPECT_EQ(std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)), 0);
}

TEST(Srgb, FunctionsAreInverseAndMatchTheStandard) {
  for (int i = 0; i <= 1000; ++i) {
    const double s = i / 1000.0;
    EXPECT_NEAR(srgbToLinear(static_cast<float>(s)), srgbToLinear64(s), 3e-7);
    EXPECT_NEAR(linearToSrgb(srgbToLinear(static_cast<float>(s))), s, 1e-6);
  }
  EXPECT_NEAR(srgbToLinear(0.5f), 0.21404114, 1e-7);  // middle grey of the display
}

// ---- EXR

TEST(Exr, EveryFloatSurvives) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const TempFolder folder;
  for (const int channels : {1, 3, 4}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {17, 33}, {40, 16}}) {
      Image image = picture(width, height, channels);
      std::size_t i = 0;
      for (const float special :
           {-1.5f, 1e30f, 1e-42f, kInf, -kInf, std::numeric_limits<float>::quiet_NaN(), 65537.0f})
        image.data[i++ % image.data.size()] = special;
      writeExr(folder / "x.exr", image);
      expectSameBits(readImage(folder / "x.exr"), image);
    }
  }
}

TEST(Exr, IsOnePartOfFloatScanLinesWithZip) {
  const TempFolder folder;
  const std::array<std::vector<std::string>, 5> names = {
      {{}, {"Y"}, {}, {"B", "G", "R"}, {"A", "B", "G", "R"}}};
  for (const int channels : {1, 3, 4}) {
    writeExr(folder / "x.exr", picture(20, 10, channels));
    const Imf::InputFile file((folder / "x.exr").c_str());
    const Imf::Header& header = file.header();
    EXPECT_EQ(file.version() & ~0xff, 0) << "no flags: one part, scan lines, short names";
    EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(header.lineOrder(), Imf::INCREASING_Y);
    EXPECT_EQ(header.dataWindow(), Imath::Box2i({0, 0}, {19, 9}));
    std::vector<std::string> found;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      found.push_back(c.name());
      EXPECT_EQ(c.channel().type, Imf::FLOAT);
    }
    EXPECT_EQ(found, names[static_cast<std::size_t>(channels)]);
  }
}

TEST(Exr, SameImageSameBytes) {
  const TempFolder folder;
  writeExr(folder / "a.exr", picture(70, 50, 3));
  writeExr(folder / "b.exr", picture(70, 50, 3));
  EXPECT_EQ(readFile(folder / "a.exr"), readFile(folder / "b.exr"));
}

// Every compression that OpenEXR can write, scan lines and tiles, each channel type. Halves are exact in the
// test's values.
TEST(Exr, ReadsEveryKind) {
  Image image(21, 13, 3);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i % 64);
  for (const auto layout : {ExrLayout::kScanLines, ExrLayout::kTiles}) {
    for (int compression = 0; compression <= 5; ++compression) {
      for (const char type : {'f', 'h', 'u'}) {
        SCOPED_TRACE(testing::Message() << "compression " << compression << ", type " << type);
        const bool lossy = compression == 5 && type == 'f';  // PXR24 keeps 24 bits, enough for these numbers
        const Bytes file = encodeExr(image, {{"R", type}, {"G", type}, {"B", type}}, layout, compression);
        const Image read = readBytes(file);
        ASSERT_EQ(read.channels, 3);
        for (std::size_t i = 0; i < image.data.size(); ++i)
          ASSERT_NEAR(read.data[i], image.data[i], lossy ? 1e-3 : 0.0);
      }
    }
  }
}

TEST(Exr, FindsTheChannels) {
  const Image rgba = picture(9, 5, 4), grey = picture(9, 5, 1);
  expectSameBits(readBytes(encodeExr(rgba, {{"R", 'f'}, {"G", 'f'}, {"B", 'f'}, {"A", 'f'}})), rgba);
  expectSameBits(readBytes(encodeExr(rgba, {{"View.Combined.R", 'f'},
                                            {"View.Combined.G", 'f'},
                                            {"View.Combined.B", 'f'},
                                            {"View.Combined.A", 'f'}})),
                 rgba);
  expectSameBits(readBytes(encodeExr(grey, {{"Y", 'f'}})), grey);
  expectSameBits(readBytes(encodeExr(grey, {{"depth", 'f'}})), grey);
  Image two(9, 5, 2), first(9, 5, 1), all(9, 5, 4);
  for (std::size_t p = 0; p < two.pixels(); ++p) {
    first.data[p] = two.data[2 * p] = rgba.data[p];
    two.data[2 * p + 1] = 0.25f;
    for (std::size_t c = 0; c < 4; ++c) all.data[4 * p + c] = c < 3 ? rgba.data[p] : 0.25f;
  }
  expectSameBits(readBytes(encodeExr(two, {{"Y", 'f'}, {"Z", 'f'}})), first);
  expectSameBits(readBytes(encodeExr(two, {{"Y", 'f'}, {"A", 'f'}})), all);
  expectSameBits(readBytes(encodeExr(rgba, {{"R", 'f'}, {"G", 'f'}, {"B", 'f'}, {"A", 'f'}},
                                     ExrLayout::kTiles, 3, -7, 1000)),
                 rgba);
  EXPECT_EQ(codeOf([&] { readBytes(encodeExr(rgba, {{"u", 'f'}, {"v", 'f'}})); }), ErrorCode::kUnsupported);
  EXPECT_EQ(codeOf([&] {
              readBytes(encodeExr(grey, {{"Y", 'f'}}, ExrLayout::kDeep));
            }),
            ErrorCode::kUnsupported);
}

// ---- PNG

TEST(Png, EveryByteSurvivesLinearisation) {
  Image8 ramp{256, 1, 3, {}};
  for (int i = 0; i < 256; ++i)
    for (int c = 0; c < 3; ++c) ramp.data.push_back(static_cast<unsigned char>(i));
  const Image linear = readBytes(test::encodePng(ramp));
  for (int i = 0; i < 256; ++i) EXPECT_NEAR(linear.at(i, 0)[1], srgbToLinear64(i / 255.0), 1e-6);
  EXPECT_EQ(decodeTexture(encodePngSrgb(linear), "ramp").data, ramp.data);
}

TEST(Png, DataIsStoredAsItIs) {
  for (const int channels : {1, 2, 3, 4}) {
    const Image8 expected = toImage8(picture(31, 9, channels));
    Image values(31, 9, channels);
    for (std::size_t i = 0; i < values.data.size(); ++i)
      values.data[i] = static_cast<float>(expected.data[i]) / 255.0f;
    const Image8 read = decodeTexture(encodePngData(values), "data");
    EXPECT_EQ(read.channels, channels);
    EXPECT_EQ(read.data, expected.data);
  }
}

TEST(Png, ValuesOutsideAreClamped) {
  Image image(4, 1, 1);
  image.data = {-3.0f, 7.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()};
  EXPECT_EQ(decodeTexture(encodePngData(image), "x").data, (std::vector<unsigned char>{0, 255, 0, 255}));
  EXPECT_EQ(decodeTexture(encodePngSrgb(image), "x").data, (std::vector<unsigned char>{0, 255, 0, 255}));
}

TEST(Png, SixteenBitsKeepTheirPrecision) {
  Image8 pairs{300, 1, 1, {}};
  for (int i = 0; i < 300; ++i) {
    const int v = 219 * i;
    pairs.data.push_back(static_cast<unsigned char>(v >> 8));
    pairs.data.push_back(static_cast<unsigned char>(v & 255));
  }
  const Bytes file = test::encodePng(pairs, {.sixteen_bits = true});
  const Image read = readBytes(file);
  const Image8 texture = decodeTexture(file, "x");
  for (int i = 0; i < 300; ++i) {
    EXPECT_NEAR(read.at(i, 0)[0], srgbToLinear64(219 * i / 65535.0), 3e-7);
    EXPECT_EQ(texture.data[static_cast<std::size_t>(i)], std::lround(219 * i / 257.0));
  }
}

TEST(Png, AlphaStaysLinear) {
  Image8 grey_alpha{2, 1, 2, {188, 51, 255, 255}};
  const Image read = readBytes(test::encodePng(grey_alpha));
  ASSERT_EQ(read.channels, 4);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(read.at(0, 0)[c], srgbToLinear64(188 / 255.0), 1e-6);
  EXPECT_NEAR(read.at(0, 0)[3], 0.2f, 1e-6);
  const Image8 again = decodeTexture(encodePngSrgb(read), "x");
  EXPECT_EQ(again.data, (std::vector<unsigned char>{188, 188, 188, 51, 255, 255, 255, 255}));
}

TEST(Png, PaletteAndInterlacing) {
  const PngOptions options{.interlaced = true,
                           .sixteen_bits = false,
                           .palette = {{10, 20, 30}, {40, 50, 60}},
                           .palette_alpha = {7}};
  const Image8 read = decodeTexture(test::encodePng({3, 1, 1, {0, 1, 0}}, options), "x");
  EXPECT_EQ(read.channels, 4);
  EXPECT_EQ(read.data, (std::vector<unsigned char>{10, 20, 30, 7, 40, 50, 60, 255, 10, 20, 30, 7}));
  const Image8 image = toImage8(picture(37, 29, 3));
  EXPECT_EQ(decodeTexture(test::encodePng(image, {.interlaced = true}), "x").data, image.data);
}

TEST(Png, DamageIsNoticed) {
  Bytes file = test::encodePng(toImage8(picture(20, 20, 3)));
  file[file.size() / 2] ^= std::byte{1};
  EXPECT_EQ(codeOf([&] { decodeTexture(file, "x"); }), ErrorCode::kFileUnreadable);
}

// ---- JPEG, WebP

TEST(Jpeg, DecodesColourAndGrey) {
  for (const bool progressive : {false, true}) {
    for (const int channels : {1, 3}) {
      Image8 image{24, 17, channels, {}};
      const std::array<unsigned char, 3> colour = {200, 90, 40};
      for (int i = 0; i < 24 * 17; ++i)
        image.data.insert(image.data.end(), colour.begin(), colour.begin() + channels);
      const Image8 read = decodeTexture(encodeJpeg(image, progressive), "x");
      ASSERT_EQ(read.width, 24);
      ASSERT_EQ(read.height, 17);
      ASSERT_EQ(read.channels, channels);
      for (std::size_t i = 0; i < read.data.size(); ++i) ASSERT_NEAR(read.data[i], image.data[i], 2);
    }
  }
  const Image8 cmyk = toImage8(picture(8, 8, 4));
  EXPECT_EQ(codeOf([&] { decodeTexture(encodeJpeg(cmyk, false, true), "x"); }), ErrorCode::kUnsupported);
}

TEST(Webp, LosslessIsExact) {
  for (const int channels : {3, 4}) {
    Image8 image = toImage8(picture(33, 21, channels));
    // WebP may drop the colour of invisible pixels.
    for (std::size_t i = 3; channels == 4 && i < image.data.size(); i += 4) image.data[i] |= 1;
    const Image8 read = decodeTexture(encodeWebpLossless(image), "x");
    EXPECT_EQ(read.channels, channels);
    EXPECT_EQ(read.data, image.data);
  }
}

// ---- HDR

TEST(Hdr, RoundTripWithinTheMantissaAndWithoutBias) {
  const TempFolder folder;
  for (const int width : {1, 7, 8, 130, 1000}) {
    Image image = picture(width, 5, 3);
    for (std::size_t i = 0; i < image.data.size(); ++i)
      image.data[i] *= std::exp2(static_cast<float>(i % 40) - 20.0f);
    for (int x = 0; x < width; ++x) image.setRgb(x, 3, Vec3(2.0f));  // a row of runs
    writeImage(folder / "x.hdr", image);
    const Image read = readImage(folder / "x.hdr");
    ASSERT_EQ(read.pixels(), image.pixels());
    double sum = 0, count = 0;
    for (std::size_t p = 0; p < image.pixels(); ++p) {
      const float* in = &image.data[3 * p];
      const float* out = &read.data[3 * p];
      const float largest = std::max({in[0], in[1], in[2]});
      for (int c = 0; c < 3; ++c) ASSERT_LE(std::abs(out[c] - in[c]), largest * 0x1p-8f);
      for (int c = 0; c < 3; ++c) sum += (out[c] - in[c]) / largest, ++count;
    }
    // Each error is uniform within +-2^-9 to 2^-8 of the largest channel, deviation below 2^-8 / sqrt 3; six
    // deviations of the mean: false alarm rate 2e-9. Truncation would give -2^-9.5 or so.
    if (width == 1000) {
      EXPECT_LT(std::abs(sum / count), 6 * 0x1p-8 / std::sqrt(3 * count));
    }
  }
}

TEST(Hdr, GreyAndUnfitValues) {
  const TempFolder folder;
  Image image(3, 1, 1);
  image.data = {0.25f, -1.0f, std::numeric_limits<float>::infinity()};
  writeImage(folder / "x.HDR", image);
  const Image read = readImage(folder / "x.HDR");
  EXPECT_EQ(read.rgb(0, 0), Vec3(0.25f));
  EXPECT_EQ(read.rgb(1, 0), Vec3(0.0f));
  EXPECT_GT(read.rgb(2, 0).x, 1e38f);
  EXPECT_TRUE(isFinite(read.rgb(2, 0)));
}

Bytes hdrFile(const std::string& size_line, std::initializer_list<int> pixels) {
  const std::string head =
      "#?RADIANCE\n# made by hand\nEXPOSURE=1\nFORMAT=32-bit_rle_rgbe\n\n" + size_line + "\n";
  Bytes out;
  for (const char c : head) out.push_back(static_cast<std::byte>(c));
  for (const int p : pixels) out.push_back(static_cast<std::byte>(p));
  return out;
}

TEST(Hdr, ReadsPlainPixelsAndOldRuns) {
  // 128 * 2^(129 - 136) = 1; then "the one before, three times".
  const Image read = readBytes(hdrFile("-Y 1 +X 5", {128, 64, 0, 129, 1, 1, 1, 3, 128, 128, 128, 128}));
  for (int x = 0; x < 4; ++x) EXPECT_EQ(read.rgb(x, 0), Vec3(1.0f, 0.5f, 0.0f));
  EXPECT_EQ(read.rgb(4, 0), Vec3(0.5f));
}

TEST(Hdr, OldRunsInARowCountInBytes) {
  const Image read = readBytes(hdrFile("-Y 1 +X 259", {128, 64, 0, 129, 1, 1, 1, 2, 1, 1, 1, 1}));
  EXPECT_EQ(read.rgb(258, 0), Vec3(1.0f, 0.5f, 0.0f));
}

TEST(Hdr, RunsThatLeaveTheirRowAreRefused) {
  EXPECT_EQ(codeOf([] {
              readBytes(hdrFile("-Y 1 +X 2", {1, 1, 1, 3, 0, 0, 0, 0}));
            }),
            ErrorCode::kFileUnreadable);
  EXPECT_EQ(codeOf([] {
              readBytes(hdrFile("-Y 1 +X 2", {9, 9, 9, 9, 1, 1, 1, 2}));
            }),
            ErrorCode::kFileUnreadable);
  EXPECT_EQ(codeOf([] {
              readBytes(hdrFile("-Y 1 +X 8", {2, 2, 0, 8, 128 + 9, 5}));
            }),
            ErrorCode::kFileUnreadable);
  EXPECT_EQ(codeOf([] {
              readBytes(hdrFile("-Y 1 +X 8", {2, 2, 0, 8, 0, 0, 0, 0, 0, 0}));
            }),
            ErrorCode::kFileUnreadable);
  EXPECT_EQ(codeOf([] { readBytes(hdrFile("+Y 1 +X 8", {})); }), ErrorCode::kUnsupported);
}

// ---- Hostile files

struct Kind {
  const char* name;
  Bytes file;
};

std::vector<Kind> everyKind() {
  const TempFolder folder;
  const Image colour = picture(19, 11, 3);
  writeImage(folder / "x.hdr", colour);
  writeImage(folder / "x.exr", colour);
  return {{"png", test::encodePng(toImage8(colour))},
          {"interlaced png", test::encodePng(toImage8(picture(19, 11, 4)), {.interlaced = true})},
          {"jpeg", encodeJpeg(toImage8(colour))},
          {"progressive jpeg", encodeJpeg(toImage8(colour), true)},
          {"webp", encodeWebpLossless(toImage8(picture(19, 11, 4)))},
          {"hdr", readFile(folder / "x.hdr")},
          {"exr", readFile(folder / "x.exr")},
          {"piz exr", encodeExr(colour, {{"R", 'h'}, {"G", 'h'}, {"B", 'h'}}, ExrLayout::kTiles, 4)}};
}

TEST(HostileFiles, EveryTruncationIsAnError) {
  for (const Kind& kind : everyKind()) {
    SCOPED_TRACE(kind.name);
    std::size_t truncated = 0;
    for (std::size_t n = 0; n < kind.file.size(); ++n) {
      // A copy of its own, so that a sanitizer sees every byte read too far.
      const Bytes cut(kind.file.begin(), kind.file.begin() + static_cast<std::ptrdiff_t>(n));
      try {
        decodeImage(cut, "cut");
        ADD_FAILURE() << n << " of " << kind.file.size() << " bytes were enough";
      } catch (const Error& e) {
        truncated += e.code() == ErrorCode::kTruncated;
        EXPECT_EQ(e.subject(), "cut");
      }
      textureSize(cut);
    }
    EXPECT_GT(truncated, kind.file.size() / 2) << "most cuts should be called what they are";
  }
}

// Damaged bytes may still make an image; they must not crash, hang or ask for much memory.
TEST(HostileFiles, DamageNeverCrashes) {
  std::uint32_t state = 7;
  const auto random = [&state](std::size_t below) {
    state = state * 1664525u + 1013904223u;
    return static_cast<std::size_t>((std::uint64_t{state} * below) >> 32);
  };
  for (const Kind& kind : everyKind()) {
    for (int trial = 0; trial < 1000; ++trial) {
      Bytes file = kind.file;
      const std::size_t changes = 1 + random(4);
      for (std::size_t i = 0; i < changes; ++i)
        file[random(trial % 2 ? file.size() : std::min<std::size_t>(file.size(), 400))] =
            static_cast<std::byte>(random(256));
      try {
        const Image image = decodeImage(file, "x");
        EXPECT_LE(image.pixels(), std::size_t{1} << 25);
      } catch (const Error&) {
      }
      try {
        decodeTexture(file, "x");
      } catch (const Error&) {
      }
      textureSize(file);
    }
  }
}

void putBigEndian(Bytes& file, std::size_t at, std::uint32_t v) {
  for (std::size_t i = 0; i < 4; ++i) file[at + i] = static_cast<std::byte>(v >> (24 - 8 * i));
}

std::uint32_t pngCrc(std::span<const std::byte> data) {
  std::uint32_t crc = ~0u;
  for (const std::byte b : data) {
    crc ^= std::to_integer<std::uint32_t>(b);
    for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
  }
  return ~crc;
}

TEST(HostileFiles, SmallFilesCannotClaimLargeImages) {
  Bytes png = test::encodePng(toImage8(picture(4, 4, 3)));
  for (const std::uint32_t side : {30000u, 65535u, 65537u, 0x7fffffffu}) {
    putBigEndian(png, 16, side);
    putBigEndian(png, 20, side);
    putBigEndian(png, 29, pngCrc(std::span(png).subspan(12, 17)));
    EXPECT_THROW(decodeTexture(png, "x"), Error) << side;
  }
  Bytes jpeg = encodeJpeg(toImage8(picture(8, 8, 3)));
  for (std::size_t i = 0; i + 9 < jpeg.size(); ++i) {
    if (jpeg[i] != std::byte{0xff} || jpeg[i + 1] != std::byte{0xc0}) continue;
    for (std::size_t k = 5; k < 9; ++k) jpeg[i + k] = std::byte{0xfe};
    break;
  }
  EXPECT_EQ(textureSize(jpeg), IVec2(0xfefe));
  EXPECT_THROW(decodeTexture(jpeg, "x"), Error);
  EXPECT_EQ(codeOf([] { readBytes(hdrFile("-Y 60000 +X 16000", {})); }), ErrorCode::kFileUnreadable);
  EXPECT_EQ(codeOf([] { readBytes(hdrFile("-Y 2 +X 70000", {})); }), ErrorCode::kUnsupported);
  EXPECT_EQ(codeOf([] { readBytes(hdrFile("-Y 0 +X 7", {})); }), ErrorCode::kInvalidValue);
  EXPECT_EQ(codeOf([] { readBytes(hdrFile("-Y 99999999999 +X 7", {})); }), ErrorCode::kUnsupported);

  Bytes exr = encodeExr(picture(4, 4, 3), {{"R", 'f'}, {"G", 'f'}, {"B", 'f'}});
  const std::string needle = "dataWindow";
  const auto* text = reinterpret_cast<const char*>(exr.data());
  const std::size_t at = std::string(text, exr.size()).find(needle) + needle.size() + 1 + 6 + 4;
  for (const std::int32_t far : {40000, 200000, 0x7ffffff0}) {
    std::memcpy(exr.data() + at + 8, &far, 4);
    std::memcpy(exr.data() + at + 12, &far, 4);
    EXPECT_THROW(readBytes(exr), Error) << far;
  }
}

// OpenEXR would reserve almost 2 GB for this string.
TEST(HostileFiles, ExrAttributesLieWithinTheFile) {
  Bytes exr = encodeExr(picture(4, 4, 1), {{"Y", 'f'}});
  const std::string type = "lineOrder";  // stands twice: name and type
  const auto* text = reinterpret_cast<const char*>(exr.data());
  const std::size_t at = std::string(text, exr.size()).find(type) + 2 * (type.size() + 1);
  const std::int32_t huge = 0x70000000;
  std::memcpy(exr.data() + at, &huge, 4);
  EXPECT_EQ(codeOf([&] { readBytes(exr); }), ErrorCode::kTruncated);
}

// ---- Names and errors

TEST(ImageFiles, SizeWithoutDecoding) {
  const Image8 image = toImage8(picture(53, 27, 3));
  for (const Bytes& file :
       {test::encodePng(image), encodeJpeg(image), encodeJpeg(image, true), encodeWebpLossless(image)})
    EXPECT_EQ(textureSize(file), IVec2(53, 27));
  EXPECT_EQ(textureSize({}), std::nullopt);
  EXPECT_EQ(textureSize(hdrFile("-Y 1 +X 1", {})), std::nullopt);
}

TEST(ImageFiles, MistakesHaveTheirCodes) {
  const TempFolder folder;
  const Image image = picture(4, 4, 3);
  EXPECT_EQ(codeOf([&] { readImage(folder / "none.png"); }), ErrorCode::kFileNotFound);
  EXPECT_EQ(codeOf([&] { readImage(folder.path()); }), ErrorCode::kFileUnreadable);
  writeFileAtomically(folder / "text", std::string_view("this is no image at all"));
  EXPECT_EQ(codeOf([&] { readImage(folder / "text"); }), ErrorCode::kUnsupported);
  EXPECT_EQ(codeOf([&] { writeImage(folder / "x.jpg", image); }), ErrorCode::kUsage);
  for (const char* name : {"none/x.png", "none/x.exr", "none/x.hdr"})
    EXPECT_EQ(codeOf([&] { writeImage(folder / name, image); }), ErrorCode::kCannotWrite);
}

TEST(ImageFiles, ContentDecidesNotTheName) {
  const TempFolder folder;
  writeImage(folder / "a.png", picture(4, 4, 3));
  std::filesystem::rename(folder / "a.png", folder / "a.exr");
  EXPECT_EQ(readImage(folder / "a.exr").width, 4);
}

}  // namespace
}  // namespace relume::image
