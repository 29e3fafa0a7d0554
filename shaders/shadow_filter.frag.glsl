// A tent of three by three texels over shadow moments, by four bilinear look-ups; over the edges of a cube too.
#ifdef CUBE
layout(binding = 0) uniform samplerCube u_source;
uniform int u_face;
#else
layout(binding = 0) uniform sampler2D u_source;
#endif
uniform float u_texel;  // width of one, of the picture's
uniform float u_radius; // texels

in vec2 v_uv;
layout(location = 0) out vec2 o_moments;

#ifdef CUBE
vec3 directionOf(vec2 uv) {
  vec2 p = 2.0 * uv - 1.0;
  if (u_face == 0) return vec3(1.0, -p.y, -p.x);
  if (u_face == 1) return vec3(-1.0, -p.y, p.x);
  if (u_face == 2) return vec3(p.x, 1.0, p.y);
  if (u_face == 3) return vec3(p.x, -1.0, -p.y);
  if (u_face == 4) return vec3(p.x, -p.y, 1.0);
  return vec3(-p.x, -p.y, -1.0);
}
vec2 at(vec2 uv) { return texture(u_source, directionOf(uv)).xy; }
#else
vec2 at(vec2 uv) { return texture(u_source, uv).xy; }
#endif

void main() {
  float o = 0.5 * u_texel * u_radius;
  o_moments = 0.25 * (at(v_uv + vec2(-o, -o)) + at(v_uv + vec2(o, -o)) + at(v_uv + vec2(-o, o)) + at(v_uv + vec2(o, o)));
}
