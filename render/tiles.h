// What a frame draws a DP by: tiles, convex pieces of its (x, y) each of which needs few tests. A DP that is
// small on the picture is one tile; a large one is drawn by the cells of its region (region_cells.h), and
// curved ones are cut so that their tiles' prisms lie close around the surface, as far as they can be seen at
// all.
#ifndef DUPIN_RENDER_TILES_H
#define DUPIN_RENDER_TILES_H

#include <cstdint>
#include <map>
#include <vector>

#include "gpu_encode.h"
#include "part_camera.h"

namespace dupin {

// What a tile is tested against; each combination has a program of its own.
constexpr std::uint32_t kCurvedTile = 1;
constexpr std::uint32_t kPlanesTile = 2;  ///< curved: its DP has clip planes
constexpr std::uint32_t kConicTile = 4;   ///< its cell has a conic
constexpr std::uint32_t kPiecesTile = 8;  ///< the whole of a DP, tested piece by piece
constexpr std::uint32_t kEdgesTile =
    16;  ///< feature edges run in it or near it; of a kPiecesTile its pieces tell
constexpr std::uint32_t kPrismTile = 32;  ///< curved: too near to the eye for a proxy in the picture's plane
constexpr std::uint32_t kOneRootTile = 64;  ///< curved: only its outer, or only its inner, side can be seen
/// Of a kPiecesTile: so many lines and arcs at most and nothing else, which go with the proxy. 1 + index in
/// kFlatPieces.
constexpr std::uint32_t kFlatShift = 7, kFlatTile = 7U << kFlatShift;
struct FlatPieces {
  std::uint32_t lines, arcs;
};
inline constexpr FlatPieces kFlatPieces[] = {{0, 1}, {0, 2}, {0, 4}, {2, 0}, {4, 4}};
/// The outputs of a vertex shader that they need, in components; OpenGL 3.3 promises fewer.
inline constexpr int kFlatComponents = 128;
/// What colors drawn together with ids need.
inline constexpr int kAtOnceComponents = 80;

/// Texels of one tile (RGBA32UI; floats by their bits):
///   corners 0, 1 | corners 2, 3 | z lo, z hi, slot (bit 31: the inner side is seen), the DP's size in pixels
///   curved, unless kPrismTile: the proxy's corners (tile_proxy.h) 0, 1 | 2, 3, in clip coordinates | a pixel
///     among them: where its centre's ray is at the depth of the DP's origin, and its column | row << 16
///   kConicTile: a.xyz, b.x | b.yz, c.xy | c.z, sign, steepest, 0     (RegionCell's)
///   kEdgesTile: first texel of its edges, lines, arcs, ellipses
/// Edges stand in a run of their own: a line's two points; an arc's p0, p1 | p2, 4w², 0; an ellipse's centre,
/// mxx, mxy | myy, 0, 0, 0.
std::uint32_t tile_texels(std::uint32_t kind);

struct TileOptions {
  int width = 0, height = 0;  ///< of the picture
  bool flats = true;          ///< vertex shaders may hand on as much as kFlatPieces need
  bool edges = false;         ///< feature edges are drawn
  double edge_px = 0;         ///< how far from an edge's line its ink reaches
};

/// A frame's tiles by kind, nearest DPs first.
struct Tiles {
  std::map<std::uint32_t, std::vector<Texel>> by_kind;
  std::vector<Texel> edges;
  void clear();
};

/// A DP as it is seen in this frame.
struct SeenDp {
  const DpBounds* dp;
  const PartCamera* camera;
  std::uint32_t slot;
  double size_px;      ///< about; infinite where it comes close to the eye
  double px_per_unit;  ///< about; infinite likewise
  bool towards, away;  ///< only that side can be seen, or is drawn
};
void add_tiles(const SeenDp& seen, const TileOptions& options, Tiles& tiles);

}  // namespace dupin

#endif
