#include "point_sampler.h"

#include <atomic>
#include <memory>

#include "../core/parallel.h"
#include "mesh_points.h"
#include "point_faces.h"
#include "sampler.h"

namespace dupin {
namespace {

constexpr int kMostRefinement = 256;

std::string face_name(const Part& part, std::size_t face) {
  if (!part.faces[face].name.empty()) return part.faces[face].name;
  return "face " + std::to_string(face + 1) + (part.name.empty() ? "" : " of " + part.name);
}

/// Patches of all faces of a part, and what became of them.
struct PatchTask {
  std::size_t face;
  Box2 domain;
  SampleGrid grid;
  PatchPoints made;
};

class PartPointSampler {
 public:
  PartPointSampler(const Part& part, const PointSamplingOptions& options) : part_(part), options_(options) {
    faces_.resize(part.faces.size());
    parallel_for(
        faces_.size(),
        [&](std::size_t i) {
          faces_[i] = std::make_unique<FacePoints>(part, static_cast<std::uint32_t>(i), options);
        },
        16);
    for (std::size_t i = 0; i < faces_.size(); ++i)
      for (const Box2& patch : parameter_patches(faces_[i]->surface(), faces_[i]->region().box()))
        tasks_.push_back({i, patch, {}, {}});
  }

  Status run(const std::function<bool(double)>& go_on, PartPoints& out) {
    Status status = make_all(1, std::vector<bool>(faces_.size(), true), go_on);
    std::vector<bool> again = missed();
    for (int refine = 2; options_.method == PointMethod::uniform && refine <= kMostRefinement; refine *= 2) {
      if (!status.ok() || std::find(again.begin(), again.end(), true) == again.end()) break;
      status = make_all(refine, again, go_on);
      again = missed();
    }
    if (!status.ok()) return status;
    out.points.reserve(made_);
    for (const PatchTask& task : tasks_) append(task.made.points, out);
    list_skipped(again, out);
    return {};
  }

 private:
  /// Room for all samples of the grids?
  Status make_grids(int refine, const std::vector<bool>& wanted) {
    if (options_.method != PointMethod::uniform) return {};
    parallel_for(
        tasks_.size(),
        [&](std::size_t i) {
          PatchTask& task = tasks_[i];
          if (wanted[task.face]) task.grid = uniform_grid(*faces_[task.face], task.domain, refine);
        },
        16);
    std::size_t samples = 0;
    for (const PatchTask& task : tasks_) samples += std::size_t{task.grid.rows} * task.grid.columns;
    return samples <= kMostPoints ? Status{} : too_many();
  }

  static Status too_many() {
    return {StatusCode::limit, "more than " + std::to_string(kMostPoints) + " samples of a part"};
  }

  Status make_all(int refine, const std::vector<bool>& wanted, const std::function<bool(double)>& go_on) {
    if (const Status status = make_grids(refine, wanted); !status.ok()) return status;
    std::atomic<std::size_t> done{0};
    parallel_for(tasks_.size(), [&](std::size_t i) {
      PatchTask& task = tasks_[i];
      if (stop_ || !wanted[task.face]) return;
      const FacePoints& face = *faces_[task.face];
      task.made = options_.method == PointMethod::uniform ? uniform_patch(face, task.domain, task.grid)
                                                          : adaptive_patch(face, task.domain);
      const std::size_t now = ++done;
      made_ += task.made.points.points.size();
      if (made_ > kMostPoints) stop_ = true;
      if ((now & 31) == 0 && !go_on(static_cast<double>(now) / static_cast<double>(tasks_.size())))
        stop_ = true;
    });
    if (made_ > kMostPoints) return too_many();
    return stop_ ? Status{StatusCode::cancelled, ""} : Status{};
  }

  std::vector<bool> missed() const {
    std::vector<bool> none(faces_.size(), true);
    for (const PatchTask& task : tasks_)
      if (!task.made.points.points.empty()) none[task.face] = false;
    return none;
  }

  void list_skipped(const std::vector<bool>& missed, PartPoints& out) const {
    std::vector<bool> undefined(faces_.size(), false);
    for (const PatchTask& task : tasks_)
      if (task.made.undefined) undefined[task.face] = true;
    for (std::size_t i = 0; i < missed.size(); ++i)
      if (missed[i])
        out.skipped.push_back(
            {face_name(part_, i),
             undefined[i] ? "its surface has no curvature at any sample" : "no sample lies within its trims",
             1});
  }

