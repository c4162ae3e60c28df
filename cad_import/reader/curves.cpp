#include <Geom2dConvert.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_Hyperbola.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_OffsetCurve.hxx>
#include <Geom2d_Parabola.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Hyperbola.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetCurve.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <gp_Circ.hxx>
#include <gp_Circ2d.hxx>
#include <gp_Elips.hxx>
#include <gp_Elips2d.hxx>
#include <gp_Hypr.hxx>
#include <gp_Hypr2d.hxx>
#include <gp_Lin.hxx>
#include <gp_Lin2d.hxx>
#include <gp_Parab.hxx>
#include <gp_Parab2d.hxx>

#include "geometry.h"
#include "splines.h"

namespace dupin::reader {
namespace {

// The two dimensions' classes have the same members under different names.
struct Plane2 {
  using V = Vec2;
  using Curve = Geom2d_Curve;
  using Line = Geom2d_Line;
  using Circle = Geom2d_Circle;
  using Ellipse = Geom2d_Ellipse;
  using Parabola = Geom2d_Parabola;
  using Hyperbola = Geom2d_Hyperbola;
  using Bezier = Geom2d_BezierCurve;
  using Bspline = Geom2d_BSplineCurve;
  using Offset = Geom2d_OffsetCurve;
  using Trimmed = Geom2d_TrimmedCurve;
  static auto lin(const Line& c) { return c.Lin2d(); }
  static auto circ(const Circle& c) { return c.Circ2d(); }
  static auto elips(const Ellipse& c) { return c.Elips2d(); }
  static auto hypr(const Hyperbola& c) { return c.Hypr2d(); }
  static Vec3 reference(const Offset&) { return {}; }
};
struct Space3 {
  using V = Vec3;
  using Curve = Geom_Curve;
  using Line = Geom_Line;
  using Circle = Geom_Circle;
  using Ellipse = Geom_Ellipse;
  using Parabola = Geom_Parabola;
  using Hyperbola = Geom_Hyperbola;
  using Bezier = Geom_BezierCurve;
  using Bspline = Geom_BSplineCurve;
  using Offset = Geom_OffsetCurve;
  using Trimmed = Geom_TrimmedCurve;
  static auto lin(const Line& c) { return c.Lin(); }
  static auto circ(const Circle& c) { return c.Circ(); }
  static auto elips(const Ellipse& c) { return c.Elips(); }
  static auto hypr(const Hyperbola& c) { return c.Hypr(); }
  static Vec3 reference(const Offset& c) { return to_vec(c.Direction().XYZ()); }
};

auto coordinates(const gp_Pnt& p) {
  return to_vec(p.XYZ());
}
auto coordinates(const gp_Pnt2d& p) {
  return to_vec(p.XY());
}
auto coordinates(const gp_Dir& d) {
  return to_vec(d.XYZ());
}
auto coordinates(const gp_Dir2d& d) {
  return to_vec(d.XY());
}

template <class D>
BsplineOf<typename D::V> bezier(const typename D::Bezier& c) {
  BsplineOf<typename D::V> r;
  r.degree = c.Degree();
  r.knots.assign(r.degree + 1, 0.0);
  r.knots.insert(r.knots.end(), r.degree + 1, 1.0);
  for (int i = 1; i <= c.NbPoles(); ++i) {
    r.poles.push_back(coordinates(c.Pole(i)));
    if (c.IsRational()) r.weights.push_back(c.Weight(i));
  }
  drop_equal_weights(r.weights);
  return r;
}

template <class D>
BsplineOf<typename D::V> bspline(const typename D::Bspline& c) {
  BsplineOf<typename D::V> r;
  r.degree = c.Degree();
  r.periodic = c.IsPeriodic();
  r.knots = full_knots(c.Knots(), c.Multiplicities(), r.degree, r.periodic);
  const int count = c.NbPoles(), full = static_cast<int>(r.knots.size()) - r.degree - 1;
  for (int i = 0; i < full; ++i) {
    r.poles.push_back(coordinates(c.Pole(i % count + 1)));
    if (c.IsRational()) r.weights.push_back(c.Weight(i % count + 1));
  }
  drop_equal_weights(r.weights);
  return r;
}

template <class T, class Any>
const T* as(const Any& geometry) {
  return geometry->DynamicType() == T::get_type_descriptor() ? static_cast<const T*>(geometry.get())
                                                             : nullptr;
}

template <class D, class HandleType>
std::optional<CurveOf<typename D::V>> convert(const HandleType& curve) {
  using V = typename D::V;
  using Result = CurveOf<V>;
  if (curve.IsNull()) return std::nullopt;
  if (const auto* trimmed = as<typename D::Trimmed>(curve)) return convert<D>(trimmed->BasisCurve());
  if (const auto* line = as<typename D::Line>(curve)) {
    const auto c = D::lin(*line);
    return Result{LineOf<V>{coordinates(c.Location()), coordinates(c.Direction())}};
  }
  if (const auto* circle = as<typename D::Circle>(curve)) {
    const auto c = D::circ(*circle);
    return Result{CircleOf<V>{coordinates(c.Location()), coordinates(c.XAxis().Direction()),
                              coordinates(c.YAxis().Direction()), c.Radius()}};
  }
  if (const auto* ellipse = as<typename D::Ellipse>(curve)) {
    const auto c = D::elips(*ellipse);
    return Result{EllipseOf<V>{coordinates(c.Location()), coordinates(c.XAxis().Direction()),
                               coordinates(c.YAxis().Direction()), c.MajorRadius(), c.MinorRadius()}};
  }
  if (const auto* parabola = as<typename D::Parabola>(curve)) {
    const auto frame = parabola->Position();
    return Result{ParabolaOf<V>{coordinates(parabola->Location()), coordinates(frame.XDirection()),
                                coordinates(frame.YDirection()), parabola->Focal()}};
  }
  if (const auto* hyperbola = as<typename D::Hyperbola>(curve)) {
    const auto c = D::hypr(*hyperbola);
    return Result{HyperbolaOf<V>{coordinates(c.Location()), coordinates(c.XAxis().Direction()),
                                 coordinates(c.YAxis().Direction()), c.MajorRadius(), c.MinorRadius()}};
  }
  if (const auto* c = as<typename D::Bezier>(curve)) return Result{bezier<D>(*c)};
  if (const auto* c = as<typename D::Bspline>(curve)) return Result{bspline<D>(*c)};
  if (const auto* c = as<typename D::Offset>(curve)) {
    auto base = convert<D>(c->BasisCurve());
    if (!base) return std::nullopt;
    return Result{
        OffsetCurveOf<V>{std::make_shared<const Result>(std::move(*base)), c->Offset(), D::reference(*c)}};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Curve2> to_curve(const Handle(Geom2d_Curve) & curve) {
  return convert<Plane2>(curve);
}
std::optional<Curve3> to_curve(const Handle(Geom_Curve) & curve) {
  return convert<Space3>(curve);
}

}  // namespace dupin::reader
