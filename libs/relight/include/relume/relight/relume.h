/* SPDX-License-Identifier: MIT
 * Relume for engines: C interface of the run-time library. Opens a bake and relights it.
 *
 *   relume_relighter* r;
 *   if (relume_open(bytes, size, "lightpath", &r) != RELUME_OK) puts(relume_last_error());
 *   relume_set_visibility(r, visibility, my_shadow_maps);
 *   relume_set_lights(r, lights, light_count);
 *   relume_evaluate(r, NULL, irradiance, 3 * relume_texel_count(r));
 *   relume_close(r);
 *
 * What comes out depends on the kind of the layer, relume_kind:
 *   RELUME_OBSCURANCE  ambient and direct light, weighed by obscurance
 *   RELUME_TRANSFER    indirect light alone, of lights that move (light path maps); add your direct light
 *   RELUME_GROUPS      what was baked for each group of lamps, times its gain; no lights are set
 *
 * Metres, radians, linear RGB (Rec. 709), glTF's axes. Irradiance is E: a Lambertian surface sends out albedo
 * * E / pi. No function throws or aborts on bad input; a function that fails changes nothing. One relighter
 * may be used by one thread at a time.
 */
#ifndef RELUME_RELIGHT_RELUME_H
#define RELUME_RELIGHT_RELUME_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum relume_status {
  RELUME_OK = 0,
  RELUME_BAD_ARGUMENT = 1, /* null pointer, buffer too small, a number out of range */
  RELUME_NOT_GLTF = 2,
  RELUME_TRUNCATED = 3,
  RELUME_CORRUPT = 4,       /* a checksum or the layout is wrong */
  RELUME_UNSUPPORTED = 5,   /* a newer format version */
  RELUME_NO_SUCH_LAYER = 6, /* no bake, no layer of that name, or not one that can be relit */
  RELUME_OUT_OF_MEMORY = 7,
  RELUME_FAILED = 8 /* anything else; relume_last_error says what */
} relume_status;

typedef enum relume_light_kind {
  RELUME_POINT = 0,
  RELUME_SPOT = 1,
  RELUME_DIRECTIONAL = 2,
  RELUME_AREA = 3
} relume_light_kind;

typedef enum relume_layer_kind {
  RELUME_OBSCURANCE = 0,
  RELUME_TRANSFER = 1,
  RELUME_GROUPS = 2
} relume_layer_kind;

/* An area light is taken for a disk of its area about its middle. Zero all of it before you fill it. */
typedef struct relume_light {
  int32_t kind; /* relume_light_kind */
  float colour[3];
  float intensity;  /* cd (point, spot), lux (directional), radiance (area) */
  float range;      /* metres; 0: unlimited; point and spot */
  float inner_cone; /* radians from the axis; spot; inner < outer <= pi / 2 */
  float outer_cone;
  float position[3];  /* world; all but directional */
  float direction[3]; /* world, the way the light travels, any length above 0; spot, directional; area: the
                         side it shines to */
  float area;         /* m^2 above 0; area lights */
  int32_t two_sided;  /* not 0: shines to the other side too; area lights */
} relume_light;

typedef struct relume_settings {
  float ambient[3]; /* irradiance I_A */
  float beta;       /* share of every light that arrives everywhere as indirect light, 0 to 1; 0.1 is usual */
} relume_settings;

typedef struct relume_relighter relume_relighter;

/* Fills `visibility` (point_count numbers in [0, 1]) for one light, e.g. from its shadow map. */
typedef void (*relume_visibility)(void* user, size_t light, float* visibility, size_t point_count);

/* Opens layer `layer` (null or "": the first) of the .glb in memory; the bytes are not needed afterwards. */
relume_status relume_open(const void* glb, size_t size, const char* layer, relume_relighter** out);
/* Null is allowed. */
void relume_close(relume_relighter* relighter);

/* What the atlas covers. Arrays live as long as the relighter. */
size_t relume_texel_count(const relume_relighter* relighter);
void relume_atlas_size(const relume_relighter* relighter, uint32_t* width, uint32_t* height, uint32_t* pages);
const uint32_t* relume_texels(
    const relume_relighter* relighter); /* (page * height + row) * width + column, row 0 on top */
const float* relume_positions(const relume_relighter* relighter); /* [texel_count][3], world */
const float* relume_normals(const relume_relighter* relighter);   /* [texel_count][3], world */

/* The kind of the layer. */
relume_layer_kind relume_kind(const relume_relighter* relighter);

/* The points about which visibility is asked: the texels of RELUME_OBSCURANCE, the points where light enters
 * of RELUME_TRANSFER (and then the texels, where the bake leaves short ways to obscurance), none of
 * RELUME_GROUPS. Arrays live as long as the relighter. */
size_t relume_point_count(const relume_relighter* relighter);
const float* relume_points(const relume_relighter* relighter);        /* [point_count][3], world */
const float* relume_point_normals(const relume_relighter* relighter); /* [point_count][3], world */

/* Copies the lights. Any count. */
relume_status relume_set_lights(relume_relighter* relighter, const relume_light* lights, size_t count);
/* Null: every light is seen everywhere, as it is at first. `user` is handed to the function. */
relume_status relume_set_visibility(relume_relighter* relighter, relume_visibility function, void* user);
/* RELUME_TRANSFER asks again only about lights that have moved: call this when something else has. */
relume_status relume_forget_visibility(relume_relighter* relighter);

/* Groups of lamps of RELUME_GROUPS; elsewhere there are none. */
size_t relume_group_count(const relume_relighter* relighter);
const char* relume_group_name(const relume_relighter* relighter, size_t group); /* null beyond the last */
/* gains: [group_count][3], 0 and above; `count` is the number of groups. 1 at first: as baked. */
relume_status relume_set_gains(relume_relighter* relighter, const float* gains, size_t count);

/* Irradiance at each texel, [texel_count][3]; `capacity` is the number of floats there is room for. Uses all
 * cores. `settings` may be null but for RELUME_OBSCURANCE, which alone reads them. */
relume_status relume_evaluate(relume_relighter* relighter, const relume_settings* settings, float* irradiance,
                              size_t capacity);

/* What the last failing call on this thread had to say; never null. Valid until the next call on this thread.
 */
const char* relume_last_error(void);

#ifdef __cplusplus
}
#endif
#endif
