// What a surface shows. With k = albedo / pi, W the baked value, E the direct irradiance of visible lights, I the
// relit indirect irradiance: the pictures of libs/picture (its src/shader.cpp), which rays make; and with
// u_full_materials glTF's metallic-roughness lobes under E, and normal maps.
#include "material.glsl"
#include "lights.glsl"
#include "ggx.glsl"
#include "shadows.glsl"
#if RELIEF
#include "relief.glsl"
#endif
#if OBJECT_LIGHT || NEAR_OBJECTS
#include "objects.glsl"
uniform int u_object, u_object_count;
uniform float u_object_occlusion_gain;
#endif

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;
in vec4 v_uv01;
in vec4 v_uv23;
in vec4 v_colour;

layout(std430, binding = 1) readonly buffer Lights { Light lights[]; };
layout(binding = 4) uniform sampler2DArray u_value;      // the layer's value, or relit irradiance, on the atlas
layout(binding = 5) uniform sampler2DArray u_label;      // colours of charts, or of validity; alpha 0: no texel
layout(binding = 6) uniform sampler2DArray u_bent;       // bent normals
layout(binding = 7) uniform sampler2D u_reflected;       // GGX: scale and bias of the directional albedo
layout(binding = 10) uniform sampler2DArray u_obscurance; // W, for what moves the indirect light

uniform uint u_material;
uniform int u_page;            // of the atlas; negative: the surface has no bake
uniform int u_light_count;
uniform vec3 u_eye;
uniform vec3 u_forward;
uniform uint u_orthographic;
uniform vec3 u_ambient;        // irradiance
uniform float u_beta;
uniform vec3 u_without_label;
uniform float u_small_scale_gain;
uniform uint u_relief_steps, u_relief_shadows;
uniform float u_direct_gain, u_indirect_gain, u_obscurance_gain, u_bounce_gain;
uniform uint u_has_tangents;
uniform float u_mirror;        // -1 where the transform mirrors

layout(location = 0) out vec4 o_colour;

// Known when the program is made, so that a view costs what it shows and no more.
const int u_view = VIEW;
const uint u_full_materials = FULL;

const int kObscurance = 0, kOcclusion = 1, kLit = 2, kLightmap = 3, kRelit = 4, kIndirect = 5, kAlbedo = 6, kNormal = 7,
          kBentNormal = 8, kTexels = 9, kLabels = 10, kDirect = 11;
const vec3 kWithoutBake = vec3(1.0, 0.0, 1.0);

#if DIRECTIONS
#include "directions.glsl"
#endif

float parity(vec2 p) {
  vec2 cell = floor(p);
  return mod(abs(cell.x + cell.y), 2.0);
}

vec3 checker(vec2 texel) {
  vec3 hue = parity(texel / 8.0) >= 1.0 ? vec3(1.0, 0.75, 0.4) : vec3(0.4, 0.75, 1.0);
  return hue * (parity(texel) >= 1.0 ? 1.0 : 0.45);
}

// Texture coordinates of the mesh, or of where the eye meets its relief; how they change from pixel to pixel is
// told by the mesh, since those of the relief jump.
vec4 g_uv01, g_uv23, g_x01, g_x23, g_y01, g_y23;

void startCoordinates() {
  g_uv01 = v_uv01, g_uv23 = v_uv23;
  g_x01 = dFdx(v_uv01), g_x23 = dFdx(v_uv23);
  g_y01 = dFdy(v_uv01), g_y23 = dFdy(v_uv23);
}

// Of invocations that only help others with their derivatives nothing may be asked but what is interpolated: a
// driver may give them zeros for what they read from buffers.
#define LOOK_UP(map, use) \
  textureGrad(map, uvOf(use, g_uv01, g_uv23), changeOf(use, g_x01, g_x23), changeOf(use, g_y01, g_y23))

#if RELIEF
struct Relief {
  vec3 along_u, along_v;  // metres per unit of the height map's coordinates
  vec3 place;             // of the map, and height
  float depth;            // metres
  vec3 normal;            // world
  float open;             // share of W(alpha, gamma, h)
};

