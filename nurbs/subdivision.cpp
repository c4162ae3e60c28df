#include "subdivision.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "jets.h"
#include "limit_caps.h"
#include "limit_part.h"
#include "shape_operator.h"

namespace dupin {
namespace {

constexpr int kFewestLevels = 3;
/// Cuts from which it is told how many more are worth it.
constexpr int kProbeLevels = 5;
/// Creases less sharp than this are never taken for infinitely sharp.
constexpr double kLeastSharpened = 3;
/// A level that has so many times the faces of the one before grows along edges, not around vertices.
constexpr double kAlongEdges = 1.7;
/// Pieces that refinement may make in all.
constexpr double kMostPieces = 1e6;

double longest_edge(const CageLevel& level, std::uint32_t face) {
  double most = 0;
  for (std::uint32_t e : level.edges(face)) {
    const auto& ends = level.edge_vertices[e];
    most = std::max(most, distance(level.points[ends[0]], level.points[ends[1]]));
  }
  return most;
}

/// How often to cut, and whether that is until what is left is too small to matter.
struct LevelPlan {
  int levels = 0;
  bool complete = true;
};

/// From what a few cuts leave over. Semi-sharp creases double their pieces with every cut up to `sharpest`.
LevelPlan plan_levels(const LimitForest& few, double sharpest, double diagonal, double least_size) {
  const int last = static_cast<int>(few.cage.levels.size()) - 1;
  double counts[2] = {0, 0}, longest = 0;
  for (const LimitNode& node : few.nodes) {
    if (node.regular() || node.level + 1 < last) continue;
    ++counts[node.level == last];
    if (node.level == last) longest = std::max(longest, longest_edge(few.cage.levels[node.level], node.face));
  }
  if (counts[1] == 0) return {last, true};
  const double growth = std::max(1.0, counts[1] / std::max(counts[0], 1.0));
  constexpr double kPiecesEach = 8;  // with the neighbours that refinement needs
  constexpr int kBelowCaps = 3;      // to bound what a cap is off
  int level = last;
  double pieces = 0, each = counts[1];
  // Along edges that are not manifold OpenSubdiv refines for ever.
  double faces = static_cast<double>(few.cage.levels[few.cage.levels.size() - 1].face_count());
  const double before = static_cast<double>(few.cage.levels[few.cage.levels.size() - 2].face_count());
  const bool along_edges = faces > kAlongEdges * before;
  while (level < kMaxSubdivisionLevels && longest > least_size * diagonal * std::ldexp(1.0, -kBelowCaps)) {
    each = level < sharpest ? each * growth : counts[1];
    pieces += kPiecesEach * each;
    if (along_edges) faces *= 2;
    if (pieces > kMostPieces || (along_edges && faces > kMostPieces)) return {level, false};
    ++level, longest *= 0.5;
  }
  return {level, true};
}

constexpr float kInfinitelySharp = 10;

double sharpest_of(const SubdivisionTags& tags) {
  float most = 0;
  for (const auto& crease : tags.creases)
    if (crease.sharpness < kInfinitelySharp) most = std::max(most, crease.sharpness);
  for (const auto& corner : tags.corners)
    if (corner.sharpness < kInfinitelySharp) most = std::max(most, corner.sharpness);
  return most;
}

/// Makes the sharpest semi-sharp creases infinitely sharp; returns how many.
int sharpen(SubdivisionTags& tags, double from) {
  int count = 0;
  for (auto& crease : tags.creases)
    if (crease.sharpness >= from && crease.sharpness < kInfinitelySharp)
      crease.sharpness = kInfinitelySharp, ++count;
  return count;
}

LimitJet nothing() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  LimitJet out;
  out.jet.p = out.jet.pu = out.jet.pv = {nan, nan, nan};
  out.exact = false;
  return out;
}

}  // namespace

class SubdivisionSurface::Impl {
 public:
  Impl(PolygonMesh cage, CageLevels levels)
      : cage_(std::move(cage)), forest_(make_limit_forest(std::move(levels))) {
    faces_.assign(cage_.polygon_count(), kNoIndex);
    for (std::size_t f = 0; f < forest_.cage.polygons.size(); ++f)
      faces_[forest_.cage.polygons[f]] = static_cast<std::uint32_t>(f);
    for (const Vec3& p : forest_.cage.levels[0].points) box_.add(p);
  }

  const LimitForest& forest() const { return forest_; }
  const PolygonMesh& cage() const { return cage_; }
  double diagonal() const { return box_.diagonal(); }
  const LimitNode* root(std::size_t polygon) const {
    if (polygon >= faces_.size() || faces_[polygon] == kNoIndex) return nullptr;
    const std::uint32_t node = forest_.roots[faces_[polygon]];
    return node == kNoIndex ? nullptr : &forest_.nodes[node];
  }
  bool is_whole(const LimitNode& root) const {
    return static_cast<int>(forest_.cage.levels[0].vertices(root.face).size()) == forest_.corners();
  }

