// What one light of unit strength gives each group of points: the mean of visibility * E * cos over the fixed points
// of an entry (multi-scale PRT, section 10, with a mean over the patch where the paper has one point), or one point
// alone. Groups are the entries, then the texels where short ways are left out.
#include "lights.glsl"
#include "shadows.glsl"

layout(local_size_x = 64) in;
#include "invocation.glsl"
layout(std430, binding = 1) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 2) readonly buffer Points { vec4 points[]; };    // w unused
layout(std430, binding = 3) readonly buffer Normals { vec4 normals[]; };
layout(std430, binding = 4) writeonly buffer Factors { float factors[]; };  // [light][group]

uniform uint u_light;
uniform uint u_entries;  // groups of u_samples points
uniform uint u_samples;
uniform uint u_groups;   // entries and single points
uniform uint u_shadows;

void main() {
  uint g = invocationIndex();
  if (g >= u_groups) return;
  uint first = g < u_entries ? g * u_samples : u_entries * u_samples + (g - u_entries);
  uint count = g < u_entries ? u_samples : 1u;
  Light light = lights[u_light];
  float sum = 0.0;
  for (uint i = first; i < first + count; ++i) {
    vec3 p = points[i].xyz, n = normals[i].xyz;
    float r;
    vec3 way = wayTo(light, p, r);
    float received = incidentFactor(light, way, r) * max(dot(n, way), 0.0);
    if (received > 0.0) sum += u_shadows != 0u ? received * visibility(light, p, n) : received;
  }
  factors[u_light * u_groups + g] = sum / float(count);
}
