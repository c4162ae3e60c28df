// What is known of the surface around each point from its neighbors in space (Reniers & Telea, §2.1): the
// classifier, a tangent plane, and the fan of triangles around it there (§2.2, Figure 3).
#ifndef DUPIN_SIMPLIFY_AMG_NEIGHBOURHOODS_H
#define DUPIN_SIMPLIFY_AMG_NEIGHBOURHOODS_H

#include "../../core/progress.h"
#include "symmetric_eigen3.h"
#include "unique_points.h"

namespace dupin::amg {

struct NeighborhoodOptions {
  std::size_t neighbors = 50;  ///< k_min: at least so many, the point not counted
  double radius = 0;           ///< ε: and all within it
};

/// The zero and first moment of points about one of them, with eigenvalues λ0 >= λ1 >= λ2 (eqs. 1, 2).
struct Moments {
  Vec3 offset;  ///< M⁰ − x
  Eigen3 first;
};
Moments moments(const Vec3& center, const std::vector<Vec3>& points);

/// Eq. 3 with α = 0.01 and β = 100, for a neighborhood of radius ε: 100 where the surface is flat, orders of
/// magnitude less at an edge or a tip.
inline constexpr double kClassifierAlpha = 0.01, kClassifierBeta = 100;
double classifier(const Moments& m, double radius);

/// The fans around points: fan i is the points first[i] … first[i + 1] of `points`, in order; it has a
/// triangle between each and the next, and between the last and the first if `closed`.
struct Fans {
  std::vector<std::uint64_t> first{0};
  std::vector<std::uint32_t> points;
  std::vector<std::uint8_t> closed;
};

struct Neighborhoods {
  std::vector<double> classifiers;
  std::vector<Vec3>
      normals;  ///< e2 of the first moment, or the given normal; either side where none was given
  /// How far the surface may be taken to reach from the point without another: the distance of its
  /// kSpacingNeighbor-th neighbor.
  std::vector<double> spacings;
  Fans fans;  ///< of loose points only; others' fans are their mesh's
};
inline constexpr std::size_t kSpacingNeighbor = 4;

/// Points that are farther apart than this times the smaller of their spacings do not belong together: they
/// are of different islands, or on both sides of a gap.
inline constexpr double kLargestGap = 4;

bool together(const UniquePoints& points, const Neighborhoods& around, std::uint32_t a, std::uint32_t b);

Result<Neighborhoods> neighborhoods(const UniquePoints& points, const NeighborhoodOptions& options,
                                    const Progress& progress);

}  // namespace dupin::amg

#endif