  const Part& part_;
  const PointSamplingOptions& options_;
  std::vector<std::unique_ptr<FacePoints>> faces_;
  std::vector<PatchTask> tasks_;
  std::atomic<std::size_t> made_{0};
  std::atomic<bool> stop_{false};
};

/// A quadric DP approximates over its cell: at the cell's middle the surface's own position, frame and
/// curvatures are taken, where it has them.
void place_point(const QuadricDp& dp, const Surface& surface, DifferentialPoint& point) {
  const Vec2 uv = dp.cell.center();
  const double side = dp.flipped ? -1 : 1;
  point.position = dp.origin;
  point.u = dp.u, point.v = dp.v * side;
  point.lambda_u = side * dp.lambda_u, point.lambda_v = side * dp.lambda_v;
  if (dp.exact) return;
  const Curvature curvature = principal_curvature(surface, uv.x, uv.y, uv);
  const Vec3 position = point_at(surface, uv.x, uv.y);
  if (curvature.kind == Curvature::Kind::undefined || !is_finite(position)) return;
  point.position = position;
  point.u = curvature.d1, point.v = curvature.d2 * side;
  point.lambda_u = side * curvature.k1, point.lambda_v = side * curvature.k2;
}

/// Its rectangle holds the DP's footprint, which need not be symmetric.
DifferentialPoint point_of(const QuadricDp& dp, const Surface& surface) {
  DifferentialPoint point;
  place_point(dp, surface, point);
  for (const Vec2 c : dp.footprint) {
    const Vec3 corner = dp.origin + dp.u * c.x + dp.v * c.y - point.position;
    point.half_u = std::max(point.half_u, std::abs(dot(corner, point.u)));
    point.half_v = std::max(point.half_v, std::abs(dot(corner, point.v)));
  }
  if (std::abs(point.lambda_u) < std::abs(point.lambda_v)) {
    std::swap(point.lambda_u, point.lambda_v);
    std::swap(point.half_u, point.half_v);
    const Vec3 u = point.u;
    point.u = point.v;
    point.v = -u;
  }
  point.uv = dp.cell.center();
  point.bound = dp.bound;
  point.face = dp.face;
  point.own_size = true;
  return point;
}

Result<PointScene> certified_points(const Model& model, const PointSamplingOptions& options) {
  SamplingOptions sampling;
  sampling.tolerance = options.tolerance;
  sampling.progress = options.progress;
  auto dps = sample_quadric_dps(model, sampling);
  if (!dps) return dps.status();
  PointScene scene;
  for (std::size_t i = 0; i < dps->parts.size(); ++i) {
    PartPoints& out = scene.parts.emplace_back();
    const Part& part = model.parts[i];
    for (const QuadricDp& dp : dps->parts[i].dps)
      out.points.push_back(point_of(dp, part.surfaces[part.faces[dp.face].surface]));
    out.skipped = std::move(dps->parts[i].skipped);
  }
  return scene;
}

std::string group_name(const Part& part, std::size_t group) {
  const std::vector<MeshGroup>& groups = part.polygons.groups;
  if (group < groups.size() && !groups[group].name.empty()) return groups[group].name;
  return "mesh" + (part.name.empty() ? std::string{} : " of " + part.name);
}

/// Lists the groups of the part's polygons that no point is of.
void list_skipped_groups(const Part& part, const char* reason, PartPoints& out) {
  std::vector<bool> sampled(face_count(part), false);
  for (const DifferentialPoint& p : out.points) sampled[p.face] = true;
  for (std::size_t f = part.faces.size(); f < sampled.size(); ++f)
    if (!sampled[f]) out.skipped.push_back({group_name(part, f - part.faces.size()), reason, 1});
}

void count_losses(const MeshPointLosses& losses, PointScene& scene) {
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) scene.notes.push_back(std::to_string(count) + what);
  };
  note(losses.loose_vertices, " vertices that no polygon uses lie on no surface: not sampled");
  note(losses.flat_triangles, " triangles without area: of no weight in curvatures");
  note(losses.lost_vertices, " vertices have only triangles without area: not sampled");
  note(losses.split_vertices, " vertices at creases: a point for each smooth side");
}

