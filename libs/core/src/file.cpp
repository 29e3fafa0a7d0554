// SPDX-License-Identifier: MIT
#include "relume/core/file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>

#include "relume/core/error.h"

namespace relume {
namespace fs = std::filesystem;

namespace {

[[noreturn]] void cannotWrite(const fs::path& path, const std::string& why) {
  throw Error(ErrorCode::kCannotWrite, path.string(), "cannot write: " + why,
              "choose a folder that exists and that you may write to");
}

fs::path temporaryBeside(const fs::path& path) {
  return path.parent_path() / ("." + path.filename().string() + "." + std::to_string(::getpid()) + ".part");
}

struct Closer {
  void operator()(std::FILE* f) const { std::fclose(f); }
};
using File = std::unique_ptr<std::FILE, Closer>;

}  // namespace

std::vector<std::byte> readFile(const fs::path& path) {
  std::error_code ec;
  if (!fs::exists(path, ec)) throw Error(ErrorCode::kFileNotFound, path.string(), "no such file");
  if (fs::is_directory(path, ec))
    throw Error(ErrorCode::kFileUnreadable, path.string(), "is a folder, not a file");
  File file(std::fopen(path.c_str(), "rb"));
  if (!file)
    throw Error(ErrorCode::kFileUnreadable, path.string(),
                std::string("cannot be read: ") + std::strerror(errno));
  std::vector<std::byte> data;
  const auto size = fs::file_size(path, ec);
  if (!ec) data.reserve(static_cast<std::size_t>(size));
  std::byte chunk[1 << 16];
  for (std::size_t n; (n = std::fread(chunk, 1, sizeof chunk, file.get())) > 0;)
    data.insert(data.end(), chunk, chunk + n);
  if (std::ferror(file.get())) throw Error(ErrorCode::kFileUnreadable, path.string(), "reading failed");
  return data;
}

std::string readTextFile(const fs::path& path) {
  const auto data = readFile(path);
  return {reinterpret_cast<const char*>(data.data()), data.size()};
}

void writeFileAtomically(const fs::path& path, std::span<const std::byte> data) {
  const fs::path part = temporaryBeside(path);
  File file(std::fopen(part.c_str(), "wb"));
  if (!file) cannotWrite(path, std::strerror(errno));
  const bool written = data.empty() || std::fwrite(data.data(), 1, data.size(), file.get()) == data.size();
  const bool flushed = std::fflush(file.get()) == 0 && ::fsync(::fileno(file.get())) == 0;
  const std::string why = written && flushed ? "" : std::strerror(errno);
  file.reset();
  std::error_code ec;
  if (!why.empty()) {
    fs::remove(part, ec);
    cannotWrite(path, why);
  }
  fs::rename(part, path, ec);
  if (ec) {
    const std::string message = ec.message();
    fs::remove(part, ec);
    cannotWrite(path, message);
  }
}

void writeFileAtomically(const fs::path& path, std::string_view text) {
  writeFileAtomically(path, std::as_bytes(std::span(text.data(), text.size())));
}

void requireWritable(const fs::path& path) {
  std::error_code ec;
  if (fs::is_directory(path, ec)) cannotWrite(path, "it is a folder");
  const fs::path part = temporaryBeside(path);
  File file(std::fopen(part.c_str(), "wb"));
  if (!file) cannotWrite(path, std::strerror(errno));
  file.reset();
  fs::remove(part, ec);
}

}  // namespace relume
