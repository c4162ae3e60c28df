// The cracks between faces, closed by ruled strips.
//
// Where two faces use an edge, their pcurves' images A(t) and B(t) run side by side, some distance apart: the
// strip is the segments from A(t) to B(t). Where one face alone does (a file that was never sewn), it reaches
// from the image to the edge's own curve, where the neighbour's strip begins. A strip adds nothing at a
// silhouette, and has no width where the file has no crack.
#ifndef DUPIN_EXACT_CRACK_STRIPS_H
#define DUPIN_EXACT_CRACK_STRIPS_H

#include <functional>
#include <vector>

#include "../nurbs/model.h"
#include "bvh.h"

namespace dupin::exact {

class CrackStrips {
 public:
  /// The part must outlive it.
  explicit CrackStrips(const Part& part);

  /// Where a line meets a strip.
  struct Crossing {
    double t = 0;            ///< of the line
    std::uint32_t face = 0;  ///< the first of the edge's faces
    Vec2 uv;                 ///< of the edge's point there, in that face's parameters
  };
  /// Every crossing at a parameter in [least, most].
  void traverse(const Line& line, double least, double most,
                const std::function<void(const Crossing&)>& visit) const;

 private:
  struct Use {
    std::uint32_t face = 0;
    const Trim* trim = nullptr;
  };
  /// Between two uses of an edge, or between the only one and the edge's curve.
  struct Strip {
    std::uint32_t edge = 0;
    Use from, to;  ///< `to.trim` null: the curve
  };
  struct Piece {
    std::uint32_t strip = 0;
    double t0 = 0, t1 = 0;
  };
  void add(const Strip& strip, std::vector<Box3>& boxes);
  void cut(std::uint32_t strip, double t0, double t1, int depth, std::vector<Box3>& boxes);
  Vec3 image(const Use& use, double t) const;
  Vec3 end(const Strip& strip, double t) const;
  void meet(const Line& line, const Piece& piece, const std::function<void(const Crossing&)>& visit) const;

  const Part& part_;
  std::vector<Strip> strips_;
  std::vector<Piece> pieces_;
  Bvh bvh_;
};

}  // namespace dupin::exact

#endif
