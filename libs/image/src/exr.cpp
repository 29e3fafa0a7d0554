// SPDX-License-Identifier: MIT
// OpenEXR files. Written: one part, scan lines, 32-bit float, ZIP, nothing that changes from run to run.
// Read: scan lines or tiles of any compression and channel type; of several parts the first.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>

#include "codecs.h"
#include "relume/core/check.h"
#include "relume/core/error.h"

namespace relume::image::detail {
namespace {

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(Bytes file, const std::string& name) : IStream(name.c_str()), file_(file) {}

  bool read(char c[], int n) override {
    if (n < 0 || at_ > file_.size() || static_cast<std::size_t>(n) > file_.size() - at_) {
      hit_end_ = true;
      throw std::runtime_error("ends early");
    }
    std::memcpy(c, file_.data() + at_, static_cast<std::size_t>(n));
    at_ += static_cast<std::size_t>(n);
    return at_ < file_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t pos) override { at_ = pos; }
  void clear() override {}
  bool hitEnd() const { return hit_end_; }

 private:
  Bytes file_;
  std::uint64_t at_ = 0;
  bool hit_end_ = false;
};

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : OStream("memory") {}
  void write(const char c[], int n) override {
    const std::size_t end = at_ + static_cast<std::size_t>(n);
    if (end > file_.size()) file_.resize(end);
    std::memcpy(file_.data() + at_, c, static_cast<std::size_t>(n));
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t pos) override { at_ = pos; }
  std::vector<std::byte> take() { return std::move(file_); }

 private:
  std::vector<std::byte> file_;
  std::size_t at_ = 0;
};

// OpenEXR reserves what an attribute claims to hold before it reads it. Walks the headers (of all parts) and
// throws unless every attribute lies within the file and every data window and tile has a plausible size.
class HeaderCheck {
 public:
  HeaderCheck(Bytes file, const std::string& subject) : file_(file), subject_(subject) {
    constexpr std::uint32_t kMultiPart = 0x1000;
    at_ = 4;
    const bool many = (number() & kMultiPart) != 0;
    do {
      while (attribute()) continue;
    } while (many && !endOfHeaders());
  }

 private:
  std::uint32_t number() {
    need(4);
    std::uint32_t v = 0;
    for (std::size_t i = 0; i < 4; ++i) v |= std::uint32_t{byteAt(file_, at_ + i)} << (8 * i);
    at_ += 4;
    return v;
  }
  std::int64_t signedNumber() { return std::bit_cast<std::int32_t>(number()); }
  std::string text() {
    std::string out;
    for (need(1); file_[at_] != std::byte{0}; need(1)) out.push_back(static_cast<char>(file_[at_++]));
    ++at_;
    return out;
  }
  void need(std::size_t count) const {
    if (count > file_.size() - at_) throwTruncated(subject_);
  }
  // A header ends with an empty name, and the headers with an empty header.
  bool attribute() {
    const std::string name = text();
    if (name.empty()) return false;
    const std::string type = text();
    const std::uint32_t size = number();
    need(size);
    const std::size_t end = at_ + size;
    if (type == "box2i" && name == "dataWindow" && size == 16) {
      const std::int64_t x0 = signedNumber(), y0 = signedNumber(), x1 = signedNumber(), y1 = signedNumber();
      requirePlausibleSize(x1 - x0 + 1, y1 - y0 + 1, file_.size(), subject_);
    } else if (type == "tiledesc" && size >= 8) {
      const std::int64_t width = number(), height = number();
      requirePlausibleSize(width, height, file_.size(), subject_ + ": tile");
    }
    at_ = end;
    return true;
  }
  bool endOfHeaders() const {
    need(1);
    return file_[at_] == std::byte{0};
  }

  Bytes file_;
  const std::string& subject_;
  std::size_t at_ = 0;
};

