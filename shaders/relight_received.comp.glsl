// What one light of unit strength gives each point: visibility * E * cos (multi-scale PRT, section 10). Points are
// those of the entries' patches, then the texels where short ways are left out.
#include "lights.glsl"
#include "shadows.glsl"

layout(local_size_x = 64) in;
#include "invocation.glsl"
layout(std430, binding = 1) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 2) readonly buffer Points { vec4 points[]; };    // w unused
layout(std430, binding = 3) readonly buffer Normals { vec4 normals[]; };
layout(std430, binding = 4) writeonly buffer Received { float received[]; };

uniform uint u_light, u_points, u_shadows;

void main() {
  uint i = invocationIndex();
  if (i >= u_points) return;
  Light light = lights[u_light];
  vec3 p = points[i].xyz, n = normals[i].xyz;
  float r;
  vec3 way = wayTo(light, p, r);
  float e = incidentFactor(light, way, r) * max(dot(n, way), 0.0);
  received[i] = e > 0.0 && u_shadows != 0u ? e * visibility(light, p, n) : e;
}