// Texture coordinates that a direction crosses while it rises by the whole depth.
vec2 crossed(Relief r, vec3 way, vec3 n) {
  vec3 g = cross(r.along_u, r.along_v);
  vec2 uv = vec2(dot(cross(way, r.along_v), g), dot(cross(r.along_u, way), g)) / dot(g, g);
  return uv * (r.depth / max(dot(way, n), kLeastRise));
}

Relief reliefOf(Material m, vec3 n, vec3 to_viewer) {
  Relief r;
  vec2 uv = uvOf(m.height, v_uv01, v_uv23), x = changeOf(m.height, g_x01, g_x23), y = changeOf(m.height, g_y01, g_y23);
  vec3 px = dFdx(v_position), py = dFdy(v_position);
  float area = x.x * y.y - x.y * y.x;
  r.place = vec3(uv, 1.0), r.normal = n, r.open = 1.0, r.depth = 0.0;
  if (area == 0.0) return r;
  r.along_u = (px * y.y - py * x.y) / area;
  r.along_v = (py * x.x - px * y.x) / area;
  r.along_u -= dot(r.along_u, n) * n;
  r.along_v -= dot(r.along_v, n) * n;
  r.depth = m.height_scale * length(r.along_u);
  if (u_relief_steps != 0u)
    r.place = meetRelief(uv, -crossed(r, to_viewer, n), m.height_scale);
  else
    r.place.z = textureLod(u_relief, uv, 0.0).x;
  vec2 by = r.place.xy - uv;
  // What every set of coordinates changes by: as many pixels as the relief's do.
  vec2 pixels = vec2(by.x * y.y - by.y * y.x, x.x * by.y - x.y * by.x) / area;
  g_uv01 += g_x01 * pixels.x + g_y01 * pixels.y;
  g_uv23 += g_x23 * pixels.x + g_y23 * pixels.y;
  vec4 there = textureGrad(u_relief, r.place.xy, x, y);
  vec2 slope = 2.0 * there.zw - 1.0;
  float up = sqrt(max(1.0 - dot(slope, slope), 0.0));
  r.normal = normalize(slope.x * normalize(r.along_u) - slope.y * normalize(r.along_v) + up * n);
  r.open = smallScaleOcclusion(up, there.y, there.x);
  return r;
}
#endif

// The normal of the surface's detail, on the side of n; n where there is none.
vec3 detailNormal(Material m, vec3 n) {
  if (m.normal.present == 0u) return n;
  vec3 t;
  float hand;
  if (u_has_tangents != 0u) {
    t = v_tangent.xyz;
    hand = (v_tangent.w < 0.0 ? -1.0 : 1.0) * u_mirror;
  } else {
    // v runs downwards in glTF, so the bitangent is minus dp/dv.
    vec3 px = dFdx(v_position), py = dFdy(v_position);
    vec2 sx = changeOf(m.normal, g_x01, g_x23), sy = changeOf(m.normal, g_y01, g_y23);
    float area = sx.x * sy.y - sx.y * sy.x;
    if (abs(area) == 0.0) return n;
    t = (px * sy.y - py * sx.y) / area;
    vec3 b = -(py * sx.x - px * sy.x) / area;
    hand = dot(cross(n, t), b) < 0.0 ? -1.0 : 1.0;
  }
  t -= dot(t, n) * n;
  float l = length(t);
  if (!(l > 0.0)) return n;
  t /= l;
  vec3 local = 2.0 * LOOK_UP(u_normal, m.normal).xyz - 1.0;
  local.xy *= m.normal_scale;
  return normalize(local.x * t + local.y * hand * cross(n, t) + local.z * n);
}

