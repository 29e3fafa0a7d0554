// SPDX-License-Identifier: MIT
// Still WebP pictures by libwebp, lossy or lossless.
#include <webp/decode.h>

#include "codecs.h"
#include "relume/core/error.h"

namespace relume::image::detail {

Texels decodeWebp(Bytes file, const std::string& subject) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(file.data());
  WebPBitstreamFeatures features;
  const VP8StatusCode status = WebPGetFeatures(data, file.size(), &features);
  if (status == VP8_STATUS_NOT_ENOUGH_DATA) throwTruncated(subject);
  if (status != VP8_STATUS_OK) throwUnreadable(subject, "WebP", "its header is damaged");
  if (features.has_animation)
    throw Error(ErrorCode::kUnsupported, subject, "is an animated WebP", "save one frame of it");
  requirePlausibleSize(features.width, features.height, file.size(), subject);

  Texels out;
  out.width = features.width;
  out.height = features.height;
  out.channels = features.has_alpha ? 4 : 3;
  const int stride = out.width * out.channels;
  out.data.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(out.height));
  WebPDecoderConfig config;
  if (!WebPInitDecoderConfig(&config))
    throwUnreadable(subject, "WebP", "libwebp has another version than its header");
  config.output.colorspace = features.has_alpha ? MODE_RGBA : MODE_RGB;
  config.output.is_external_memory = 1;
  config.output.u.RGBA.rgba = out.data.data();
  config.output.u.RGBA.stride = stride;
  config.output.u.RGBA.size = out.data.size();
  const VP8StatusCode decoded = WebPDecode(data, file.size(), &config);
  WebPFreeDecBuffer(&config.output);
  if (decoded == VP8_STATUS_NOT_ENOUGH_DATA || decoded == VP8_STATUS_SUSPENDED) throwTruncated(subject);
  if (decoded == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
  if (decoded != VP8_STATUS_OK) throwUnreadable(subject, "WebP", "its pixels are damaged");
  return out;
}

}  // namespace relume::image::detail
