// Texels out of exits, by interpolation within their chart; where short ways were left out,
// (far + c E) / (1 - c) with the share c of near directions and the direct irradiance E.
layout(local_size_x = 64) in;
#include "invocation.glsl"
layout(std430, binding = 1) readonly buffer First { uint first[]; };
layout(std430, binding = 2) readonly buffer Taps { uvec2 tap[]; };  // exit, bits of its weight
layout(std430, binding = 3) readonly buffer Exits { vec4 exits[]; };
layout(std430, binding = 4) readonly buffer Texels { uint texel[]; };  // place in the pages
layout(std430, binding = 5) readonly buffer Near { vec4 near[]; };
layout(std430, binding = 6) readonly buffer Irradiances { vec4 irradiance[]; };
layout(rgba32f, binding = 0) writeonly uniform image2DArray u_pages;
uniform uint u_texels, u_has_near, u_first_direct;

void main() {
  uint i = invocationIndex();
  if (i >= u_texels) return;
  vec3 e = vec3(0.0);
  for (uint k = first[i]; k < first[i + 1u]; ++k) e += uintBitsToFloat(tap[k].y) * exits[tap[k].x].xyz;
  if (u_has_near != 0u) {
    vec3 c = near[i].xyz;
    e = (e + c * irradiance[u_first_direct + i].xyz) / (1.0 - c);
  }
  ivec2 size = imageSize(u_pages).xy;
  int at = int(texel[i]), row = at / size.x;
  imageStore(u_pages, ivec3(at % size.x, row % size.y, row / size.y), vec4(e, 1.0));
}
