// SPDX-License-Identifier: MIT
#include "gpu_scene.h"

#include <algorithm>
#include <cmath>

#include "relume/image/relief.h"

namespace relume::render {
namespace {

constexpr GLuint kReliefUnit = 11;  // shaders/relief.glsl

struct Vertex {
  Vec3 position, normal;
  Vec4 uv01, uv23, tangent, colour;
};

struct MapUse {
  Vec4 row;
  Vec2 offset;
  std::uint32_t set, present;
};
struct GpuMaterial {  // std430, shaders/material.glsl
  Vec4 base_colour, emission_alpha;
  float metallic, roughness, normal_scale, alpha_cutoff;
  std::uint32_t alpha_mode, unlit, double_sided;
  float height_scale;
  MapUse base, metallic_roughness, normal, emission, height;
};

MapUse useOf(const scene::TextureRef& ref, const scene::Scene& scene) {
  MapUse use{};
  if (!ref || !scene.textures[ref.texture].image) return use;
  const Vec2 origin = ref.apply(Vec2(0)), u = ref.apply(Vec2(1, 0)) - origin,
             v = ref.apply(Vec2(0, 1)) - origin;
  use.row = Vec4(u.x, v.x, u.y, v.y);
  use.offset = origin;
  use.set = ref.uv_set;
  use.present = 1;
  return use;
}

GpuMaterial toGpu(const scene::Material& m, const scene::Scene& scene) {
  GpuMaterial out{};
  out.base_colour = m.base_colour;
  out.emission_alpha = Vec4(m.unlit ? Vec3(0) : m.emission, 0);
  out.metallic = m.metallic, out.roughness = m.roughness;
  out.normal_scale = m.normal_scale, out.alpha_cutoff = m.alpha_cutoff;
  out.alpha_mode = static_cast<std::uint32_t>(m.alpha_mode);
  out.unlit = m.unlit, out.double_sided = m.double_sided;
  out.base = useOf(m.base_colour_texture, scene);
  out.metallic_roughness = useOf(m.metallic_roughness_texture, scene);
  out.normal = useOf(m.normal_texture, scene);
  out.emission = useOf(m.emission_texture, scene);
  out.height = useOf(m.height_texture, scene);
  out.height_scale = m.height_scale;
  return out;
}

Vertex vertexOf(const scene::Mesh& mesh, std::uint32_t i) {
  const auto uv = [&](std::size_t set) { return mesh.uv[set].empty() ? Vec2(0) : mesh.uv[set][i]; };
  Vertex v;
  v.position = mesh.positions[i];
  v.normal = mesh.normals.empty() ? Vec3(0) : mesh.normals[i];
  v.uv01 = Vec4(uv(0), uv(1));
  v.uv23 = Vec4(uv(2), uv(3));
  v.tangent = mesh.tangents.empty() ? Vec4(0) : mesh.tangents[i];
  v.colour = mesh.colours.empty() ? Vec4(1) : mesh.colours[i];
  return v;
}

GLint wrapOf(scene::Wrap wrap) {
  return wrap == scene::Wrap::kClamp    ? GL_CLAMP_TO_EDGE
         : wrap == scene::Wrap::kMirror ? GL_MIRRORED_REPEAT
                                        : GL_REPEAT;
}

Box3 moved(const Box3& box, const Mat4& m) {
  Box3 out;
  if (box.empty()) return out;
  for (int k = 0; k < 8; ++k)
    out.add(Point(
        m * Vec4(k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y, k & 4 ? box.hi.z : box.lo.z, 1)));
  return out;
}

}  // namespace

bool mayBeSeen(const Box3& box, const Mat4& clip_from_world) {
  int beyond[5] = {};
  for (int k = 0; k < 8; ++k) {
    const Vec4 c = clip_from_world * Vec4(k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y,
                                          k & 4 ? box.hi.z : box.lo.z, 1);
    beyond[0] += c.x > c.w, beyond[1] += c.x < -c.w;
    beyond[2] += c.y > c.w, beyond[3] += c.y < -c.w;
    beyond[4] += c.w < 0;
  }
  return std::none_of(std::begin(beyond), std::end(beyond), [](int n) { return n == 8; });
}

GpuScene::GpuScene(const scene::Scene& scene) {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  for (const scene::Mesh& mesh : scene.meshes) {
    Range range{static_cast<std::uint32_t>(indices.size()),
                static_cast<std::uint32_t>(3 * mesh.triangles.size()),
                static_cast<std::int32_t>(vertices.size())};
    Box3& box = local_boxes_.emplace_back();
    for (const Point& p : mesh.positions) box.add(p);
    const bool flat = mesh.flat_normals || mesh.normals.empty();
    if (flat) {
      // Corners of their own: a zero normal makes the shader take that of the face.
      for (const UVec3 t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
          indices.push_back(static_cast<std::uint32_t>(vertices.size()) -
                            static_cast<std::uint32_t>(range.first_vertex));
          vertices.push_back(vertexOf(mesh, t[k]));
          vertices.back().normal = Vec3(0);
        }
    } else {
      for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) vertices.push_back(vertexOf(mesh, i));
      for (const UVec3 t : mesh.triangles)
        for (int k = 0; k < 3; ++k) indices.push_back(t[k]);
    }
    ranges_.push_back(range);
  }
  vertices_ = Buffer(vertices);
  indices_ = Buffer(indices);
  array_ = VertexArray::make();
  const GLuint vao = array_.name();
  glVertexArrayVertexBuffer(vao, 0, vertices_.name(), 0, sizeof(Vertex));
  glVertexArrayElementBuffer(vao, indices_.name());
  const auto attribute = [&](GLuint at, GLint size, std::size_t offset) {
    glEnableVertexArrayAttrib(vao, at);
    glVertexArrayAttribFormat(vao, at, size, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(vao, at, 0);
  };
  attribute(0, 3, offsetof(Vertex, position));
  attribute(1, 3, offsetof(Vertex, normal));
  attribute(2, 4, offsetof(Vertex, uv01));
  attribute(3, 4, offsetof(Vertex, uv23));
  attribute(4, 4, offsetof(Vertex, tangent));
  attribute(5, 4, offsetof(Vertex, colour));

  for (const scene::Texture& texture : scene.textures) textures_.push_back(upload(texture));
  textures_.push_back(upload({}));
  const auto white = static_cast<std::uint32_t>(scene.textures.size());
  std::vector<GpuMaterial> materials;
  for (const scene::Material& m : scene.materials) {
    materials.push_back(toGpu(m, scene));
    const auto slot = [&](const scene::TextureRef& ref) { return ref ? ref.texture : white; };
    slots_.push_back({slot(m.base_colour_texture), slot(m.metallic_roughness_texture), slot(m.normal_texture),
                      slot(m.emission_texture), kNoRelief});
    if (m.height_texture && scene.textures[m.height_texture.texture].image) addRelief(scene, m);
    alpha_tested_.push_back(m.alpha_mode != scene::AlphaMode::kOpaque);
    double_sided_.push_back(m.double_sided);
  }
  materials_ = Buffer(materials);

  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    const scene::Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.triangles.empty()) continue;
    Drawn d{};
    d.instance = i, d.mesh = instance.mesh, d.material = mesh.material;
    d.dynamic = instance.dynamic;
    d.translucent = scene.materials[mesh.material].alpha_mode == scene::AlphaMode::kBlend;
    d.page = instance.dynamic || mesh.atlas_page == scene::kNone ? -1 : static_cast<int>(mesh.atlas_page);
    d.tangents = !mesh.tangents.empty();
    drawn_.push_back(d);
    place(drawn_.size() - 1, instance.world_from_local);
  }
  // The same material together: fewer changes of textures.
  std::stable_sort(drawn_.begin(), drawn_.end(),
                   [](const Drawn& a, const Drawn& b) { return a.material < b.material; });
  setFilter(TextureFilter::kMipmaps);
}