void main() {
  Material m = materials[u_material];
  startCoordinates();
  vec3 to_viewer = u_orthographic != 0u ? -u_forward : normalize(u_eye - v_position);
  // Surfaces are lit on the side from which they are seen.
  vec3 ng = normalize(cross(dFdx(v_position), dFdy(v_position)));
  if (dot(ng, to_viewer) < 0.0) ng = -ng;
  float length_n = length(v_normal);
  vec3 n = length_n > 0.0 ? v_normal / length_n : ng;
  if (dot(n, ng) < 0.0) n = -n;
#if RELIEF
  Relief relief = reliefOf(m, n, to_viewer);
#endif

  vec4 base = m.base_colour * v_colour;
  if (m.base.present != 0u) base *= LOOK_UP(u_base, m.base);
  if (m.alpha_mode == kAlphaMask && base.a < m.alpha_cutoff) discard;
  float opacity = m.alpha_mode == kAlphaBlend ? clamp(base.a, 0.0, 1.0) : 1.0;

  float metallic = m.metallic, roughness = m.roughness;
  if (m.metallic_roughness.present != 0u) {
    vec4 texel = LOOK_UP(u_metallic_roughness, m.metallic_roughness);
    roughness *= texel.g;
    metallic *= texel.b;
  }
  vec3 emission = m.emission_alpha.rgb;
  if (m.emission.present != 0u) emission *= LOOK_UP(u_emission, m.emission).rgb;

  vec2 atlas_uv = v_uv01.zw;
  bool baked = u_page >= 0;
  vec3 place = vec3(atlas_uv, float(max(u_page, 0)));
  vec3 value = baked ? texture(u_value, place).rgb : vec3(1.0);
  float headlight = 0.4 + 0.6 * abs(dot(n, to_viewer));

  vec3 colour;
  if (u_view == kAlbedo) {
    colour = m.unlit != 0u ? vec3(0.0) : base.rgb * (1.0 - metallic);
  } else if (u_view == kNormal) {
    // By winding, as data; not the side that is seen.
    vec3 outside = gl_FrontFacing == (u_mirror > 0.0) ? ng : -ng;
    vec3 shown = dot(n, outside) < 0.0 ? -n : n;
    colour = 0.5 * (shown + 1.0);
  } else if (u_view == kOcclusion) {
    colour = value;
  } else if (u_view == kBentNormal) {
    vec3 bent = baked ? texture(u_bent, place).xyz : n;
    float l = length(bent);
    colour = 0.5 * ((l > 1e-6 ? bent / l : n) + 1.0);
  } else if (u_view == kTexels) {
    colour = baked ? (0.2 + 0.8 * value) * checker(atlas_uv * vec2(textureSize(u_value, 0).xy)) : kWithoutBake * headlight;
  } else if (u_view == kLabels) {
    ivec3 size = textureSize(u_label, 0);
    ivec2 texel = clamp(ivec2(atlas_uv * vec2(size.xy)), ivec2(0), size.xy - 1);
    vec4 label = baked ? texelFetch(u_label, ivec3(texel, max(u_page, 0)), 0) : vec4(0.0);
    colour = (label.a > 0.0 ? label.rgb : u_without_label) * headlight;
  } else if (m.unlit != 0u) {
    colour = base.rgb + emission;
  } else {
    bool full = u_full_materials != 0u;
    vec3 nd = full || DIRECTIONS > 0 ? detailNormal(m, n) : n;
#if RELIEF
    if (m.normal.present == 0u) nd = relief.normal;
#endif
    if (dot(nd, ng) <= 0.0) nd = n;
#if DIRECTIONS
    {
      // Light is known on the side that the normal points to; seen from behind it is shown likewise.
      bool behind = gl_FrontFacing != (u_mirror > 0.0);
      vec3 own = behind ? -n : n, turned = behind ? -nd : nd;
      vec3 eye = behind ? reflect(to_viewer, own) : to_viewer;
      if (dot(turned, eye) <= 0.0) turned = own;
      vec3 light = directionalLight(atlas_uv, max(u_page, 0), own, turned, eye, base.rgb, clamp(metallic, 0.0, 1.0), roughness,
                                    base.rgb * value * kInvPi);
      o_colour = vec4(light + emission, opacity);
      return;
    }
#endif
    float cos_o = max(dot(nd, to_viewer), kLeastCosine);
    Lobes lobes;
    if (full) {
      float alpha = clamp(roughness * roughness, kLeastAlpha, 1.0);
      // Entries of the table lie at squares, its first and last at the middles of texels.
      vec2 at = (sqrt(vec2(cos_o, alpha)) * 31.0 + 0.5) / 32.0;
      lobes = lobesOf(base.rgb, clamp(metallic, 0.0, 1.0), roughness, texture(u_reflected, at).xy);
    }
    vec3 direct = vec3(0.0), glossy = vec3(0.0), incident = vec3(0.0);
    if (u_view == kLit || u_view == kRelit || u_view == kDirect || (u_view == kIndirect && u_bounce_gain > 0.0)) {
      for (int i = 0; i < u_light_count; ++i) {
        Light light = lights[i];
        float r;
        vec3 way = wayTo(light, v_position, r);
        float factor = incidentFactor(light, way, r);
        incident += factor * light.strength_area.rgb;
        float cos_i = dot(nd, way);
        if (factor <= 0.0 || cos_i <= 0.0 || dot(n, way) <= 0.0) continue;
        float seen = visibility(light, v_position, n);
#if RELIEF
        if (u_relief_shadows != 0u) seen *= reliefVisibility(relief.place, crossed(relief, way, n));
#endif
        vec3 e = light.strength_area.rgb * (factor * cos_i * seen);
        direct += e;
        if (full) glossy += e * specularLobe(lobes, nd, way, to_viewer, cos_i, cos_o);
      }
    }
    vec3 indirect = u_ambient, around = vec3(0.0);  // the latter for glossy lobes, where they know better
    if (u_view == kLightmap) {
      direct = baked ? value : u_ambient;
      indirect = vec3(0.0);
    } else if (u_view == kRelit || u_view == kIndirect) {
      indirect += baked ? value * u_indirect_gain : vec3(0.0);
      around = indirect;
#if OBJECT_LIGHT == 1
      around += u_indirect_gain * kPi * surroundingsRadiance(u_object, v_position, reflect(-to_viewer, nd), roughness * roughness);
      indirect += u_indirect_gain * surroundingsIrradiance(u_object, v_position, nd);
#elif OBJECT_LIGHT == 2
      around += u_indirect_gain * probeIrradiance(u_object, v_position, reflect(-to_viewer, nd));
      indirect += u_indirect_gain * probeIrradiance(u_object, v_position, nd);
#elif NEAR_OBJECTS
      indirect *= mix(1.0, leftByObjects(u_object_count, v_position, nd), u_object_occlusion_gain);
#endif
    } else if (u_view == kDirect) {
      indirect = vec3(0.0);
    } else if (baked) {
      if (u_view == kLit) indirect += u_beta * incident;
      indirect *= value;
    } else {
      direct = vec3(0.0), glossy = vec3(0.0);
    }
    if (baked && (u_obscurance_gain > 0.0 || u_bounce_gain > 0.0)) {
      // Multi-scale PRT, section 10: W from the large scale to the medium one, and the last short way of direct light.
      vec3 w = texture(u_obscurance, place).rgb;
      indirect = indirect * mix(vec3(1.0), w, u_obscurance_gain) + u_bounce_gain * w * direct;
    }
#if RELIEF
    indirect *= mix(1.0, relief.open, u_small_scale_gain);
#endif
    if (u_view == kIndirect) direct = vec3(0.0), glossy = vec3(0.0);
    direct *= u_direct_gain;
    glossy *= u_direct_gain;
    vec3 seen = u_view == kIndirect ? vec3(0.0) : emission;
    if (full && u_view != kIndirect)
      // Indirect light has no direction here: the glossy lobes take it as coming from all sides alike.
      colour = (lobes.diffuse * (direct + indirect) + lobes.glossy * (OBJECT_LIGHT != 0 ? around : indirect)) * kInvPi + glossy + seen;
    else
      colour = base.rgb * (direct + indirect) * kInvPi + seen;
  }
#if SURROUNDINGS
  o_colour = vec4(min(colour, vec3(6e4)), 1.0 / distance(v_position, u_eye));
#else
  o_colour = vec4(colour, opacity);
#endif
}
