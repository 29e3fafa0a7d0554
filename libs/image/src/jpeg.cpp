// SPDX-License-Identifier: MIT
// JPEG by libjpeg(-turbo). Its errors come by longjmp: the functions that call setjmp own nothing, so nothing
// is skipped.
#include <csetjmp>
#include <cstddef>
#include <cstdio>

// jpeglib.h needs the ones above.
#include <jerror.h>
#include <jpeglib.h>

#include "codecs.h"
#include "relume/core/error.h"

namespace relume::image::detail {
namespace {

// A progressive file may repeat scans over a large image for ever; real ones have about ten.
constexpr int kMaxScans = 500;

struct Reader {
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf on_error;
  bool truncated = false;
  char message[JMSG_LENGTH_MAX] = "";

  Reader() = default;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { jpeg_destroy_decompress(&info); }
};

Reader& readerOf(j_common_ptr info) { return *static_cast<Reader*>(info->client_data); }

[[noreturn]] void onError(j_common_ptr info) {
  Reader& reader = readerOf(info);
  info->err->format_message(info, reader.message);
  std::longjmp(reader.on_error, 1);
}

void onMessage(j_common_ptr info, int level) {
  if (level < 0 && info->err->msg_code == JWRN_JPEG_EOF) readerOf(info).truncated = true;
}

void onProgress(j_common_ptr info) {
  if (info->is_decompressor && reinterpret_cast<j_decompress_ptr>(info)->input_scan_number > kMaxScans)
    ERREXIT(info, JERR_BAD_PROGRESSION);
}

bool readHeader(Reader& reader, Bytes file) {
  reader.info.err = jpeg_std_error(&reader.errors);
  reader.info.client_data = &reader;
  reader.errors.error_exit = onError;
  reader.errors.emit_message = onMessage;
  reader.progress.progress_monitor = onProgress;
  if (setjmp(reader.on_error)) return false;
  jpeg_create_decompress(&reader.info);
  reader.info.client_data = &reader;
  reader.info.progress = &reader.progress;
  jpeg_mem_src(&reader.info, reinterpret_cast<const unsigned char*>(file.data()), file.size());
  return jpeg_read_header(&reader.info, TRUE) == JPEG_HEADER_OK;
}

bool readRows(Reader& reader, unsigned char* to, std::size_t row_bytes) {
  if (setjmp(reader.on_error)) return false;
  jpeg_start_decompress(&reader.info);
  while (reader.info.output_scanline < reader.info.output_height) {
    JSAMPROW row = to + reader.info.output_scanline * row_bytes;
    jpeg_read_scanlines(&reader.info, &row, 1);
  }
  jpeg_finish_decompress(&reader.info);
  return true;
}

[[noreturn]] void fail(const Reader& reader, const std::string& subject) {
  if (reader.truncated) throwTruncated(subject);
  const int code = reader.errors.msg_code;
  if (code == JERR_SOF_UNSUPPORTED || code == JERR_BAD_PRECISION || code == JERR_ARITH_NOTIMPL)
    throw Error(ErrorCode::kUnsupported, subject, std::string("is a JPEG of a rare kind: ") + reader.message,
                "save it as a baseline or progressive JPEG of 8 bits");
  throwUnreadable(subject, "JPEG", reader.message);
}

}  // namespace

Texels decodeJpeg(Bytes file, const std::string& subject) {
  Reader reader;
  if (!readHeader(reader, file)) fail(reader, subject);
  requirePlausibleSize(reader.info.image_width, reader.info.image_height, file.size(), subject);
  if (reader.info.jpeg_color_space == JCS_CMYK || reader.info.jpeg_color_space == JCS_YCCK)
    throw Error(ErrorCode::kUnsupported, subject, "is a CMYK JPEG", "save it as RGB");
  reader.info.out_color_space = reader.info.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;

  Texels out;
  out.width = static_cast<int>(reader.info.image_width);
  out.height = static_cast<int>(reader.info.image_height);
  out.channels = reader.info.num_components == 1 ? 1 : 3;
  const std::size_t row_bytes = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.channels);
  out.data.resize(row_bytes * static_cast<std::size_t>(out.height));
  if (!readRows(reader, out.data.data(), row_bytes)) fail(reader, subject);
  if (reader.truncated) throwTruncated(subject);
  return out;
}

}  // namespace relume::image::detail
