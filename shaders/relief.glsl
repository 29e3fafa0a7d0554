// Relief below a surface: a ray goes down through the free cones of a height map until it meets it (Policarpo,
// Oliveira 2007, the strict form, which misses nothing), and up again towards lights. Heights are shares of the
// depth, 1 at the surface; places are texture coordinates of the map.
layout(binding = 11) uniform sampler2D u_relief;  // height, sine of half the cone's aperture, normal's x, y in [0, 1]

const int kReliefSteps = 48, kReliefShadowSteps = 24;
const float kWidestCone = 4.0;    // tangent; libs/image/include/relume/image/relief.h
const float kLeastRise = 0.08;    // cosine below which rays are taken for steeper than they are
const float kReliefMet = 0.004;   // of the depth

// `sink`: texture coordinates per unit of height that the ray goes down; depth: share of the map's width.
// Place and height where it meets the relief.
vec3 meetRelief(vec2 uv, vec2 sink, float depth) {
  vec2 size = vec2(textureSize(u_relief, 0));
  float reach = length(sink * vec2(1.0, size.y / size.x));  // widths per unit of height
  float z = 1.0;
  for (int i = 0; i < kReliefSteps; ++i) {
    vec2 there = textureLod(u_relief, uv, 0.0).xy;
    float above = z - there.x;
    if (above <= kReliefMet) break;
    float tangent = min(there.y * inversesqrt(max(1.0 - there.y * there.y, 1e-6)), kWidestCone) * depth;
    float way = above * tangent / (reach + tangent);
    z -= way;
    uv += sink * way;
  }
  return vec3(uv, max(z, 0.0));
}

// Share of light that arrives at a place of the relief along a ray that goes `rise` per unit of height upwards.
float reliefVisibility(vec3 place, vec2 rise) {
  float hidden = 0.0;
  for (int i = 1; i <= kReliefShadowSteps; ++i) {
    float up = (1.0 - place.z) * (float(i) - 0.5) / float(kReliefShadowSteps);
    hidden = max(hidden, textureLod(u_relief, place.xy + rise * up, 0.0).x - place.z - up);
  }
  return 1.0 - smoothstep(0.01, 0.06, hidden);
}

// Open share of the hemisphere (multi-scale PRT, section 9): 1 + h cos alpha + (1 - h) cos gamma over 2, gamma the
// closed angle of the wedge.
float smallScaleOcclusion(float cos_alpha, float sine, float h) {
  return 0.5 * (1.0 + h * cos_alpha + (1.0 - h) * (2.0 * sine * sine - 1.0));
}
