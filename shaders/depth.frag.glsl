// Depth alone, so that each place is shaded once.
#include "material.glsl"
in vec4 v_uv01;
in vec4 v_uv23;
in vec4 v_colour;
uniform uint u_material;

void main() {
  Material m = materials[u_material];
  if (m.alpha_mode != kAlphaMask) return;
  float alpha = m.base_colour.a * v_colour.a;
  if (m.base.present != 0u) alpha *= LOOK_UP_MESH(u_base, m.base, v_uv01, v_uv23).a;
  if (alpha < m.alpha_cutoff) discard;
}
