// A surface as a few quasi-flat domains that overlap and blend: the decomposition of Reniers & Telea,
// "Extreme simplification and rendering of point sets using algebraic multigrid", Comput. Visual Sci., 2006,
// §2.
//
//   auto bases = decompose(points, {});
//   auto psi = bases->level(5);          // five levels finer than the coarsest
//
// A level is a partition of unity: each point belongs to one or a few domains, to each by Ψ in (0, 1], and
// its Ψ sum to 1. Bases end at creases and fade into each other where the surface is flat. From level to
// level there are two to three times as many domains; the finest level has one a point.
#ifndef DUPIN_SIMPLIFY_DOMAIN_BASES_H
#define DUPIN_SIMPLIFY_DOMAIN_BASES_H

#include <cstdint>
#include <memory>
#include <vector>

#include "../core/progress.h"
#include "surface_points.h"

namespace dupin {

/// The classifier of a flat surface: its largest value.
inline constexpr double kFlatClassifier = 100;

struct DecomposeOptions {
  std::size_t neighbors = 50;  ///< k_min: the classifier looks at least at so many around each point, 3 …
  double radius =
      0;  ///< ε, in the part's units: and at all that are as near; features smaller than it vanish
  Progress progress;
};

/// Ψ of every point: those of point i are starts[i] … starts[i + 1], by domain. They sum to 1.
struct DomainBasis {
  std::uint32_t domains = 0;
  std::vector<std::uint64_t> starts{0};
  std::vector<std::uint32_t> domain;
  std::vector<double> value;
};
/// How far the sums may be from 1.
inline constexpr double kPartitionError = 1e-12;
/// Values of a basis that are smaller are left out.
inline constexpr double kLeastBasis = 1e-4;

class DomainBases {
 public:
  class Impl;
  explicit DomainBases(std::unique_ptr<Impl> impl);
  DomainBases(DomainBases&&) noexcept;
  DomainBases& operator=(DomainBases&&) noexcept;
  ~DomainBases();

  /// How many levels there are; the last is the finest.
  std::size_t levels() const;
  /// How many domains level `level` has: 0 is the coarsest, whose domains are, where nothing is split into
  /// islands, one or a few. At least one for every connected component.
  std::uint32_t domains(std::size_t level) const;
  DomainBasis level(std::size_t level) const;

  /// The paper's C_ε of each point (eq. 3): 100 where the surface is flat, near 0 at edges and tips.
  const std::vector<double>& classifier() const;
  /// The normals that were given, or of the tangent planes (either side), unit.
  const std::vector<Vec3>& normals() const;
  /// How far a point's surface may be taken to reach without another point, in the part's units; 0 for a
  /// single point.
  const std::vector<double>& spacings() const;
  /// The surface between the points, three indices a triangle: those of the mesh, and of loose points those
  /// of their fans, without what reaches over a gap. A point that coincides with others may have none.
  const std::vector<std::uint32_t>& triangles() const;
  /// Loose points at the rim of the triangles, or without any: their surface reaches half a spacing further.
  const std::vector<bool>& rim() const;
  /// Seconds of each step.
  struct Times {
    double neighborhoods = 0, matrix = 0, multigrid = 0;
  };
  const Times& times() const;

 private:
  std::unique_ptr<Impl> impl_;
};

/// The same for any number of threads. Points that coincide are one. invalid_argument: options out of range
/// or check(points) fails. unreadable: Dupin was built without hypre.
Result<DomainBases> decompose(const SurfacePoints& points, const DecomposeOptions& options);

/// D = {x | Ψ(x) > τ} (eq. 8): the points of each domain, ascending, with their Ψ. A point whose Ψ are all
/// smaller stays with its largest.
inline constexpr double kDomainThreshold = 0.05;
struct Domain {
  std::vector<std::uint32_t> points;
  std::vector<double> values;
};
std::vector<Domain> domains_of(const DomainBasis& basis, double threshold = kDomainThreshold);

/// Which domains blend with each: those with which either has more than this part of its points in common.
/// Symmetric; each list ascending.
inline constexpr double kNeighborOverlap = 0.05;
std::vector<std::vector<std::uint32_t>> domain_neighbors(const std::vector<Domain>& domains,
                                                         std::size_t points,
                                                         double overlap = kNeighborOverlap);

}  // namespace dupin

#endif
