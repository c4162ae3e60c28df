#include "exact_pixels.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "../core/parallel.h"
#include "../nurbs/invert.h"

namespace dupin {
namespace {

/// A face's points to start from where there is no cell of a DP, or a search from it went astray.
constexpr int kSeeds = 16;
constexpr std::size_t kSeedTries = 4;

Vec2 grid_point(const Box2& box, int i, int j) {
  return {box.lo.x + box.size().x * (i + 0.5) / kSeeds, box.lo.y + box.size().y * (j + 0.5) / kSeeds};
}

/// The nearest point within a box of parameters, without derivatives: from the best point of a grid in ever
/// smaller steps. For singular corners, where Newton's method finds no way.
Vec2 by_halving(const Surface& surface, const Vec3& p, const Box2& box) {
  constexpr int kHalvings = 40;
  Vec2 best = box.center();
  double least = std::numeric_limits<double>::infinity();
  const auto attempt = [&](Vec2 q) {
    q = {std::clamp(q.x, box.lo.x, box.hi.x), std::clamp(q.y, box.lo.y, box.hi.y)};
    const double d = length(point_at(surface, q.x, q.y) - p);
    if (!(d < least)) return false;
    least = d, best = q;
    return true;
  };
  for (int j = 0; j < kSeeds; ++j)
    for (int i = 0; i < kSeeds; ++i) attempt(grid_point(box, i, j));
  Vec2 step = box.size() / kSeeds;
  for (int k = 0; k < kHalvings; ++k) {
    const Vec2 from = best;
    bool nearer = false;
    for (const Vec2 way : {Vec2{step.x, 0}, Vec2{-step.x, 0}, Vec2{0, step.y}, Vec2{0, -step.y}})
      nearer = attempt(from + way) || nearer;
    if (!nearer) step = step / 2;
  }
  return best;
}

/// One placed face, searched pixel by pixel along a row.
class FaceSearch {
 public:
  FaceSearch(const Surface& surface, const Box2& box) : surface_(surface), box_(box) {}

  /// The parameters for a point no farther than `reach` from the surface; `guess` is tried first, and they
  /// are likely to be in or near the cell.
  std::optional<Vec2> find(const Vec3& p, Vec2 guess, const Box2& cell, double reach) {
    if (const auto q = near(p, guess, reach)) return q;
    if (const auto q = near(p, cell.center(), reach)) return q;
    if (seeds_.empty()) plant();
    std::array<std::size_t, kSeedTries> nearest{};
    for (std::size_t rank = 0; rank < kSeedTries; ++rank) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < seeds_.size(); ++i) {
        const double d = length(seeds_[i] - p);
        if (d < least && std::find(nearest.begin(), nearest.begin() + rank, i) == nearest.begin() + rank)
          least = d, nearest[rank] = i;
      }
      const int i = static_cast<int>(nearest[rank]);
      if (const auto q = near(p, grid_point(box_, i % kSeeds, i / kSeeds), reach)) return q;
    }
    const Vec2 q = by_halving(surface_, p, cell);
    if (length(point_at(surface_, q.x, q.y) - p) <= reach) return q;
    return std::nullopt;
  }

 private:
  std::optional<Vec2> near(const Vec3& p, Vec2 guess, double reach) const {
    const auto q = invert(surface_, p, guess);
    if (!q || !(length(point_at(surface_, q->x, q->y) - p) <= reach)) return std::nullopt;
    return q;
  }
  void plant() {
    for (int j = 0; j < kSeeds; ++j)
      for (int i = 0; i < kSeeds; ++i) {
        const Vec2 q = grid_point(box_, i, j);
        seeds_.push_back(point_at(surface_, q.x, q.y));
      }
  }

  const Surface& surface_;
  Box2 box_;
  std::vector<Vec3> seeds_;
};

/// The largest stretch of a linear map is at most this.
double stretch(const Mat3& m) {
  return std::sqrt(dot(m.x, m.x) + dot(m.y, m.y) + dot(m.z, m.z));
}

SurfaceJet placed(const Affine3& to_world, const SurfaceJet& jet) {
  const Mat3& l = to_world.linear;
  SurfaceJet result;
  result.pu = l * jet.pu, result.pv = l * jet.pv;
  result.puu = l * jet.puu, result.puv = l * jet.puv, result.pvv = l * jet.pvv;
  return result;
}

/// The surface's principal curvatures as it is placed, towards the face's outward normal. At singular points
/// the limit, for placements that keep angles; not finite if there is none.
Curvature placed_curvature(const Surface& surface, const Face& face, const SceneInstance& instance, Vec2 q,
                           Vec2 inside) {
  const Mat3& l = instance.to_world.linear;
  const double volume = dot(l.x, cross(l.y, l.z));
  const double side = (face.reversed ? -1 : 1) * (volume < 0 ? -1 : 1);
  Curvature c = principal_curvature(surface, q.x, q.y, inside);
  if (c.kind == Curvature::Kind::singular_limit) {
    const double scale = std::cbrt(std::abs(volume));
    c.k1 *= 1 / scale, c.k2 *= 1 / scale;
    // A mirrored placement mirrors n with the surface: the curvature towards it keeps its sign.
    c.k1 *= volume < 0 ? -1 : 1, c.k2 *= volume < 0 ? -1 : 1;
    c.d1 = normalized(l * c.d1);
  } else {
    c = principal_curvature(placed(instance.to_world, evaluate(surface, q.x, q.y, 2)));
  }
  c.k1 *= side, c.k2 *= side;
  return c;
}

