#include "exact_scene.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "../core/parallel.h"
#include "bvh.h"
#include "crack_strips.h"
#include "surface_caster.h"
#include "trim_region.h"

namespace dupin::exact {
namespace {

struct ExactFace {
  std::unique_ptr<SurfaceCaster> surface;
  std::unique_ptr<TrimRegion> region;
};

struct Candidate {
  double t = INFINITY;
  Vec2 uv;
  std::uint32_t instance = 0, face = 0;
  bool found = false, in_crack = false;
  bool nearer_than(const Candidate& other) const {
    return t < other.t || (t == other.t && std::pair(instance, face) < std::pair(other.instance, other.face));
  }
};

class ExactPart {
 public:
  explicit ExactPart(const Part& part) : cracks_(part), faces_(part.faces.size()) {
    parallel_for(faces_.size(), [&](std::size_t i) {
      const Face& face = part.faces[i];
      faces_[i].surface = make_caster(part.surfaces[face.surface], face.uv_box);
      faces_[i].region = std::make_unique<TrimRegion>(part, face);
    });
    std::vector<Box3> boxes;
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      for (std::uint32_t c = 0; c < faces_[f].surface->boxes().size(); ++c) {
        boxes.push_back(faces_[f].surface->boxes()[c]);
        cells_.push_back({f, c});
        box_.add(boxes.back());
      }
    bvh_ = Bvh(boxes);
  }

  const Box3& box() const { return box_; }
  const std::vector<ExactFace>& faces() const { return faces_; }

  void cast(const Line& line, double least, std::uint32_t instance, Candidate& nearest) const {
    std::vector<Crossing> crossings;
    bvh_.traverse(line, least, nearest.t, [&](std::uint32_t item) {
      const auto [face, cell] = cells_[item];
      crossings.clear();
      faces_[face].surface->meet(cell, line, crossings);
      for (const Crossing& crossing : crossings) {
        Candidate candidate{crossing.t, crossing.uv, instance, face, true};
        if (crossing.t >= least && candidate.nearer_than(nearest) &&
            faces_[face].region->contains(candidate.uv))
          nearest = candidate;
      }
      return nearest.t;
    });
    cracks_.traverse(line, least, nearest.t, [&](const CrackStrips::Crossing& crossing) {
      const Candidate candidate{crossing.t, crossing.uv, instance, crossing.face, true, true};
      if (candidate.nearer_than(nearest)) nearest = candidate;
    });
  }

 private:
  struct Cell {
    std::uint32_t face, cell;
  };
  CrackStrips cracks_;
  std::vector<ExactFace> faces_;
  std::vector<Cell> cells_;
  Box3 box_;
  Bvh bvh_;
};

SurfaceJet transformed(const Affine3& to_world, const SurfaceJet& jet) {
  const auto vector = [&](const Vec3& v) { return transform_vector(to_world, v); };
  return {transform_point(to_world, jet.p),
          vector(jet.pu),
          vector(jet.pv),
          vector(jet.puu),
          vector(jet.puv),
          vector(jet.pvv)};
}

}  // namespace

class ExactScene::Impl {
 public:
  explicit Impl(const Model& model) : model_(model) {
    for (const Part& part : model.parts) parts_.emplace_back(part);
    std::vector<Box3> boxes;
    std::uint32_t number = 1;
    for (const Instance& instance : model.instances) {
      boxes.push_back(transform_box(instance.to_world, parts_[instance.part].box()));
      to_part_.push_back(inverse(instance.to_world));
      first_number_.push_back(number);
      number += static_cast<std::uint32_t>(model.parts[instance.part].faces.size());
    }
    instances_ = Bvh(boxes);
  }

  std::optional<Hit> cast(const Line& ray, double least) const {
    Candidate nearest;
    instances_.traverse(ray, least, INFINITY, [&](std::uint32_t i) {
      const Affine3& to_part = to_part_[i];
      const Line line{transform_point(to_part, ray.origin), transform_vector(to_part, ray.direction)};
      parts_[model_.instances[i].part].cast(line, least, i, nearest);
      return nearest.t;
    });
    if (!nearest.found) return std::nullopt;
    return describe(nearest);
  }

