// SPDX-License-Identifier: MIT
// PNG by libpng. Its errors come by longjmp: the functions that call setjmp own nothing, so nothing is
// skipped.
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>

#include "codecs.h"
#include "relume/core/check.h"
#include "relume/core/error.h"

namespace relume::image::detail {
namespace {

struct Reader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  Bytes file;
  std::size_t at = 0;
  bool truncated = false;
  char message[160] = "";

  Reader() = default;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::vector<std::byte> file;
  bool out_of_memory = false;

  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

[[noreturn]] void onReadError(png_structp png, png_const_charp message) {
  auto& reader = *static_cast<Reader*>(png_get_error_ptr(png));
  std::strncpy(reader.message, message, sizeof reader.message - 1);
  png_longjmp(png, 1);
}

[[noreturn]] void onWriteError(png_structp png, png_const_charp) { png_longjmp(png, 1); }

void onWarning(png_structp, png_const_charp) {}

void readBytes(png_structp png, png_bytep to, std::size_t count) {
  auto& reader = *static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader.file.size() - reader.at) {
    reader.truncated = true;
    png_error(png, "ends early");
  }
  std::memcpy(to, reader.file.data() + reader.at, count);
  reader.at += count;
}

void appendBytes(png_structp png, png_bytep from, std::size_t count) {
  auto& writer = *static_cast<Writer*>(png_get_io_ptr(png));
  try {
    const auto* bytes = reinterpret_cast<const std::byte*>(from);
    writer.file.insert(writer.file.end(), bytes, bytes + count);
  } catch (const std::bad_alloc&) {
    writer.out_of_memory = true;
  }
  if (writer.out_of_memory) png_error(png, "out of memory");
}

bool readHeader(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_read_fn(reader.png, &reader, readBytes);
  png_set_user_limits(reader.png, kMaxSide, kMaxSide);
  png_set_chunk_malloc_max(reader.png, 8 << 20);
  png_read_info(reader.png, reader.info);
  return true;
}

bool setUpRows(Reader& reader, bool keep_16_bits) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_expand(reader.png);
  if (!keep_16_bits) png_set_scale_16(reader.png);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(reader.png);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool readRows(Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

bool writeAll(Writer& writer, const Texels& texels, png_bytepp rows) {
  static constexpr int kColourTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                         PNG_COLOR_TYPE_RGB_ALPHA};
  if (setjmp(png_jmpbuf(writer.png))) return false;
  png_set_write_fn(writer.png, &writer, appendBytes, nullptr);
  png_set_user_limits(writer.png, kMaxSide, kMaxSide);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(texels.width),
               static_cast<png_uint_32>(texels.height), 8, kColourTypes[texels.channels - 1],
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, nullptr);
  return true;
}

[[noreturn]] void fail(const Reader& reader, const std::string& subject) {
  if (reader.truncated) throwTruncated(subject);
  throwUnreadable(subject, "PNG", reader.message);
}

std::vector<png_bytep> rowsOf(unsigned char* data, std::size_t height, std::size_t row_bytes) {
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = data + y * row_bytes;
  return rows;
}

}  // namespace

Texels decodePng(Bytes file, const std::string& subject, bool keep_16_bits) {
  Reader reader;
  reader.file = file;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, onReadError, onWarning);
  if (reader.png) reader.info = png_create_info_struct(reader.png);
  if (!reader.info) throw std::bad_alloc();
  if (!readHeader(reader)) fail(reader, subject);
  requirePlausibleSize(png_get_image_width(reader.png, reader.info),
                       png_get_image_height(reader.png, reader.info), file.size(), subject);
  if (!setUpRows(reader, keep_16_bits)) fail(reader, subject);

  Texels out;
  out.width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  out.height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  out.channels = png_get_channels(reader.png, reader.info);
  out.bytes_per_value = png_get_bit_depth(reader.png, reader.info) == 16 ? 2 : 1;
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  RELUME_CHECK_EQ(row_bytes, static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.channels) *
                                 static_cast<std::size_t>(out.bytes_per_value));
  out.data.resize(row_bytes * static_cast<std::size_t>(out.height));
  auto rows = rowsOf(out.data.data(), static_cast<std::size_t>(out.height), row_bytes);
  if (!readRows(reader, rows.data())) fail(reader, subject);
  return out;
}

std::vector<std::byte> encodePng(const Texels& texels) {
  RELUME_CHECK(texels.channels >= 1 && texels.channels <= 4 && texels.bytes_per_value == 1);
  if (texels.width < 1 || texels.height < 1 || texels.width > kMaxSide || texels.height > kMaxSide)
    throw Error(ErrorCode::kUnsupported, "PNG image",
                "has " + std::to_string(texels.width) + " x " + std::to_string(texels.height) + " pixels",
                "1 to " + std::to_string(kMaxSide) + " per side can be written");
  Writer writer;
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, onWriteError, onWarning);
  if (writer.png) writer.info = png_create_info_struct(writer.png);
  if (!writer.info) throw std::bad_alloc();
  const std::size_t row_bytes =
      static_cast<std::size_t>(texels.width) * static_cast<std::size_t>(texels.channels);
  // libpng takes rows to write as non-const and does not change them without a write transform.
  auto rows = rowsOf(const_cast<unsigned char*>(texels.data.data()), static_cast<std::size_t>(texels.height),
                     row_bytes);
  if (!writeAll(writer, texels, rows.data())) throw std::bad_alloc();
  return std::move(writer.file);
}

}  // namespace relume::image::detail
