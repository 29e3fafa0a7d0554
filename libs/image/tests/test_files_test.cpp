// SPDX-License-Identifier: MIT
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>
#include <png.h>
#include <unistd.h>
#include <webp/encode.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

// jpeglib.h needs stdio.
#include <jpeglib.h>

#include "relume/core/file.h"
#include "test_files.h"

namespace relume::image::test {
namespace {

std::size_t size(int n) { return static_cast<std::size_t>(n); }

void append(png_structp png, png_bytep from, std::size_t count) {
  auto& out = *static_cast<Bytes*>(png_get_io_ptr(png));
  const auto* bytes = reinterpret_cast<const std::byte*>(from);
  out.insert(out.end(), bytes, bytes + count);
}

}  // namespace

TempFolder::TempFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "relume-image-XXXXXX").string();
  if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TempFolder::~TempFolder() {
  std::error_code ec;
  std::filesystem::remove_all(path_, ec);
}

Image picture(int width, int height, int channels, std::uint32_t seed) {
  Image out(width, height, channels);
  std::uint32_t state = seed * 2654435761u + 1u;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) {
        state = state * 1664525u + 1013904223u;
        const float noise = static_cast<float>(state >> 8) * 0x1p-24f;
        const float wave =
            0.5f + 0.5f * std::sin(0.21f * static_cast<float>(x * (c + 1)) + 0.13f * static_cast<float>(y));
        out.at(x, y)[c] = 0.85f * wave * wave + 0.15f * noise;
      }
  return out;
}

Image8 toImage8(const Image& image) {
  Image8 out{image.width, image.height, image.channels, {}};
  for (const float v : image.data) out.data.push_back(static_cast<unsigned char>(std::lround(255.0f * v)));
  return out;
}

Bytes encodePng(const Image8& image, const PngOptions& options) {
  static constexpr int kTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                   PNG_COLOR_TYPE_RGB_ALPHA};
  Bytes out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &out, append, nullptr);
  const int type = options.palette.empty() ? kTypes[image.channels - 1] : PNG_COLOR_TYPE_PALETTE;
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height),
               options.sixteen_bits ? 16 : 8, type,
               options.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_color> palette;
  for (const auto& c : options.palette) palette.push_back({c[0], c[1], c[2]});
  if (!palette.empty()) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  if (!options.palette_alpha.empty())
    png_set_tRNS(png, info, options.palette_alpha.data(), static_cast<int>(options.palette_alpha.size()),
                 nullptr);
  png_write_info(png, info);
  const std::size_t stride = size(image.width) * size(image.channels) * (options.sixteen_bits ? 2 : 1);
  std::vector<png_bytep> rows;
  for (int y = 0; y < image.height; ++y)
    rows.push_back(const_cast<png_bytep>(image.data.data()) + size(y) * stride);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

Bytes encodeJpeg(const Image8& image, bool progressive, bool cmyk) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* data = nullptr;
  unsigned long count = 0;
  jpeg_mem_dest(&info, &data, &count);
  info.image_width = static_cast<JDIMENSION>(image.width);
  info.image_height = static_cast<JDIMENSION>(image.height);
  info.input_components = image.channels;
  info.in_color_space = cmyk ? JCS_CMYK : image.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 95, TRUE);
  if (progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(image.data.data()) +
                   info.next_scanline * size(image.width) * size(image.channels);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  Bytes out(bytes, bytes + count);
  jpeg_destroy_compress(&info);
  std::free(data);
  return out;
}

Bytes encodeWebpLossless(const Image8& image) {
  std::uint8_t* data = nullptr;
  const int stride = image.width * image.channels;
  const std::size_t count =
      image.channels == 4
          ? WebPEncodeLosslessRGBA(image.data.data(), image.width, image.height, stride, &data)
          : WebPEncodeLosslessRGB(image.data.data(), image.width, image.height, stride, &data);
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  Bytes out(bytes, bytes + count);
  WebPFree(data);
  return out;
}

Bytes encodeExr(const Image& image, const std::vector<ExrChannel>& channels, ExrLayout layout,
                int compression, int first_x, int first_y) {
  const TempFolder folder;
  const std::string path = (folder / "x.exr").string();
  const Imath::Box2i window({first_x, first_y}, {first_x + image.width - 1, first_y + image.height - 1});
  Imf::Header header(window, window);
  header.compression() = static_cast<Imf::Compression>(compression);
  const auto typeOf = [](char t) { return t == 'f' ? Imf::FLOAT : t == 'h' ? Imf::HALF : Imf::UINT; };
  for (const ExrChannel& c : channels) header.channels().insert(c.name, Imf::Channel(typeOf(c.type)));

  if (layout == ExrLayout::kDeep) {
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    Imf::DeepScanLineOutputFile file(path.c_str(), header);
    std::vector<unsigned> counts(image.pixels(), 1);
    std::vector<float> values(image.data);
    std::vector<const float*> pointers;
    for (const float& v : values) pointers.push_back(&v);
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()),
                                            sizeof(unsigned), sizeof(unsigned) * size(image.width)));
    for (const ExrChannel& c : channels)
      frame.insert(c.name, Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()),
                                          sizeof(float*), sizeof(float*) * size(image.width), sizeof(float)));
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  } else {
    // One plane of the file's own type for each channel.
    std::vector<std::vector<unsigned>> whole(channels.size());
    std::vector<std::vector<half>> halves(channels.size());
    std::vector<std::vector<float>> floats(channels.size());
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      for (std::size_t p = 0; p < image.pixels(); ++p) {
        const float v = image.data[p * size(image.channels) + c];
        floats[c].push_back(v), halves[c].push_back(half(v)), whole[c].push_back(static_cast<unsigned>(v));
      }
      const char t = channels[c].type;
      void* base = t == 'f'   ? static_cast<void*>(floats[c].data())
                   : t == 'h' ? static_cast<void*>(halves[c].data())
                              : whole[c].data();
      const std::size_t step = t == 'h' ? 2 : 4;
      frame.insert(channels[c].name,
                   Imf::Slice::Make(typeOf(t), base, window, step, step * size(image.width)));
    }
    if (layout == ExrLayout::kTiles) {
      header.setTileDescription(Imf::TileDescription(8, 8, Imf::ONE_LEVEL));
      Imf::TiledOutputFile file(path.c_str(), header);
      file.setFrameBuffer(frame);
      file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
      Imf::OutputFile file(path.c_str(), header);
      file.setFrameBuffer(frame);
      file.writePixels(image.height);
    }
  }
  return readFile(path);
}

}  // namespace relume::image::test
