// SPDX-License-Identifier: MIT
// The C interface: checks every argument, lets no exception out.
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <variant>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/core/error.h"
#include "relume/relight/group_relighter.h"
#include "relume/relight/obscurance.h"
#include "relume/relight/relume.h"
#include "relume/relight/transfer_relighter.h"

struct relume_relighter {
  using Obscurance = relume::relight::ObscuranceRelighter;
  using Transfer = relume::relight::TransferRelighter;
  using Groups = relume::relight::GroupRelighter;

  relume_relighter(const relume::asset::Asset& asset, const relume::asset::Layer& layer)
      : relighter(relighterOf(asset, layer)), atlas(asset.atlas) {
    if (const auto* groups = std::get_if<Groups>(&relighter))
      gains.assign(groups->groupCount(), relume::Vec3(1));
  }

  // In the order of relume_layer_kind.
  using Relighter = std::variant<Obscurance, Transfer, Groups>;
  static Relighter relighterOf(const relume::asset::Asset& asset, const relume::asset::Layer& layer) {
    if (layer.kind == "lightgroups") return Groups(asset, layer);
    if (layer.findTable("shape")) return Transfer(asset, layer);
    return Obscurance(asset, layer);
  }

  Relighter relighter;
  relume::asset::AtlasTable atlas;
  relume::LightSet lights;
  std::vector<relume::Vec3> gains;  ///< by group
  relume::relight::VisibilitySource visibility;
};

namespace {

using relume::ErrorCode;
using relume::Light;

thread_local std::string last_error;

relume_status fail(relume_status status, const char* what) noexcept {
  try {
    last_error = what;
  } catch (...) {
    last_error.clear();
  }
  return status;
}

relume_status statusOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::kNotGltf:
    case ErrorCode::kInvalidJson:
      return RELUME_NOT_GLTF;
    case ErrorCode::kTruncated:
      return RELUME_TRUNCATED;
    case ErrorCode::kCorruptAsset:
      return RELUME_CORRUPT;
    case ErrorCode::kUnsupported:
      return RELUME_UNSUPPORTED;
    case ErrorCode::kMismatch:
    case ErrorCode::kNoSuchLayer:
      return RELUME_NO_SUCH_LAYER;
    case ErrorCode::kInvalidValue:
      return RELUME_BAD_ARGUMENT;
    case ErrorCode::kOutOfMemory:
      return RELUME_OUT_OF_MEMORY;
    default:
      return RELUME_FAILED;
  }
}

template <class Body>
relume_status guarded(Body&& body) noexcept {
  try {
    return body();
  } catch (const relume::Error& e) {
    return fail(statusOf(e.code()), e.what());
  } catch (const std::bad_alloc&) {
    return fail(RELUME_OUT_OF_MEMORY, "out of memory");
  } catch (const std::exception& e) {
    return fail(RELUME_FAILED, e.what());
  } catch (...) {
    return fail(RELUME_FAILED, "unknown failure");
  }
}

bool finite(relume::Vec3 v) { return relume::isFinite(v); }
relume::Vec3 vec(const float* v) { return {v[0], v[1], v[2]}; }
bool atLeastZero(float x) { return x >= 0 && x <= std::numeric_limits<float>::max(); }

