// Inside the folder: splines in double-double arithmetic, for points so close to a singular one, or so badly
// parametrised, that double precision does not see their curvature.
#ifndef DUPIN_NURBS_PRECISE_H
#define DUPIN_NURBS_PRECISE_H

#include <optional>

#include "double_double.h"
#include "jets.h"

namespace dupin {

/// A jet to about 30 digits, relative to `reference`.
struct PreciseJet {
  std::array<std::array<DoubleDouble, 3>, jet_size(3)> d;
  Vec3 reference;
  double size_u = 0, size_v = 0;  ///< of the sums that Su and Sv are: how large what may have cancelled is

  SurfaceJet rounded() const;
};
/// (u, v) in the spline's domain; order 0 … 3.
PreciseJet precise_jet(const BsplineSurface& surface, double u, double v, int order, Sides sides = {});

/// By the symmetric shape operator; empty where Su × Sv vanishes even so.
std::optional<Curvature> precise_curvature(const PreciseJet& jet);

}  // namespace dupin

#endif
