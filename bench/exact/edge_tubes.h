// Edges as tubes of their tolerance, which close the cracks between faces. An edge that bounds one face once
// closes nothing and is none.
#ifndef DUPIN_BENCH_EXACT_EDGE_TUBES_H
#define DUPIN_BENCH_EXACT_EDGE_TUBES_H

#include <functional>
#include <vector>

#include "../../nurbs/model.h"
#include "bvh.h"

namespace dupin::exact {

class EdgeTubes {
 public:
  /// The part must outlive it.
  explicit EdgeTubes(const Part& part);

  /// Where a line comes nearer to an edge's curve than its tolerance.
  struct Passage {
    double t = 0;            ///< of the line, where it is nearest
    std::uint32_t face = 0;  ///< the first of the edge's faces
    Vec2 uv;                 ///< the edge's point nearest to the line, in that face's parameters
    /// How much farther along the line the edge's own faces may be met, where they meet it less than steeply.
    double reach = 0;
  };
  /// Every passage at a parameter in [least, most].
  void traverse(const Line& line, double least, double most,
                const std::function<void(const Passage&)>& visit) const;

 private:
  /// A nearly straight piece of an edge's curve.
  struct Piece {
    std::uint32_t edge = 0;
    double t0 = 0, t1 = 0;
  };
  /// The first use of an edge, and how many there are.
  struct Use {
    std::uint32_t face = 0;
    const Trim* trim = nullptr;
    int count = 0;
  };
  void cut(std::uint32_t edge, double t0, double t1, int depth, std::vector<Box3>& boxes);
  bool passes(const Line& line, const Piece& piece, Passage& passage) const;

  const Part& part_;
  std::vector<Use> uses_;  ///< of every edge
  std::vector<Piece> pieces_;
  Bvh bvh_;
};

}  // namespace dupin::exact

#endif