// Null where the light is sound, else what is wrong with it.
const char* convert(const relume_light& in, Light& out) {
  if (in.kind < RELUME_POINT || in.kind > RELUME_AREA) return "a light has an unknown kind";
  out.kind = static_cast<Light::Kind>(in.kind);
  out.colour = vec(in.colour);
  out.intensity = in.intensity;
  if (!finite(out.colour) || !atLeastZero(std::min({in.colour[0], in.colour[1], in.colour[2]})) ||
      !atLeastZero(in.intensity))
    return "a light has a colour or an intensity that is negative or not finite";
  if (out.kind != Light::Kind::kDirectional) {
    out.position = vec(in.position);
    if (!finite(out.position)) return "a light has a position that is not finite";
  }
  if (out.kind == Light::Kind::kPoint || out.kind == Light::Kind::kSpot) {
    if (!(in.range >= 0)) return "a light has a negative range";
    out.range = in.range > 0 ? in.range : relume::kInfinity;
  }
  if (out.kind != Light::Kind::kPoint) {
    const relume::Vec3 d = vec(in.direction);
    const float largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    if (!finite(d) || !(largest > 0)) return "a light has a direction that is zero or not finite";
    out.direction = glm::normalize(d / largest);
  }
  if (out.kind == Light::Kind::kSpot) {
    if (!(in.inner_cone >= 0 && in.inner_cone < in.outer_cone && in.outer_cone <= relume::kPi / 2))
      return "a spot light needs 0 <= inner_cone < outer_cone <= pi / 2";
    out.inner_cone = in.inner_cone;
    out.outer_cone = in.outer_cone;
  }
  if (out.kind == Light::Kind::kArea) {
    if (!(in.area > 0 && in.area <= std::numeric_limits<float>::max()))
      return "an area light needs an area above 0";
    out.area = in.area;
    out.two_sided = in.two_sided != 0;
  }
  return nullptr;
}

const float* floatsOf(std::span<const relume::Vec3> values) {
  static_assert(sizeof(relume::Vec3) == 3 * sizeof(float));
  return reinterpret_cast<const float*>(values.data());
}

// Where visibility is asked.
std::span<const relume::Point> pointsOf(const relume_relighter* r) {
  if (!r || std::get_if<relume_relighter::Groups>(&r->relighter)) return {};
  const auto* transfer = std::get_if<relume_relighter::Transfer>(&r->relighter);
  return transfer ? transfer->visibilityPoints() : r->atlas.position;
}
std::span<const relume::Normal> normalsOf(const relume_relighter* r) {
  if (!r || std::get_if<relume_relighter::Groups>(&r->relighter)) return {};
  const auto* transfer = std::get_if<relume_relighter::Transfer>(&r->relighter);
  return transfer ? transfer->visibilityNormals() : r->atlas.normal;
}

std::span<const relume::Irradiance> evaluate(relume_relighter& r, const relume_settings* settings) {
  if (auto* groups = std::get_if<relume_relighter::Groups>(&r.relighter)) return groups->evaluate(r.gains);
  if (auto* transfer = std::get_if<relume_relighter::Transfer>(&r.relighter))
    return transfer->evaluate(r.lights, r.visibility);
  const relume::relight::ObscuranceOptions options{relume::Irradiance(vec(settings->ambient)),
                                                   settings->beta};
  return std::get<relume_relighter::Obscurance>(r.relighter).evaluate(r.lights, options, r.visibility);
}

}  // namespace