 private:
  PolygonMesh cage_;
  LimitForest forest_;
  std::vector<std::uint32_t> faces_;  ///< of the first level, by polygon
  Box3 box_;
};

SubdivisionSurface::SubdivisionSurface(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SubdivisionSurface::SubdivisionSurface(SubdivisionSurface&&) noexcept = default;
SubdivisionSurface& SubdivisionSurface::operator=(SubdivisionSurface&&) noexcept = default;
SubdivisionSurface::~SubdivisionSurface() = default;

Result<SubdivisionSurface> SubdivisionSurface::make(const PolygonMesh& cage,
                                                    const SubdivisionOptions& options) {
  if (Status status = check(cage); !status.ok()) return status;
  if (options.levels != 0 && (options.levels < kFewestLevels || options.levels > kMaxSubdivisionLevels))
    return {StatusCode::invalid_argument, "subdivision levels must be " + std::to_string(kFewestLevels) +
                                              " to " + std::to_string(kMaxSubdivisionLevels)};
  Box3 box;
  for (const Vec3& p : cage.positions) box.add(p);
  PolygonMesh own = cage;
  SharpenedCreases sharpened;
  LevelPlan plan{options.levels, true};
  while (options.levels == 0) {
    const double sharpest = sharpest_of(own.tags);
    Result<CageLevels> few = refine_cage(own, {options.scheme, kProbeLevels, true});
    if (!few.ok()) return few.status();
    plan = plan_levels(make_limit_forest(std::move(*few)), sharpest, box.diagonal(),
                       LimitPartOptions{}.least_size);
    const double from = std::ceil(sharpest) - 1;
    if (plan.complete || from < kLeastSharpened) break;
    sharpened.count += sharpen(own.tags, from);
    sharpened.sharpness = from;
  }
  Result<CageLevels> refined = refine_cage(own, {options.scheme, plan.levels, true});
  if (!refined.ok()) return refined.status();
  SubdivisionSurface surface(std::make_unique<Impl>(std::move(own), std::move(*refined)));
  surface.sharpened_ = sharpened;
  return surface;
}

SubdivisionScheme SubdivisionSurface::scheme() const {
  return impl_->forest().cage.scheme;
}
int SubdivisionSurface::levels() const {
  return static_cast<int>(impl_->forest().cage.levels.size()) - 1;
}

LimitJet SubdivisionSurface::evaluate(std::size_t polygon, double u, double v, int order) const {
  const LimitNode* node = impl_->root(polygon);
  if (!node || !std::isfinite(u) || !std::isfinite(v)) return nothing();
  const LimitForest& forest = impl_->forest();
  Vec2 local{u, std::clamp(v, 0.0, 1.0)};
  if (!impl_->is_whole(*node)) {
    if (node->leaf()) return nothing();
    const double piece = std::clamp(std::floor(u), 0.0, static_cast<double>(node->children) - 1);
    node = &forest.nodes[node->first_child + static_cast<std::uint32_t>(piece)];
    local.x -= piece;
  }
  local.x = std::clamp(local.x, 0.0, 1.0);
  const double whole = node->size();
  // The last node that the interpolant may be made of, should there be no exact one below.
  const LimitNode* above[2] = {node, node};
  Vec2 above_local[2] = {local, local};
  while (!node->leaf()) {
    above[0] = above[1], above_local[0] = above_local[1];
    above[1] = node, above_local[1] = local;
    node = &forest.nodes[node->first_child + static_cast<std::uint32_t>(child_at(forest.corners(), local))];
  }
  LimitJet out;
  out.exact = node->regular();
  LimitPatch stand_in;
  if (!out.exact) {
    node = above[0], local = above_local[0];
    stand_in = interpolant(forest, *node);
  }
  order = std::clamp(order, 0, 3);
  Vec3 d[jet_size(3)];
  evaluate_patch(out.exact ? forest.patches[node->patch] : stand_in, local, order, d);
  const double rate = (node->flipped ? -1 : 1) * whole / node->size();
  double factor = rate;
  for (int k = 1; k <= order; ++k, factor *= rate)
    for (int b = 0; b <= k; ++b) d[jet_index(k - b, b)] = d[jet_index(k - b, b)] * factor;
  out.jet = {d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7], d[8], d[9]};
  return out;
}

Curvature SubdivisionSurface::curvature(std::size_t polygon, double u, double v) const {
  const LimitJet limit = evaluate(polygon, u, v, 2);
  return limit.exact ? principal_curvature(limit.jet) : undefined_curvature();
}

Vec3 SubdivisionSurface::corner_normal(std::size_t polygon, std::size_t corner) const {
  const LimitNode* node = impl_->root(polygon);
  if (!node || corner >= impl_->cage().corner_count(polygon)) return {};
  return corner_limit_normal(impl_->forest(), *node, static_cast<int>(corner));
}

Part SubdivisionSurface::part(const LimitPartOptions& options) const {
  return make_limit_part(impl_->forest(), impl_->cage(), impl_->diagonal(), options);
}

}  // namespace dupin
