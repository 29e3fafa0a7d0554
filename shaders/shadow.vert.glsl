// What casts shadows, seen from a light.
layout(location = 0) in vec3 a_position;
layout(location = 2) in vec4 a_uv01;
layout(location = 3) in vec4 a_uv23;
layout(location = 5) in vec4 a_colour;

uniform mat4 u_world_from_local;
uniform mat4 u_clip_from_world;

out vec3 v_position;
out vec4 v_uv01;
out vec4 v_uv23;
out float v_alpha;

void main() {
  vec4 world = u_world_from_local * vec4(a_position, 1.0);
  v_position = world.xyz;
  v_uv01 = a_uv01;
  v_uv23 = a_uv23;
  v_alpha = a_colour.a;
  gl_Position = u_clip_from_world * world;
}
