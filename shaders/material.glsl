// Materials as the scene has them, and where their textures are looked up.
struct MapUse {
  vec4 row;      // of the matrix of KHR_texture_transform, by rows
  vec2 offset;
  uint set;      // of texture coordinates
  uint present;  // 0: there is no map
};

struct Material {
  vec4 base_colour;
  vec4 emission_alpha;  // radiance; w unused
  float metallic, roughness, normal_scale, alpha_cutoff;
  uint alpha_mode, unlit, double_sided;
  float height_scale;  // depth of the relief, a share of its map's width
  MapUse base, metallic_roughness, normal, emission, height;
};

const uint kAlphaOpaque = 0u, kAlphaMask = 1u, kAlphaBlend = 2u;

layout(std430, binding = 0) readonly buffer Materials { Material materials[]; };
layout(binding = 0) uniform sampler2D u_base;
layout(binding = 1) uniform sampler2D u_metallic_roughness;
layout(binding = 2) uniform sampler2D u_normal;
layout(binding = 3) uniform sampler2D u_emission;

vec2 uvOf(MapUse map, vec4 uv01, vec4 uv23) {
  vec2 uv = map.set == 0u ? uv01.xy : map.set == 1u ? uv01.zw : map.set == 2u ? uv23.xy : uv23.zw;
  return vec2(dot(map.row.xy, uv), dot(map.row.zw, uv)) + map.offset;
}

// How the map's coordinates change with the mesh's.
vec2 changeOf(MapUse map, vec4 by01, vec4 by23) { return uvOf(map, by01, by23) - map.offset; }

// The map between its levels, by how the mesh's coordinates change from pixel to pixel (see surface.frag.glsl).
#define LOOK_UP_MESH(pixels, map, uv01, uv23) \
  textureGrad(pixels, uvOf(map, uv01, uv23), changeOf(map, dFdx(uv01), dFdx(uv23)), changeOf(map, dFdy(uv01), dFdy(uv23)))
