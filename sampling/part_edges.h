// A part's edges as chains of conic arcs, and how far faces reach over them so that no crack opens.
//
// Two faces that meet in an edge are drawn by sheets that are not quite the faces: each is off by its bound,
// and a file's edge is itself off both its faces by its tolerance. So that no ray passes between them,
//   - the chain is moved to where the two faces' tangent planes meet, if they meet at an angle;
//   - each face then reaches outwards, along itself, until the sheets cross: for sheets off by e1 and e2 that
//     meet at the angle θ that is at (e1 + e2) / sin θ, or, where they go on smoothly, a few times e1 + e2.
#ifndef DUPIN_SAMPLING_PART_EDGES_H
#define DUPIN_SAMPLING_PART_EDGES_H

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "../nurbs/model.h"
#include "conic_arc.h"

namespace dupin {

/// What edges and the cells at them are held to, as parts of the tolerance that holds for faces.
inline constexpr double kEdgeTolerance = 0.02, kTrimTolerance = 0.02;

/// How far a face reaches over an arc: at its first point, its middle and its last, in the edge's direction.
struct ArcReach {
  std::array<Vec3, 3> by;
  double own = 0;  ///< the largest of it that is due to approximation, not to the file's edge being off
};

/// Moves an arc's ends and its middle, the point at its parameter's half.
void displace(ConicArc3& arc, const std::array<Vec3, 3>& by);

/// A plane, cylinder, cone or sphere (or recognised as one): drawn as the surface itself.
bool is_drawn_exactly(const Part& part, const Face& face);

/// A face at a point of one of its edges.
struct EdgeSide {
  Vec3 p, n;       ///< of the surface; n is Su × Sv, unit, or zero at a pole
  double off = 0;  ///< what its sheet may be off
};

class PartEdges {
 public:
  /// `tolerance`: that of faces.
  PartEdges(const Part& part, const LocalTolerance& tolerance);
  /// By edge. Ends that meet in a vertex are the same point, bit for bit: the vertex's.
  const std::vector<ArcChain>& chains() const { return chains_; }
  /// Of the trim-th use of an edge by the face, counted through its loops: one for each arc of the edge's
  /// chain, or none where it need not reach.
  std::span<const ArcReach> reach(std::uint32_t face, std::size_t trim) const;
  /// How far the edge's chain was moved, at most.
  double moved(std::uint32_t edge) const { return moved_[edge]; }

 private:
  struct Use {
    std::uint32_t face;
    std::uint32_t trim;  ///< over all faces
    const Trim* as;
  };
  /// The faces of an edge at one of its ends, where the file's edge is off them.
  struct EndPlanes {
    EdgeSide sides[2];
  };
  void find_uses();
  void join_vertices();
  void note_planes(std::uint32_t end, const EdgeSide& a, const EdgeSide& b);
  Vec3 meeting_point(const std::vector<std::uint32_t>& ends, const Vec3& p, double most) const;
  void close_edge(std::uint32_t edge, const LocalTolerance& tolerance);
  void close_between(std::uint32_t edge, std::span<const Use> used, const LocalTolerance& tolerance);
  std::span<const Use> uses(std::uint32_t edge) const {
    return {uses_.data() + first_use_[edge], uses_.data() + first_use_[edge + 1]};
  }

  const Part& part_;
  std::vector<ArcChain> chains_;
  std::vector<double> moved_;
  std::vector<std::unique_ptr<std::array<EndPlanes, 2>>> planes_;  ///< by edge, where there are any
  std::vector<std::uint32_t> first_trim_;                          ///< by face
  std::vector<Use> uses_;                                          ///< by edge, from
  std::vector<std::uint32_t> first_use_;                           ///< to the next edge's
  std::vector<std::vector<ArcReach>> reach_;                       ///< by trim
};

}  // namespace dupin

#endif
