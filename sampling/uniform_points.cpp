// Uniform sampling in a patch's parameters (Kalaiah & Varshney 2003, section IV-B).
#include "point_faces.h"

namespace dupin {
namespace {

constexpr int kProbes = 5;

/// How far a rectangle reaches in a direction of its plane.
double reach(const DifferentialPoint& point, const Vec3& direction) {
  const double x = std::abs(dot(direction, point.u)), y = std::abs(dot(direction, point.v));
  return std::min(x > 0 ? point.half_u / x : INFINITY, y > 0 ? point.half_v / y : INFINITY);
}

/// Steps along one parameter over the lines through the probes: by the spacing, or by the rectangles' reach.
double steps_needed(const FacePoints& face, const Box2& patch, bool along_u) {
  const double spacing = face.options().spacing;
  const int lines = spacing > 0 ? 3 : kProbes;
  double most = 1;
  for (int line = 0; line < lines; ++line) {
    double length_of_line = 0, density = 0;
    std::optional<Vec3> last;
    for (int i = 0; i < kProbes; ++i) {
      const double along = i / (kProbes - 1.0), across = line / (lines - 1.0);
      const Vec2 part = along_u ? Vec2{along, across} : Vec2{across, along};
      const Vec2 uv = patch.lo + Vec2{patch.size().x * part.x, patch.size().y * part.y};
      const Vec3 here = point_at(face.surface(), uv.x, uv.y);
      if (last) length_of_line += distance(*last, here);
      last = here;
      if (spacing > 0) continue;
      const SurfaceJet jet = evaluate(face.surface(), uv.x, uv.y, 1);
      const Vec3 speed = along_u ? jet.pu * patch.size().x : jet.pv * patch.size().y;
      const double size = length(speed);
      const auto point = face.at(uv, patch.center());
      if (point && size > 0) density = std::max(density, size / reach(*point, speed / size));
    }
    most = std::max(most, spacing > 0 ? length_of_line / spacing : density);
  }
  return most;
}

std::uint32_t samples(const FacePoints& face, const Box2& patch, bool along_u, int refine) {
  const int grid = face.options().grid;
  const double most = std::max(kMostSteps, grid) - 1;
  const double steps = grid > 0 ? grid - 1 : std::ceil(steps_needed(face, patch, along_u));
  return static_cast<std::uint32_t>(std::clamp(steps * refine, 1.0, most)) + 1;
}

}  // namespace

SampleGrid uniform_grid(const FacePoints& face, const Box2& patch, int refine) {
  return {0, samples(face, patch, true, refine), samples(face, patch, false, refine)};
}

PatchPoints uniform_patch(const FacePoints& face, const Box2& patch, const SampleGrid& grid) {
  PatchPoints out;
  bool any = false;
  for (std::uint32_t i = 0; i < grid.rows; ++i)
    for (std::uint32_t j = 0; j < grid.columns; ++j) {
      const Vec2 part{static_cast<double>(i) / (grid.rows - 1), static_cast<double>(j) / (grid.columns - 1)};
      const Vec2 uv{i + 1 == grid.rows ? patch.hi.x : patch.lo.x + patch.size().x * part.x,
                    j + 1 == grid.columns ? patch.hi.y : patch.lo.y + patch.size().y * part.y};
      std::uint32_t index = kNoPoint;
      if (face.region().contains(uv)) {
        if (const auto point = face.at(uv, patch.center())) {
          index = static_cast<std::uint32_t>(out.points.points.size());
          out.points.points.push_back(*point);
          any = true;
        } else {
          out.undefined = true;
        }
      }
      out.points.grid_points.push_back(index);
    }
  if (any) {
    out.points.grids.push_back(grid);
  } else {
    out.points.grid_points.clear();
  }
  return out;
}

}  // namespace dupin
