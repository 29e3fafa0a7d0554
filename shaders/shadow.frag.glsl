// Distance to the light and its square, with what the slope of a surface within the texel adds to the mean square
// (Lauritzen, GPU Gems 3, ch. 8).
#include "material.glsl"

in vec3 v_position;
in vec4 v_uv01;
in vec4 v_uv23;
in float v_alpha;

uniform vec4 u_light;  // w 1: position of the light; w 0: direction of its light
uniform uint u_material;
uniform float u_plane_start;  // distances of directional lights count from this plane

layout(location = 0) out vec2 o_moments;

// The same for the same place: what is half clear leaves half its texels open.
float thresholdAt(vec3 p) {
  uvec3 q = floatBitsToUint(p * 16.0);
  uint h = q.x * 73856093u ^ q.y * 19349663u ^ q.z * 83492791u;
  h ^= h >> 16; h *= 0x7feb352du; h ^= h >> 15; h *= 0x846ca68bu; h ^= h >> 16;
  return float(h >> 8) / 16777216.0;
}

void main() {
  Material m = materials[u_material];
  if (m.alpha_mode != kAlphaOpaque) {
    float alpha = m.base_colour.a * v_alpha;
    if (m.base.present != 0u) alpha *= LOOK_UP_MESH(u_base, m.base, v_uv01, v_uv23).a;
    if (m.alpha_mode == kAlphaMask ? alpha < m.alpha_cutoff : alpha <= thresholdAt(v_position)) discard;
  }
  float d = u_light.w > 0.0 ? length(v_position - u_light.xyz) : dot(v_position, u_light.xyz) - u_plane_start;
  float dx = dFdx(d), dy = dFdy(d);
  // Edge-on surfaces would blur everything about them.
  float slope = min(0.25 * (dx * dx + dy * dy), 0.0025 * d * d);
  o_moments = vec2(d, d * d + slope);
}
