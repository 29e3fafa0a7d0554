// SPDX-License-Identifier: MIT
#include "atlas_textures.h"

#include <vector>

#include "relume/core/check.h"

namespace relume::render {

Texture planeTexture(const asset::AtlasTable& atlas, const asset::Plane& plane) {
  const auto channels = static_cast<std::size_t>(plane.channels);
  RELUME_CHECK(channels == 1 || channels == 3);
  RELUME_CHECK_EQ(plane.values.size(), atlas.pageTexels() * channels);
  Texture t = Texture::makeArray(channels == 1 ? GL_R32F : GL_RGB32F, {atlas.width, atlas.height},
                                 static_cast<int>(atlas.pages));
  glTextureSubImage3D(t.name(), 0, 0, 0, 0, atlas.width, atlas.height, static_cast<GLsizei>(atlas.pages),
                      channels == 1 ? GL_RED : GL_RGB, GL_FLOAT, plane.values.data());
  t.plain(true);
  if (channels == 1) {
    t.parameter(GL_TEXTURE_SWIZZLE_G, GL_RED);
    t.parameter(GL_TEXTURE_SWIZZLE_B, GL_RED);
  }
  return t;
}

Texture labelTexture(const asset::AtlasTable& atlas, std::span<const Vec3> colours) {
  std::vector<Vec4> rgba(atlas.pageTexels(), Vec4(0));
  for (std::size_t i = 0; i < atlas.texel.size(); ++i) rgba[atlas.texel[i]] = Vec4(colours[i], 1);
  Texture t = Texture::makeArray(GL_RGBA16F, {atlas.width, atlas.height}, static_cast<int>(atlas.pages));
  glTextureSubImage3D(t.name(), 0, 0, 0, 0, atlas.width, atlas.height, static_cast<GLsizei>(atlas.pages),
                      GL_RGBA, GL_FLOAT, rgba.data());
  t.plain(false);
  return t;
}

Texture whiteArray() {
  Texture t = Texture::makeArray(GL_RGBA8, {1, 1}, 1);
  const unsigned char white[4] = {255, 255, 255, 255};
  glTextureSubImage3D(t.name(), 0, 0, 0, 0, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, white);
  t.plain(false);
  return t;
}

}  // namespace relume::render
