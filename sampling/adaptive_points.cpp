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
/// Points of a surface's border that are nearer to each other than this part of `border` are one.
constexpr double kSame = 1e-3;
/// Over one cell the normal turns by less than this: else its rectangle says little of what is behind it.
constexpr double kLeastCosine = 0.5;

class AdaptivePatch {
 public:
  AdaptivePatch(const FacePoints& face, PatchPoints& out) : face_(face), out_(out) {
    border_ = face.options().border > 0 ? face.options().border : face.options().delta / 8;
    find_open_sides();
  }

  void refine(const Box2& cell, int halvings) {
    const TrimRegion::Overlap overlap = face_.region().overlap(cell);
    if (overlap == TrimRegion::Overlap::outside) return;
    const Cell made = measure(cell);
    const double size = std::max(made.reach.x, made.reach.y);
    const bool last = halvings >= kMostHalvings || (made.point && size < kLeastSize * face_.options().delta);
    const bool out_of_border =
        overlap == TrimRegion::Overlap::crossing ? size > border_ : made.overhang > border_;
    if (!last && (!made.point || !made.covered || (out_of_border && size > border_)))
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
    double overhang = 0;   ///< how far the rectangle stands out over an open side of the face
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
    made.overhang = overhang(cell, p, made.reach);
    made.covered = facing && made.reach.x <= p.half_u && made.reach.y <= p.half_v;
    if (across[0] != across[1]) made.along_u = across[0] > across[1];
    return made;
  }

  /// The sides of the face's box that are neither collapsed to a point nor a closed surface's seam.
  void find_open_sides() {
    const Box2& box = face_.region().box();
    constexpr double kAt[] = {0.17, 0.5, 0.83};
    Vec3 at[4][3];  // on the sides lo.x, hi.x, lo.y, hi.y
    for (int k = 0; k < 3; ++k) {
      const Vec2 uv = box.lo + Vec2{box.size().x * kAt[k], box.size().y * kAt[k]};
      at[0][k] = point_at(face_.surface(), box.lo.x, uv.y);
      at[1][k] = point_at(face_.surface(), box.hi.x, uv.y);
      at[2][k] = point_at(face_.surface(), uv.x, box.lo.y);
      at[3][k] = point_at(face_.surface(), uv.x, box.hi.y);
    }
    const auto same = [&](const Vec3& a, const Vec3& b) { return distance(a, b) <= kSame * border_; };
    for (int side = 0; side < 4; ++side) {
      const Vec3 *own = at[side], *other = at[side ^ 1];
      const bool collapsed = same(own[0], own[1]) && same(own[1], own[2]),
                 seam = same(own[0], other[0]) && same(own[1], other[1]) && same(own[2], other[2]);
      open_[side] = !collapsed && !seam;
    }
  }

  /// In the tangent plane, where the cell is a parallelogram.
  double overhang(const Box2& cell, const DifferentialPoint& p, Vec2 reach) const {
    const Box2& box = face_.region().box();
    const bool touched[] = {open_[0] && cell.lo.x == box.lo.x, open_[1] && cell.hi.x == box.hi.x,
                            open_[2] && cell.lo.y == box.lo.y, open_[3] && cell.hi.y == box.hi.y};
    if (!touched[0] && !touched[1] && !touched[2] && !touched[3]) return 0;
    const Vec2 c = cell.center(), h = cell.size() * 0.5;
    const SurfaceJet jet = evaluate(face_.surface(), c.x, c.y, 1);
    const Vec2 a = Vec2{dot(jet.pu, p.u), dot(jet.pu, p.v)} * h.x,
               b = Vec2{dot(jet.pv, p.u), dot(jet.pv, p.v)} * h.y;
    double most = 0;
    for (int k = 0; k < 2; ++k) {  // across the sides of u, of v
      if (!touched[2 * k] && !touched[2 * k + 1]) continue;
      const Vec2 along = k == 0 ? b : a;
      const double size = length(along);
      if (!(size > 0)) continue;
      const double out = (std::abs(along.y) * reach.x + std::abs(along.x) * reach.y) / size;
      most = std::max(most, out - std::abs(cross(a, b)) / size);
    }
    return most;
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
  bool open_[4];
};

}  // namespace

PatchPoints adaptive_patch(const FacePoints& face, const Box2& patch) {
  PatchPoints out;
  AdaptivePatch(face, out).refine(patch, 0);
  return out;
}

}  // namespace dupin
