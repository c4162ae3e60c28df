#include "normal_maps.h"

#include <algorithm>
#include <cmath>

#include "../sampling/differential_point.h"
#include "../simplify/dp_codec.h"

namespace dupin {
namespace {

constexpr int kLevels = 6;  // 32 … 1

void allocate(const Gl& gl, const GlTexture& texture) {
  gl.ActiveTexture(GL_TEXTURE0 + kScratchUnit);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture.name());
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, wrap, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

std::vector<float> finest_map(int map) {
  const double rho = rho_of(static_cast<std::uint8_t>(map)), reach = map_reach(map);
  std::vector<float> texels;
  for (int j = 0; j < kNormalMapSize; ++j)
    for (int i = 0; i < kNormalMapSize; ++i) {
      const double u = 2.0 * i / (kNormalMapSize - 1) - 1, v = reach * (2.0 * j / (kNormalMapSize - 1) - 1);
      const Vec3 n = local_normal_field(1, rho, u, v);
      texels.push_back(static_cast<float>(n.x / n.z));
      texels.push_back(static_cast<float>(n.y / n.z));
    }
  return texels;
}

std::vector<float> halved(const std::vector<float>& finer, int size) {
  std::vector<float> texels;
  for (int j = 0; j < size; j += 2)
    for (int i = 0; i < size; i += 2)
      for (int k = 0; k < 2; ++k) {
        const auto at = [&](int x, int y) { return finer[static_cast<std::size_t>(2 * (y * size + x) + k)]; };
        texels.push_back(0.25F * (at(i, j) + at(i + 1, j) + at(i, j + 1) + at(i + 1, j + 1)));
      }
  return texels;
}

}  // namespace

float map_reach(int map) {
  return static_cast<float>(1 / std::max(std::abs(rho_of(static_cast<std::uint8_t>(map))), 0.5 / 127));
}

std::vector<float> normal_map(int map, int level) {
  std::vector<float> texels = finest_map(map);
  for (int k = 0, size = kNormalMapSize; k < level; ++k, size /= 2) texels = halved(texels, size);
  return texels;
}

std::vector<std::uint8_t> ellipse_texture(int slimness) {
  const double minor = std::max(slimness, 1) / 255.0;
  std::vector<std::uint8_t> texels;
  for (int j = 0; j < kEllipseSize; ++j)
    for (int i = 0; i < kEllipseSize; ++i) {
      const double x = (i + 0.5) * 2 / kEllipseSize - 1, y = ((j + 0.5) * 2 / kEllipseSize - 1) / minor;
      texels.push_back(x * x + y * y <= 1 ? 0 : 255);
    }
  return texels;
}

GlTexture make_normal_maps(const Gl& gl) {
  GlTexture texture(gl);
  allocate(gl, texture);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  std::vector<std::vector<float>> maps;
  for (int i = 0; i < kNormalMaps; ++i) maps.push_back(finest_map(i));
  for (int level = 0, size = kNormalMapSize; level < kLevels; ++level, size /= 2) {
    std::vector<float> all;
    for (std::vector<float>& map : maps) {
      all.insert(all.end(), map.begin(), map.end());
      if (size > 1) map = halved(map, size);
    }
    gl.TexImage3D(GL_TEXTURE_2D_ARRAY, level, GL_RG32F, size, size, kNormalMaps, 0, GL_RG, GL_FLOAT,
                  all.data());
  }
  return texture;
}

GlTexture make_ellipses(const Gl& gl) {
  GlTexture texture(gl);
  allocate(gl, texture);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  std::vector<std::uint8_t> all;
  for (int i = 0; i < kEllipses; ++i) {
    const std::vector<std::uint8_t> one = ellipse_texture(i);
    all.insert(all.end(), one.begin(), one.end());
  }
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R8, kEllipseSize, kEllipseSize, kEllipses, 0, GL_RED,
                GL_UNSIGNED_BYTE, all.data());
  return texture;
}

}  // namespace dupin
