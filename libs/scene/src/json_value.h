// SPDX-License-Identifier: MIT
// A place in a JSON document: reads fields with their types checked, and knows what to call the place in a
// message.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "relume/core/error.h"
#include "relume/core/vec.h"

namespace relume::scene::gltf {

/// A JSON value or the absence of one. Every reader throws Error kInvalidValue, naming the place, when the
/// type is another.
class Value {
 public:
  Value(const std::string& file, const nlohmann::json& json) : file_(&file), json_(&json) {}

  explicit operator bool() const { return json_ != nullptr; }
  /// A field of an object; absent when the object, or this value, has none.
  Value operator[](const char* key) const;
  Value operator[](const std::string& key) const { return (*this)[key.c_str()]; }
  /// An element of an array; i < size().
  Value at(std::size_t i) const;
  /// Elements of an array; 0 when absent.
  std::size_t size() const;
  /// `extensions.name` of this object.
  Value extension(const char* name) const;
  /// `extras.relume` of this object, where both are objects: extras may be anything.
  Value notes() const;
  /// `extras.relume.group`, empty where there is no such text.
  std::string group() const;

  const nlohmann::json& json() const { return *json_; }
  bool boolean(bool fallback) const;
  double number(double fallback) const;
  float real(float fallback) const { return static_cast<float>(finite(number(fallback))); }
  std::string text(const std::string& fallback) const;
  /// A whole number in [0, 2^53]; the first form requires it to be there.
  std::uint64_t integer() const;
  std::uint64_t integer(std::uint64_t fallback) const { return json_ ? integer() : fallback; }
  /// An index below `count`; the error kInvalidReference says how many `things` there are.
  std::uint32_t index(std::size_t count, const char* things) const;
  Vec2 vec2(Vec2 fallback) const;
  Vec3 vec3(Vec3 fallback) const;
  Vec4 vec4(Vec4 fallback) const;
  Mat4 mat4(const Mat4& fallback) const;

  /// "file: path".
  std::string subject() const;
  const std::string& path() const { return path_; }
  [[noreturn]] void fail(ErrorCode code, const std::string& problem, const std::string& remedy = {}) const;

 private:
  Value(const std::string* file, const nlohmann::json* json, std::string path)
      : file_(file), json_(json), path_(std::move(path)) {}
  void numbers(float* out, std::size_t count) const;
  double finite(double v) const;

  const std::string* file_;
  const nlohmann::json* json_;
  std::string path_;
};

}  // namespace relume::scene::gltf
