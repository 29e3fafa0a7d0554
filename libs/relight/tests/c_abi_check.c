/* SPDX-License-Identifier: MIT
 * The C interface as a C compiler sees it. Returns 0, or the line of the check that failed. */
#include "c_abi_check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "relume/relight/relume.h"

#define CHECK(condition) \
  if (!(condition)) return __LINE__

/* Light 0 is seen by texel 0 alone. */
static void firstTexelOnly(void* user, size_t light, float* visibility, size_t texel_count) {
  ++*(int*)user;
  for (size_t i = 0; i < texel_count; ++i) visibility[i] = light == 0 && i > 0 ? 0.0f : 1.0f;
}

int checkCAbi(const void* glb, size_t size) {
  relume_relighter* r = NULL;
  CHECK(relume_open(glb, size, "no such layer", &r) == RELUME_NO_SUCH_LAYER && r == NULL);
  CHECK(strstr(relume_last_error(), "no such layer") != NULL);
  CHECK(relume_open(glb, size - 1, NULL, &r) == RELUME_TRUNCATED && r == NULL);
  CHECK(relume_open("no glTF", 7, NULL, &r) == RELUME_NOT_GLTF);
  CHECK(relume_open(NULL, 0, NULL, &r) == RELUME_BAD_ARGUMENT);
  CHECK(relume_open(glb, size, "obscurance", &r) == RELUME_OK && r != NULL);

  const size_t count = relume_texel_count(r);
  uint32_t width, height, pages;
  relume_atlas_size(r, &width, &height, &pages);
  CHECK(count == 2 && width == 2 && height == 1 && pages == 1);
  CHECK(relume_texels(r)[1] == 1 && relume_positions(r)[3] == 1.0f && relume_normals(r)[1] == 1.0f);

  relume_light light;
  memset(&light, 0, sizeof light);
  light.kind = RELUME_DIRECTIONAL;
  light.colour[0] = light.colour[1] = light.colour[2] = 1.0f;
  light.intensity = 3.0f;
  CHECK(relume_set_lights(r, &light, 1) == RELUME_BAD_ARGUMENT); /* its direction is zero */
  light.direction[1] = -2.0f;
  CHECK(relume_set_lights(r, &light, 1) == RELUME_OK);
  CHECK(relume_set_lights(r, NULL, 1) == RELUME_BAD_ARGUMENT);
  light.kind = 7;
  CHECK(relume_set_lights(r, &light, 1) == RELUME_BAD_ARGUMENT);
  light.kind = RELUME_DIRECTIONAL;
  light.intensity = NAN;
  CHECK(relume_set_lights(r, &light, 1) == RELUME_BAD_ARGUMENT);

  /* E = (I_A + beta * 3) W + 3 with W = 0.5 and 0.25 */
  relume_settings settings = {{1.0f, 2.0f, 4.0f}, 0.5f};
  float e[6];
  CHECK(relume_evaluate(r, &settings, e, 5) == RELUME_BAD_ARGUMENT);
  CHECK(relume_evaluate(r, &settings, e, 6) == RELUME_OK);
  CHECK(fabsf(e[0] - 4.25f) < 1e-5f && fabsf(e[2] - 5.75f) < 1e-5f && fabsf(e[3] - 3.625f) < 1e-5f);

  int calls = 0;
  CHECK(relume_set_visibility(r, firstTexelOnly, &calls) == RELUME_OK);
  CHECK(relume_evaluate(r, &settings, e, 6) == RELUME_OK && calls == 1);
  CHECK(fabsf(e[0] - 4.25f) < 1e-5f && fabsf(e[3] - 0.625f) < 1e-5f);
  settings.beta = 1.5f;
  CHECK(relume_evaluate(r, &settings, e, 6) == RELUME_BAD_ARGUMENT);

  relume_close(r);
  relume_close(NULL);
  CHECK(relume_texel_count(NULL) == 0);
  return 0;
}
