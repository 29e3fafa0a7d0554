// What one light of unit strength gives each group of points: an entry is a mix of what the points of its patch have
// (asset/transfer.h, Entries), a texel where short ways are left out has its own point's. Groups are the entries, then
// those texels.
layout(local_size_x = 64) in;
#include "invocation.glsl"
layout(std430, binding = 2) readonly buffer Received { float received[]; };
layout(std430, binding = 3) readonly buffer Mixes { uvec4 of_entry[]; };  // its first point, first mix, stride of mixes
layout(std430, binding = 5) readonly buffer Mix { float mixes[]; };
layout(std430, binding = 4) writeonly buffer Factors { float factors[]; };  // [light][group]

uniform uint u_light;
uniform uint u_entries;  // groups of u_samples points
uniform uint u_samples;
uniform uint u_groups;        // entries and single points
uniform uint u_first_single;  // point

void main() {
  uint g = invocationIndex();
  if (g >= u_groups) return;
  float sum = 0.0;
  if (g < u_entries) {
    uvec4 entry = of_entry[g];
    for (uint k = 0u; k < u_samples; ++k) sum += mixes[entry.y + k * entry.z] * received[entry.x + k];
  } else {
    sum = received[u_first_single + (g - u_entries)];
  }
  factors[u_light * u_groups + g] = sum;
}
