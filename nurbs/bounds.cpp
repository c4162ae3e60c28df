#include "bounds.h"

#include <algorithm>
#include <numbers>

#include "homogeneous.h"
#include "tensor.h"

namespace dupin {
namespace {

Box3 box_of(const std::vector<Vec4>& poles) {
  Box3 box;
  for (const Vec4& pole : poles) {
    if (!(pole.w > 0)) {
      const double infinity = std::numeric_limits<double>::infinity();
      return {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
    }
    box.add(homogeneous::projected(pole));
  }
  return box;
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace

Box3 bounding_box(const BezierPatch& patch) {
  return box_of(patch.poles);
}
Box3 bounding_box(const BezierCurve3& curve) {
  return box_of(curve.poles);
}

NormalCone normal_cone(const BezierPatch& patch) {
  const NormalCone everything{{}, std::numbers::pi};
  for (const Vec4& pole : patch.poles)
    if (!(pole.w > 0)) return everything;
  Frame3 frame;
  frame.origin = homogeneous::projected(patch.pole(patch.degree_u / 2, patch.degree_v / 2));
  const std::array<Tensor, 3> n = normal_tensors(homogeneous_tensors(patch, frame), patch.rational);
  // Scaling does not turn a coefficient: the scaled form will do.
  double largest = 0;
  Vec3 sum;
  for (std::size_t i = 0; i < n[0].c.size(); ++i) {
    const Vec3 coefficient{n[0].c[i], n[1].c[i], n[2].c[i]};
    largest = std::max(largest, length(coefficient));
  }
  const double least = 1e-13 * largest;
  std::vector<Vec3> directions;
  directions.reserve(n[0].c.size());
  for (std::size_t i = 0; i < n[0].c.size(); ++i) {
    const Vec3 coefficient{n[0].c[i], n[1].c[i], n[2].c[i]};
    if (length(coefficient) > least) directions.push_back(normalized(coefficient)), sum += directions.back();
  }
  if (!(length(sum) > 0)) return everything;
  NormalCone cone{normalized(sum), 0};
  for (const Vec3& d : directions) cone.angle = std::max(cone.angle, angle_between(cone.axis, d));
  cone.angle += 1e-12;  // the coefficients' own rounding
  return cone.bounded() ? cone : everything;
}

bool may_face(const NormalCone& cone, const Vec3& to_eye, double spread) {
  return !cone.bounded() || angle_between(cone.axis, to_eye) < std::numbers::pi / 2 + cone.angle + spread;
}

}  // namespace dupin
