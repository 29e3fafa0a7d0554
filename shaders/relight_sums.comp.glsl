// Irradiance of groups: the sum over lights of strength * factor. Entries go to their place among the columns of the
// product; what is beyond them keeps its own.
#include "lights.glsl"

layout(local_size_x = 64) in;
#include "invocation.glsl"
layout(std430, binding = 1) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 2) readonly buffer Factors { float factors[]; };
layout(std430, binding = 3) readonly buffer Columns { uint column[]; };  // place of an entry
layout(std430, binding = 4) writeonly buffer Product { vec4 x[]; };            // by place
layout(std430, binding = 5) writeonly buffer Irradiances { vec4 irradiance[]; };  // by group

uniform uint u_lights, u_groups, u_entries;

void main() {
  uint g = invocationIndex();
  if (g >= u_groups) return;
  vec3 sum = vec3(0.0);
  for (uint l = 0u; l < u_lights; ++l) sum += lights[l].strength_area.rgb * factors[l * u_groups + g];
  irradiance[g] = vec4(sum, 0.0);
  if (g < u_entries) x[column[g]] = vec4(sum, 0.0);
}
