// Sums of a sparse matrix by rows: exits out of the rows of tiles that hold them.
layout(local_size_x = 64) in;
#include "invocation.glsl"
layout(std430, binding = 1) readonly buffer First { uint first[]; };
layout(std430, binding = 2) readonly buffer From { uint from[]; };
layout(std430, binding = 3) readonly buffer Source { vec4 source[]; };
layout(std430, binding = 4) writeonly buffer Result { vec4 result[]; };
uniform uint u_rows;

void main() {
  uint i = invocationIndex();
  if (i >= u_rows) return;
  vec4 sum = vec4(0.0);
  for (uint k = first[i]; k < first[i + 1u]; ++k) sum += source[from[k]];
  result[i] = sum;
}
