// SPDX-License-Identifier: MIT
#include "uri.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <optional>

#include "relume/core/file.h"

namespace relume::scene::gltf {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view kDataScheme = "data:";

std::optional<unsigned> hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

// A per cent sign that no two hexadecimal digits follow stands for itself: exporters forget to encode it.
std::string percentDecode(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size()) {
      const auto hi = hexDigit(text[i + 1]), lo = hexDigit(text[i + 2]);
      if (hi && lo) {
        out.push_back(static_cast<char>(*hi * 16 + *lo));
        i += 2;
        continue;
      }
    }
    out.push_back(text[i]);
  }
  return out;
}

constexpr std::array<signed char, 256> base64Table() {
  std::array<signed char, 256> table{};
  for (auto& v : table) v = -1;
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    table[static_cast<unsigned char>(kDigits[i])] = static_cast<signed char>(i);
  table['-'] = 62;  // the URL-safe alphabet
  table['_'] = 63;
  return table;
}

std::vector<std::byte> base64Decode(std::string_view text, const std::string& subject) {
  static constexpr auto kTable = base64Table();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<std::byte> out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const int v = kTable[static_cast<unsigned char>(c)];
    if (v < 0) throw Error(ErrorCode::kInvalidValue, subject, "holds base64 with an invalid character");
    bits = bits << 6 | static_cast<std::uint32_t>(v);
    if ((held += 6) >= 8) {
      held -= 8;
      out.push_back(static_cast<std::byte>(bits >> held & 0xff));
    }
  }
  return out;
}

// RFC 3986: a scheme is a letter, then letters, digits, '+', '-', '.'; a single letter is a drive of another
// system.
bool hasScheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  if (!std::isalpha(static_cast<unsigned char>(uri[0]))) return false;
  for (const char c : uri.substr(0, colon))
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '-' && c != '.') return false;
  return true;
}

std::string shortened(std::string_view uri) {
  return uri.size() <= 80 ? std::string(uri) : std::string(uri.substr(0, 77)) + "...";
}

}  // namespace

bool isDataUri(std::string_view uri) { return uri.substr(0, kDataScheme.size()) == kDataScheme; }

std::vector<std::byte> decodeDataUri(std::string_view uri, const std::string& subject) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos)
    throw Error(ErrorCode::kInvalidValue, subject, "is a data URI without data");
  const std::string_view header = uri.substr(0, comma), data = uri.substr(comma + 1);
  constexpr std::string_view kBase64 = ";base64";
  if (header.size() >= kBase64.size() && header.substr(header.size() - kBase64.size()) == kBase64) {
    // Base64 itself may be percent-encoded ("%2B", "%3D").
    return data.find('%') == std::string_view::npos ? base64Decode(data, subject)
                                                    : base64Decode(percentDecode(data), subject);
  }
  const std::string text = percentDecode(data);
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  return {bytes, bytes + text.size()};
}

fs::path relativePath(std::string_view uri, const std::string& subject) {
  if (hasScheme(uri))
    throw Error(ErrorCode::kInvalidReference, subject,
                fmt::format("names \"{}\", which is not a relative path", shortened(uri)),
                "put the file beside the glTF file and name it by a relative path");
  fs::path path(percentDecode(uri));
  if (path.empty() || path.is_absolute() || path.native().find('\0') != std::string::npos)
    throw Error(ErrorCode::kInvalidReference, subject,
                fmt::format("names \"{}\", which is not a relative path", shortened(uri)),
                "put the file beside the glTF file and name it by a relative path");
  return path;
}

std::vector<std::byte> readRelative(const fs::path& folder, std::string_view uri,
                                    const std::string& subject) {
  const fs::path relative = relativePath(uri, subject);
  if (folder.empty())
    throw Error(ErrorCode::kInvalidReference, subject,
                fmt::format("names the file \"{}\", but no files may be read", shortened(uri)),
                "embed it in the glTF file");
  std::error_code ec;
  const fs::path path = folder / relative;
  if (!fs::exists(path, ec))
    throw Error(ErrorCode::kFileNotFound, subject,
                fmt::format("the file \"{}\" is missing", relative.string()),
                "put it beside the glTF file or export as .glb");
  // Anything but a regular file might never end.
  if (!fs::is_regular_file(path, ec))
    throw Error(ErrorCode::kFileUnreadable, subject,
                fmt::format("\"{}\" is not a regular file", relative.string()));
  try {
    return readFile(path);
  } catch (const Error& error) {
    throw Error(error.code(), subject, fmt::format("the file \"{}\" cannot be read", relative.string()));
  }
}

}  // namespace relume::scene::gltf