// Height, sine of half the aperture of the free cone, and the normal's x and y.
void GpuScene::addRelief(const scene::Scene& scene, const scene::Material& material) {
  const scene::Texture& map = scene.textures[material.height_texture.texture];
  image::Image heights(map.image->width, map.image->height, 1);
  for (std::size_t i = 0; i < heights.pixels(); ++i)
    heights.data[i] =
        static_cast<float>(map.image->data[i * static_cast<std::size_t>(map.image->channels)]) / 255.0f;
  const image::ReliefOptions how{.depth = material.height_scale};
  const image::Image normals = image::reliefNormals(heights, how), cones = image::reliefCones(heights, how);
  const auto share = [](float v) { return static_cast<std::uint16_t>(std::lround(65535.0f * v)); };
  std::vector<std::uint16_t> texels;
  for (std::size_t i = 0; i < heights.pixels(); ++i)
    texels.insert(texels.end(),
                  {share(heights.data[i]), share(cones.data[i]), share(0.5f + 0.5f * normals.data[3 * i]),
                   share(0.5f + 0.5f * normals.data[3 * i + 1])});
  Texture out = Texture::make2d(GL_RGBA16, {heights.width, heights.height}, true);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(out.name(), 0, 0, 0, heights.width, heights.height, GL_RGBA, GL_UNSIGNED_SHORT,
                      texels.data());
  glGenerateTextureMipmap(out.name());
  out.parameter(GL_TEXTURE_WRAP_S, wrapOf(map.wrap_u));
  out.parameter(GL_TEXTURE_WRAP_T, wrapOf(map.wrap_v));
  out.parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  slots_.back().relief = static_cast<std::uint32_t>(reliefs_.size());
  reliefs_.push_back(std::move(out));
}

