// The textures of one domain, before they are put into an atlas.
#ifndef DUPIN_SIMPLIFY_AMG_TILE_H
#define DUPIN_SIMPLIFY_AMG_TILE_H

#include <array>
#include <cstdint>
#include <vector>

#include "../domain_primitives.h"

namespace dupin::amg {

/// The surface that tiles are made from.
struct TileSource {
  const SurfacePoints& points;
  const std::vector<Vec3>& normals;  ///< unit, one a point
  bool oriented = true;              ///< normals are outward; else either side
  const std::vector<std::uint32_t>& triangles;
  const std::vector<bool>& rim;
  const std::vector<double>& spacings;
};

/// A domain with all that its textures need.
struct TileDomain {
  std::vector<std::uint32_t> points;     ///< ascending: those of the domain and of its triangles
  std::vector<float> values;             ///< Ψ
  std::vector<std::uint32_t> triangles;  ///< indices of triangles that touch the domain
  std::vector<std::uint32_t> corners;    ///< of each triangle three, as places in `points`
};
/// Sets `corners`.
void find_corners(const std::vector<std::uint32_t>& triangles, TileDomain& domain);

/// Its rectangle: the plane by principal components of its points weighted with Ψ, the sides along the two
/// longer ones, around all that its textures show. Texels are larger where the tile would have more
/// than kMostDomainTile a side.
DomainPrimitive support(const TileSource& source, const TileDomain& domain, double texel);

struct Tile {
  std::vector<std::uint8_t> psi;
  std::vector<std::array<std::uint8_t, 4>> normal_height;
  std::vector<std::uint32_t> nearest;  ///< for color and face: a point; of the source
  std::vector<float> deviations;       ///< of each point with Ψ >= 1/2: how far it is from the drawn height
};
/// Resamples the domain by linear interpolation over its triangles, those that lie higher hiding the others,
/// and beyond them by radial functions around rim points. Sets the primitive's lo and hi.
Tile make_tile(const TileSource& source, const TileDomain& domain, double texel, DomainPrimitive& primitive);

}  // namespace dupin::amg

#endif
