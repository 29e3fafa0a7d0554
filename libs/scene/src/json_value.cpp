// SPDX-License-Identifier: MIT
#include "json_value.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/type_ptr.hpp>

namespace relume::scene::gltf {

using Json = nlohmann::json;

namespace {
const char* typeName(const Json& j) { return j.type_name(); }
}  // namespace

std::string Value::subject() const {
  if (path_.empty()) return *file_;
  return file_->empty() ? path_ : *file_ + ": " + path_;
}

void Value::fail(ErrorCode code, const std::string& problem, const std::string& remedy) const {
  throw Error(code, subject(), problem, remedy);
}

Value Value::operator[](const char* key) const {
  std::string path = path_.empty() ? std::string(key) : path_ + "." + key;
  if (!json_) return {file_, nullptr, std::move(path)};
  if (!json_->is_object())
    fail(ErrorCode::kInvalidValue, fmt::format("is {}, not an object", typeName(*json_)));
  const auto it = json_->find(key);
  return {file_, it == json_->end() ? nullptr : &*it, std::move(path)};
}

Value Value::at(std::size_t i) const {
  const Json& element = (*json_)[i];
  std::string path = fmt::format("{}[{}]", path_, i);
  if (element.is_object()) {
    const auto name = element.find("name");
    if (name != element.end() && name->is_string() && !name->get_ref<const std::string&>().empty())
      path += fmt::format(" \"{}\"", name->get_ref<const std::string&>());
  }
  return {file_, &element, std::move(path)};
}

std::size_t Value::size() const {
  if (!json_) return 0;
  if (!json_->is_array())
    fail(ErrorCode::kInvalidValue, fmt::format("is {}, not an array", typeName(*json_)));
  return json_->size();
}

Value Value::extension(const char* name) const { return (*this)["extensions"][name]; }

bool Value::boolean(bool fallback) const {
  if (!json_) return fallback;
  if (!json_->is_boolean())
    fail(ErrorCode::kInvalidValue, fmt::format("is {}, not true or false", typeName(*json_)));
  return json_->get<bool>();
}

Value Value::notes() const {
  const Value extras = (*this)["extras"];
  if (!extras || !extras.json().is_object()) return {file_, nullptr, path_};
  const Value mark = extras["relume"];
  return mark && mark.json().is_object() ? mark : Value(file_, nullptr, path_);
}

std::string Value::group() const {
  const Value mark = notes();
  if (!mark) return {};
  const Value group = mark["group"];
  return group && group.json().is_string() ? group.text("") : std::string();
}

double Value::number(double fallback) const {
  if (!json_) return fallback;
  if (!json_->is_number())
    fail(ErrorCode::kInvalidValue, fmt::format("is {}, not a number", typeName(*json_)));
  return json_->get<double>();
}

double Value::finite(double v) const {
  if (!(std::abs(v) <= std::numeric_limits<float>::max()))
    fail(ErrorCode::kInvalidValue, "is too large a number");
  return v;
}

std::string Value::text(const std::string& fallback) const {
  if (!json_) return fallback;
  if (!json_->is_string())
    fail(ErrorCode::kInvalidValue, fmt::format("is {}, not a string", typeName(*json_)));
  return json_->get_ref<const std::string&>();
}

std::uint64_t Value::integer() const {
  if (!json_) fail(ErrorCode::kInvalidValue, "is missing");
  const double v = number(0);
  // 2^53: every smaller whole number is exact in a double, as JSON numbers often are written.
  if (!(v >= 0 && v <= 9007199254740992.0) || v != std::floor(v))
    fail(ErrorCode::kInvalidValue, fmt::format("is {}, not a whole number", v));
  return static_cast<std::uint64_t>(v);
}

std::uint32_t Value::index(std::size_t count, const char* things) const {
  const std::uint64_t i = integer();
  if (i >= count)
    fail(ErrorCode::kInvalidReference,
         count == 0 ? fmt::format("refers to {} {}, but there is none", things, i)
                    : fmt::format("refers to {} {}, but the last is {}", things, i, count - 1));
  return static_cast<std::uint32_t>(i);
}

void Value::numbers(float* out, std::size_t count) const {
  if (size() != count)
    fail(ErrorCode::kInvalidValue, fmt::format("has {} elements instead of {}", size(), count));
  for (std::size_t i = 0; i < count; ++i) out[i] = at(i).real(0);
}

Vec2 Value::vec2(Vec2 v) const { return json_ ? (numbers(&v.x, 2), v) : v; }
Vec3 Value::vec3(Vec3 v) const { return json_ ? (numbers(&v.x, 3), v) : v; }
Vec4 Value::vec4(Vec4 v) const { return json_ ? (numbers(&v.x, 4), v) : v; }

Mat4 Value::mat4(const Mat4& fallback) const {
  if (!json_) return fallback;
  Mat4 m;
  numbers(glm::value_ptr(m), 16);
  return m;
}

}  // namespace relume::scene::gltf
