// Inside the folder: the limit surface of a cage as trees of exact patches, one tree a polygon.
#ifndef DUPIN_NURBS_LIMIT_FOREST_H
#define DUPIN_NURBS_LIMIT_FOREST_H

#include <optional>

#include "cage_levels.h"

namespace dupin {

/// A polynomial piece as a tensor-product Bézier patch over local parameters s, t in [0,1]: bicubic, or of
/// degree 4 both ways for Loop (there s + t <= 1 counts; beyond, the polynomial goes on). poles[i · (degree +
/// 1) + j], i along s.
struct LimitPatch {
  int degree = 3;
  std::vector<Vec3> poles;
};

/// A polygon, or a piece of one.
struct LimitNode {
  std::uint32_t face = 0;                ///< in the cage's level `level`
  std::uint32_t polygon = 0;             ///< of the first level
  std::uint32_t first_child = kNoIndex;  ///< of 4, or of as many as the polygon has corners
  std::uint32_t patch = kNoIndex;        ///< where it is regular
  std::uint32_t children = 0;            ///< how many
  std::uint8_t level = 0, rotation = 0;  ///< local corner i is the face's vertex (i + rotation) % corners
  bool flipped = false;                  ///< a triangle's middle: its parameters run against the polygon's
  Vec2 origin;                           ///< of local (0,0), in the polygon's parameters

  /// How long a side is in the polygon's parameters.
  double size() const;
  bool regular() const { return patch != kNoIndex; }
  bool leaf() const { return children == 0; }
};

struct LimitForest {
  CageLevels cage;
  std::vector<LimitNode> nodes;
  std::vector<std::uint32_t> roots;  ///< by face of the first level; kNoIndex for holes
  std::vector<LimitPatch> patches;

  int corners() const { return cage.scheme == SubdivisionScheme::loop ? 3 : 4; }
  int degree() const { return cage.scheme == SubdivisionScheme::loop ? 4 : 3; }
  std::uint32_t vertex(const LimitNode& node, int corner) const;
  std::uint32_t edge(const LimitNode& node, int side) const;
};

/// The face's patch where all of its neighbourhood is regular.
std::optional<LimitPatch> regular_patch(const CageLevel& level, int corners, std::uint32_t face,
                                        int rotation);
/// Cuts every polygon until its pieces are regular or the cage ends.
LimitForest make_limit_forest(CageLevels cage);

/// The child that holds a local parameter, which becomes local to it. Not for polygons that are neither.
int child_at(int corners, Vec2& local);
/// The leaf that holds a local parameter of a node, and the parameter in it.
const LimitNode& leaf_at(const LimitForest& forest, const LimitNode& node, Vec2& local);

/// A local corner's limit; exact at extraordinary vertices too.
Vec3 corner_limit(const LimitForest& forest, const LimitNode& node, int corner);
/// Unit limit normal at a local corner, or zero.
Vec3 corner_limit_normal(const LimitForest& forest, const LimitNode& node, int corner);

/// Jets in local parameters.
void evaluate_patch(const LimitPatch& patch, Vec2 local, int order, Vec3* jets);
Vec3 point_of(const LimitPatch& patch, Vec2 local);

/// The polynomial that agrees with the limit at 4 × 4 (15) points of a node that still has children for two
/// levels: its sides are the same as seen from both neighbours, and exact where they are polynomial.
LimitPatch interpolant(const LimitForest& forest, const LimitNode& node);

}  // namespace dupin

#endif