  const Model& model() const { return model_; }
  const std::vector<ExactPart>& parts() const { return parts_; }

 private:
  Hit describe(const Candidate& nearest) const {
    const Instance& instance = model_.instances[nearest.instance];
    const Part& part = model_.parts[instance.part];
    const Face& face = part.faces[nearest.face];
    const Surface& surface = part.surfaces[face.surface];
    const Affine3& to_world = instance.to_world;
    const SurfaceJet jet = evaluate(surface, nearest.uv.x, nearest.uv.y, 2);
    Curvature curvature = principal_curvature(transformed(to_world, jet));
    // What mirrors turns Su × Sv to the other side.
    double sign = (face.reversed ? -1.0 : 1.0) * (determinant(to_world.linear) < 0 ? -1.0 : 1.0);
    if (curvature.kind == Curvature::Kind::undefined) {
      curvature = principal_curvature(surface, nearest.uv.x, nearest.uv.y, face.uv_box.center());
      const Mat3 normals = cofactor(to_world.linear);
      curvature.n = normalized(normals * curvature.n);
      curvature.d1 = normalized(transform_vector(to_world, curvature.d1));
    }
    Hit hit;
    hit.depth = nearest.t;
    hit.point = transform_point(to_world, jet.p);
    hit.normal = curvature.n * sign;
    hit.k1 = curvature.k1 * sign;
    hit.k2 = curvature.k2 * sign;
    hit.d1 = curvature.d1;
    hit.instance = nearest.instance;
    hit.face = nearest.face;
    hit.number = first_number_[nearest.instance] + nearest.face;
    hit.u = nearest.uv.x;
    hit.v = nearest.uv.y;
    hit.in_crack = nearest.in_crack;
    return hit;
  }

  const Model& model_;
  std::vector<ExactPart> parts_;
  std::vector<Affine3> to_part_;
  std::vector<std::uint32_t> first_number_;
  Bvh instances_;
};

ExactScene::ExactScene(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
ExactScene::~ExactScene() = default;

std::optional<Hit> ExactScene::cast(const Line& ray, double least) const {
  return impl_->cast(ray, least);
}

std::vector<std::string> ExactScene::incomplete_faces() const {
  std::vector<std::string> lines;
  for (std::size_t p = 0; p < impl_->parts().size(); ++p) {
    const Part& part = impl_->model().parts[p];
    for (std::size_t f = 0; f < part.faces.size(); ++f)
      if (!impl_->parts()[p].faces()[f].surface->complete())
        lines.push_back("face " + std::to_string(f + 1) + " of " + part.name + ": " +
                        std::string(kind_name(part.surfaces[part.faces[f].surface])));
  }
  return lines;
}

double ExactScene::widest_gap() const {
  double widest = 0;
  for (std::size_t p = 0; p < impl_->parts().size(); ++p)
    for (std::size_t f = 0; f < impl_->parts()[p].faces().size(); ++f) {
      const Vec2 size = impl_->model().parts[p].faces[f].uv_box.size();
      const double extent = std::max(size.x, size.y);
      if (extent > 0) widest = std::max(widest, impl_->parts()[p].faces()[f].region->widest_gap() / extent);
    }
  return widest;
}

Line pixel_ray(const Camera& camera, int column, int row) {
  const CameraAxes axes = camera_axes(camera);
  const double half =
      camera.orthographic ? camera.ortho_height / 2 : std::tan(camera.fov_degrees * std::numbers::pi / 360);
  const double x = (2 * (column + 0.5) / camera.width - 1) * half * camera.width / camera.height,
               y = (1 - 2 * (row + 0.5) / camera.height) * half;
  const Vec3 across = axes.right * x + axes.up * y;
  return camera.orthographic ? Line{camera.eye + across, -axes.back} : Line{camera.eye, across - axes.back};
}

}  // namespace dupin::exact
