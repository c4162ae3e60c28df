// Curvature-adaptive sampling: a cell of the parameter domain is one point's if the point's rectangle reaches
// over it.
#include "point_faces.h"

namespace dupin {
namespace {

constexpr int kMostHalvings = 40;
/// Cells this much smaller than δ are not halved any more, whatever their curvature: at singular points it
/// has no bound.
constexpr double kLeastSize = 1e-3;
/// What a rectangle has to reach beyond the eight points, for the border between them.
constexpr double kMargin = 0.02;
/// Seen at a slant, neighbouring rectangles in different planes shift against each other by their distance
/// times the slant's tangent: they reach this tangent times the distance of the osculating circle farther.
constexpr double kSlant = 2;
/// Over one cell the normal turns by less than this: else its rectangle says little of what is behind it.
constexpr double kLeastCosine = 0.5;

class AdaptivePatch {
 public:
  AdaptivePatch(const FacePoints& face, PatchPoints& out) : face_(face), out_(out) {
    border_ = face.options().border > 0 ? face.options().border : face.options().delta / 8;
  }

  void refine(const Box2& cell, int halvings) {
    const TrimRegion::Overlap overlap = face_.region().overlap(cell);
    if (overlap == TrimRegion::Overlap::outside) return;
    const Cell made = measure(cell);
    const double size = std::max(made.reach.x, made.reach.y);
    const bool last = halvings >= kMostHalvings || (made.point && size < kLeastSize * face_.options().delta);
    if (!last &&
        (!made.point || !made.covered || (overlap == TrimRegion::Overlap::crossing && size > border_)))
      return halve(cell, made.along_u, halvings);
    if (made.point) {
      emit(made);
    } else {
      out_.undefined = true;
    }
  }

 private:
  struct Cell {
    std::optional<DifferentialPoint> point;
    Vec2 reach;            ///< half-extents that the cell needs
    bool covered = false;  ///< they are within the rectangle
    bool along_u = true;   ///< the parameter that is too long for the rectangle, in relation
  };

  Cell measure(const Box2& cell) const {
    Cell made;
    const Vec2 c = cell.center(), h = cell.size() * 0.5;
    made.along_u = h.x / face_.region().box().size().x >= h.y / face_.region().box().size().y;
    made.point = face_.at(c, face_.region().box().center());
    if (!made.point) return made;
    const DifferentialPoint& p = *made.point;
    const Vec3 n = p.n();
    bool facing = true;
    double across[2] = {0, 0};
    for (int k = 0; k < 9; ++k) {
      if (k == 4) continue;
      const SurfaceJet jet = evaluate(face_.surface(), c.x + (k % 3 - 1) * h.x, c.y + (k / 3 - 1) * h.y, 1);
      const Vec3 d = jet.p - p.position, normal = normalized(cross(jet.pu, jet.pv));
      const Vec2 at{std::abs(dot(d, p.u)), std::abs(dot(d, p.v))};
      made.reach = {std::max(made.reach.x, at.x), std::max(made.reach.y, at.y)};
      facing &= std::abs(dot(normal, n)) >= kLeastCosine || normal == Vec3{};
      if (k % 2 == 1) {  // the middles of the cell's sides
        double& most = across[k == 3 || k == 5 ? 0 : 1];
        most = std::max({most, at.x / p.half_u, at.y / p.half_v});
      }
    }
    made.reach = made.reach * (1 + kMargin);
    made.reach = {made.reach.x + kSlant * sagitta(p.lambda_u, made.reach.x),
                  made.reach.y + kSlant * sagitta(p.lambda_v, made.reach.y)};
    made.covered = facing && made.reach.x <= p.half_u && made.reach.y <= p.half_v;
    if (across[0] != across[1]) made.along_u = across[0] > across[1];
    return made;
  }

  void halve(const Box2& cell, bool along_u, int halvings) {
    Box2 a = cell, b = cell;
    const Vec2 c = cell.center();
    if (along_u) {
      a.hi.x = b.lo.x = c.x;
    } else {
      a.hi.y = b.lo.y = c.y;
    }
    refine(a, halvings + 1);
    refine(b, halvings + 1);
  }

  void emit(const Cell& made) {
    DifferentialPoint point = *made.point;
    point.own_size = true;
    point.half_u = made.reach.x;
    point.half_v = made.reach.y;
    out_.points.points.push_back(point);
  }

  const FacePoints& face_;
  PatchPoints& out_;
  double border_;
};

}  // namespace

PatchPoints adaptive_patch(const FacePoints& face, const Box2& patch) {
  PatchPoints out;
  AdaptivePatch(face, out).refine(patch, 0);
  return out;
}

}  // namespace dupin
