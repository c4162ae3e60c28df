// The papers' textures: normal maps for quantised ratios of the principal curvatures, and ellipses of
// quantised slimness.
#ifndef DUPIN_RENDER_NORMAL_MAPS_H
#define DUPIN_RENDER_NORMAL_MAPS_H

#include <cstdint>
#include <vector>

#include "gl_objects.h"

namespace dupin {

/// Map i holds (n.x, n.y) / n.z of eq. 11 (2003) for λu = 1 and ρ = (i − 128) / 127 (dp_codec.h), over
/// |u| <= 1 and |v| <= map_reach(i): by Lemma 1 a point's normals are those at λu times its coordinates. The
/// outermost texels' middles lie on the border.
inline constexpr int kNormalMaps = 256, kNormalMapSize = 32;
/// 1 / |ρ|, where λv · v is 1; the flattest have as much as ρ's own step lets matter.
float map_reach(int map);
/// One level of one map, row by row along v: two floats a texel. Coarser levels are means of four texels.
std::vector<float> normal_map(int map, int level);

/// Texture i is 0 inside an ellipse of half-axes 1 and i / 255 in the square [-1, 1]², and 255 outside.
inline constexpr int kEllipses = 256, kEllipseSize = 64;
std::vector<std::uint8_t> ellipse_texture(int slimness);

/// Array textures of all of them, in the current context.
GlTexture make_normal_maps(const Gl& gl);
GlTexture make_ellipses(const Gl& gl);

}  // namespace dupin

#endif
