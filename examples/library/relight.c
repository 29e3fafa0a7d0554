/* SPDX-License-Identifier: MIT
 * Carries a lamp through a baked scene by the C interface: the light of every texel, frame by frame.
 *   relight BAKE.glb LAYER [FRAMES]
 * An engine would fill `visibility` from its shadow maps and upload the irradiance as a texture. */
#include <relume/relight/relume.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Everything that the lamp faces is taken for lit: this program has no shadow maps. */
static void seenEverywhere(void* user, size_t light, float* visibility, size_t point_count) {
  (void)user, (void)light;
  for (size_t i = 0; i < point_count; ++i) visibility[i] = 1.0f;
}

static unsigned char* readWhole(const char* path, size_t* size) {
  FILE* file = fopen(path, "rb");
  if (!file) return NULL;
  fseek(file, 0, SEEK_END);
  const long length = ftell(file);
  rewind(file);
  unsigned char* bytes = length > 0 ? malloc((size_t)length) : NULL;
  *size = bytes ? fread(bytes, 1, (size_t)length, file) : 0;
  fclose(file);
  return bytes;
}

/* A place at `share` of the way through the middle of all surfaces. */
static void place(const relume_relighter* r, float share, float* position) {
  const float* p = relume_positions(r);
  for (int c = 0; c < 3; ++c) {
    float lo = p[c], hi = p[c];
    for (size_t i = 1; i < relume_texel_count(r); ++i) {
      if (p[3 * i + c] < lo) lo = p[3 * i + c];
      if (p[3 * i + c] > hi) hi = p[3 * i + c];
    }
    position[c] = lo + (c == 0 ? 0.2f + 0.6f * share : 0.5f) * (hi - lo);
  }
}

int main(int argc, char** argv) {
  if (argc < 3) {
    fprintf(stderr, "usage: %s BAKE.glb LAYER [FRAMES]\n", argv[0]);
    return 2;
  }
  const int frames = argc > 3 ? atoi(argv[3]) : 5;
  size_t size = 0;
  unsigned char* bytes = readWhole(argv[1], &size);
  relume_relighter* r = NULL;
  if (relume_open(bytes, size, argv[2], &r) != RELUME_OK) {
    fprintf(stderr, "%s: %s\n", argv[1], relume_last_error());
    free(bytes);
    return 1;
  }
  free(bytes);

  const size_t texels = relume_texel_count(r);
  float* irradiance = malloc(3 * sizeof(float) * (texels + 1));
  const relume_settings settings = {{0.1f, 0.1f, 0.1f}, 0.1f}; /* read by obscurance alone */
  relume_light lamp;
  memset(&lamp, 0, sizeof lamp);
  lamp.kind = RELUME_POINT;
  lamp.colour[0] = 1.0f, lamp.colour[1] = 0.8f, lamp.colour[2] = 0.6f;
  lamp.intensity = 10.0f;
  relume_set_visibility(r, seenEverywhere, NULL);
  int status = irradiance && texels ? 0 : 1;
  for (int frame = 0; frame < frames && status == 0; ++frame) {
    place(r, frames > 1 ? (float)frame / (float)(frames - 1) : 0.5f, lamp.position);
    if (relume_set_lights(r, &lamp, 1) != RELUME_OK ||
        relume_evaluate(r, &settings, irradiance, 3 * texels) != RELUME_OK) {
      fprintf(stderr, "frame %d: %s\n", frame, relume_last_error());
      status = 1;
      break;
    }
    double mean[3] = {0, 0, 0};
    for (size_t i = 0; i < 3 * texels; ++i) mean[i % 3] += irradiance[i] / (double)texels;
    printf("lamp at %.2f %.2f %.2f: mean irradiance %.4f %.4f %.4f W/m^2\n", lamp.position[0],
           lamp.position[1], lamp.position[2], mean[0], mean[1], mean[2]);
  }
  free(irradiance);
  relume_close(r);
  return status;
}
