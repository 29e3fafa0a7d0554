// Directional light maps (Hey, Purgathofer 2002): for each of a set of directions that all surfaces share, the
// irradiance on a plane perpendicular to it. One pass over a texel's directions gives diffuse and glossy light: the
// functions of libs/basis/src/bases/directions.cpp and libs/basis/src/glossy.cpp, which says why.
// DIRECTIONS is their number, GLOSS how surfaces reflect: 0 diffusely, 1 as GGX, 2 as Phong's lobe as wide.
struct DirectionPoint {
  vec3 way;
  uint nearest;  // numbers of the four directions nearest to it, a byte each, nearest first
};
struct DirectionRectangle {
  vec2 corner, size;  // texels
  float most;         // irradiance that 1 stands for
  float unused0, unused1, unused2;
};
layout(std430, binding = 11) readonly buffer DirectionSet { vec4 direction_of[]; };
layout(std430, binding = 12) readonly buffer DirectionPoints { DirectionPoint direction_points[]; };
layout(std430, binding = 13) readonly buffer DirectionCharts { vec4 direction_charts[]; };  // x, y, width, height
layout(std430, binding = 14) readonly buffer DirectionRectangles { DirectionRectangle direction_rectangles[]; };
layout(binding = 14) uniform usampler2DArray u_chart;        // of the atlas: number of the chart + 1
layout(binding = 15) uniform sampler2DArray u_directions;   // by direction, shares of `most`

const int kDirectionPoints = 24 * DIRECTIONS;
const float kFacing = 0.1, kLeastRoughness = 0.04, kLeastViewCosine = 0.05;

uint chartAt(vec2 uv, int page) {
  ivec2 size = textureSize(u_chart, 0).xy;
  const vec2 around[5] = vec2[5](vec2(0.0), vec2(-0.5, 0.0), vec2(0.5, 0.0), vec2(0.0, -0.5), vec2(0.0, 0.5));
  for (int i = 0; i < 5; ++i) {
    uint chart = texelFetch(u_chart, ivec3(clamp(ivec2(floor(uv * vec2(size) + around[i])), ivec2(0), size - 1), page), 0).x;
    if (chart != 0u) return chart;
  }
  return 0u;
}

// A lobe so much rougher that light from one of the points looks as if it came from a Gaussian as wide.
float widenedRoughness(float roughness) {
  float alpha = max(roughness, kLeastRoughness);
  alpha *= alpha;
  float own = 0.5 / (alpha * alpha), points = float(kDirectionPoints);
  float wide = own * points / (own + points);
  return sqrt(min(sqrt(0.5 / wide), 1.0));
}
float widenedExponent(float roughness) {
  float alpha = max(roughness, kLeastRoughness);
  alpha *= alpha;
  float own = 0.5 / (alpha * alpha);
  return own * float(kDirectionPoints) / (own + float(kDirectionPoints));
}

vec2 reflectedAt(float cosine, float alpha) {
  return texture(u_reflected, (sqrt(clamp(vec2(cosine, alpha), 0.0, 1.0)) * 31.0 + 0.5) / 32.0).xy;
}

// Radiance to the eye; `n` the surface's own normal, for which light is known, `nd` with its detail.
vec3 directionalLight(vec2 uv, int page, vec3 n, vec3 nd, vec3 to_viewer, vec3 base, float metallic, float roughness,
                      vec3 without) {
  uint chart = chartAt(uv, page);
  if (chart == 0u) return without;
  vec4 box = direction_charts[chart - 1u];
  vec2 inside = (uv * vec2(textureSize(u_chart, 0).xy) - box.xy) / max(box.zw, vec2(1.0));
  vec3 held[DIRECTIONS];
  float cosine[DIRECTIONS];
  vec3 e = vec3(0.0);
  for (int i = 0; i < DIRECTIONS; ++i) {
    DirectionRectangle r = direction_rectangles[int(chart - 1u) * DIRECTIONS + i];
    held[i] = vec3(0.0);
    if (r.size.x > 0.0) {
      vec2 at = r.corner + clamp(inside * r.size, vec2(0.5), r.size - 0.5);
      held[i] = r.most * textureLod(u_directions, vec3(at / vec2(textureSize(u_directions, 0).xy), float(i)), 0.0).rgb;
    }
    cosine[i] = dot(direction_of[i].xyz, n);
    e += max(dot(direction_of[i].xyz, nd), 0.0) * held[i];
  }
#if GLOSS == 0
  return base * e * kInvPi;
#else
  // Of each direction: what its share of the sphere sends, and what of that the lobe mirrors, apart from F0 and with it.
  float sent[DIRECTIONS], mirrored[DIRECTIONS], grazing[DIRECTIONS];
  for (int i = 0; i < DIRECTIONS; ++i) sent[i] = mirrored[i] = grazing[i] = 0.0;
  float view = max(dot(nd, to_viewer), kLeastViewCosine);
  float wide = widenedRoughness(roughness), alpha = wide * wide, exponent = widenedExponent(roughness);
  vec3 mirror = reflect(-to_viewer, nd);
  for (int k = 0; k < kDirectionPoints; ++k) {
    DirectionPoint p = direction_points[k];
    float z = dot(p.way, n);
    if (!(z > 0.0)) continue;
    uint nearest = p.nearest;
    int i = int(nearest & 255u);
    for (int rank = 0; rank < 3 && !(cosine[i] > kFacing); ++rank) nearest >>= 8, i = int(nearest & 255u);
    if (!(cosine[i] > kFacing)) continue;
    sent[i] += z;
    float n_l = dot(nd, p.way);
    if (!(n_l > 0.0)) continue;
#if GLOSS == 1
    vec3 h = normalize(p.way + to_viewer);
    float lobe = ggxDistribution(dot(nd, h), alpha) * ggxVisibility(n_l, view, alpha) * n_l;
    float weight = schlickWeight(dot(to_viewer, h));
    mirrored[i] += lobe * (1.0 - weight);
    grazing[i] += lobe * weight;
#else
    mirrored[i] += (exponent + 2.0) * 0.5 * kInvPi * pow(max(dot(mirror, p.way), 0.0), exponent) * n_l;
#endif
  }
  vec3 whole = vec3(0.0), added = vec3(0.0);
  for (int i = 0; i < DIRECTIONS; ++i)
    if (sent[i] > 0.0) {
      vec3 light = held[i] * (cosine[i] / sent[i]);
      whole += light * mirrored[i];
      added += light * grazing[i];
    }
#if GLOSS == 1
  vec2 table = reflectedAt(view, alpha);
  float more = 1.0 / (table.x + table.y) - 1.0;
  vec3 metal = (1.0 + base * more) * (base * whole + added);
  vec3 dielectric = (1.0 + kDielectric * more) * (kDielectric * whole + added);
  float own = max(roughness, kLeastRoughness);
  vec2 sharp = reflectedAt(view, own * own);
  float albedo = (kDielectric * sharp.x + sharp.y) * (1.0 + kDielectric * (1.0 / (sharp.x + sharp.y) - 1.0));
#else
  vec3 metal = base * whole, dielectric = kDielectric * whole;
  float albedo = kDielectric;
#endif
  return metallic * metal + (1.0 - metallic) * ((1.0 - albedo) * base * e * kInvPi + dielectric);
#endif
}
