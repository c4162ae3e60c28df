#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>

#include "geometry.h"
#include "splines.h"

namespace dupin::reader {
namespace {

Frame3 to_frame(const gp_Ax3& a) {
  return {to_vec(a.Location().XYZ()), to_vec(a.XDirection().XYZ()), to_vec(a.YDirection().XYZ()),
          to_vec(a.Direction().XYZ())};
}

std::vector<double> clamped_unit_knots(int degree) {
  std::vector<double> knots(degree + 1, 0.0);
  knots.insert(knots.end(), degree + 1, 1.0);
  return knots;
}

template <class S>
void copy_poles(const S& s, BsplineSurface& r) {
  const int nu = s.NbUPoles(), nv = s.NbVPoles();
  const bool rational = s.IsURational() || s.IsVRational();
  r.count_u = static_cast<int>(r.knots_u.size()) - r.degree_u - 1;
  r.count_v = static_cast<int>(r.knots_v.size()) - r.degree_v - 1;
  r.poles.reserve(static_cast<std::size_t>(r.count_u) * r.count_v);
  for (int i = 0; i < r.count_u; ++i)
    for (int j = 0; j < r.count_v; ++j) {
      r.poles.push_back(to_vec(s.Pole(i % nu + 1, j % nv + 1).XYZ()));
      if (rational) r.weights.push_back(s.Weight(i % nu + 1, j % nv + 1));
    }
  drop_equal_weights(r.weights);
}

BsplineSurface bezier(const Geom_BezierSurface& s) {
  BsplineSurface r;
  r.degree_u = s.UDegree(), r.degree_v = s.VDegree();
  r.knots_u = clamped_unit_knots(r.degree_u), r.knots_v = clamped_unit_knots(r.degree_v);
  copy_poles(s, r);
  return r;
}

BsplineSurface bspline(const Geom_BSplineSurface& s) {
  BsplineSurface r;
  r.degree_u = s.UDegree(), r.degree_v = s.VDegree();
  r.periodic_u = s.IsUPeriodic(), r.periodic_v = s.IsVPeriodic();
  r.knots_u = full_knots(s.UKnots(), s.UMultiplicities(), r.degree_u, r.periodic_u);
  r.knots_v = full_knots(s.VKnots(), s.VMultiplicities(), r.degree_v, r.periodic_v);
  copy_poles(s, r);
  return r;
}

std::optional<Surface> offset(const Geom_OffsetSurface& s) {
  // The offset of a plane, cylinder, … is one itself, with the same parameters.
  const Handle(Geom_Surface) same = s.Surface();
  if (!same.IsNull() && same->DynamicType() != STANDARD_TYPE(Geom_OffsetSurface)) return to_surface(same);
  auto base = to_surface(s.BasisSurface());
  if (!base) return std::nullopt;
  return Surface{OffsetSurface{std::make_shared<const Surface>(std::move(*base)), s.Offset()}};
}

}  // namespace

Affine3 to_affine(const gp_Trsf& t) {
  const gp_Mat m = t.VectorialPart();  // with the scale
  return {{to_vec(m.Column(1)), to_vec(m.Column(2)), to_vec(m.Column(3))}, to_vec(t.TranslationPart())};
}

Handle(Geom_Surface) untrimmed(Handle(Geom_Surface) surface) {
  while (!surface.IsNull() && surface->IsKind(STANDARD_TYPE(Geom_RectangularTrimmedSurface)))
    surface = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface)->BasisSurface();
  return surface;
}

std::optional<Surface> to_surface(const Handle(Geom_Surface) & any) {
  const Handle(Geom_Surface) surface = untrimmed(any);
  if (surface.IsNull()) return std::nullopt;
  const auto type = surface->DynamicType();
  const Geom_Surface& s = *surface;
  if (type == STANDARD_TYPE(Geom_Plane))
    return Surface{Plane{to_frame(static_cast<const Geom_Plane&>(s).Position())}};
  if (type == STANDARD_TYPE(Geom_CylindricalSurface)) {
    const auto& c = static_cast<const Geom_CylindricalSurface&>(s);
    return Surface{Cylinder{to_frame(c.Position()), c.Radius()}};
  }
  if (type == STANDARD_TYPE(Geom_ConicalSurface)) {
    const auto& c = static_cast<const Geom_ConicalSurface&>(s);
    return Surface{Cone{to_frame(c.Position()), c.RefRadius(), c.SemiAngle()}};
  }
  if (type == STANDARD_TYPE(Geom_SphericalSurface)) {
    const auto& c = static_cast<const Geom_SphericalSurface&>(s);
    return Surface{Sphere{to_frame(c.Position()), c.Radius()}};
  }
  if (type == STANDARD_TYPE(Geom_ToroidalSurface)) {
    const auto& c = static_cast<const Geom_ToroidalSurface&>(s);
    return Surface{Torus{to_frame(c.Position()), c.MajorRadius(), c.MinorRadius()}};
  }
  if (type == STANDARD_TYPE(Geom_BezierSurface))
    return Surface{bezier(static_cast<const Geom_BezierSurface&>(s))};
  if (type == STANDARD_TYPE(Geom_BSplineSurface))
    return Surface{bspline(static_cast<const Geom_BSplineSurface&>(s))};
  if (type == STANDARD_TYPE(Geom_SurfaceOfRevolution)) {
    const auto& c = static_cast<const Geom_SurfaceOfRevolution&>(s);
    auto profile = to_curve(c.BasisCurve());
    if (!profile) return std::nullopt;
    return Surface{Revolution{to_vec(c.Location().XYZ()), to_vec(c.Direction().XYZ()), std::move(*profile)}};
  }
  if (type == STANDARD_TYPE(Geom_SurfaceOfLinearExtrusion)) {
    const auto& c = static_cast<const Geom_SurfaceOfLinearExtrusion&>(s);
    auto profile = to_curve(c.BasisCurve());
    if (!profile) return std::nullopt;
    return Surface{Extrusion{std::move(*profile), to_vec(c.Direction().XYZ())}};
  }
  if (type == STANDARD_TYPE(Geom_OffsetSurface)) return offset(static_cast<const Geom_OffsetSurface&>(s));
  return std::nullopt;
}

}  // namespace dupin::reader
