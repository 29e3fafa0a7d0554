// The ring of texels about charts that bilinear look-ups at their edges read: the mean of the covered texels among
// their eight neighbours.
layout(local_size_x = 64) in;
#include "invocation.glsl"
layout(std430, binding = 1) readonly buffer Ring { uvec2 ring[]; };  // place in the pages, bits of covered neighbours
layout(rgba32f, binding = 0) coherent uniform image2DArray u_pages;
uniform uint u_count;

void main() {
  uint i = invocationIndex();
  if (i >= u_count) return;
  ivec2 size = imageSize(u_pages).xy;
  int at = int(ring[i].x), row = at / size.x;
  ivec3 own = ivec3(at % size.x, row % size.y, row / size.y);
  vec3 sum = vec3(0.0);
  float count = 0.0;
  for (int n = 0; n < 9; ++n) {
    if ((ring[i].y & (1u << n)) == 0u) continue;
    sum += imageLoad(u_pages, own + ivec3(n % 3 - 1, n / 3 - 1, 0)).rgb;
    count += 1.0;
  }
  imageStore(u_pages, own, vec4(sum / count, 1.0));
}
