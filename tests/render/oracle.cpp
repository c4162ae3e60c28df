#include "oracle.h"

namespace dupin::testing {
namespace {

/// Every root of the quadric along o + t d, by the textbook formula in long double, the surest there is here.
int roots(const QuadricDp& dp, const Vec3& o, const Vec3& d, double t[2]) {
  const long double lu = dp.lambda_u, lv = dp.lambda_v, a = dp.a, b = dp.b, c = dp.c;
  const long double A =
      -(lu * d.x * d.x + lv * d.y * d.y + c * d.z * d.z) / 2 - a * d.x * d.z - b * d.y * d.z;
  const long double B = d.z - lu * o.x * d.x - lv * o.y * d.y - c * o.z * d.z - a * (o.x * d.z + o.z * d.x) -
                        b * (o.y * d.z + o.z * d.y);
  const long double C =
      o.z - (lu * o.x * o.x + lv * o.y * o.y + c * o.z * o.z) / 2 - a * o.x * o.z - b * o.y * o.z;
  if (A == 0) {
    if (B == 0) return 0;
    t[0] = static_cast<double>(-C / B);
    return 1;
  }
  const long double disc = B * B - 4 * A * C;
  if (disc < 0) return 0;
  const long double s = std::sqrt(disc);
  t[0] = static_cast<double>((-B - s) / (2 * A));
  t[1] = static_cast<double>((-B + s) / (2 * A));
  return 2;
}

/// Principal curvatures of F = 0 at p from its mean and Gaussian curvature (Goldman's formulas), positive
/// towards ∇F.
void curvatures(const QuadricDp& dp, const Vec3& p, double& k1, double& k2) {
  const Vec3 g = quadric_gradient(dp, p);
  const Mat3 h{{-dp.lambda_u, 0, -dp.a}, {0, -dp.lambda_v, -dp.b}, {-dp.a, -dp.b, -dp.c}};
  const double l = length(g), trace = h.x.x + h.y.y + h.z.z;
  const double mean = (dot(g, h * g) - l * l * trace) / (2 * l * l * l);
  const double gauss = dot(g, cofactor(h) * g) / (l * l * l * l);
  const double r = std::sqrt(std::max(0.0, mean * mean - gauss));
  k1 = mean >= 0 ? mean + r : mean - r;
  k2 = mean >= 0 ? mean - r : mean + r;
}

bool cut_away(const Sections& sections, const Vec3& p) {
  return std::any_of(sections.begin(), sections.end(),
                     [&](const auto& section) { return dot(section.normal, p) + section.offset < 0; });
}

}  // namespace

Ray pixel_ray(const Camera& camera, double column, double row) {
  const CameraAxes axes = camera_axes(camera);
  const double aspect = static_cast<double>(camera.width) / camera.height;
  const double half = camera.orthographic ? camera.ortho_height / 2
                                          : std::tan(camera.fov_degrees * 3.14159265358979323846 / 360);
  const double x = ((column + 0.5) / camera.width * 2 - 1) * aspect * half,
               y = (1 - (row + 0.5) / camera.height * 2) * half;
  const Vec3 across = axes.right * x + axes.up * y;
  return camera.orthographic ? Ray{camera.eye + across, -axes.back} : Ray{camera.eye, across - axes.back};
}

std::optional<OracleHit> cast(const HandMade& scene, const Camera& camera, const Ray& ray,
                              const Sections& sections) {
  std::optional<OracleHit> best;
  const PartDps& part = scene.dps.parts[0];
  for (std::size_t k = 0; k < scene.model.instances.size(); ++k) {
    const Affine3& to_world = scene.model.instances[k].to_world;
    const Affine3 back = inverse(to_world);
    const Vec3 o = transform_point(back, ray.origin), d = transform_vector(back, ray.direction);
    for (std::size_t i = 0; i < part.dps.size(); ++i) {
      const QuadricDp& dp = part.dps[i];
      const Frame3 frame{dp.origin, dp.u, dp.v, dp.n()};
      const Vec3 lo = frame.to_local(o), ld{dot(d, dp.u), dot(d, dp.v), dot(d, dp.n())};
      double t[2];
      const int n = roots(dp, lo, ld, t);
      for (int r = 0; r < n; ++r) {
        Vec3 p = lo + ld * t[r];
        if (dp.planar) p.z = 0;
        if ((!camera.orthographic && t[r] <= 0) || (best && t[r] >= best->depth) ||
            !region_contains(part, dp, p) || cut_away(sections, ray.origin + ray.direction * t[r]))
          continue;
        OracleHit hit;
        hit.depth = t[r];
        hit.point = ray.origin + ray.direction * t[r];
        const Vec3 g = quadric_gradient(dp, p) * (dp.flipped ? -1.0 : 1.0);
        const Mat3 m = cofactor(to_world.linear);
        hit.normal = normalized(m * (dp.u * g.x + dp.v * g.y + dp.n() * g.z)) *
                     (determinant(to_world.linear) < 0 ? -1.0 : 1.0);
        hit.face = static_cast<std::uint32_t>(k * part.dps.size() + dp.face + 1);
        hit.primitive = static_cast<std::uint32_t>(k * part.dps.size() + i + 1);
        curvatures(dp, p, hit.k1, hit.k2);
        if (dp.flipped) hit.k1 = -hit.k1, hit.k2 = -hit.k2;
        best = hit;
      }
    }
  }
  return best;
}

Differences differences(const HandMade& scene, const Camera& camera, const Frame& frame,
                        const Sections& sections) {
  Differences d;
  const double degree = 180 / 3.14159265358979323846;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const std::size_t i = static_cast<std::size_t>(row * camera.width + column);
      const auto hit = cast(scene, camera, pixel_ray(camera, column, row), sections);
      ++d.pixels;
      d.covered += hit.has_value();
      if (hit.has_value() != (frame.primitive[i] != 0)) ++d.coverage;
      if (!hit || frame.primitive[i] == 0) continue;
      if (hit->primitive != frame.primitive[i] || hit->face != frame.face[i]) {
        ++d.other_primitive;
        continue;
      }
      const auto vec = [&](const std::vector<float>& v) {
        return Vec3{v[3 * i], v[3 * i + 1], v[3 * i + 2]};
      };
      const double px = pixel_size(camera, hit->depth);
      // On a grazing surface depth changes by many pixels from one pixel to the next.
      const double facing =
          std::max(std::abs(dot(hit->normal, normalized(pixel_ray(camera, column, row).direction))), 1e-3);
      d.depth_px = std::max(d.depth_px, std::abs(frame.depth[i] - hit->depth) / px * facing);
      d.position_px = std::max(d.position_px, distance(vec(frame.position), hit->point) / px * facing);
      d.normal_degrees =
          std::max(d.normal_degrees, length(vec(frame.normal) - hit->normal) * degree * facing);
      const double scale = std::max(std::abs(hit->k1), 1e-6);
      d.curvature = std::max({d.curvature, std::abs(frame.curvature[2 * i] - hit->k1) / scale * facing,
                              std::abs(frame.curvature[2 * i + 1] - hit->k2) / scale * facing});
    }
  }
  return d;
}

}  // namespace dupin::testing