extern "C" {

relume_status relume_open(const void* glb, size_t size, const char* layer, relume_relighter** out) {
  if (!glb || !out) return fail(RELUME_BAD_ARGUMENT, "relume_open: a pointer is null");
  return guarded([&] {
    const relume::asset::Asset asset =
        relume::asset::decode({static_cast<const std::byte*>(glb), size}, "bake");
    *out = std::make_unique<relume_relighter>(asset, asset.layer(layer ? layer : "")).release();
    return RELUME_OK;
  });
}

void relume_close(relume_relighter* relighter) { delete relighter; }

size_t relume_texel_count(const relume_relighter* relighter) {
  return relighter ? relighter->atlas.texel.size() : 0;
}

void relume_atlas_size(const relume_relighter* relighter, uint32_t* width, uint32_t* height,
                       uint32_t* pages) {
  if (width) *width = relighter ? static_cast<uint32_t>(relighter->atlas.width) : 0;
  if (height) *height = relighter ? static_cast<uint32_t>(relighter->atlas.height) : 0;
  if (pages) *pages = relighter ? relighter->atlas.pages : 0;
}

const uint32_t* relume_texels(const relume_relighter* relighter) {
  return relighter ? relighter->atlas.texel.data() : nullptr;
}

const float* relume_positions(const relume_relighter* relighter) {
  return relighter ? floatsOf(relighter->atlas.position) : nullptr;
}

const float* relume_normals(const relume_relighter* relighter) {
  return relighter ? floatsOf(relighter->atlas.normal) : nullptr;
}

relume_layer_kind relume_kind(const relume_relighter* relighter) {
  return relighter ? static_cast<relume_layer_kind>(relighter->relighter.index()) : RELUME_OBSCURANCE;
}

size_t relume_point_count(const relume_relighter* relighter) { return pointsOf(relighter).size(); }
const float* relume_points(const relume_relighter* relighter) { return floatsOf(pointsOf(relighter)); }
const float* relume_point_normals(const relume_relighter* relighter) {
  return floatsOf(normalsOf(relighter));
}

relume_status relume_set_lights(relume_relighter* relighter, const relume_light* lights, size_t count) {
  if (!relighter || (!lights && count > 0))
    return fail(RELUME_BAD_ARGUMENT, "relume_set_lights: a pointer is null");
  return guarded([&] {
    relume::LightSet set(count);
    for (size_t i = 0; i < count; ++i)
      if (const char* problem = convert(lights[i], set[i]))
        return fail(RELUME_BAD_ARGUMENT,
                    ("relume_set_lights: lights[" + std::to_string(i) + "]: " + problem).c_str());
    relighter->lights = std::move(set);
    return RELUME_OK;
  });
}

relume_status relume_set_visibility(relume_relighter* relighter, relume_visibility function, void* user) {
  if (!relighter) return fail(RELUME_BAD_ARGUMENT, "relume_set_visibility: a pointer is null");
  return guarded([&] {
    relighter->visibility = nullptr;
    if (function)
      relighter->visibility = [function, user](std::size_t light, std::span<float> v) {
        function(user, light, v.data(), v.size());
      };
    return RELUME_OK;
  });
}

relume_status relume_forget_visibility(relume_relighter* relighter) {
  if (!relighter) return fail(RELUME_BAD_ARGUMENT, "relume_forget_visibility: a pointer is null");
  if (auto* transfer = std::get_if<relume_relighter::Transfer>(&relighter->relighter))
    transfer->forgetVisibility();
  return RELUME_OK;
}

size_t relume_group_count(const relume_relighter* relighter) {
  return relighter ? relighter->gains.size() : 0;
}

const char* relume_group_name(const relume_relighter* relighter, size_t group) {
  if (group >= relume_group_count(relighter)) return nullptr;
  return std::get<relume_relighter::Groups>(relighter->relighter).groupNames()[group].c_str();
}

relume_status relume_set_gains(relume_relighter* relighter, const float* gains, size_t count) {
  if (!relighter || (!gains && count > 0))
    return fail(RELUME_BAD_ARGUMENT, "relume_set_gains: a pointer is null");
  if (count != relighter->gains.size())
    return fail(RELUME_BAD_ARGUMENT, "relume_set_gains: the number of gains is not that of the groups");
  for (size_t i = 0; i < 3 * count; ++i)
    if (!atLeastZero(gains[i]))
      return fail(RELUME_BAD_ARGUMENT, "relume_set_gains: a gain is negative or not finite");
  for (size_t g = 0; g < count; ++g) relighter->gains[g] = vec(gains + 3 * g);
  return RELUME_OK;
}

relume_status relume_evaluate(relume_relighter* relighter, const relume_settings* settings, float* irradiance,
                              size_t capacity) {
  if (!relighter || !irradiance) return fail(RELUME_BAD_ARGUMENT, "relume_evaluate: a pointer is null");
  if (!settings && relume_kind(relighter) == RELUME_OBSCURANCE)
    return fail(RELUME_BAD_ARGUMENT, "relume_evaluate: obscurance needs settings");
  if (capacity / 3 < relighter->atlas.texel.size())
    return fail(RELUME_BAD_ARGUMENT, "relume_evaluate: the buffer is too small");
  if (settings && (!finite(vec(settings->ambient)) || !(settings->beta >= 0 && settings->beta <= 1)))
    return fail(RELUME_BAD_ARGUMENT, "relume_evaluate: ambient is not finite or beta not in [0, 1]");
  return guarded([&] {
    for (const relume::Irradiance& e : evaluate(*relighter, settings))
      for (int c = 0; c < 3; ++c) *irradiance++ = e.rgb[c];
    return RELUME_OK;
  });
}

const char* relume_last_error(void) { return last_error.c_str(); }

}  // extern "C"
