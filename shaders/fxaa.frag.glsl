// Edges smoothed along their direction after the picture was made (Lottes, FXAA white paper, 2009; the short form:
// direction from the luma of the corners, two and four taps along it, the wider ones kept where they stay within
// the luma about).
layout(binding = 0) uniform sampler2D u_picture;  // alpha: luma
uniform vec2 u_pixel;                             // size of one
uniform uint u_smooth;
in vec2 v_uv;
layout(location = 0) out vec4 o_colour;

void main() {
  vec4 here = texture(u_picture, v_uv);
  if (u_smooth == 0u) { o_colour = vec4(here.rgb, 1.0); return; }
  float nw = textureOffset(u_picture, v_uv, ivec2(-1, 1)).a, ne = textureOffset(u_picture, v_uv, ivec2(1, 1)).a;
  float sw = textureOffset(u_picture, v_uv, ivec2(-1, -1)).a, se = textureOffset(u_picture, v_uv, ivec2(1, -1)).a;
  float lo = min(here.a, min(min(nw, ne), min(sw, se))), hi = max(here.a, max(max(nw, ne), max(sw, se)));
  if (hi - lo < max(0.0312, 0.125 * hi)) { o_colour = vec4(here.rgb, 1.0); return; }
  vec2 way = vec2((nw + ne) - (sw + se), (nw + sw) - (ne + se));
  float damp = max(0.25 * (nw + ne + sw + se) * 0.125, 1.0 / 128.0);
  way = clamp(way / (min(abs(way.x), abs(way.y)) + damp), vec2(-8.0), vec2(8.0)) * u_pixel;
  vec4 a = 0.5 * (texture(u_picture, v_uv - way / 6.0) + texture(u_picture, v_uv + way / 6.0));
  vec4 b = 0.5 * a + 0.25 * (texture(u_picture, v_uv - 0.5 * way) + texture(u_picture, v_uv + 0.5 * way));
  o_colour = vec4((b.a < lo || b.a > hi ? a : b).rgb, 1.0);
}
