// glTF's metallic-roughness material, appendix B: GGX with height-correlated Smith (Heitz 2014, eq. 99), Schlick,
// and compensation for light that microfacets reflect more than once (Turquin 2019, eq. 16). The functions of
// libs/transport/include/relume/transport/bsdf.h, tested against them. Text for OpenGL and WebGL 2 alike.

const float kLeastAlpha = 1e-3;
const float kDielectric = 0.04;
const float kLeastCosine = 1e-4;

float ggxDistribution(float n_h, float alpha) {
  float a2 = alpha * alpha;
  float c2 = min(n_h * n_h, 1.0);
  float q = a2 * c2 + (1.0 - c2);
  return a2 / (3.14159265358979323846 * q * q);
}

// G2 / (4 cos_i cos_o).
float ggxVisibility(float cos_i, float cos_o, float alpha) {
  float a2 = alpha * alpha;
  float below = cos_i * sqrt(a2 + (1.0 - a2) * cos_o * cos_o) + cos_o * sqrt(a2 + (1.0 - a2) * cos_i * cos_i);
  return below > 0.0 ? 0.5 / below : 0.0;
}

float schlickWeight(float cosine) {
  float m = 1.0 - clamp(cosine, 0.0, 1.0), m2 = m * m;
  return m2 * m2 * m;
}

struct Lobes {
  vec3 diffuse;     // albedo of the diffuse lobe
  vec3 at_normal;   // Fresnel's term with its compensation at normal incidence
  vec3 to_grazing;  // and what Schlick's weight adds
  vec3 glossy;      // share of light from all sides that the specular lobes reflect
  float alpha;
};

// `reflected`: scale and bias of the directional albedo of the lobe, F0 * scale + bias, at the view's cosine.
Lobes lobesOf(vec3 base, float metallic, float roughness, vec2 reflected) {
  float whole = 1.0 / (reflected.x + reflected.y) - 1.0;
  vec3 metal_gain = 1.0 + base * whole;
  float dielectric_gain = 1.0 + kDielectric * whole;
  vec3 metal_albedo = min((base * reflected.x + reflected.y) * metal_gain, vec3(1.0));
  float dielectric_albedo = min((kDielectric * reflected.x + reflected.y) * dielectric_gain, 1.0);
  Lobes l;
  l.alpha = clamp(roughness * roughness, kLeastAlpha, 1.0);
  vec3 metal = metallic * metal_gain;
  float dielectric = (1.0 - metallic) * dielectric_gain;
  l.at_normal = metal * base + vec3(dielectric * kDielectric);
  l.to_grazing = metal * (vec3(1.0) - base) + vec3(dielectric * (1.0 - kDielectric));
  l.glossy = metallic * metal_albedo + vec3((1.0 - metallic) * dielectric_albedo);
  l.diffuse = (1.0 - metallic) * (1.0 - dielectric_albedo) * base;
  return l;
}

// f without the diffuse lobe; all unit; cos_o at least kLeastCosine.
vec3 specularLobe(Lobes l, vec3 n, vec3 incoming, vec3 outgoing, float cos_i, float cos_o) {
  vec3 h = normalize(incoming + outgoing);
  return (l.at_normal + l.to_grazing * schlickWeight(dot(h, outgoing))) *
         (ggxDistribution(dot(n, h), l.alpha) * ggxVisibility(cos_i, cos_o, l.alpha));
}
