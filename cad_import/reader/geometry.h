// OCCT's curves and surfaces as ours. Parametrisations are the same, so parameter ranges carry over
// unchanged.
#ifndef DUPIN_CAD_IMPORT_READER_GEOMETRY_H
#define DUPIN_CAD_IMPORT_READER_GEOMETRY_H

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <gp_Trsf.hxx>
#include <gp_XY.hxx>
#include <gp_XYZ.hxx>

#include <optional>

#include "../../nurbs/curve.h"
#include "../../nurbs/surface.h"

namespace dupin::reader {

inline Vec2 to_vec(const gp_XY& p) {
  return {p.X(), p.Y()};
}
inline Vec3 to_vec(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}
Affine3 to_affine(const gp_Trsf& t);

/// None for a kind that has no exact counterpart and no B-spline form either. Trimmed curves give their base.
std::optional<Curve2> to_curve(const Handle(Geom2d_Curve) & curve);
std::optional<Curve3> to_curve(const Handle(Geom_Curve) & curve);
/// Rectangular-trimmed surfaces give their base.
std::optional<Surface> to_surface(const Handle(Geom_Surface) & surface);

/// The surface below any rectangular trimming.
Handle(Geom_Surface) untrimmed(Handle(Geom_Surface) surface);

}  // namespace dupin::reader

#endif
