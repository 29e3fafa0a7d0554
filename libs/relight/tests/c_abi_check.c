/* SPDX-License-Identifier: MIT
 * The C interface as a C compiler sees it. */
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

int checkObscuranceFromC(const void* glb, size_t size) {
  relume_relighter* r = NULL;
  CHECK(relume_open(glb, size, "no such layer", &r) == RELUME_NO_SUCH_LAYER && r == NULL);
  CHECK(strstr(relume_last_error(), "no such layer") != NULL);
  CHECK(relume_open(glb, size - 1, NULL, &r) == RELUME_TRUNCATED && r == NULL);
  CHECK(relume_open("no glTF", 7, NULL, &r) == RELUME_NOT_GLTF);
  CHECK(relume_open(NULL, 0, NULL, &r) == RELUME_BAD_ARGUMENT);
  CHECK(relume_open(glb, size, "obscurance", &r) == RELUME_OK && r != NULL);
  CHECK(relume_kind(r) == RELUME_OBSCURANCE && relume_group_count(r) == 0 && relume_group_name(r, 0) == NULL);
  CHECK(relume_point_count(r) == 2 && relume_points(r) == relume_positions(r));

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
  CHECK(relume_evaluate(r, NULL, e, 6) == RELUME_BAD_ARGUMENT);
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

struct Asked {
  size_t calls, points;
};
static void everySecond(void* user, size_t light, float* visibility, size_t point_count) {
  struct Asked* asked = user;
  (void)light;
  ++asked->calls, asked->points = point_count;
  for (size_t i = 0; i < point_count; ++i) visibility[i] = i % 2 == 0 ? 1.0f : 0.0f;
}
static void wrong(void* user, size_t light, float* visibility, size_t point_count) {
  (void)user, (void)light;
  for (size_t i = 0; i < point_count; ++i) visibility[i] = 1.5f;
}

int checkTransferFromC(const void* glb, size_t size, const float* expected) {
  relume_relighter* r = NULL;
  CHECK(relume_open(glb, size - 1, NULL, &r) == RELUME_TRUNCATED && r == NULL);
  CHECK(relume_open(glb, size, "lightpath", &r) == RELUME_OK && r != NULL);
  CHECK(relume_kind(r) == RELUME_TRANSFER && relume_point_count(r) > 0 && relume_points(r) != NULL);
  const float* n = relume_point_normals(r);
  CHECK(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-5f);

  relume_light light;
  memset(&light, 0, sizeof light);
  light.colour[0] = light.colour[1] = light.colour[2] = 1.0f;
  light.intensity = 10.0f;
  light.position[0] = 2.0f, light.position[1] = 1.5f, light.position[2] = 2.5f;
  CHECK(relume_set_lights(r, &light, 1) == RELUME_OK);
  struct Asked asked = {0, 0};
  CHECK(relume_set_visibility(r, everySecond, &asked) == RELUME_OK);
  const size_t floats = 3 * relume_texel_count(r);
  float* e = malloc(floats * sizeof(float));
  CHECK(e != NULL);
  CHECK(relume_evaluate(r, NULL, e, floats - 1) == RELUME_BAD_ARGUMENT);
  CHECK(relume_evaluate(r, NULL, e, floats) == RELUME_OK);
  CHECK(asked.calls == 1 && asked.points == relume_point_count(r));
  CHECK(memcmp(e, expected, floats * sizeof(float)) == 0);
  CHECK(relume_evaluate(r, NULL, e, floats) == RELUME_OK && asked.calls == 1); /* nothing moved */
  CHECK(relume_forget_visibility(r) == RELUME_OK);
  CHECK(relume_evaluate(r, NULL, e, floats) == RELUME_OK && asked.calls == 2);
  CHECK(memcmp(e, expected, floats * sizeof(float)) == 0);

  light.intensity = -1.0f;
  CHECK(relume_set_lights(r, &light, 1) == RELUME_BAD_ARGUMENT);
  CHECK(relume_set_visibility(r, wrong, NULL) == RELUME_OK && relume_forget_visibility(r) == RELUME_OK);
  CHECK(relume_evaluate(r, NULL, e, floats) == RELUME_BAD_ARGUMENT);
  CHECK(strstr(relume_last_error(), "visibility") != NULL);
  CHECK(relume_set_visibility(r, everySecond, &asked) == RELUME_OK);
  CHECK(relume_evaluate(r, NULL, e, floats) == RELUME_OK); /* nothing was lost */
  CHECK(memcmp(e, expected, floats * sizeof(float)) == 0);
  free(e);
  relume_close(r);
  return 0;
}

int checkGroupsFromC(const void* glb, size_t size) {
  relume_relighter* r = NULL;
  CHECK(relume_open(glb, size, NULL, &r) == RELUME_OK && r != NULL);
  CHECK(relume_kind(r) == RELUME_GROUPS && relume_point_count(r) == 0 && relume_group_count(r) == 2);
  CHECK(strcmp(relume_group_name(r, 1), "b") == 0 && relume_group_name(r, 2) == NULL);
  float e[6];
  CHECK(relume_evaluate(r, NULL, e, 6) == RELUME_OK && e[0] == 11.0f && e[5] == 33.0f);
  const float gains[6] = {1, 0, 0.5f, 0, 2, 0};
  CHECK(relume_set_gains(r, gains, 1) == RELUME_BAD_ARGUMENT);
  CHECK(relume_set_gains(r, gains, 2) == RELUME_OK);
  CHECK(relume_evaluate(r, NULL, e, 6) == RELUME_OK && e[0] == 1.0f && e[1] == 40.0f && e[2] == 1.5f);
  const float bad[6] = {1, 0, 0.5f, 0, NAN, 0};
  CHECK(relume_set_gains(r, bad, 2) == RELUME_BAD_ARGUMENT);
  CHECK(relume_set_gains(NULL, gains, 2) == RELUME_BAD_ARGUMENT);
  relume_close(r);
  return 0;
}
