// Irradiance of glTF's lights and of area lights: the functions of libs/core/include/relume/core/light.h,
// tested against them. Text for OpenGL and WebGL 2 alike.

const float kPi = 3.14159265358979323846;
const float kInvPi = 0.31830988618379067154;

const int kPoint = 0, kSpot = 1, kDirectional = 2, kArea = 3;

struct Light {
  vec4 position_kind;   // world; w: kind
  vec4 direction_back;  // the way the light travels; w: 1 where an area light shines to both sides
  vec4 strength_area;   // colour * intensity; m^2
  vec4 cone;            // x: 1 / range^2, 0 without one; y: cosine of the outer cone; z: 1 / the cone's width in
                        // cosines; w: layer of its shadow map, negative: none
  vec4 shadow_origin;   // from where that was drawn: a point of an area light
};

int kindOf(Light light) { return int(light.position_kind.w); }

// Unit, from p to the light; r is its distance (1 for directional lights, which are nowhere).
vec3 wayTo(Light light, vec3 p, out float r) {
  r = 1.0;
  if (kindOf(light) == kDirectional) return -light.direction_back.xyz;
  vec3 d = light.position_kind.xyz - p;
  r = length(d);
  return r > 0.0 ? d / r : -light.direction_back.xyz;
}

// Irradiance on a plane at distance r that faces a light of unit strength, which it sees along `way`.
float incidentFactor(Light light, vec3 way, float r) {
  int kind = kindOf(light);
  if (kind == kDirectional) return 1.0;
  float cos_light = -dot(light.direction_back.xyz, way);
  if (kind == kArea) {
    float facing = max(cos_light, -light.direction_back.w * cos_light);
    return light.strength_area.w * max(facing, 0.0) / (r * r + light.strength_area.w * kInvPi);
  }
  if (!(r > 1e-6)) return 0.0;
  float q2 = r * r * light.cone.x;
  float factor = clamp(1.0 - q2 * q2, 0.0, 1.0) / (r * r);
  if (kind == kSpot) {
    float s = clamp((cos_light - light.cone.y) * light.cone.z, 0.0, 1.0);
    factor *= s * s;
  }
  return factor;
}