Texture GpuScene::upload(const scene::Texture& texture) {
  const bool there = texture.image && !texture.image->data.empty();
  const image::Image8 white{1, 1, 4, {255, 255, 255, 255}};
  const image::Image8& im = there ? *texture.image : white;
  const auto channels = static_cast<std::size_t>(im.channels);
  std::vector<unsigned char> rgba;
  rgba.reserve(im.data.size() / channels * 4);
  for (std::size_t i = 0; i + channels <= im.data.size(); i += channels) {
    const unsigned char* p = im.data.data() + i;
    const bool grey = channels <= 2;
    rgba.insert(rgba.end(), {p[0], grey ? p[0] : p[1], grey ? p[0] : p[2],
                             channels == 2   ? p[1]
                             : channels == 4 ? p[3]
                                             : static_cast<unsigned char>(255)});
  }
  Texture out = Texture::make2d(texture.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, {im.width, im.height}, true);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(out.name(), 0, 0, 0, im.width, im.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  glGenerateTextureMipmap(out.name());
  out.parameter(GL_TEXTURE_WRAP_S, wrapOf(texture.wrap_u));
  out.parameter(GL_TEXTURE_WRAP_T, wrapOf(texture.wrap_v));
  return out;
}

void GpuScene::setFilter(TextureFilter filter) {
  for (Texture& t : textures_) {
    t.parameter(GL_TEXTURE_MIN_FILTER,
                filter == TextureFilter::kMipmaps ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
    t.parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
}

void GpuScene::place(std::size_t index, const Mat4& world_from_local) {
  Drawn& d = drawn_[index];
  d.world_from_local = world_from_local;
  d.box = moved(local_boxes_[d.mesh], world_from_local);
  d.mirrored = glm::determinant(Mat3(world_from_local)) < 0;
}

Box3 GpuScene::bounds() const {
  Box3 box;
  for (const Drawn& d : drawn_) box.add(d.box);
  return box;
}

void GpuScene::bind() const {
  glBindVertexArray(array_.name());
  materials_.bindStorage(0);
}

void GpuScene::draw(const Drawn& what, const Program& program, bool all_textures) const {
  program.set("u_world_from_local", what.world_from_local);
  program.set("u_material", what.material);
  const Slots& s = slots_[what.material];
  if (all_textures || alpha_tested_[what.material]) textures_[s.base].bind(0);
  if (all_textures) {
    textures_[s.metallic_roughness].bind(1);
    textures_[s.normal].bind(2);
    textures_[s.emission].bind(3);
    if (s.relief != kNoRelief) reliefs_[s.relief].bind(kReliefUnit);
  }
  const Range& r = ranges_[what.mesh];
  glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(r.indices), GL_UNSIGNED_INT,
                           reinterpret_cast<const void*>(std::size_t{r.first_index} * 4), r.first_vertex);
}

}  // namespace relume::render
