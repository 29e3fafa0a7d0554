// Coefficient of each component: scale * sum over the columns of its cluster of weight * irradiance, with
// weight = sign(q) (q / max)^2 (libs/codec/include/relume/codec/block_matrix.h).
layout(local_size_x = 64) in;
#include "invocation.glsl"

struct Component {
  uint weights;   // first word
  uint place;     // first of its columns
  uint words;     // of samples; the last ones are 0
  float scale;    // over the largest sample of planes, which come as shares of it
};
layout(std430, binding = 1) readonly buffer Product { vec4 x[]; };
layout(std430, binding = 2) readonly buffer Components { Component component[]; };
layout(std430, binding = 3) readonly buffer Weights { uint weights[]; };
layout(std430, binding = 4) writeonly buffer Coefficients { vec4 coefficient[]; };
layout(std430, binding = 5) readonly buffer Lit { uint lit[]; };
layout(std430, binding = 6) readonly buffer ClusterOf { uint cluster_of[]; };
uniform uint u_components;

void main() {
  uint k = invocationIndex();
  if (k >= u_components) return;
  if (lit[cluster_of[k]] == 0u) return;  // nothing reads it
  Component c = component[k];
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < c.words; ++i) {
    uint word = weights[c.weights + i];
#if BITS == 8
    vec4 q = unpackSnorm4x8(word);
    vec4 w = q * abs(q);
    uint j = c.place + 4u * i;
    sum += w.x * x[j].xyz + w.y * x[j + 1u].xyz + w.z * x[j + 2u].xyz + w.w * x[j + 3u].xyz;
#else
    vec2 q = unpackSnorm2x16(word);
    vec2 w = q * abs(q);
    uint j = c.place + 2u * i;
    sum += w.x * x[j].xyz + w.y * x[j + 1u].xyz;
#endif
  }
  coefficient[k] = vec4(c.scale * sum, 0.0);
}
