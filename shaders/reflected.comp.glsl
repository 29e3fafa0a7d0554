// Directional albedo of the GGX lobe with Schlick's Fresnel factor: F0 * scale + bias (the table of
// libs/transport/src/ggx.cpp). Entries lie at cos = t^2 and alpha = s^2.
#include "ggx.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rg32f, binding = 0) writeonly uniform image2D u_table;

const int kSize = 32;
const uint kSamples = 1024u;

float coordinate(int i) {
  float t = float(i) / float(kSize - 1);
  return max(t * t, 1e-4);
}

// A normal among those visible from o (Dupuy, Benyoub 2023).
vec3 visibleNormal(vec3 o, float alpha, vec2 u) {
  vec3 stretched = normalize(vec3(alpha * o.xy, o.z));
  float phi = 6.28318530717958647692 * u.x;
  float z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
  float sine = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  vec3 h = vec3(sine * cos(phi), sine * sin(phi), z) + stretched;
  return normalize(vec3(alpha * h.xy, max(h.z, 1e-9)));
}

float masking(float cosine, float alpha) {
  float a2 = alpha * alpha;
  return 2.0 * cosine / (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine));
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(kSize)))) return;
  float cos_o = coordinate(at.x), alpha = coordinate(at.y);
  vec3 o = vec3(sqrt(max(0.0, 1.0 - cos_o * cos_o)), 0.0, cos_o);
  float scale = 0.0, bias = 0.0;
  for (uint i = 0u; i < kSamples; ++i) {
    vec2 u = vec2((float(i) + 0.5) / float(kSamples), float(bitfieldReverse(i) >> 8) / 16777216.0);
    vec3 h = visibleNormal(o, alpha, u);
    float o_h = dot(o, h);
    vec3 incoming = 2.0 * o_h * h - o;
    if (!(incoming.z > 0.0) || !(o_h > 0.0)) continue;
    float share = ggxVisibility(incoming.z, cos_o, alpha) * 4.0 * incoming.z * cos_o / masking(cos_o, alpha);
    float fresnel = schlickWeight(o_h);
    scale += share * (1.0 - fresnel);
    bias += share * fresnel;
  }
  imageStore(u_table, at, vec4(scale, bias, 0.0, 0.0) / float(kSamples));
}