// R, G, B[, A], else Y[, A], else the first layer that has R, G and B, else the only channel.
std::vector<std::string> chooseChannels(const Imf::ChannelList& list, const std::string& subject) {
  const auto has = [&](const std::string& name) { return list.findChannel(name) != nullptr; };
  const auto layer = [&](const std::string& prefix) {
    std::vector<std::string> names = {prefix + "R", prefix + "G", prefix + "B"};
    if (has(prefix + "A")) names.push_back(prefix + "A");
    return names;
  };
  const auto complete = [&](const std::string& prefix) {
    return has(prefix + "R") && has(prefix + "G") && has(prefix + "B");
  };
  if (complete("")) return layer("");
  if (has("Y") && !has("RY") && !has("BY")) {
    if (has("A")) return {"Y", "A"};
    return {"Y"};
  }
  std::size_t count = 0;
  std::string only;
  for (auto c = list.begin(); c != list.end(); ++c, ++count) {
    only = c.name();
    const std::size_t dot = only.rfind('.');
    if (dot != std::string::npos && complete(only.substr(0, dot + 1))) return layer(only.substr(0, dot + 1));
  }
  if (count == 1) return {only};
  throw Error(ErrorCode::kUnsupported, subject, "has no channels R, G, B or Y", "save it as RGB");
}

// Grey and alpha become red, green, blue and alpha.
Image widened(const Image& grey_alpha) {
  Image out(grey_alpha.width, grey_alpha.height, 4);
  for (std::size_t p = 0; p < out.pixels(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) out.data[4 * p + c] = grey_alpha.data[2 * p];
    out.data[4 * p + 3] = grey_alpha.data[2 * p + 1];
  }
  return out;
}

Image readPart(Imf::MultiPartInputFile& file, const std::string& subject) {
  const Imf::Header& header = file.header(0);
  if (header.hasType() && Imf::isDeepData(header.type()))
    throw Error(ErrorCode::kUnsupported, subject, "is a deep EXR", "flatten it");
  const auto window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  const std::vector<std::string> names = chooseChannels(header.channels(), subject);
  for (const std::string& name : names) {
    const Imf::Channel& channel = header.channels()[name];
    if (channel.xSampling != 1 || channel.ySampling != 1)
      throw Error(ErrorCode::kUnsupported, subject, "has subsampled channels",
                  "save it with full resolution");
  }

  Image out(static_cast<int>(width), static_cast<int>(height), static_cast<int>(names.size()));
  Imf::FrameBuffer frame;
  const std::size_t pixel_bytes = names.size() * sizeof(float);
  for (std::size_t c = 0; c < names.size(); ++c)
    frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, out.data.data() + c, window, pixel_bytes,
                                            pixel_bytes * static_cast<std::size_t>(width)));
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame);
  part.readPixels(window.min.y, window.max.y);
  return out.channels == 2 ? widened(out) : out;
}

}  // namespace

Image decodeExr(Bytes file, const std::string& subject) {
  if (file.size() < 8) throwTruncated(subject);
  const HeaderCheck header_is_sound(file, subject);
  MemoryInput in(file, subject);
  try {
    Imf::MultiPartInputFile parts(in, 0);
    return readPart(parts, subject);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    if (in.hitEnd()) throwTruncated(subject);
    throwUnreadable(subject, "EXR", e.what());
  }
}

std::vector<std::byte> encodeExr(const Image& image) {
  static const char* const kNames[4][4] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  const auto channels = static_cast<std::size_t>(image.channels);
  RELUME_CHECK(channels >= 1 && channels <= 4);
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 4;
  Imf::FrameBuffer frame;
  const std::size_t pixel_bytes = channels * sizeof(float);
  for (std::size_t c = 0; c < channels; ++c) {
    const char* name = kNames[channels - 1][c];
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    // OpenEXR only reads through the slice of an output file.
    auto* base = const_cast<char*>(reinterpret_cast<const char*>(image.data.data() + c));
    frame.insert(
        name, Imf::Slice(Imf::FLOAT, base, pixel_bytes, pixel_bytes * static_cast<std::size_t>(image.width)));
  }
  MemoryOutput out;
  {
    Imf::OutputFile file(out, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }
  return out.take();
}

}  // namespace relume::image::detail
