// Fewer differential points: the greedy pruning of Kalaiah & Varshney (2003, section IV-C).
//
// The most redundant point, the one whose normal its neighbours' normal fields predict best and that predicts
// theirs (eq. 6), goes first, if its rectangle is enclosed: covered by its neighbours'. Neighbours of a
// pruned point that overlap become neighbours of each other (eq. 5). What is left covers what all of them
// covered, as seen along each pruned point's normal.
#ifndef DUPIN_SIMPLIFY_PRUNE_H
#define DUPIN_SIMPLIFY_PRUNE_H

#include "../core/progress.h"
#include "../core/status.h"
#include "../sampling/differential_point.h"

namespace dupin {

enum class EnclosureTest {
  /// The neighbours' projected rectangles are cut out of the point's own; nothing may remain.
  exact,
  /// The papers': eight segments of the rectangle are clipped against the neighbours'. Slivers between them
  /// go unnoticed.
  segments,
};

/// What may remain of a rectangle that the exact test calls covered, as a part of its area; roundoff.
inline constexpr double kSliver = 1e-9;
/// Neighbours whose normals are farther apart than this chord of the unit circle (60°), or than the
/// curvatures explain, do not count as covering the same surface (exact test): rectangles stick out over
/// sharp edges.
inline constexpr double kMostTurn = 1;

struct PruneOptions {
  EnclosureTest enclosure = EnclosureTest::exact;
  /// Rectangles are made smaller by this part for the test. The papers: 0.15, to make up for what segments
  /// miss.
  double scale_down = 0;
  /// Both tests look along a point's normal. Seen at a slant, rectangles in different planes shift against
  /// each other by their distances times the slant's tangent: so each is made smaller, on either side, by
  /// this tangent times the distance of the osculating circle from it at its edge. 2: no hole opens up to 63°
  /// from the normal, where a surface is as its osculating circles are. The papers: 0.
  double slant = 2;
  /// 8 or 24: the samples around a sample of a grid that are its first neighbours.
  int grid_neighbors = 24;
  /// Neighbours also across the borders of patches and faces; the papers: not.
  bool across_patches = true;
  /// Of a pruned point's neighbours so many, the nearest, may become each other's (eq. 5; the papers: all).
  /// Lists stay short, at the price of a tenth of the pruning.
  std::size_t reconnected = 12;
  /// Points that were not enclosed are looked at once more when all have been; the papers: not.
  bool second_chance = true;
  Progress progress;
};
/// As published.
PruneOptions papers_prune_options();

/// Of each part, whether each point stays. Grids and edges say which are neighbours; points without either
/// have their nearest. In parallel over blocks of points and then, in one thread, over those at the blocks'
/// borders: the result does not depend on the number of threads.
Result<std::vector<std::vector<bool>>> points_to_keep(const std::vector<PartPoints>& parts,
                                                      const PruneOptions& options);

/// Prunes every part.
Status prune(PointScene& scene, const PruneOptions& options);

}  // namespace dupin

#endif
