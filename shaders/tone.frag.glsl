// Exposure and tone curve (libs/image/src/colour.cpp: Hable's), then sRGB.
layout(binding = 0) uniform sampler2D u_picture;
uniform float u_scale;
uniform uint u_filmic;
in vec2 v_uv;
layout(location = 0) out vec4 o_colour;

vec3 hable(vec3 x) {
  return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
}

void main() {
  vec3 c = min(max(texture(u_picture, v_uv).rgb * u_scale, vec3(0.0)), vec3(1e6));
  if (u_filmic != 0u) c = hable(c) / hable(vec3(11.2));
  c = min(c, vec3(1.0));
  vec3 low = 12.92 * c, high = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
  vec3 srgb = mix(high, low, vec3(lessThanEqual(c, vec3(0.0031308))));
  o_colour = vec4(srgb, dot(srgb, vec3(0.299, 0.587, 0.114)));  // luma for the filter after it
}
