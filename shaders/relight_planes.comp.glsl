// Rows of a tile: the sum over its components of coefficient * plane. An invocation has the rows of one word of
// samples, ROWS of them; SLICES invocations share a word's components and add up what they found.
layout(local_size_x = WORDS, local_size_y = SLICES) in;
#include "invocation.glsl"

#if BITS == 8
#define ROWS 4
#define UNPACK unpackSnorm4x8
#define SHARES vec4
#else
#define ROWS 2
#define UNPACK unpackSnorm2x16
#define SHARES vec2
#endif

struct Chunk {
  uint planes;     // first word of the tile
  uint words;      // of a plane of the tile
  uint word;       // first of this chunk
  uint blocks;     // first block of the tile
  uint rows;       // where the tile's rows go
  uint components; // first of the tile
  uint unused0, unused1;
};
layout(std430, binding = 1) readonly buffer Chunks { Chunk chunks[]; };
layout(std430, binding = 2) readonly buffer Planes { uint planes[]; };
layout(std430, binding = 3) readonly buffer Coefficients { vec4 coefficient[]; };
layout(std430, binding = 4) readonly buffer BlockFirst { uint block_first[]; };
layout(std430, binding = 5) readonly buffer Lit { uint lit[]; };
layout(std430, binding = 6) writeonly buffer Rows { vec4 rows[]; };
uniform uint u_clusters, u_chunks;

#if SLICES > 1
shared SHARES s_sum[SLICES][WORDS][3];
#endif

void main() {
  uint g = groupIndex();
  if (g >= u_chunks) return;  // the whole group
  Chunk chunk = chunks[g];
  uint lane = gl_LocalInvocationID.x, slice = gl_LocalInvocationID.y;
  uint word = chunk.word + lane;
  SHARES red = SHARES(0.0), green = SHARES(0.0), blue = SHARES(0.0);
  if (word < chunk.words) {
    for (uint c = 0u; c < u_clusters; ++c) {
      if (lit[c] == 0u) continue;
      uint end = block_first[chunk.blocks + c + 1u];
      for (uint k = block_first[chunk.blocks + c] + slice; k < end; k += uint(SLICES)) {
        vec3 a = coefficient[k].xyz;
        uint at = chunk.planes + (k - chunk.components) * (uint(CHANNELS) * chunk.words) + word;
        SHARES p = UNPACK(planes[at]);
        red += a.x * p;
#if CHANNELS == 3
        green += a.y * UNPACK(planes[at + chunk.words]);
        blue += a.z * UNPACK(planes[at + 2u * chunk.words]);
#else
        green += a.y * p;
        blue += a.z * p;
#endif
      }
    }
  }
#if SLICES > 1
  s_sum[slice][lane][0] = red;
  s_sum[slice][lane][1] = green;
  s_sum[slice][lane][2] = blue;
  barrier();
  if (slice > 0u) return;
  for (uint s = 1u; s < uint(SLICES); ++s) {
    red += s_sum[s][lane][0];
    green += s_sum[s][lane][1];
    blue += s_sum[s][lane][2];
  }
#endif
  if (word >= chunk.words) return;
  uint row = chunk.rows + word * uint(ROWS);
  for (int i = 0; i < ROWS; ++i) rows[row + uint(i)] = vec4(red[i], green[i], blue[i], 0.0);
}
