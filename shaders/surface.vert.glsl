layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_uv01;
layout(location = 3) in vec4 a_uv23;
layout(location = 4) in vec4 a_tangent;
layout(location = 5) in vec4 a_colour;

uniform mat4 u_world_from_local;
uniform mat4 u_clip_from_world;

invariant gl_Position;

out vec3 v_position;
out vec3 v_normal;
out vec4 v_tangent;
out vec4 v_uv01;
out vec4 v_uv23;
out vec4 v_colour;

void main() {
  vec4 world = u_world_from_local * vec4(a_position, 1.0);
  mat3 m = mat3(u_world_from_local);
  v_position = world.xyz;
  // The cofactor matrix takes normals through any transform, flattening ones too.
  v_normal = cross(m[1], m[2]) * a_normal.x + cross(m[2], m[0]) * a_normal.y + cross(m[0], m[1]) * a_normal.z;
  v_tangent = vec4(m * a_tangent.xyz, a_tangent.w);
  v_uv01 = a_uv01;
  v_uv23 = a_uv23;
  v_colour = a_colour;
  gl_Position = u_clip_from_world * world;
}
