// SPDX-License-Identifier: MIT
#include "json_node.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "relume/core/error.h"
#include "relume/core/hash.h"

namespace relume::asset {
namespace {

constexpr int kMaxDepth = 32;

void appendText(std::vector<std::byte>& out, const std::string& text) {
  out.push_back(std::byte{'s'});
  const auto* p = reinterpret_cast<const std::byte*>(text.c_str());
  out.insert(out.end(), p, p + text.size() + 1);
}

void appendCanonical(std::vector<std::byte>& out, const Json& value, const JsonNode& root, int depth) {
  if (depth > kMaxDepth) root.fail("is nested too deep");
  const auto tag = [&](char c) { out.push_back(static_cast<std::byte>(c)); };
  switch (value.type()) {
    case Json::value_t::object:
      tag('{');
      for (const auto& [key, member] : value.items()) {
        if (key == "bufferView" || key == "extras" || (depth == 0 && key == "crc32")) continue;
        appendText(out, key);
        appendCanonical(out, member, root, depth + 1);
      }
      tag('}');
      break;
    case Json::value_t::array:
      tag('[');
      for (const Json& item : value) appendCanonical(out, item, root, depth + 1);
      tag(']');
      break;
    case Json::value_t::string:
      appendText(out, value.get_ref<const std::string&>());
      break;
    case Json::value_t::boolean:
      tag(value.get<bool>() ? 't' : 'f');
      break;
    case Json::value_t::null:
      tag('n');
      break;
    default: {
      const double number = value.get<double>() + 0.0;  // -0 becomes 0, as other JSON libraries write it
      std::byte bytes[sizeof number];
      std::memcpy(bytes, &number, sizeof number);
      tag('d');
      out.insert(out.end(), bytes, bytes + sizeof number);
    }
  }
}

}  // namespace

void JsonNode::fail(const std::string& problem) const {
  throw Error(ErrorCode::kCorruptAsset, file_, path_ + " " + problem, "the bake is damaged; bake it again");
}

JsonNode JsonNode::at(const char* key) const {
  if (!has(key)) fail(fmt::format("has no member {}", key));
  return {(*value_)[key], file_, path_ + "." + key};
}

std::vector<JsonNode> JsonNode::items() const {
  if (!value_->is_array()) fail("is not an array");
  std::vector<JsonNode> nodes;
  for (std::size_t i = 0; i < value_->size(); ++i) nodes.push_back(item(i));
  return nodes;
}

JsonNode JsonNode::item(std::size_t index) const {
  if (!value_->is_array() || index >= value_->size()) fail(fmt::format("has no item {}", index));
  return {(*value_)[index], file_, fmt::format("{}[{}]", path_, index)};
}

std::string JsonNode::text() const {
  if (!value_->is_string()) fail("is not a string");
  return value_->get<std::string>();
}

double JsonNode::number() const {
  if (!value_->is_number() || !std::isfinite(value_->get<double>())) fail("is not a finite number");
  return value_->get<double>();
}

float JsonNode::real() const {
  const auto value = static_cast<float>(number());
  if (!std::isfinite(value)) fail("is too large");
  return value;
}

std::uint64_t JsonNode::integer(std::uint64_t lowest, std::uint64_t highest) const {
  // Some tools write whole numbers as 3.0.
  std::uint64_t value = 0;
  bool whole = value_->is_number_unsigned();
  if (whole) {
    value = value_->get<std::uint64_t>();
  } else if (value_->is_number_float()) {
    const double d = value_->get<double>();
    whole = d >= 0 && d < 0x1p64 && d == std::floor(d);
    if (whole) value = static_cast<std::uint64_t>(d);
  }
  if (!whole || value < lowest || value > highest)
    fail(fmt::format("is not a whole number from {} to {}", lowest, highest));
  return value;
}

std::uint32_t descriptionCrc(const JsonNode& root) {
  std::vector<std::byte> bytes;
  appendCanonical(bytes, root.json(), root, 0);
  return crc32(bytes);
}

}  // namespace relume::asset
