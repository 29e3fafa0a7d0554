// Visibility of lights by variance shadow maps (Donnelly, Lauritzen 2006), which keep the mean of the distance
// to what the light sees and of its square: the share of a filtered place that is at least as far as the receiver
// is at most variance / (variance + (d - mean)^2) (Chebyshev). The lower part of that bound, where light bleeds
// through, is cut off and the rest stretched. Distances are in metres.

layout(binding = 8) uniform samplerCubeArray u_cubes;   // of point, spot and area lights
layout(binding = 9) uniform sampler2DArray u_planes;    // of directional lights
layout(std430, binding = 9) readonly buffer PlaneMatrices { mat4 map_from_world[]; };

uniform float u_cube_texel;   // width of a texel at distance 1
uniform float u_bleeding;     // share of the bound that is cut off

float visibleShare(vec2 moments, float d, float texel) {
  if (d <= moments.x) return 1.0;
  // What rounding and the width of a texel make of a flat surface.
  float least = 0.25 * texel * texel + 1e-8 * d * d;
  float variance = max(moments.y - moments.x * moments.x, least);
  float away = d - moments.x;
  float bound = variance / (variance + away * away);
  return smoothstep(u_bleeding, 1.0, bound);
}

// p is moved off its surface by the width of a shadow texel, as far as the light grazes it.
float visibility(Light light, vec3 p, vec3 n_geometric) {
  int layer = int(light.cone.w);
  if (layer < 0) return 1.0;
  float r;
  vec3 way = wayTo(light, p, r);
  float cosine = clamp(abs(dot(n_geometric, way)), 0.0, 1.0);
  float grazing = sqrt(1.0 - cosine * cosine);
  if (kindOf(light) == kDirectional) {
    mat4 m = map_from_world[layer];
    // Rows of the matrix: texture coordinates, and distance in metres.
    float texel = 1.0 / (length(vec3(m[0].x, m[1].x, m[2].x)) * float(textureSize(u_planes, 0).x));
    vec3 q = (m * vec4(p + n_geometric * texel * (0.5 + 1.5 * grazing), 1.0)).xyz;
    if (any(lessThan(q.xy, vec2(0.0))) || any(greaterThan(q.xy, vec2(1.0)))) return 1.0;
    return visibleShare(texture(u_planes, vec3(q.xy, float(layer))).xy, q.z, texel);
  }
  vec3 off = p - light.shadow_origin.xyz;
  float texel = u_cube_texel * length(off);
  off += n_geometric * texel * (0.5 + 1.5 * grazing);
  return visibleShare(texture(u_cubes, vec4(off, float(layer))).xy, length(off), texel);
}
