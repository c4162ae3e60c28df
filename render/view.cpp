#include "view.h"

#include <optional>

namespace dupin {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Side {
  Vec3 back, up;
};

std::optional<Side> side(std::string_view name) {
  if (name == "iso") return Side{normalized(Vec3{1, -1, 1}), {0, 0, 1}};
  if (name == "front") return Side{{0, -1, 0}, {0, 0, 1}};
  if (name == "back") return Side{{0, 1, 0}, {0, 0, 1}};
  if (name == "left") return Side{{-1, 0, 0}, {0, 0, 1}};
  if (name == "right") return Side{{1, 0, 0}, {0, 0, 1}};
  if (name == "top") return Side{{0, 0, 1}, {0, 1, 0}};
  if (name == "bottom") return Side{{0, 0, -1}, {0, -1, 0}};
  return std::nullopt;
}

/// The box's corners seen from its centre: along one picture axis, and away from the viewer.
struct Extents {
  double plus, minus;  ///< max over the corners of (±x − slope·depth): what the eye's distance and sideways
                       ///< place must make up for
};
Extents extents(const Box3& box, const Vec3& axis, const Vec3& back, double slope) {
  Extents e{-INFINITY, -INFINITY};
  for (int i = 0; i < 8; ++i) {
    const Vec3 p = box.corner(i) - box.center();
    const double x = dot(p, axis), depth = -dot(p, back);
    e.plus = std::max(e.plus, x - slope * depth);
    e.minus = std::max(e.minus, -x - slope * depth);
  }
  return e;
}

Box3 drawable(const Box3& box) {
  Box3 result = box;
  if (box.empty()) result.add(Vec3{});
  if (result.diagonal() > 0) return result;
  const Vec3 c = result.center();
  result.add(c + Vec3{0.5, 0.5, 0.5});
  result.add(c - Vec3{0.5, 0.5, 0.5});
  return result;
}

}  // namespace

Result<Camera> fit_view(const Box3& given, std::string_view name, const Camera& settings) {
  const std::optional<Side> from = side(name);
  if (!from) return {StatusCode::invalid_argument, "there is no view \"" + std::string(name) + "\""};
  const Box3 box = drawable(given);
  Camera camera = settings;
  camera.up = from->up;
  camera.eye = from->back;
  camera.target = {};
  const CameraAxes axes = camera_axes(camera);
  const double aspect = static_cast<double>(camera.width) / camera.height;
  const double tangent =
      camera.orthographic ? 0 : std::tan(camera.fov_degrees * kPi / 360) * (1 - kFitMargin);
  // A corner x sideways and z behind the centre is in the picture from an eye e sideways and d in front of
  // the centre if |x − e| <= slope (z + d): two conditions an axis, whose extremes over the corners give the
  // smallest d and its e.
  const Extents h = extents(box, axes.right, axes.back, tangent * aspect),
                v = extents(box, axes.up, axes.back, tangent);
  const Vec3 center =
      box.center() + axes.right * ((h.plus - h.minus) / 2) + axes.up * ((v.plus - v.minus) / 2);
  double d = box.diagonal();
  if (camera.orthographic) {
    camera.ortho_height = std::max(v.plus + v.minus, (h.plus + h.minus) / aspect) / (1 - kFitMargin);
  } else {
    d = std::max((h.plus + h.minus) / (2 * tangent * aspect), (v.plus + v.minus) / (2 * tangent));
  }
  camera.target = center;
  camera.eye = center + axes.back * d;
  return camera;
}

}  // namespace dupin
