// Domains as what is drawn of them: a rectangle with textures (Reniers & Telea, 2006, §3), and with the
// normal map that they call the most effective addition, and heights. A domain that folds, as a cylinder's
// does, becomes several: one for each piece that a plane can carry.
//
//   auto set = make_domain_set(points, *bases, 5, {});
//
// A primitive's texel (i, j) of w × h stands for the place
//     center + x u + y v + z n,   x = half_u (2 (i + ½) / w − 1),  y = half_v (2 (j + ½) / h − 1)
// with n = u × v, where z is the surface's height there, between lo and hi.
#ifndef DUPIN_SIMPLIFY_DOMAIN_PRIMITIVES_H
#define DUPIN_SIMPLIFY_DOMAIN_PRIMITIVES_H

#include <array>
#include <cstdint>
#include <vector>

#include "domain_bases.h"

namespace dupin {

struct DomainPrimitive {
  Vec3 center;                  ///< of the rectangle, in the part's space
  Vec3 u{1, 0, 0}, v{0, 1, 0};  ///< unit, perpendicular; n is outward
  double half_u = 0, half_v = 0;
  double lo = 0, hi = 0;
  std::uint32_t face = 0;  ///< which most of its points are of
  std::uint32_t first_neighbor = 0, neighbors = 0;
  std::uint32_t x = 0, y = 0, width = 0, height = 0;  ///< its texels in the atlas
  Vec3 n() const { return cross(u, v); }
};

/// Row by row. Texels that nothing of a domain lies in have Ψ = 0, and of the rest what is near.
struct DomainAtlas {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> psi;  ///< 255 Ψ
  std::vector<std::array<std::uint8_t, 4>>
      normal_height;                 ///< 128 + 127 (x, y, z) along u, v, n; 255 (z − lo) / (hi − lo)
  std::vector<std::uint32_t> color;  ///< as SurfacePoints', of the nearest point; or empty
  std::vector<std::uint16_t>
      face;  ///< of the nearest point; empty where all are of one, or there are more than 65536
};

/// One level of a part: a primitive for every domain, or several that have its Ψ in common.
struct DomainSet {
  std::vector<DomainPrimitive> primitives;
  std::vector<std::uint32_t> neighbors;  ///< domains that blend with each (domain_neighbors)
  DomainAtlas atlas;
  std::vector<std::uint32_t> faces;  ///< of the points, ascending
  double texel = 0;                  ///< the largest edge of a texel, in the part's units
  /// How far points are from the surface that the textures describe, along n: the root mean square, and what
  /// 99 of 100 points are within. Measured, not bounded.
  double deviation_rms = 0, deviation_99 = 0;
  std::size_t points = 0;  ///< that it was made of
  bool oriented = true;    ///< else nothing told which side of the points is outside, and n is either
};

/// A model's domains: of each part some levels, the coarsest first, or none.
struct DomainScene {
  std::vector<std::vector<DomainSet>> parts;
};

struct DomainPrimitiveOptions {
  double texel = 0;                 ///< the edge of a texel; 0: a quarter of the points are as near
  std::uint32_t most_atlas = 8192;  ///< largest width or height of the atlas; texels grow to fit
  Progress progress;
};

/// The same for any number of threads.
Result<DomainSet> make_domain_set(const SurfacePoints& points, const DomainBases& bases, std::size_t level,
                                  const DomainPrimitiveOptions& options);

/// The first thing that is wrong with a set (from a file, say): indices and rectangles within range, axes
/// unit and perpendicular, numbers finite.
Status check(const DomainSet& set);

/// Largest numbers of a set.
inline constexpr std::uint32_t kMostDomains = 1U << 24, kMostDomainTile = 1024;

}  // namespace dupin

#endif