class Row {
 public:
  Row(const Model& model, const Scene::Impl& scene, const DrawnPixels& drawn, const ExactPixels& result)
      : model_(model), scene_(scene), drawn_(drawn), result_(result) {}

  void run(int row) {
    for (int column = 0; column < drawn_.view.width; ++column) {
      const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(drawn_.view.width) +
                            static_cast<std::size_t>(column);
      const std::uint32_t face = drawn_.numbers[2 * i], primitive = drawn_.numbers[2 * i + 1];
      if (face == 0 || face > scene_.faces.size() || !std::isfinite(drawn_.depth[i])) {
        last_primitive_ = 0;
        continue;
      }
      if (face != face_) enter(face);
      if (surface_) pixel(i, column, row, primitive);
    }
  }

 private:
  void enter(std::uint32_t face) {
    face_ = face;
    surface_ = nullptr;
    last_primitive_ = 0;
    const FaceName& name = scene_.faces[face - 1];
    instance_ = &scene_.instances[name.instance];
    const Part& part = model_.parts[instance_->part];
    if (name.face >= part.faces.size()) return;  // a mesh without exact faces
    exact_face_ = &part.faces[name.face];
    if (exact_face_->surface >= part.surfaces.size()) return;  // points without their surface
    surface_ = &part.surfaces[exact_face_->surface];
    quadric_ = is_quadric(*surface_);
    search_.emplace(*surface_, exact_face_->uv_box);
    to_part_stretch_ = stretch(instance_->to_part.linear);
  }

  /// In the part's space.
  Vec3 point(std::size_t i, int column, int row) const {
    const ViewRays& view = drawn_.view;
    const double z = drawn_.depth[i], x = (column + 0.5) * 2 / view.width - 1,
                 y = (row + 0.5) * 2 / view.height - 1, across = view.perspective ? z : 1;
    const Vec3 p = view.eye + view.forward * z + view.right * ((view.ox + view.sx * x) * across) +
                   view.up * ((view.oy + view.sy * y) * across);
    return transform_point(instance_->to_part, p);
  }

  /// Where the search starts, and how far off the surface the DP may be.
  struct Start {
    Vec2 guess;
    Box2 cell;
    double bound = 0;
  };
  Start start(std::uint32_t primitive) const {
    const ScenePart& part = scene_.parts[instance_->part];
    const std::uint32_t index = primitive - instance_->first_primitive - 1;
    const bool dp = index < part.dps.size();
    const Box2& cell = dp ? part.dps[index].dp.cell : exact_face_->uv_box;
    Start s{cell.center(), cell, dp ? part.dps[index].dp.bound : 0};
    if (primitive == last_primitive_) s.guess = last_;
    return s;
  }

  /// Layers know their own curvatures.
  bool of_layer(std::uint32_t primitive) const {
    const ScenePart& part = scene_.parts[instance_->part];
    return primitive - instance_->first_primitive > part.dps.size() + part.triangles;
  }

  void pixel(std::size_t i, int column, int row, std::uint32_t primitive) {
    const bool curvatures = (result_.curvature || result_.direction) && !quadric_ && !of_layer(primitive);
    if (!curvatures && !result_.uv) return;
    const Start from = start(primitive);
    const double reach = kFarthestPx * pixel_size(drawn_.view, drawn_.depth[i]) * to_part_stretch_ +
                         kFarthestBounds * from.bound + exact_face_->tolerance;
    const auto q = search_->find(point(i, column, row), from.guess, from.cell, reach);
    if (!q) return;
    last_ = *q;
    last_primitive_ = primitive;
    if (result_.uv) store(*result_.uv, 2 * i, {q->x, q->y});
    if (curvatures) store_curvature(i, *q, from.cell.center());
  }

  void store_curvature(std::size_t i, Vec2 q, Vec2 inside) const {
    const Curvature c = placed_curvature(*surface_, *exact_face_, *instance_, q, inside);
    if (!std::isfinite(c.k1) || !std::isfinite(c.k2)) return;
    if (result_.curvature) store(*result_.curvature, 2 * i, {c.k1, c.k2});
    if (result_.direction) store(*result_.direction, 3 * i, {c.d1.x, c.d1.y, c.d1.z});
  }
  static void store(std::vector<float>& out, std::size_t at, std::initializer_list<double> values) {
    for (const double v : values) out[at++] = static_cast<float>(v);
  }

  const Model& model_;
  const Scene::Impl& scene_;
  const DrawnPixels& drawn_;
  const ExactPixels& result_;

  std::uint32_t face_ = 0, last_primitive_ = 0;
  Vec2 last_;
  const SceneInstance* instance_ = nullptr;
  const Face* exact_face_ = nullptr;
  const Surface* surface_ = nullptr;
  bool quadric_ = false;
  double to_part_stretch_ = 1;
  std::optional<FaceSearch> search_;
};

}  // namespace

void find_exact(const Model& model, const Scene::Impl& scene, const DrawnPixels& drawn,
                const ExactPixels& result) {
  parallel_for(static_cast<std::size_t>(drawn.view.height),
               [&](std::size_t row) { Row(model, scene, drawn, result).run(static_cast<int>(row)); });
}

}  // namespace dupin
