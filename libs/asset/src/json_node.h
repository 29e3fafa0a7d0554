// SPDX-License-Identifier: MIT
// A JSON value of untrusted origin: every access says what it expects, and an error says where it failed.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace relume::asset {

using Json = nlohmann::json;

class JsonNode {
 public:
  JsonNode(const Json& value, std::string file, std::string path)
      : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

  bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
  /// Member of an object; throws Error kCorruptAsset where there is none.
  JsonNode at(const char* key) const;
  std::vector<JsonNode> items() const;  ///< of an array
  JsonNode item(std::size_t index) const;
  std::string text() const;
  double number() const;  ///< finite
  float real() const;     ///< finite in single precision
  std::uint64_t integer(std::uint64_t lowest, std::uint64_t highest) const;
  const Json& json() const { return *value_; }
  const std::string& file() const { return file_; }
  /// Throws Error kCorruptAsset about this value.
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  const Json* value_;
  std::string file_, path_;
};

/// Checksum of a JSON value that survives another tool's formatting: docs/format.md, "Checksum of the
/// description". Leaves out members named bufferView and extras anywhere, and crc32 at the root. Throws Error
/// kCorruptAsset when nested too deep.
std::uint32_t descriptionCrc(const JsonNode& root);

}  // namespace relume::asset
