// Things that move: indirect light on them, out of a cube map about each or of probes, and what they hide of the
// light on others (libs/render/src/dynamic_objects.h names the papers).
struct Object {
  mat4 volume_from_world;  // to [0, 1]^3 where it hides light
  mat4 world_from_start;
  vec4 centre_occludes;    // middle of its cube map; w: 1 where it hides light
  vec4 box_lo, box_size;   // world
  vec4 harmonics[72];      // [corner][coefficient] of irradiance
};
layout(std430, binding = 10) readonly buffer Objects { Object objects[]; };
layout(binding = 12) uniform samplerCubeArray u_surroundings;  // radiance; alpha: inverse of distance
layout(binding = 13) uniform sampler3D u_hidden;               // of all objects, one behind the other along z

const float kSurroundingsSize = 64.0, kDiffuseLevel = 4.0;
const int kDiffuseSide = 4;

vec3 cubeWay(int face, vec2 p) {
  if (face == 0) return vec3(1.0, -p.y, -p.x);
  if (face == 1) return vec3(-1.0, -p.y, p.x);
  if (face == 2) return vec3(p.x, 1.0, p.y);
  if (face == 3) return vec3(p.x, -1.0, -p.y);
  if (face == 4) return vec3(p.x, -p.y, 1.0);
  return vec3(-p.x, -p.y, -1.0);
}

// Irradiance at p: every texel of a small level of the cube map is a disk that faces the middle, where it is seen.
vec3 surroundingsIrradiance(int object, vec3 p, vec3 n) {
  vec3 away = p - objects[object].centre_occludes.xyz, sum = vec3(0.0);
  float all = 0.0;
  for (int face = 0; face < 6; ++face)
    for (int j = 0; j < kDiffuseSide; ++j)
      for (int i = 0; i < kDiffuseSide; ++i) {
        vec2 q = (vec2(i, j) + 0.5) * (2.0 / float(kDiffuseSide)) - 1.0;
        vec3 way = cubeWay(face, q);
        float r2 = dot(way, way);
        float angle = 4.0 / float(kDiffuseSide * kDiffuseSide) / (r2 * sqrt(r2));
        way *= inversesqrt(r2);
        vec4 texel = textureLod(u_surroundings, vec4(way, float(object)), kDiffuseLevel);
        // With d its distance: y = d way, of area angle d^2; all over d^2, so that infinity is no special case.
        vec3 to = way - away * texel.a;
        float t2 = dot(to, to);
        vec3 w = to * inversesqrt(max(t2, 1e-12));
        sum += texel.rgb * (angle * max(dot(n, w), 0.0) * max(dot(way, w), 0.0) / (t2 + angle * kInvPi));
        all += angle * max(dot(n, way), 0.0) / (1.0 + angle * kInvPi);
      }
  // So that light that is alike on all sides gives pi times itself.
  return sum * (kPi / all);
}

// Radiance along a ray from p, mean over a lobe of that width (GGX's alpha).
vec3 surroundingsRadiance(int object, vec3 p, vec3 way, float alpha) {
  vec3 away = p - objects[object].centre_occludes.xyz;
  float level = clamp(log2(max(alpha * kSurroundingsSize * 0.6, 1.0)), 0.0, 5.0);
  // The ray leaves the middle's sphere where its distance and the map's agree.
  float t = 1.0 / max(textureLod(u_surroundings, vec4(way, float(object)), level).a, 1e-4);
  for (int i = 0; i < 4; ++i) {
    vec3 q = away + t * way;
    t = max(t + 1.0 / max(textureLod(u_surroundings, vec4(q, float(object)), level).a, 1e-4) - length(q), 0.0);
  }
  return textureLod(u_surroundings, vec4(away + t * way, float(object)), level).rgb;
}

// Irradiance out of the harmonics at the corners of the object's box.
vec3 probeIrradiance(int object, vec3 p, vec3 n) {
  vec3 at = clamp((p - objects[object].box_lo.xyz) / objects[object].box_size.xyz, 0.0, 1.0);
  float y[9] = float[9](0.282095, 0.488603 * n.y, 0.488603 * n.z, 0.488603 * n.x, 1.092548 * n.x * n.y, 1.092548 * n.y * n.z,
                        0.315392 * (3.0 * n.z * n.z - 1.0), 1.092548 * n.x * n.z, 0.546274 * (n.x * n.x - n.y * n.y));
  vec3 sum = vec3(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    vec3 side = vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    vec3 w = mix(1.0 - at, at, side);
    vec3 e = vec3(0.0);
    for (int c = 0; c < 9; ++c) e += y[c] * objects[object].harmonics[9 * corner + c].xyz;
    sum += w.x * w.y * w.z * e;
  }
  return max(sum, vec3(0.0));
}

// libs/transport/include/relume/transport/occlusion_volume.h
float hiddenByCap(float share, float cosine) {
  bool large = share > 0.5;
  if (large) share = 1.0 - share, cosine = -cosine;
  float q = 4.0 * share * (1.0 - share), hidden;
  if (q <= 1e-6) {
    hidden = 0.0;
  } else if (cosine * cosine >= q) {
    hidden = max(cosine, 0.0) * q;
  } else {
    float rim = sqrt(max(1.0 - cosine * cosine / q, 0.0)), beyond = sqrt(max(1.0 / q - 1.0, 1e-6));
    float part = cosine * acos(clamp(-cosine * beyond * inversesqrt(1.0 - cosine * cosine), -1.0, 1.0)) - rim * beyond;
    hidden = max((part * q + atan(rim / beyond)) * kInvPi, 0.0);
  }
  return large ? 1.0 - hidden : hidden;
}

// Share of indirect light that objects leave a surface of the standing world.
float leftByObjects(int count, vec3 p, vec3 n) {
  float left = 1.0;
  float side = float(textureSize(u_hidden, 0).x);
  for (int i = 0; i < count; ++i) {
    if (objects[i].centre_occludes.w == 0.0) continue;
    vec3 q = (objects[i].volume_from_world * vec4(p, 1.0)).xyz;
    if (any(lessThan(q, vec3(0.0))) || any(greaterThan(q, vec3(1.0)))) continue;
    float z = (clamp(q.z * side, 0.5, side - 0.5) + side * float(i)) / (side * float(count));
    vec4 cell = texture(u_hidden, vec3(q.xy, z));
    vec3 way = mat3(objects[i].world_from_start) * cell.xyz;
    float l = length(way);
    vec3 rim = min(q, 1.0 - q);
    float fade = smoothstep(0.0, 0.12, min(rim.x, min(rim.y, rim.z)));
    if (l > 1e-4) left *= 1.0 - fade * hiddenByCap(clamp(cell.w, 0.0, 1.0), dot(n, way) / l);
  }
  return left;
}
