// Which clusters of entries are lit at all: the others are not read.
layout(local_size_x = 64) in;
#include "invocation.glsl"
layout(std430, binding = 1) readonly buffer Product { vec4 x[]; };
layout(std430, binding = 2) readonly buffer Clusters { uvec2 cluster[]; };  // first place, places
layout(std430, binding = 3) writeonly buffer Lit { uint lit[]; };
uniform uint u_clusters;

void main() {
  uint c = invocationIndex();
  if (c >= u_clusters) return;
  uint any_light = 0u;
  for (uint i = 0u; i < cluster[c].y; ++i)
    if (x[cluster[c].x + i].xyz != vec3(0.0)) any_light = 1u;
  lit[c] = any_light;
}