Status check(const PointSamplingOptions& options) {
  const auto bad = [](const char* why) { return Status{StatusCode::invalid_argument, why}; };
  if (options.method == PointMethod::certified)
    return options.tolerance > 0 ? Status{} : bad("certified points need a tolerance above 0");
  if (!(options.epsilon > 0 && options.epsilon <= 1)) return bad("epsilon must be above 0 and at most 1");
  if (!(options.delta > 0) || !std::isfinite(options.delta)) return bad("delta must be above 0");
  if (options.grid != 0 && options.grid < 2) return bad("a grid needs at least 2 samples along a parameter");
  if (options.spacing < 0 || options.border < 0) return bad("distances must not be negative");
  return {};
}

}  // namespace

FacePoints::FacePoints(const Part& part, std::uint32_t index, const PointSamplingOptions& options)
    : face_(part.faces[index]),
      surface_(part.surfaces[part.faces[index].surface]),
      index_(index),
      options_(options),
      region_(part, part.faces[index]) {}

std::optional<DifferentialPoint> FacePoints::at(Vec2 uv, Vec2 inside) const {
  const Curvature curvature = principal_curvature(surface_, uv.x, uv.y, inside);
  const Vec3 position = point_at(surface_, uv.x, uv.y);
  if (curvature.kind == Curvature::Kind::undefined || !is_finite(position)) return std::nullopt;
  DifferentialPoint point;
  point.position = position;
  point.u = curvature.d1;
  point.v = face_.reversed ? -curvature.d2 : curvature.d2;
  point.lambda_u = face_.reversed ? -curvature.k1 : curvature.k1;
  point.lambda_v = face_.reversed ? -curvature.k2 : curvature.k2;
  point.uv = uv;
  point.face = index_;
  set_extents(point, options_.epsilon, options_.delta);
  return point;
}

void append(const PartPoints& from, PartPoints& to) {
  const auto first = static_cast<std::uint32_t>(to.points.size());
  const auto first_cell = static_cast<std::uint32_t>(to.grid_points.size());
  to.points.insert(to.points.end(), from.points.begin(), from.points.end());
  for (const SampleGrid& grid : from.grids)
    to.grids.push_back({first_cell + grid.first, grid.rows, grid.columns});
  for (const std::uint32_t index : from.grid_points)
    to.grid_points.push_back(index == kNoPoint ? kNoPoint : first + index);
  for (const auto& [a, b] : from.edges) to.edges.push_back({first + a, first + b});
  to.pruned = to.pruned || from.pruned;
  to.skipped.insert(to.skipped.end(), from.skipped.begin(), from.skipped.end());
}

Result<PointScene> sample_points(const Model& model, const PointSamplingOptions& options) {
  if (const Status status = check(options); !status.ok()) return status;
  if (options.method == PointMethod::certified) {
    auto scene = certified_points(model, options);
    for (std::size_t i = 0; scene.ok() && i < model.parts.size(); ++i)
      list_skipped_groups(model.parts[i], "a mesh has no certified points", scene->parts[i]);
    return scene;
  }
  PointScene scene;
  scene.epsilon = options.epsilon;
  scene.delta = options.delta;
  scene.parts.resize(model.parts.size());
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(model.parts.size(), 1));
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    const auto go_on = [&](double part) {
      return report(options.progress, "sample", share * (static_cast<double>(i) + part));
    };
    const Status status = PartPointSampler(model.parts[i], options).run(go_on, scene.parts[i]);
    if (!status.ok()) return status;
    const Part& part = model.parts[i];
    if (!part.polygons.empty()) {
      MeshPointLosses losses;
      MeshPointOptions mesh = options.mesh;
      mesh.epsilon = options.epsilon;
      mesh.first_face = static_cast<std::uint32_t>(part.faces.size());
      append(mesh_points(part.polygons, mesh, losses), scene.parts[i]);
      count_losses(losses, scene);
      list_skipped_groups(part, "none of its polygons has an area", scene.parts[i]);
    }
    if (!go_on(1)) return {StatusCode::cancelled, ""};
  }
  return scene;
}

}  // namespace dupin
